//! Diagrams for reports, as SVG.
//!
//! A diagram is drawn on a canvas of whole units, two of which make a pixel at its natural size, so that
//! curves are not bent to whole pixels. What diagrams share is here, in [`theme`] and in [`text`].

use std::path::Path;

use plotters::coord::Shift;
use plotters::prelude::{DrawingArea, DrawingAreaErrorKind, IntoDrawingArea as _, SVGBackend};

use crate::error::{CliError, Result};
use crate::files::write_whole;

pub(crate) mod axis;
pub(crate) mod curve;
pub(crate) mod heat;
mod legend;
#[cfg(feature = "train")]
mod raster;
pub(crate) mod text;
pub(crate) mod theme;
mod thin;

#[cfg(feature = "train")]
pub(crate) use self::raster::png;

/// What a diagram, or a part of one, is drawn on; (0, 0) is its top left corner.
pub(crate) type Canvas<'a> = DrawingArea<SVGBackend<'a>, Shift>;
/// How drawing can fail: in memory, only by a range that makes no sense.
pub(crate) type DrawResult<T = ()> = std::result::Result<T, DrawingAreaErrorKind<std::io::Error>>;

/// Units of a canvas in a pixel of the picture.
const UNITS_PER_PX: u32 = 2;

/// A whole SVG of `[width, height]` units, of which `title` is what screen readers say.
pub(crate) fn svg(
    title: &str,
    [width, height]: [u32; 2],
    draw: impl FnOnce(&Canvas<'_>) -> DrawResult,
) -> Result<String> {
    let mut drawn = String::new();
    let canvas = SVGBackend::with_string(&mut drawn, (width, height)).into_drawing_area();
    let done = canvas.fill(&theme::PAPER).and_then(|()| draw(&canvas)).and_then(|()| canvas.present());
    drop(canvas);
    done.map_err(|error| CliError::failed(format!("cannot draw the diagram: {error}")))?;
    // The opening tag is written anew, since the library's makes a unit a pixel.
    let (_, body) = drawn.split_once('>').unwrap_or_default();
    let [width_px, height_px] = [width, height].map(|side| side / UNITS_PER_PX);
    let title = text::escaped(title);
    Ok(format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width_px}\" height=\"{height_px}\" \
         viewBox=\"0 0 {width} {height}\" role=\"img\" stroke-linejoin=\"round\">\n<title>{title}</title>{body}"
    ))
}

/// Writes a diagram whole or not at all, over what is there.
pub(crate) fn write_svg(path: &Path, svg: &str) -> Result<()> {
    write_whole(path, svg.as_bytes(), true)
}
