//! Pictures and frames in files.
//!
//! What a file holds is told from its first bytes, not from its name. Colour becomes luma
//! ([`crate::luma`]), what is transparent lies on black, and 16 bits become 8.
//!
//! [`read_frame`] reads one picture; of an animation it takes the first frame. [`FrameSource`] reads
//! whatever has frames: animations, videos, folders of pictures. [`read_motion`] makes the motion template of such a
//! sequence, and [`ck_plus`] lists the sequences of the Extended Cohn-Kanade data set.

use std::path::Path;

use image::codecs::png::PngEncoder;
use image::{ExtendedColorType, ImageEncoder};

use crate::{Error, Frame, FrameView, Goal, PictureProblem, SequenceProblem};

mod animation;
mod apng;
mod canvas;
pub mod ck_plus;
mod ffmpeg;
mod folder;
mod gif;
mod jpeg;
mod limits;
mod natural;
mod picture;
mod pixels;
mod sequence;
mod sniff;
mod source;
mod webp;
mod y4m;

pub use limits::Limits;
pub use sequence::{MotionSequence, SequenceWarning, read_motion};
pub use source::{FrameInfo, FrameSource};

/// Reads a picture (PNG, JPEG, BMP, WebP or GIF) with the default [`Limits`].
///
/// # Errors
///
/// [`Error::Picture`], which names the file and says what is wrong with it.
pub fn read_frame(path: impl AsRef<Path>) -> Result<Frame, Error> {
    read_frame_within(path, Limits::default())
}

/// Reads a picture (PNG, JPEG, BMP, WebP or GIF) that keeps to `limits`.
///
/// # Errors
///
/// [`Error::Picture`], which names the file and says what is wrong with it.
pub fn read_frame_within(path: impl AsRef<Path>, limits: Limits) -> Result<Frame, Error> {
    let path = path.as_ref();
    let mut frame = Frame::new(1, 1);
    picture::read_into(path, limits, &mut frame).map_err(|problem| picture_error(path, problem))?;
    Ok(frame)
}

/// Reads a cut-out: its pixels on black, and as its mask which of them are not wholly transparent. A picture that is opaque
/// everywhere has no mask.
///
/// # Errors
///
/// [`Error::Picture`], which names the file and says what is wrong with it.
pub fn read_cut_out(path: impl AsRef<Path>) -> Result<Goal, Error> {
    let path = path.as_ref();
    picture::read_cut_out(path, Limits::default()).map_err(|problem| picture_error(path, problem))
}

/// Writes a picture as PNG, 8 bits of grey. An existing file is overwritten.
///
/// # Errors
///
/// [`Error::Picture`] when the file can't be written.
pub fn write_frame(frame: FrameView<'_>, path: impl AsRef<Path>) -> Result<(), Error> {
    let path = path.as_ref();
    std::fs::write(path, png(frame)).map_err(|error| picture_error(path, PictureProblem::Io(error)))
}

/// A picture as the bytes of a PNG, 8 bits of grey.
#[must_use]
pub fn png(frame: FrameView<'_>) -> Vec<u8> {
    encode([frame.width(), frame.height()], frame.as_slice(), ExtendedColorType::L8)
}

/// A picture in colour as the bytes of a PNG, 8 bits of red, green and blue.
#[cfg(feature = "explain")]
#[must_use]
pub fn picture_png(picture: &crate::Picture) -> Vec<u8> {
    encode([picture.width(), picture.height()], picture.as_rgb(), ExtendedColorType::Rgb8)
}

fn encode([width, height]: [usize; 2], pixels: &[u8], colour: ExtendedColorType) -> Vec<u8> {
    let mut bytes = Vec::new();
    let encoded = PngEncoder::new(&mut bytes).write_image(pixels, width as u32, height as u32, colour);
    encoded.expect("writing to memory doesn't fail, and the pixels are as many as the sides say");
    bytes
}

fn picture_error(path: &Path, problem: PictureProblem) -> Error {
    Error::Picture { path: path.to_owned(), problem }
}

fn sequence_error(path: &Path, problem: SequenceProblem) -> Error {
    Error::Sequence { path: path.to_owned(), problem }
}
