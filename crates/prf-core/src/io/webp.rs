//! The frames of an animated WebP.
//!
//! Each frame is made a WebP file of its own in memory, which the decoder of pictures reads: the
//! decoder of animations doesn't dispose of frames where it should, and trusts their sizes.

use std::fs::File;
use std::io::{BufReader, Cursor, ErrorKind, Read, Seek};

use image::codecs::webp::WebPDecoder;
use image::{DynamicImage, ImageDecoder, ImageFormat};

use super::animation::{MAX_BYTES_PER_PIXEL, Patches};
use super::canvas::{Blend, Disposal, Patch, Pixel};
use super::pixels::grey_alpha;
use super::{Limits, picture};
use crate::{PictureProblem, Rect};

const NAME: &str = "WebP";
/// "RIFF", the length of the rest, "WEBP".
const RIFF_LEN: usize = 12;
const ANIMATION_FLAG: u8 = 0x02;
const ALPHA_FLAG: u8 = 0x10;
/// Of a frame's chunk, before its picture.
const FRAME_HEADER_LEN: usize = 16;

/// A chunk's name and the length of what is in it.
struct Chunk {
    name: [u8; 4],
    len: u32,
}

impl Chunk {
    fn read(from: &mut impl Read) -> std::io::Result<Chunk> {
        let (mut name, mut len) = ([0; 4], [0; 4]);
        from.read_exact(&mut name)?;
        from.read_exact(&mut len)?;
        Ok(Chunk { name, len: u32::from_le_bytes(len) })
    }

    /// With the byte that fills up an odd length.
    fn padded(&self) -> u64 {
        u64::from(self.len).next_multiple_of(2)
    }
}

/// Whether the file is as long as its header says; leaves it at its beginning.
pub(super) fn is_whole(file: &mut File) -> std::io::Result<bool> {
    let riff = Chunk::read(file)?;
    file.rewind()?;
    Ok(file.metadata()?.len() >= 8 + u64::from(riff.len))
}

pub(super) struct Webp {
    file: BufReader<File>,
    limits: Limits,
    shape: [u32; 2],
    /// Bytes of the file that come after what was read.
    left: u64,
    chunk: Vec<u8>,
}

impl Webp {
    /// The animation in this file, or nothing if it is a still picture.
    pub(super) fn open(mut file: BufReader<File>, limits: Limits) -> Result<Option<Webp>, PictureProblem> {
        let riff = Chunk::read(&mut file).map_err(problem)?;
        file.read_exact(&mut [0; 4]).map_err(problem)?;
        let first = Chunk::read(&mut file).map_err(problem)?;
        let mut header = [0; 10];
        file.read_exact(&mut header).map_err(problem)?;
        if &first.name != b"VP8X" || header[0] & ANIMATION_FLAG == 0 {
            return Ok(None);
        }
        let [width, height] = [number(&header[4..7]) + 1, number(&header[7..10]) + 1];
        limits.check_size(NAME, width, height)?;
        let read = RIFF_LEN as u64 + header.len() as u64;
        let left = u64::from(riff.len).saturating_sub(read);
        let mut webp = Webp { file, limits, shape: [height, width], left, chunk: Vec::new() };
        webp.skip(first.padded().saturating_sub(header.len() as u64))?;
        Ok(Some(webp))
    }

    fn skip(&mut self, len: u64) -> Result<(), PictureProblem> {
        self.left = self.left.saturating_sub(len);
        self.file.seek_relative(i64::try_from(len).unwrap_or(i64::MAX)).map_err(problem)
    }

    /// Reads what is in the chunk.
    fn read(&mut self, chunk: &Chunk) -> Result<(), PictureProblem> {
        if chunk.padded() > self.limits.memory_bytes(MAX_BYTES_PER_PIXEL) {
            return Err(PictureProblem::Memory { format: NAME.to_owned(), max_pixels: self.limits.max_pixels });
        }
        self.chunk.clear();
        let got = self.file.by_ref().take(chunk.padded()).read_to_end(&mut self.chunk).map_err(problem)?;
        self.left = self.left.saturating_sub(chunk.padded());
        if (got as u64) < chunk.padded() { Err(truncated()) } else { Ok(()) }
    }
}

impl Patches for Webp {
    fn shape(&self) -> [u32; 2] {
        self.shape
    }

    fn next(&mut self, pixels: &mut Vec<Pixel>) -> Result<Option<Patch>, PictureProblem> {
        while self.left >= 8 {
            let chunk = Chunk::read(&mut self.file).map_err(problem)?;
            self.left -= 8;
            if &chunk.name != b"ANMF" {
                self.skip(chunk.padded())?;
                continue;
            }
            self.read(&chunk)?;
            let (patch, picture) = frame_of(&self.chunk)?;
            decode_into(&patch, picture, self.limits, pixels)?;
            return Ok(Some(patch));
        }
        Ok(None)
    }
}

/// Where a frame lies, and the chunks that hold its picture.
fn frame_of(chunk: &[u8]) -> Result<(Patch, &[u8]), PictureProblem> {
    let Some((header, picture)) = chunk.split_at_checked(FRAME_HEADER_LEN) else {
        return Err(PictureProblem::damaged(NAME, "a frame shorter than its header"));
    };
    let [x, y, width, height, delay] = [0, 3, 6, 9, 12].map(|at| number(&header[at..at + 3]) as usize);
    // A whole file in its place would be decoded too.
    if ![b"ALPH", b"VP8 ", b"VP8L"].iter().any(|name| picture.starts_with(*name)) {
        return Err(PictureProblem::damaged(NAME, "a frame without a picture"));
    }
    let flags = header[15];
    let patch = Patch {
        rect: Rect { x: 2 * x, y: 2 * y, width: width + 1, height: height + 1 },
        blend: if flags & 2 == 0 { Blend::Over } else { Blend::Source },
        disposal: if flags & 1 == 0 { Disposal::Keep } else { Disposal::Background },
        delay_ms: delay as f64,
    };
    Ok((patch, picture))
}

fn decode_into(patch: &Patch, picture: &[u8], limits: Limits, pixels: &mut Vec<Pixel>) -> Result<(), PictureProblem> {
    let Rect { width, height, .. } = patch.rect;
    // Both have come from three bytes.
    let (width, height) = (width as u32, height as u32);
    limits.check_size(NAME, width, height)?;
    let failed = |error| picture::decoding_problem(ImageFormat::WebP, error, limits);
    let decoder = WebPDecoder::new(Cursor::new(file_of(width, height, picture))).map_err(failed)?;
    if decoder.dimensions() != (width, height) {
        return Err(PictureProblem::damaged(NAME, "a frame that is not as large as it says"));
    }
    let picture = DynamicImage::from_decoder(decoder).map_err(failed)?.into_rgba8();
    pixels.clear();
    pixels.extend(picture.as_chunks().0.iter().map(|&pixel| grey_alpha(pixel)));
    Ok(())
}

/// A file with this picture alone.
fn file_of(width: u32, height: u32, picture: &[u8]) -> Vec<u8> {
    let mut chunks = b"WEBP".to_vec();
    // A plane of alpha stands before the picture that it belongs to, and needs a header that says so.
    if picture.starts_with(b"ALPH") {
        chunks.extend(*b"VP8X\x0a\0\0\0");
        chunks.extend([ALPHA_FLAG, 0, 0, 0]);
        chunks.extend(&(width - 1).to_le_bytes()[..3]);
        chunks.extend(&(height - 1).to_le_bytes()[..3]);
    }
    chunks.extend(picture);
    // It was read from a chunk, whose length is as wide.
    let len = u32::try_from(chunks.len()).unwrap_or(u32::MAX);
    [&b"RIFF"[..], &len.to_le_bytes(), &chunks].concat()
}

/// Three bytes, the lowest first.
fn number(bytes: &[u8]) -> u32 {
    bytes.iter().rev().fold(0, |sum, &byte| sum << 8 | u32::from(byte))
}

fn problem(error: std::io::Error) -> PictureProblem {
    if error.kind() == ErrorKind::UnexpectedEof { truncated() } else { PictureProblem::Io(error) }
}

fn truncated() -> PictureProblem {
    PictureProblem::Truncated { format: NAME.to_owned() }
}
