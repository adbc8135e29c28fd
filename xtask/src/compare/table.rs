//! The tables, in Markdown.

use std::fmt::Write;

use super::statistics::Ratio;

/// One piece of work against one peer.
#[derive(Clone, Debug)]
pub struct Row {
    /// Rows of one group, which follow each other, make one table.
    pub group: String,
    /// What was done on which pictures.
    pub title: String,
    /// Against whom.
    pub peer: String,
    /// Median of a call of ours.
    pub ours_ns: f64,
    /// Median of a call of theirs.
    pub theirs_ns: f64,
    /// How many times faster we are.
    pub ratio: Ratio,
    /// What the ratio should be at least.
    pub target: Option<f64>,
}

impl Row {
    fn misses(&self) -> bool {
        self.target.is_some_and(|target| self.ratio.median < target)
    }

    fn verdict(&self) -> String {
        match self.target {
            None => "–".to_owned(),
            Some(target) if self.misses() => format!("≥ {target}: **missed**"),
            Some(target) => format!("≥ {target}: met"),
        }
    }
}

/// A table for each group, under a heading.
pub fn table(rows: &[Row]) -> String {
    let mut text = String::new();
    let mut group = "";
    for row in rows {
        if row.group != group {
            let gap = if group.is_empty() { "" } else { "\n" };
            group = &row.group;
            let _ = writeln!(text, "{gap}### {group}\n\n{HEAD}");
        }
        let Ratio { median, middle_half: [low, high], all: [least, most] } = row.ratio;
        let _ = writeln!(
            text,
            "| {} | {} | {} | {} | **{median:.2}** | {low:.2} … {high:.2} | {least:.2} … {most:.2} | {} |",
            row.title,
            microseconds(row.ours_ns),
            row.peer,
            microseconds(row.theirs_ns),
            row.verdict()
        );
    }
    text
}

const HEAD: &str = "| Work | prf, µs | Peer | Peer, µs | Times faster | Half of the rounds | All rounds | Target |\n\
                    |---|---|---|---|---|---|---|---|";

/// For each group, how many targets are missed.
pub fn missed(rows: &[Row]) -> String {
    let groups = rows.chunk_by(|a, b| a.group == b.group).map(|rows| {
        let targets = rows.iter().filter(|row| row.target.is_some()).count();
        match rows.iter().filter(|row| row.misses()).count() {
            0 => format!("{} {targets} of {targets}", rows[0].group),
            missed => format!("{} {} of {targets} (**{missed} missed**)", rows[0].group, targets - missed),
        }
    });
    format!("Targets met: {}.", groups.collect::<Vec<_>>().join(", "))
}

/// Three figures, as far as there are that many.
fn microseconds(ns: f64) -> String {
    let us = ns / 1e3;
    match us {
        _ if us < 9.995 => format!("{us:.2}"),
        _ if us < 99.95 => format!("{us:.1}"),
        _ => format!("{us:.0}"),
    }
}
