//! How large pictures may be, and how many.

use crate::PictureProblem;

/// The most that a picture may hold, and a source of frames. A bigger picture is refused from its
/// header, before any memory is set aside for it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// The most pixels on a side.
    pub max_side: u32,
    /// The most pixels in all.
    pub max_pixels: u64,
    /// The most frames of an animation or a video, and the most pictures of a folder.
    pub max_frames: u64,
}

impl Default for Limits {
    /// 8192 on a side, 67,108,864 (8192²) in all, and 100,000 frames.
    fn default() -> Limits {
        Limits { max_side: 8192, max_pixels: 8192 * 8192, max_frames: 100_000 }
    }
}

impl Limits {
    /// Whether a picture may have this size, which is what the header of a `format` says.
    pub(super) fn check_size(self, format: &str, width: u32, height: u32) -> Result<(), PictureProblem> {
        let Limits { max_side, max_pixels, .. } = self;
        if width == 0 || height == 0 {
            return Err(PictureProblem::damaged(format, format!("it says it is {width}x{height}")));
        }
        if width.max(height) <= max_side && u64::from(width) * u64::from(height) <= max_pixels {
            return Ok(());
        }
        Err(PictureProblem::TooLarge { width, height, max_side, max_pixels })
    }

    /// Whether there may be this many frames.
    pub(super) fn check_count(self, frames: u64) -> Result<(), PictureProblem> {
        let max_frames = self.max_frames;
        if frames <= max_frames { Ok(()) } else { Err(PictureProblem::TooManyFrames { max_frames }) }
    }

    /// The bound on what a decoder takes beside the picture, whose size is checked by itself.
    pub(super) fn memory_bytes(self, bytes_per_pixel: u64) -> u64 {
        self.max_pixels.saturating_mul(bytes_per_pixel)
    }
}
