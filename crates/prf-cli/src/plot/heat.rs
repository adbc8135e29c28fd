//! Tables of numbers from −1 to 1 whose cells are coloured.

use plotters::element::{PathElement, Rectangle, Text};
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{Color as _, IntoTextStyle as _, RGBColor};

use super::{Canvas, DrawResult, svg, text, theme};
use crate::error::Result;

const CELL: [u32; 2] = [112, 56];
/// Room for a table's title, for the names of its columns, and below it.
const ABOVE: u32 = 84;
const COLUMN_NAME_LINE: u32 = 36;
const BELOW: u32 = 40;
/// Room for the names of rows.
const LEFT: u32 = 200;
const HEADING: u32 = 104;
const LEAST_WIDTH: u32 = 1200;

/// A table.
#[derive(Clone, Debug)]
pub(crate) struct HeatTable {
    pub(crate) title: String,
    /// The names of the columns, each of as many lines as the others.
    pub(crate) columns: Vec<String>,
    /// Name and values of each row, from −1 to 1; nothing where there is no value.
    pub(crate) rows: Vec<(String, Vec<Option<f64>>)>,
    /// Row and column of the cell that is marked.
    pub(crate) marked: Option<(usize, usize)>,
}

impl HeatTable {
    /// Lines of the columns' names.
    pub(crate) fn name_lines(&self) -> usize {
        self.columns.first().map_or(0, |name| name.lines().count())
    }

    /// Where the cells begin.
    fn top(&self) -> u32 {
        ABOVE + COLUMN_NAME_LINE * self.name_lines() as u32
    }

    fn height(&self) -> u32 {
        self.top() + CELL[1] * self.rows.len() as u32 + BELOW
    }

    fn width(&self) -> u32 {
        LEFT + CELL[0] * self.columns.len() as u32
    }
}

/// Tables below each other, as SVG.
pub(crate) fn tables(title: &str, subtitle: &str, tables: &[HeatTable]) -> Result<String> {
    let inner = tables.iter().map(HeatTable::width).max().unwrap_or(0).max(LEAST_WIDTH);
    let height = HEADING + tables.iter().map(HeatTable::height).sum::<u32>() + 2 * theme::MARGIN;
    svg(&format!("{title}: {subtitle}"), [inner + 2 * theme::MARGIN, height], |canvas| {
        let canvas = canvas.margin(theme::MARGIN, theme::MARGIN, theme::MARGIN, theme::MARGIN);
        let lines = [(title, theme::TITLE, theme::INK, 0), (subtitle, theme::SMALL, theme::FAINT_INK, 50)];
        for (words, size, colour, top) in lines {
            write(&canvas, &text::shortened(words, size, f64::from(inner)), (0, top), (size, colour), LEFT_TOP)?;
        }
        let mut top = HEADING;
        for table in tables {
            let (_, rest) = canvas.split_vertically(top);
            draw(&rest, table)?;
            top += table.height();
        }
        Ok(())
    })
}

const LEFT_TOP: Pos = Pos { h_pos: HPos::Left, v_pos: VPos::Top };
const MIDDLE: Pos = Pos { h_pos: HPos::Center, v_pos: VPos::Center };
const RIGHT: Pos = Pos { h_pos: HPos::Right, v_pos: VPos::Center };

fn draw(canvas: &Canvas<'_>, table: &HeatTable) -> DrawResult {
    write(canvas, &table.title, (0, 30), (theme::LABEL, theme::INK), LEFT_TOP)?;
    let [width, height] = CELL.map(|side| side as i32);
    let (left, top) = (LEFT as i32, table.top() as i32);
    for (column, name) in table.columns.iter().enumerate() {
        for (line, words) in name.lines().enumerate() {
            let above = (table.name_lines() - line) as i32 * COLUMN_NAME_LINE as i32;
            let at = (left + column as i32 * width + width / 2, top - above + COLUMN_NAME_LINE as i32 / 2 - 4);
            write(canvas, words, at, (theme::SMALL, theme::FAINT_INK), MIDDLE)?;
        }
    }
    for (row, (name, values)) in table.rows.iter().enumerate() {
        let y = top + row as i32 * height;
        write(canvas, name, (left - 20, y + height / 2), (theme::SMALL, theme::FAINT_INK), RIGHT)?;
        for (column, value) in values.iter().enumerate() {
            let Some(value) = *value else { continue };
            let x = left + column as i32 * width;
            let (colour, ink) = colours(value);
            canvas.draw(&Rectangle::new([(x + 1, y + 1), (x + width - 1, y + height - 1)], colour.filled()))?;
            write(canvas, &hundredths(value), (x + width / 2, y + height / 2), (theme::SMALL, ink), MIDDLE)?;
        }
    }
    if let Some((row, column)) = table.marked {
        let (x, y) = (left + column as i32 * width, top + row as i32 * height);
        let corners = [(x, y), (x + width, y), (x + width, y + height), (x, y + height), (x, y)];
        canvas.draw(&PathElement::new(corners, theme::INK.stroke_width(6)))?;
    }
    Ok(())
}

fn write(canvas: &Canvas<'_>, words: &str, at: (i32, i32), (size, ink): (f64, RGBColor), pos: Pos) -> DrawResult {
    canvas.draw(&Text::new(text::clean(words), at, theme::font(size).into_text_style(canvas).color(&ink).pos(pos)))
}

/// A number of two decimals, and no minus before a nought.
pub(crate) fn hundredths(value: f64) -> String {
    format!("{:.2}", (value * 100.0).round() / 100.0 + 0.0)
}

/// Orange for −1, white for 0 and blue for 1, with the ink that can be read on it.
fn colours(value: f64) -> (RGBColor, RGBColor) {
    const STRONG: f64 = 0.6;
    let end = if value < 0.0 { theme::WRONG } else { theme::RIGHT };
    let share = value.abs().min(1.0);
    let mix = |paper: u8, end: u8| (f64::from(paper) + share * (f64::from(end) - f64::from(paper))).round() as u8;
    let colour = RGBColor(mix(theme::PAPER.0, end.0), mix(theme::PAPER.1, end.1), mix(theme::PAPER.2, end.2));
    (colour, if share > STRONG { theme::PAPER } else { theme::INK })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_nought_has_no_sign() {
        assert_eq!([-0.004, 0.004, -0.006, 1.0].map(hundredths), ["0.00", "0.00", "-0.01", "1.00"]);
    }

    #[test]
    fn colours_run_from_wrong_over_paper_to_right() {
        assert_eq!(colours(0.0), (theme::PAPER, theme::INK));
        assert_eq!(colours(1.0), (theme::RIGHT, theme::PAPER));
        assert_eq!(colours(-1.0), (theme::WRONG, theme::PAPER));
    }
}
