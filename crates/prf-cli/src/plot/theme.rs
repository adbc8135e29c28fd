//! Colours and sizes that all diagrams share. Sizes are in units of the canvas.

use plotters::style::{Color as _, FontDesc, FontFamily, FontStyle, RGBColor, ShapeStyle};

/// What everything is drawn on.
pub(crate) const PAPER: RGBColor = RGBColor(255, 255, 255);
/// Titles and the names of axes.
pub(crate) const INK: RGBColor = RGBColor(34, 34, 34);
/// What may be overlooked: numbers, subtitles.
pub(crate) const FAINT_INK: RGBColor = RGBColor(95, 95, 95);
/// Axes.
pub(crate) const AXIS: RGBColor = RGBColor(140, 140, 140);
/// The grid behind the data.
pub(crate) const GRID: RGBColor = RGBColor(228, 228, 228);

/// What is always wrong, and what is always right.
pub(crate) const WRONG: RGBColor = RGBColor(213, 94, 0);
pub(crate) const RIGHT: RGBColor = RGBColor(0, 114, 178);

pub(crate) const TITLE: f64 = 38.0;
pub(crate) const LABEL: f64 = 28.0;
pub(crate) const SMALL: f64 = 26.0;
/// Half a dot's width.
pub(crate) const DOT: i32 = 6;
/// Around everything.
pub(crate) const MARGIN: u32 = 36;

/// Okabe and Ito's colours, which the colour-blind can tell apart, without the yellow that is too faint
/// for lines on white.
const COLOURS: [RGBColor; 7] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(230, 159, 0),
    RGBColor(86, 180, 233),
    RGBColor(0, 0, 0),
];
/// Lengths of a dash and of the room behind it, for the second and the third use of the colours.
const DASHES: [Option<[u32; 2]>; 3] = [None, Some([18, 10]), Some([5, 9])];
/// How many series can be told apart.
pub(crate) const SERIES: usize = COLOURS.len() * DASHES.len();

/// How one of several series is drawn.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Series {
    pub(crate) colour: RGBColor,
    /// Lengths of a dash and of the room behind it; none for a solid line.
    pub(crate) dash: Option<[u32; 2]>,
}

impl Series {
    /// The look of the series of this number, from 0.
    pub(crate) fn of(index: usize) -> Series {
        Series { colour: COLOURS[index % COLOURS.len()], dash: DASHES[index / COLOURS.len() % DASHES.len()] }
    }

    pub(crate) fn line(self) -> ShapeStyle {
        self.colour.stroke_width(4)
    }

    /// For a curve of so many points that a thicker one would fill its area.
    pub(crate) fn fine_line(self) -> ShapeStyle {
        self.colour.stroke_width(2)
    }

    /// One of so many that they lie on each other.
    pub(crate) fn faint_dot(self) -> ShapeStyle {
        self.colour.mix(0.45).filled()
    }

    /// Behind a curve, and never so strong that it hides another.
    pub(crate) fn shade(self) -> ShapeStyle {
        self.colour.mix(0.16).filled()
    }

    pub(crate) fn dot(self) -> ShapeStyle {
        self.colour.filled()
    }
}

/// The one font, of `size` units.
pub(crate) fn font(size: f64) -> FontDesc<'static> {
    // The library takes a size for that of the line and divides it by this before it writes it down.
    const LINE_TO_FONT: f64 = 1.24;
    FontDesc::new(FontFamily::SansSerif, size * LINE_TO_FONT, FontStyle::Normal)
}
