//! Pictures and frames in files.
//!
//! What a file holds is told from its first bytes, not from its name. Colour becomes luma
//! ([`crate::luma`]), what is transparent lies on black, and 16 bits become 8.
//!
//! [`read_frame`] reads one picture; of an animation it takes the first frame. [`FrameSource`] reads
//! whatever has frames: animations, videos, folders of pictures.

use std::path::Path;

use image::ImageFormat;
use image::error::ImageError;

use crate::{Error, Frame, FrameView, PictureProblem};

mod animation;
mod apng;
mod canvas;
mod ffmpeg;
mod folder;
mod gif;
mod jpeg;
mod limits;
mod natural;
mod picture;
mod pixels;
mod sniff;
mod source;
mod webp;
mod y4m;

pub use limits::Limits;
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

/// Writes a picture as PNG, 8 bits of grey. An existing file is overwritten.
///
/// # Errors
///
/// [`Error::Picture`] when the file can't be written.
pub fn write_frame(frame: FrameView<'_>, path: impl AsRef<Path>) -> Result<(), Error> {
    let path = path.as_ref();
    write(frame, path).map_err(|problem| picture_error(path, problem))
}

fn picture_error(path: &Path, problem: PictureProblem) -> Error {
    Error::Picture { path: path.to_owned(), problem }
}

fn write(frame: FrameView<'_>, path: &Path) -> Result<(), PictureProblem> {
    let side = |px: usize| u32::try_from(px).unwrap_or(u32::MAX);
    let (width, height) = (side(frame.width()), side(frame.height()));
    let saved = image::save_buffer_with_format(
        path,
        frame.as_slice(),
        width,
        height,
        image::ExtendedColorType::L8,
        ImageFormat::Png,
    );
    saved.map_err(|error| match error {
        ImageError::IoError(error) => PictureProblem::Io(error),
        error => PictureProblem::Io(std::io::Error::other(error)),
    })
}
