//! `cargo xtask compare python`.

use std::collections::BTreeMap;
use std::fmt::Write;
use std::fs;
use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::Stdio;

use anyhow::{Context, Result, ensure};
use serde::Deserialize;

use super::cases::perception_cases;
use super::document::replace_section;
use super::statistics::{Ratio, median};
use super::table::{Row, missed, table};
use super::{machine, setup};
use crate::venv::target;

const DOCUMENT: &str = "docs/results/python.md";
/// Rows of this group compare a call with the work itself, so they have a table of their own.
const CALLS: &str = "Call";

pub(super) fn run(root: &Path) -> Result<()> {
    let document = root.join(DOCUMENT);
    let text = fs::read_to_string(&document).with_context(|| format!("can't read {DOCUMENT}"))?;
    // Told before the minutes of measuring, not after.
    replace_section(&text, "").with_context(|| format!("{DOCUMENT} can't take the tables"))?;

    let folder = target(root).join("compare").join("perception");
    let (cases, gallery) = perception_cases();
    gallery.write(&folder, &cases)?;
    let mut command = setup::package(root)?;
    command.arg(&folder).stdin(Stdio::null()).stdout(Stdio::piped());
    setup::hold_to_one_thread(&mut command);
    let mut child = command.spawn().context("can't start python_package.py")?;
    let mut lines = BufReader::new(child.stdout.take().context("a script without output")?).lines();
    let versions: Versions =
        parse(&lines.next().context("python_package.py said nothing; its last words are above")??)?;
    let mut measured = Vec::new();
    for line in lines {
        let row: Measured = parse(&line?)?;
        eprintln!("{}: {}", row.group, row.title);
        measured.push(row);
    }
    let status = child.wait()?;
    ensure!(status.success(), "python_package.py ended with {status}; its last words are above");

    let section = section(&versions.versions, measured);
    fs::write(&document, replace_section(&text, &section)?).with_context(|| format!("can't write {DOCUMENT}"))?;
    println!("{section}\nwritten to {DOCUMENT}");
    Ok(())
}

#[derive(Deserialize)]
struct Versions {
    versions: BTreeMap<String, String>,
}

/// A row as the script tells it.
#[derive(Deserialize)]
struct Measured {
    group: String,
    title: String,
    peer: String,
    ours_ns: Vec<f64>,
    theirs_ns: Vec<f64>,
    target: Option<f64>,
}

fn parse<'a, T: Deserialize<'a>>(line: &'a str) -> Result<T> {
    serde_json::from_str(line).with_context(|| format!("python_package.py said {line:?}"))
}

fn section(versions: &BTreeMap<String, String>, measured: Vec<Measured>) -> String {
    let versions = versions.iter().map(|(name, version)| format!("{name} {version}")).chain(machine::compiler());
    let (calls, others): (Vec<_>, Vec<_>) = measured.into_iter().partition(|row| row.group == CALLS);
    let rows: Vec<Row> = others.into_iter().map(Measured::row).collect();
    format!(
        "Machine: {}; one thread each side. Versions: {}.\n\n{}\n\n{}\n{}",
        machine::describe(),
        versions.collect::<Vec<_>>().join(", "),
        missed(&rows),
        call_table(&calls),
        table(&rows)
    )
}

impl Measured {
    fn row(self) -> Row {
        Row {
            ours_ns: median(&self.ours_ns),
            theirs_ns: median(&self.theirs_ns),
            ratio: Ratio::of(&self.ours_ns, &self.theirs_ns),
            group: self.group,
            title: self.title,
            peer: self.peer,
            target: self.target,
        }
    }
}

/// What a call from Python adds to the same work in Rust; the aim is at most 1 µs and a tenth.
fn call_table(calls: &[Measured]) -> String {
    let mut text = String::from(
        "### Call\n\n| Work | `goal.reward(frame)`, µs | in Rust, µs | the call adds, µs | at most 1 µs + 10 % |\n|---|---|---|---|---|\n",
    );
    for Measured { title, ours_ns, theirs_ns, .. } in calls {
        let added: Vec<f64> = ours_ns.iter().zip(theirs_ns).map(|(ours, theirs)| ours - theirs).collect();
        let (ours, theirs, added) = (median(ours_ns), median(theirs_ns), median(&added));
        let verdict = if added <= 1e3 + theirs / 10.0 { "met" } else { "**missed**" };
        let [ours, theirs, added] = [ours, theirs, added].map(|ns| ns / 1e3);
        let _ = writeln!(text, "| {title} | {ours:.2} | {theirs:.2} | **{added:.2}** | {verdict} |");
    }
    text
}
