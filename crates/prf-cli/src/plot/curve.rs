//! Values over frames or time, one curve a source.

use plotters::chart::{ChartBuilder, ChartContext, LabelAreaPosition};
use plotters::element::{Circle, DashedPathElement, PathElement, Text};
use plotters::prelude::{Cartesian2d, SVGBackend};
use plotters::style::{Color as _, IntoTextStyle as _, ShapeStyle};

use super::axis::Axis;
use super::legend::Legend;
use super::theme::{self, Series};
use super::{Canvas, DrawResult, svg, text, thin};
use crate::error::Result;

/// The whole canvas, what is within its margins, and the diagram's height without heading and legend.
const WIDTH: u32 = 1800;
const INNER_WIDTH: u32 = WIDTH - 2 * theme::MARGIN;
const DIAGRAM: u32 = 820;
const ABOVE_LEGEND: u32 = 20;
/// Title and subtitle.
const HEADING: u32 = 104;
/// Room for the numbers of the axes, left and below.
const LEFT: u32 = 140;
const BELOW: u32 = 88;
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
    pub(crate) joined: Joined,
}

type Chart<'a, 'b> = ChartContext<'a, SVGBackend<'b>, Cartesian2d<Axis, Axis>>;

impl Diagram<'_> {
    /// The diagram as SVG.
    pub(crate) fn svg(&self) -> Result<String> {
        let names = self.curves.iter().map(|curve| curve.name.as_str());
        let legend = Legend::new(names, self.joined == Joined::Line, INNER_WIDTH);
        let height = HEADING + DIAGRAM + ABOVE_LEGEND + legend.height() + 2 * theme::MARGIN;
        svg(&format!("{}: {}", self.title, self.subtitle), [WIDTH, height], |canvas| {
            let inner = canvas.margin(theme::MARGIN, theme::MARGIN, theme::MARGIN, theme::MARGIN);
            let (heading, rest) = inner.split_vertically(HEADING);
            let (diagram, below) = rest.split_vertically(DIAGRAM + ABOVE_LEGEND);
            let diagram = diagram.margin(0, ABOVE_LEGEND, 0, 0);
            self.draw_heading(&heading)?;
            self.draw_diagram(&diagram)?;
            legend.draw(&below)
        })
    }

    fn draw_heading(&self, canvas: &Canvas<'_>) -> DrawResult {
        let lines = [(&self.title, theme::TITLE, theme::INK, 0), (&self.subtitle, theme::SMALL, theme::FAINT_INK, 50)];
        for (words, size, colour, top) in lines {
            let style = theme::font(size).into_text_style(canvas).color(&colour);
            canvas.draw(&Text::new(text::shortened(words, size, f64::from(INNER_WIDTH)), (0, top), style))?;
        }
        Ok(())
    }

    fn draw_diagram(&self, canvas: &Canvas<'_>) -> DrawResult {
        let mut chart = ChartBuilder::on(canvas)
            .set_label_area_size(LabelAreaPosition::Left, LEFT)
            .set_label_area_size(LabelAreaPosition::Bottom, BELOW)
            .build_cartesian_2d(self.x.clone(), self.y.clone())?;
        self.draw_axes(&mut chart)?;
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

fn draw_line(chart: &Chart<'_, '_>, points: Vec<(f64, f64)>, dash: Option<[u32; 2]>, style: ShapeStyle) -> DrawResult {
    match dash {
        None => chart.plotting_area().draw(&PathElement::new(points, style)),
        Some([dash, room]) => chart.plotting_area().draw(&DashedPathElement::new(points, dash, room, style)),
    }
}
