//! Animations: GIF, APNG and WebP, frame by frame.
//!
//! However many frames there are, what is held is the canvas and the one frame that is worked on.

use std::fs::File;
use std::io::BufReader;

use image::ImageFormat;

use super::apng::Apng;
use super::canvas::{Canvas, Patch, Pixel};
use super::gif::Gif;
use super::source::{Stream, Timed};
use super::webp::Webp;
use super::{Limits, pixels};
use crate::{Frame, PictureProblem};

/// The most that a decoder holds of a frame: its colours with alpha, and those again as they lie in
/// the file.
pub(super) const MAX_BYTES_PER_PIXEL: u64 = 8;

/// The frames of an animation as they lie in its file.
pub(super) trait Patches {
    /// `[height, width]` of the canvas, within the limits.
    fn shape(&self) -> [u32; 2];

    /// Reads the next patch, its pixels row by row into `pixels`; `None` behind the last.
    fn next(&mut self, pixels: &mut Vec<Pixel>) -> Result<Option<Patch>, PictureProblem>;
}

/// An animation of which some frames have been read. Every frame is as large as the canvas.
pub(super) struct Animation {
    patches: Box<dyn Patches + Send>,
    canvas: Canvas,
    patch: Vec<Pixel>,
    time_ms: f64,
}

impl Animation {
    /// The animation in a file of this format, or nothing if it holds one still picture. A GIF is
    /// always an animation: how many frames it has is known only at its end. The file is then
    /// anywhere.
    pub(super) fn open(file: &File, format: ImageFormat, limits: Limits) -> Result<Option<Animation>, PictureProblem> {
        let file = || file.try_clone().map(BufReader::new).map_err(PictureProblem::Io);
        let patches = match format {
            ImageFormat::Gif => Some(boxed(Gif::open(file()?, limits)?)),
            ImageFormat::Png => Apng::open(file()?, limits)?.map(boxed),
            ImageFormat::WebP => Webp::open(file()?, limits)?.map(boxed),
            _ => None,
        };
        Ok(patches.map(|patches| {
            let [height, width] = patches.shape();
            Animation { patches, canvas: Canvas::new(width, height), patch: Vec::new(), time_ms: 0.0 }
        }))
    }
}

fn boxed(patches: impl Patches + Send + 'static) -> Box<dyn Patches + Send> {
    Box::new(patches)
}

impl Stream for Animation {
    fn next_into(&mut self, frame: &mut Frame) -> Result<Option<Timed>, PictureProblem> {
        let Some(patch) = self.patches.next(&mut self.patch)? else { return Ok(None) };
        pixels::copy_into(self.canvas.draw(&patch, &self.patch), frame);
        let time_s = Some(self.time_ms / 1000.0);
        self.time_ms += patch.delay_ms;
        Ok(Some(Timed { time_s }))
    }
}
