//! Pictures in files.
//!
//! What a file holds is told from its first bytes, not from its name. Colour becomes luma
//! ([`crate::luma`]), what is transparent lies on black, 16 bits become 8, and of an animation the
//! first frame is taken.

use std::fs::File;
use std::io::{BufReader, ErrorKind, Read, Seek};
use std::path::Path;

use image::error::ImageError;
use image::{DynamicImage, ImageDecoder, ImageFormat, ImageReader};

use crate::{Error, Frame, FrameView, PictureProblem, luma};

mod jpeg;

/// The most that a picture may hold. A bigger one is refused from its header, before any memory is
/// set aside for it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// The most pixels on a side.
    pub max_side: u32,
    /// The most pixels in all.
    pub max_pixels: u64,
}

impl Default for Limits {
    /// 8192 on a side and 67,108,864 (8192²) in all.
    fn default() -> Limits {
        Limits { max_side: 8192, max_pixels: 8192 * 8192 }
    }
}

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
    read(path, limits).map_err(|problem| picture_error(path, problem))
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

fn read(path: &Path, limits: Limits) -> Result<Frame, PictureProblem> {
    let mut file = open(path)?;
    let format = sniff(&mut file)?;
    let name = name_of(format);
    let failed = |error| decoding_problem(name, error, limits);
    if format == ImageFormat::Jpeg && !jpeg::is_whole(&mut file).map_err(PictureProblem::Io)? {
        return Err(PictureProblem::Truncated { format: name.to_owned() });
    }
    let mut reader = ImageReader::with_format(BufReader::new(file), format);
    // The sides are checked below; this bounds what a decoder takes beside the picture itself.
    let mut memory = image::Limits::default();
    memory.max_alloc = Some(limits.max_pixels.saturating_mul(MAX_BYTES_PER_PIXEL));
    reader.limits(memory);
    let decoder = reader.into_decoder().map_err(failed)?;
    let (width, height) = decoder.dimensions();
    check_size(width, height, limits)?;
    to_frame(DynamicImage::from_decoder(decoder).map_err(failed)?)
}

/// Opens what is a file with something in it.
fn open(path: &Path) -> Result<File, PictureProblem> {
    let metadata = std::fs::metadata(path).map_err(|error| match error.kind() {
        ErrorKind::NotFound => PictureProblem::Missing,
        _ => PictureProblem::Io(error),
    })?;
    if !metadata.is_file() {
        return Err(PictureProblem::NotAFile);
    }
    if metadata.len() == 0 {
        return Err(PictureProblem::Empty);
    }
    File::open(path).map_err(PictureProblem::Io)
}

/// The format by the file's first bytes; the file is at its beginning again afterwards.
fn sniff(file: &mut File) -> Result<ImageFormat, PictureProblem> {
    let mut start = Vec::with_capacity(32);
    file.take(32).read_to_end(&mut start).map_err(PictureProblem::Io)?;
    file.rewind().map_err(PictureProblem::Io)?;
    image::guess_format(&start).ok().filter(ImageFormat::reading_enabled).ok_or_else(|| PictureProblem::NotAPicture {
        start: format!("\"{}\"", start[..start.len().min(8)].escape_ascii()),
    })
}

fn check_size(width: u32, height: u32, limits: Limits) -> Result<(), PictureProblem> {
    let Limits { max_side, max_pixels } = limits;
    if width.max(height) <= max_side && u64::from(width) * u64::from(height) <= max_pixels {
        return Ok(());
    }
    Err(PictureProblem::TooLarge { width, height, max_side, max_pixels })
}

/// Two bytes for each of red, green, blue and alpha: the widest pixel there is.
const MAX_BYTES_PER_PIXEL: u64 = 8;

fn to_frame(picture: DynamicImage) -> Result<Frame, PictureProblem> {
    let (width, height) = (picture.width() as usize, picture.height() as usize);
    let colour = picture.color();
    let frame = match (colour.has_color(), colour.has_alpha()) {
        (false, false) => Frame::from_vec(width, height, picture.into_luma8().into_raw()),
        (false, true) => luma::from_grey_alpha(width, height, &picture.into_luma_alpha8()),
        (true, false) => luma::from_rgb(width, height, &picture.into_rgb8()),
        (true, true) => luma::from_rgba(width, height, &picture.into_rgba8()),
    };
    // Only a picture without pixels gets here.
    frame.map_err(|error| PictureProblem::Damaged { format: "picture".to_owned(), detail: error.to_string() })
}

fn decoding_problem(format: &str, error: ImageError, limits: Limits) -> PictureProblem {
    let format = format.to_owned();
    match error {
        ImageError::IoError(error) if error.kind() == ErrorKind::UnexpectedEof => PictureProblem::Truncated { format },
        ImageError::IoError(error) => PictureProblem::Io(error),
        ImageError::Limits(_) => PictureProblem::Memory { format, max_pixels: limits.max_pixels },
        // The GIF decoder has no kind of its own for this.
        error if error.to_string().contains("Unexpected End of File") => PictureProblem::Truncated { format },
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
