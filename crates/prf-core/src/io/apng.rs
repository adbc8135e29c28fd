//! The frames of an animated PNG.

use std::fs::File;
use std::io::{BufReader, ErrorKind};

use png::{BlendOp, ColorType, Decoder, DecodingError, DisposeOp, FrameControl, Reader, Transformations};

use super::Limits;
use super::animation::{MAX_BYTES_PER_PIXEL, Patches};
use super::canvas::{Blend, Disposal, Patch, Pixel};
use super::pixels::grey_alpha;
use crate::{PictureProblem, Rect};

const NAME: &str = "PNG";

pub(super) struct Apng {
    reader: Reader<BufReader<File>>,
    limits: Limits,
    /// Frames still to come.
    left: u32,
    /// The patch as the decoder gives it: 8 bits of grey and alpha, or of colours and alpha.
    bytes: Vec<u8>,
}

impl Apng {
    /// The animation in this file, or nothing if it is a still picture.
    pub(super) fn open(file: BufReader<File>, limits: Limits) -> Result<Option<Apng>, PictureProblem> {
        let failed = |error| problem(error, limits);
        let bytes = usize::try_from(limits.memory_bytes(MAX_BYTES_PER_PIXEL)).unwrap_or(usize::MAX);
        let mut decoder = Decoder::new_with_limits(file, png::Limits { bytes });
        decoder.set_transformations(Transformations::normalize_to_color8() | Transformations::ALPHA);
        let header = decoder.read_header_info().map_err(failed)?;
        limits.check_size(NAME, header.width, header.height)?;
        let reader = decoder.read_info().map_err(failed)?;
        let Some(animation) = reader.info().animation_control else { return Ok(None) };
        let mut apng = Apng { reader, limits, left: animation.num_frames, bytes: Vec::new() };
        // The picture for those who know no animations comes first, and belongs to it or doesn't.
        if apng.reader.info().frame_control.is_none() {
            apng.decode()?;
        }
        Ok(Some(apng))
    }

    /// Decodes the next picture into `bytes`; how far apart its rows lie there.
    fn decode(&mut self) -> Result<usize, PictureProblem> {
        let limits = self.limits;
        let failed = |error| problem(error, limits);
        let len = self.reader.output_buffer_size().ok_or(DecodingError::LimitsExceeded).map_err(failed)?;
        self.bytes.resize(len, 0);
        let output = self.reader.next_frame(&mut self.bytes).map_err(failed)?;
        let info = self.reader.info();
        // An interlaced patch is spread out as if it were as wide as the canvas.
        let whole = self.reader.output_line_size(info.width);
        Ok(if info.interlaced { whole.unwrap_or(output.line_size) } else { output.line_size })
    }
}

impl Patches for Apng {
    fn shape(&self) -> [u32; 2] {
        let info = self.reader.info();
        [info.height, info.width]
    }

    fn next(&mut self, pixels: &mut Vec<Pixel>) -> Result<Option<Patch>, PictureProblem> {
        if self.left == 0 {
            return Ok(None);
        }
        self.left -= 1;
        let stride = self.decode()?;
        let Some(control) = self.reader.info().frame_control else {
            return Err(PictureProblem::damaged(NAME, "a frame without its control chunk"));
        };
        let patch = patch_of(&control);
        let Rect { width, height, .. } = patch.rect;
        pixels.clear();
        for row in self.bytes.chunks_exact(stride).take(height) {
            match self.reader.output_color_type().0 {
                ColorType::GrayscaleAlpha => pixels.extend(&row.as_chunks().0[..width]),
                _ => pixels.extend(row.as_chunks().0[..width].iter().map(|&pixel| grey_alpha(pixel))),
            }
        }
        Ok(Some(patch))
    }
}

fn patch_of(control: &FrameControl) -> Patch {
    let FrameControl { width, height, x_offset, y_offset, .. } = *control;
    let [x, y, width, height] = [x_offset, y_offset, width, height].map(|px| px as usize);
    let blend = match control.blend_op {
        BlendOp::Source => Blend::Source,
        BlendOp::Over => Blend::Over,
    };
    let disposal = match control.dispose_op {
        DisposeOp::None => Disposal::Keep,
        DisposeOp::Background => Disposal::Background,
        DisposeOp::Previous => Disposal::Previous,
    };
    // By the specification a divisor of 0 stands for hundredths of a second.
    let divisor = if control.delay_den == 0 { 100 } else { control.delay_den };
    let delay_ms = 1000.0 * f64::from(control.delay_num) / f64::from(divisor);
    Patch { rect: Rect { x, y, width, height }, blend, disposal, delay_ms }
}

fn problem(error: DecodingError, limits: Limits) -> PictureProblem {
    let format = NAME.to_owned();
    match error {
        DecodingError::IoError(error) if error.kind() == ErrorKind::UnexpectedEof => {
            PictureProblem::Truncated { format }
        }
        DecodingError::IoError(error) => PictureProblem::Io(error),
        DecodingError::LimitsExceeded => PictureProblem::Memory { format, max_pixels: limits.max_pixels },
        error => PictureProblem::damaged(NAME, error.to_string()),
    }
}
