//! All settings side by side.

use std::collections::BTreeSet;
use std::fmt::Write as _;

use prf_core::Judgement;

use super::Judged;
use crate::evidence::words;
use crate::plot::heat::{HeatTable, hundredths};

/// Cell sizes by norms and blocks, of one window; `best` is marked.
pub(super) fn settings(title: String, judgements: &[Judgement], best: &Judgement) -> HeatTable {
    let column = |judgement: &Judgement| {
        let hog = judgement.params.hog;
        format!("{}\n{}x{}", words::norm_name(hog.norm), hog.block_cells, hog.block_cells)
    };
    let mut columns: Vec<String> = Vec::new();
    for judgement in judgements {
        if !columns.contains(&column(judgement)) {
            columns.push(column(judgement));
        }
    }
    let cells: BTreeSet<usize> = judgements.iter().map(|judgement| judgement.cell_px).collect();
    let at = |px: usize, name: &String| judgements.iter().find(|j| j.cell_px == px && column(j) == *name);
    let row = |&px: &usize| {
        let values = columns.iter().map(|name| at(px, name).map(|judgement| judgement.quality)).collect();
        (format!("{px} px"), values)
    };
    let rows: Vec<_> = cells.iter().map(row).collect();
    let place =
        (cells.iter().position(|&px| px == best.cell_px), columns.iter().position(|name| *name == column(best)));
    let marked = match place {
        (Some(row), Some(column)) => Some((row, column)),
        _ => None,
    };
    HeatTable { title, columns, rows, marked }
}

/// Heights by widths of the windows, each with its best setting; `best` is marked.
pub(super) fn windows(title: String, judged: &[Judged], best: &Judged) -> HeatTable {
    let sizes = |side: fn(&Judged) -> Option<usize>| judged.iter().filter_map(side).collect::<BTreeSet<usize>>();
    let width = |window: &Judged| window.candidate.rect.map(|rect| rect.width);
    let height = |window: &Judged| window.candidate.rect.map(|rect| rect.height);
    let (widths, heights) = (sizes(width), sizes(height));
    let value = |w: usize, h: usize| {
        let window = judged.iter().find(|window| width(window) == Some(w) && height(window) == Some(h))?;
        window.judgements.iter().map(|judgement| judgement.quality).max_by(f64::total_cmp)
    };
    let rows = heights.iter().map(|&h| (format!("{h} px high"), widths.iter().map(|&w| value(w, h)).collect()));
    let row = heights.iter().position(|&h| height(best) == Some(h));
    let column = widths.iter().position(|&w| width(best) == Some(w));
    HeatTable {
        title,
        columns: widths.iter().map(|w| format!("{w} px")).collect(),
        rows: rows.collect(),
        marked: row.zip(column),
    }
}

/// The table as lines of text; the marked cell has a star.
pub(super) fn text(table: &HeatTable) -> Vec<String> {
    let names = table.rows.iter().map(|(name, _)| name.chars().count()).max().unwrap_or(0);
    let words = table.columns.iter().flat_map(|name| name.lines());
    // A number and its star need this much.
    let width = words.map(|word| word.chars().count()).max().unwrap_or(0).max(6) + 1;
    let mut lines = vec![table.title.clone()];
    for line in 0..table.name_lines() {
        let mut head = " ".repeat(names);
        for name in &table.columns {
            let _ = write!(head, "{:>width$} ", name.lines().nth(line).unwrap_or_default());
        }
        lines.push(head.trim_end().to_owned());
    }
    for (row, (name, values)) in table.rows.iter().enumerate() {
        let mut line = format!("{name:>names$}");
        for (column, value) in values.iter().enumerate() {
            let value = value.map_or(String::new(), hundredths);
            let star = if table.marked == Some((row, column)) { '*' } else { ' ' };
            let _ = write!(line, "{value:>width$}{star}");
        }
        lines.push(line.trim_end().to_owned());
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_table_of_text_keeps_its_columns() {
        let table = HeatTable {
            title: "quality".to_owned(),
            columns: vec!["l2\n1x1".to_owned(), "l1-sqrt\n2x2".to_owned()],
            rows: vec![("2 px".to_owned(), vec![Some(0.963), None]), ("10 px".to_owned(), vec![Some(-0.5), Some(1.0)])],
            marked: Some((0, 0)),
        };
        let expected =
            ["quality", "           l2  l1-sqrt", "          1x1      2x2", " 2 px    0.96*", "10 px   -0.50     1.00"];
        assert_eq!(text(&table), expected);
    }
}
