//! Which series is which: a line of its look and its name, as many in a row as fit.

use plotters::element::{Circle, DashedPathElement, PathElement, Text};
use plotters::style::IntoTextStyle as _;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::theme::{self, Series};
use super::{Canvas, DrawResult, text};

const ROW: u32 = 40;
/// Length of the line before a name.
const SAMPLE: i32 = 56;
const BEHIND_SAMPLE: i32 = 14;
const BEHIND_NAME: f64 = 44.0;

/// A legend, laid out for a certain width.
pub(super) struct Legend {
    rows: Vec<Vec<Entry>>,
}

struct Entry {
    x: i32,
    /// None for the words about those that are left out.
    series: Option<Series>,
    has_line: bool,
    name: String,
}

impl Legend {
    /// As many names as can be told apart, and how many more there are; series of dots have no line.
    pub(super) fn new<'a>(names: impl ExactSizeIterator<Item = &'a str>, has_line: bool, width: u32) -> Legend {
        let more = names.len().saturating_sub(theme::SERIES);
        let mut entries: Vec<(Option<Series>, String)> =
            names.take(theme::SERIES).enumerate().map(|(i, name)| (Some(Series::of(i)), name.to_owned())).collect();
        if more > 0 {
            entries.push((None, format!("and {more} more")));
        }
        let mut rows: Vec<Vec<Entry>> = vec![Vec::new()];
        let mut end = 0.0;
        for (series, name) in entries {
            let before = f64::from(if series.is_some() { SAMPLE + BEHIND_SAMPLE } else { 0 });
            let name = text::shortened(&name, theme::SMALL, f64::from(width) - before);
            let needed = before + text::width(&name, theme::SMALL);
            if end > 0.0 && end + needed > f64::from(width) {
                rows.push(Vec::new());
                end = 0.0;
            }
            if let Some(row) = rows.last_mut() {
                row.push(Entry { x: end as i32, series, has_line, name });
            }
            end += needed + BEHIND_NAME;
        }
        Legend { rows }
    }

    pub(super) fn height(&self) -> u32 {
        self.rows.len() as u32 * ROW
    }

    pub(super) fn draw(&self, canvas: &Canvas<'_>) -> DrawResult {
        for (row, entries) in self.rows.iter().enumerate() {
            let middle = (row as u32 * ROW + ROW / 2) as i32;
            entries.iter().try_for_each(|entry| entry.draw(canvas, middle))?;
        }
        Ok(())
    }
}

impl Entry {
    fn draw(&self, canvas: &Canvas<'_>, middle: i32) -> DrawResult {
        let mut x = self.x;
        if let Some(series) = self.series {
            let ends = [(x, middle), (x + SAMPLE, middle)];
            match series.dash {
                _ if !self.has_line => {}
                None => canvas.draw(&PathElement::new(ends, series.line()))?,
                Some([dash, room]) => canvas.draw(&DashedPathElement::new(ends, dash, room, series.line()))?,
            }
            canvas.draw(&Circle::new((x + SAMPLE / 2, middle), theme::DOT, series.dot()))?;
            x += SAMPLE + BEHIND_SAMPLE;
        }
        let style = theme::font(theme::SMALL).into_text_style(canvas).pos(Pos::new(HPos::Left, VPos::Center));
        canvas.draw(&Text::new(self.name.as_str(), (x, middle), style.color(&theme::INK)))
    }
}
