//! Values over frames or time, one curve a source.

use plotters::chart::{ChartBuilder, ChartContext, LabelAreaPosition};
use plotters::element::{Circle, DashedPathElement, PathElement, Polygon, Text};
use plotters::prelude::{Cartesian2d, SVGBackend};
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{Color as _, IntoTextStyle as _, ShapeStyle};

use super::axis::Axis;
use super::legend::Legend;
use super::theme::{self, Series};
use super::{Canvas, DrawResult, svg, text, thin};
use crate::error::Result;

/// The whole canvas, and one for small screens.
const WIDTH: u32 = 1800;
#[cfg(feature = "train")]
const NARROW_WIDTH: u32 = 800;
/// The diagram's height without heading and legend.
const DIAGRAM: u32 = 820;
#[cfg(feature = "train")]
const NARROW_DIAGRAM: u32 = 620;
const ABOVE_LEGEND: u32 = 20;
/// Title and subtitle.
const HEADING: u32 = 104;
/// Room for the numbers of the axes, left and below.
const LEFT: u32 = 140;
const BELOW: u32 = 88;
/// Room for the names of levels, right, and the least height of one.
const RIGHT: u32 = 116;
const LEVEL_NAME: i32 = 62;
/// Room for the upper half of a level's name.
const ABOVE_LEVELS: u32 = 24;
/// Frames are marked one by one where at least this much lies between them.
const BETWEEN_DOTS: f64 = 24.0;
/// Points closer together than this are thinned out: a pixel.
const COLUMN: f64 = 2.0;

/// One curve.
#[derive(Clone, Debug)]
pub(crate) struct Curve {
    pub(crate) name: String,
    /// Places, going up, with their values; a gap where there is no value.
    pub(crate) points: Vec<Option<(f64, f64)>>,
    /// What is shaded behind the curve; may be empty.
    pub(crate) band: Band,
}

/// Places, going up, each with the lowest and the highest value of a range.
pub(crate) type Band = Vec<(f64, [f64; 2])>;

/// A value that curves are compared with: a dashed line across.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Level {
    pub(crate) name: &'static str,
    pub(crate) value: f64,
}

/// What a diagram is drawn for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Shape {
    /// A file of its own.
    Titled,
    /// A page that says what it is.
    #[cfg(feature = "train")]
    Untitled,
    /// The same on a small screen.
    #[cfg(feature = "train")]
    Narrow,
}

impl Curve {
    /// How far apart its values lie on average, where `across` makes units of a place.
    fn units_apart(&self, across: impl Fn(f64) -> f64) -> f64 {
        let places = || self.points.iter().flatten().map(|point| across(point.0));
        let between = places().count().saturating_sub(1);
        match (places().next(), places().next_back()) {
            (Some(first), Some(last)) if between > 0 => (last - first) / between as f64,
            _ => f64::INFINITY,
        }
    }
}

/// How the points of a series are joined.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Joined {
    /// By a line, from one place to the next.
    Line,
    /// Not at all: places come in any order and more than once.
    Dots,
}

/// A diagram of curves.
pub(crate) struct Diagram<'a> {
    pub(crate) title: String,
    pub(crate) subtitle: String,
    pub(crate) x: Axis,
    pub(crate) y: Axis,
    pub(crate) curves: &'a [Curve],
    pub(crate) levels: &'a [Level],
    pub(crate) joined: Joined,
}

type Chart<'a, 'b> = ChartContext<'a, SVGBackend<'b>, Cartesian2d<Axis, Axis>>;

impl Diagram<'_> {
    /// The diagram as SVG.
    pub(crate) fn svg(&self, shape: Shape) -> Result<String> {
        let (width, diagram_height, margin) = match shape {
            Shape::Titled => (WIDTH, DIAGRAM, theme::MARGIN),
            #[cfg(feature = "train")]
            Shape::Untitled => (WIDTH, DIAGRAM, 0),
            #[cfg(feature = "train")]
            Shape::Narrow => (NARROW_WIDTH, NARROW_DIAGRAM, 0),
        };
        let heading_height = if shape == Shape::Titled { HEADING } else { 0 };
        let inner_width = width - 2 * margin;
        let names = self.curves.iter().map(|curve| curve.name.as_str());
        let legend = Legend::new(names, self.joined == Joined::Line, inner_width);
        let height = heading_height + diagram_height + ABOVE_LEGEND + legend.height() + 2 * margin;
        svg(&format!("{}: {}", self.title, self.subtitle), [width, height], |canvas| {
            let inner = canvas.margin(margin, margin, margin, margin);
            let (heading, rest) = inner.split_vertically(heading_height);
            let (diagram, below) = rest.split_vertically(diagram_height + ABOVE_LEGEND);
            let diagram = diagram.margin(0, ABOVE_LEGEND, 0, 0);
            if shape == Shape::Titled {
                self.draw_heading(&heading, inner_width)?;
            }
            self.draw_diagram(&diagram)?;
            legend.draw(&below)
        })
    }

    fn draw_heading(&self, canvas: &Canvas<'_>, width: u32) -> DrawResult {
        let lines = [(&self.title, theme::TITLE, theme::INK, 0), (&self.subtitle, theme::SMALL, theme::FAINT_INK, 50)];
        for (words, size, colour, top) in lines {
            let style = theme::font(size).into_text_style(canvas).color(&colour);
            canvas.draw(&Text::new(text::shortened(words, size, f64::from(width)), (0, top), style))?;
        }
        Ok(())
    }

    fn draw_diagram(&self, canvas: &Canvas<'_>) -> DrawResult {
        let (right, above) = if self.levels.is_empty() { (0, 0) } else { (RIGHT, ABOVE_LEVELS) };
        let (canvas, names) = canvas.split_horizontally(canvas.dim_in_pixel().0 - right);
        let mut chart = ChartBuilder::on(&canvas)
            .margin_top(above)
            .set_label_area_size(LabelAreaPosition::Left, LEFT)
            .set_label_area_size(LabelAreaPosition::Bottom, BELOW)
            .build_cartesian_2d(self.x.clone(), self.y.clone())?;
        self.draw_axes(&mut chart)?;
        self.draw_levels(&chart, &names)?;
        for (index, curve) in self.curves.iter().enumerate() {
            draw_band(&chart, &curve.band, Series::of(index))?;
        }
        for (index, curve) in self.curves.iter().enumerate() {
            match self.joined {
                Joined::Line => self.draw_curve(&mut chart, curve, Series::of(index))?,
                Joined::Dots => draw_dots(&mut chart, curve, Series::of(index))?,
            }
        }
        Ok(())
    }

    fn draw_axes(&self, chart: &mut Chart<'_, '_>) -> DrawResult {
        chart
            .configure_mesh()
            .max_light_lines(0)
            .bold_line_style(theme::GRID.stroke_width(2))
            .axis_style(theme::AXIS.stroke_width(2))
            .label_style(theme::font(theme::SMALL).color(&theme::FAINT_INK))
            .axis_desc_style(theme::font(theme::LABEL).color(&theme::INK))
            .x_desc(self.x.name)
            .y_desc(self.y.name)
            .x_label_formatter(&|&mark| self.x.number(mark))
            .y_label_formatter(&|&mark| self.y.number(mark))
            .draw()
    }

    /// Lines across, with their names and values to the right of them.
    fn draw_levels(&self, chart: &Chart<'_, '_>, names: &Canvas<'_>) -> DrawResult {
        let mut levels = self.levels.to_vec();
        levels.sort_by(|a, b| b.value.total_cmp(&a.value));
        let mut free = i32::MIN;
        for level in levels {
            let across = [(self.x.range.start, level.value), (self.x.range.end, level.value)];
            draw_line(chart, across.to_vec(), Some([12, 10]), theme::FAINT_INK.stroke_width(3))?;
            let (_, middle) = chart.backend_coord(&across[1]);
            let (_, top) = names.get_base_pixel();
            // Names of levels that lie close together are moved apart.
            let middle = (middle - top).max(free);
            free = middle + LEVEL_NAME;
            for (words, colour, offset) in [
                (level.name.to_owned(), theme::INK, -LEVEL_NAME / 4),
                (self.y.finer_number(level.value), theme::FAINT_INK, LEVEL_NAME / 4),
            ] {
                let style = theme::font(theme::SMALL).into_text_style(names).pos(Pos::new(HPos::Left, VPos::Center));
                names.draw(&Text::new(words, (12, middle + offset), style.color(&colour)))?;
            }
        }
        Ok(())
    }

    fn draw_curve(&self, chart: &mut Chart<'_, '_>, curve: &Curve, series: Series) -> DrawResult {
        let units = f64::from(chart.plotting_area().dim_in_pixel().0);
        let across = |x: f64| (x - self.x.range.start) / (self.x.range.end - self.x.range.start) * units;
        let apart = curve.units_apart(across);
        let dotted = apart >= BETWEEN_DOTS;
        let line = if apart >= COLUMN { series.line() } else { series.fine_line() };
        for piece in thin::pieces(&curve.points, |x| (across(x) / COLUMN) as i64) {
            // A value between two gaps has no line.
            if dotted || piece.len() == 1 {
                chart.draw_series(piece.iter().map(|&point| Circle::new(point, theme::DOT, series.dot())))?;
            }
            if piece.len() > 1 {
                draw_line(chart, piece, series.dash, line)?;
            }
        }
        Ok(())
    }
}

/// Dots that let those beneath show through.
fn draw_dots(chart: &mut Chart<'_, '_>, curve: &Curve, series: Series) -> DrawResult {
    let dots = curve.points.iter().flatten().map(|&point| Circle::new(point, theme::DOT, series.faint_dot()));
    chart.draw_series(dots)?;
    Ok(())
}

/// A band that lets the grid and other bands show through.
fn draw_band(chart: &Chart<'_, '_>, band: &Band, series: Series) -> DrawResult {
    let there = band.iter().map(|&(x, [low, _])| (x, low));
    let back = band.iter().rev().map(|&(x, [_, high])| (x, high));
    let outline: Vec<(f64, f64)> = there.chain(back).collect();
    if band.len() < 2 {
        return Ok(());
    }
    chart.plotting_area().draw(&Polygon::new(outline, series.shade()))
}

fn draw_line(chart: &Chart<'_, '_>, points: Vec<(f64, f64)>, dash: Option<[u32; 2]>, style: ShapeStyle) -> DrawResult {
    match dash {
        None => chart.plotting_area().draw(&PathElement::new(points, style)),
        Some([dash, room]) => chart.plotting_area().draw(&DashedPathElement::new(points, dash, room, style)),
    }
}
