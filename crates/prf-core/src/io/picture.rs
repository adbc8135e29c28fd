//! One picture out of a file.

use std::fs::File;
use std::io::{BufReader, ErrorKind, Seek};
use std::path::Path;

use image::error::ImageError;
use image::{DynamicImage, ImageDecoder, ImageFormat, ImageReader};

use super::animation::Animation;
use super::sniff::{self, Start};
use super::source::Stream;
use super::{Limits, jpeg, pixels, webp};
use crate::{Frame, Goal, PictureProblem};

/// Two bytes for each of red, green, blue and alpha: the widest pixel there is.
const MAX_BYTES_PER_PIXEL: u64 = 8;

/// Reads the picture, or the first frame of the animation, in a file.
pub(super) fn read_into(path: &Path, limits: Limits, frame: &mut Frame) -> Result<(), PictureProblem> {
    let mut file = sniff::open(path)?;
    let start = Start::of(&mut file)?;
    let format = start.picture().ok_or_else(|| start.not_a_picture())?;
    check_whole(&mut file, format)?;
    if let Some(mut animation) = Animation::open(&file, format, limits)? {
        let first = animation.next_into(frame)?;
        return first.map(|_| ()).ok_or(PictureProblem::NoFrames);
    }
    file.rewind().map_err(PictureProblem::Io)?;
    read_still_into(file, format, limits, frame)
}

/// Reads a still picture with its transparency.
pub(super) fn read_cut_out(path: &Path, limits: Limits) -> Result<Goal, PictureProblem> {
    let mut file = sniff::open(path)?;
    let start = Start::of(&mut file)?;
    let format = start.picture().ok_or_else(|| start.not_a_picture())?;
    check_whole(&mut file, format)?;
    file.rewind().map_err(PictureProblem::Io)?;
    let decoded = decode(file, format, limits)?;
    let opacity = decoded.color().has_alpha().then(|| pixels::opacity(&decoded));
    let mut picture = Frame::new(1, 1);
    pixels::picture_into(decoded, &mut picture);
    let transparent = |mask: &Frame| mask.as_slice().contains(&0);
    Ok(Goal { picture, mask: opacity.filter(transparent) })
}

fn read_still_into(file: File, format: ImageFormat, limits: Limits, frame: &mut Frame) -> Result<(), PictureProblem> {
    pixels::picture_into(decode(file, format, limits)?, frame);
    Ok(())
}

fn decode(file: File, format: ImageFormat, limits: Limits) -> Result<DynamicImage, PictureProblem> {
    let failed = |error| decoding_problem(format, error, limits);
    let mut memory = image::Limits::default();
    memory.max_alloc = Some(limits.memory_bytes(MAX_BYTES_PER_PIXEL));
    let mut reader = ImageReader::with_format(BufReader::new(file), format);
    reader.limits(memory);
    let decoder = reader.into_decoder().map_err(failed)?;
    let (width, height) = decoder.dimensions();
    limits.check_size(name_of(format), width, height)?;
    DynamicImage::from_decoder(decoder).map_err(failed)
}

/// Whether the file ends before its picture does, where the decoder doesn't look or can't say so.
/// Leaves it at its beginning.
fn check_whole(file: &mut File, format: ImageFormat) -> Result<(), PictureProblem> {
    let whole = match format {
        ImageFormat::Jpeg => jpeg::is_whole(file),
        ImageFormat::WebP => webp::is_whole(file),
        _ => Ok(true),
    };
    if whole.map_err(PictureProblem::Io)? {
        return Ok(());
    }
    Err(PictureProblem::Truncated { format: name_of(format).to_owned() })
}

pub(super) fn decoding_problem(format: ImageFormat, error: ImageError, limits: Limits) -> PictureProblem {
    let format = name_of(format).to_owned();
    match error {
        ImageError::IoError(error) if error.kind() == ErrorKind::UnexpectedEof => PictureProblem::Truncated { format },
        ImageError::IoError(error) => PictureProblem::Io(error),
        ImageError::Limits(_) => PictureProblem::Memory { format, max_pixels: limits.max_pixels },
        error => PictureProblem::Damaged { format, detail: error.to_string().trim_end().to_owned() },
    }
}

fn name_of(format: ImageFormat) -> &'static str {
    match format {
        ImageFormat::Png => "PNG",
        ImageFormat::Jpeg => "JPEG",
        ImageFormat::Bmp => "BMP",
        ImageFormat::WebP => "WebP",
        ImageFormat::Gif => "GIF",
        _ => "picture",
    }
}
