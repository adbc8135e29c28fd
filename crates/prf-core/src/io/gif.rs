//! The frames of a GIF.

use std::fs::File;
use std::io::{BufReader, ErrorKind};

use gif::{ColorOutput, DecodeOptions, Decoder, DecodingError, DisposalMethod};

use super::Limits;
use super::animation::Patches;
use super::canvas::{Blend, Disposal, Patch, Pixel};
use super::pixels::grey_alpha;
use crate::{PictureProblem, Rect};

const NAME: &str = "GIF";
const UNIT_MS: f64 = 10.0;

pub(super) struct Gif {
    decoder: Decoder<BufReader<File>>,
    limits: Limits,
    /// The colours of patches that have none of their own: red, green, blue.
    colours: Vec<u8>,
    /// The patch as the file has it: places in the table of colours.
    indices: Vec<u8>,
}

impl Gif {
    pub(super) fn open(file: BufReader<File>, limits: Limits) -> Result<Gif, PictureProblem> {
        let mut options = DecodeOptions::new();
        options.set_color_output(ColorOutput::Indexed);
        let decoder = options.read_info(file).map_err(|error| problem(error, limits))?;
        limits.check_size(NAME, decoder.width().into(), decoder.height().into())?;
        let colours = decoder.global_palette().unwrap_or_default().to_vec();
        Ok(Gif { decoder, limits, colours, indices: Vec::new() })
    }
}

impl Patches for Gif {
    fn shape(&self) -> [u32; 2] {
        [self.decoder.height().into(), self.decoder.width().into()]
    }

    fn next(&mut self, pixels: &mut Vec<Pixel>) -> Result<Option<Patch>, PictureProblem> {
        let limits = self.limits;
        let failed = |error| problem(error, limits);
        let Some(frame) = self.decoder.next_frame_info().map_err(failed)? else { return Ok(None) };
        limits.check_size(NAME, frame.width.into(), frame.height.into())?;
        let patch = patch_of(frame);
        let table = table(frame.palette.as_deref().unwrap_or(&self.colours), frame.transparent);
        self.indices.resize(patch.rect.width * patch.rect.height, 0);
        self.decoder.read_into_buffer(&mut self.indices).map_err(failed)?;
        pixels.clear();
        pixels.extend(self.indices.iter().map(|&index| table[usize::from(index)]));
        Ok(Some(patch))
    }
}

fn patch_of(frame: &gif::Frame<'_>) -> Patch {
    let [x, y, width, height] = [frame.left, frame.top, frame.width, frame.height].map(usize::from);
    let disposal = match frame.dispose {
        DisposalMethod::Any | DisposalMethod::Keep => Disposal::Keep,
        DisposalMethod::Background => Disposal::Background,
        DisposalMethod::Previous => Disposal::Previous,
    };
    let delay_ms = UNIT_MS * f64::from(frame.delay);
    Patch { rect: Rect { x, y, width, height }, blend: Blend::Over, disposal, delay_ms }
}

/// Grey and opacity of every index. One without a colour is transparent, as in browsers.
fn table(colours: &[u8], transparent: Option<u8>) -> [Pixel; 256] {
    let mut table = [[0, 0]; 256];
    for (pixel, &[r, g, b]) in table.iter_mut().zip(colours.as_chunks().0) {
        *pixel = grey_alpha([r, g, b, 255]);
    }
    if let Some(index) = transparent {
        table[usize::from(index)] = [0, 0];
    }
    table
}

fn problem(error: DecodingError, limits: Limits) -> PictureProblem {
    let format = NAME.to_owned();
    match error {
        DecodingError::UnexpectedEof => PictureProblem::Truncated { format },
        DecodingError::Io(error) if error.kind() == ErrorKind::UnexpectedEof => PictureProblem::Truncated { format },
        DecodingError::Io(error) => PictureProblem::Io(error),
        DecodingError::OutOfMemory | DecodingError::MemoryLimit => {
            PictureProblem::Memory { format, max_pixels: limits.max_pixels }
        }
        error => PictureProblem::damaged(NAME, error.to_string()),
    }
}
