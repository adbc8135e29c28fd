//! The targets' bodies. `crates/prf-core/tests/decoders.rs` runs them on stable Rust too.
//!
//! Nothing may panic, and whatever is accepted must keep to the limits.

use std::io::Write;
use std::path::Path;

use prf_core::io::{self, FrameSource, Limits};
use prf_core::{CellSize, DirectDescriptor, Frame, HogParams, Norm, RewardParams, TaskDescriptor};
use tempfile::NamedTempFile;

/// What PNGs begin with.
pub const PNG: &[u8] = b"\x89PNG\r\n\x1a\n";
/// What JPEGs begin with.
pub const JPEG: &[u8] = b"\xff\xd8\xff";
/// What bitmaps begin with.
pub const BMP: &[u8] = b"BM";
/// What WebPs begin with, up to their length.
pub const WEBP: &[u8] = b"RIFF";
/// What GIFs begin with.
pub const GIF: &[u8] = b"GIF8";
/// What y4ms begin with.
pub const Y4M: &[u8] = b"YUV4MPEG2 ";

/// Small, so that an input is done with quickly.
const LIMITS: Limits = Limits { max_side: 256, max_pixels: 1 << 14, max_frames: 16 };

/// One picture of the format that begins with `magic`.
pub fn picture(magic: &[u8], data: &[u8]) {
    if data.starts_with(magic) {
        with_file(data, |path| {
            if let Ok(frame) = io::read_frame_within(path, LIMITS) {
                check(&frame);
            }
        });
    }
}

/// Every frame of a GIF, APNG or WebP.
pub fn animation(data: &[u8]) {
    let webp = data.starts_with(WEBP) && data.get(8..12) == Some(b"WEBP");
    if webp || data.starts_with(PNG) || data.starts_with(b"GIF87a") || data.starts_with(b"GIF89a") {
        with_file(data, frames);
    }
}

/// Every frame of a y4m.
pub fn y4m(data: &[u8]) {
    if data.starts_with(Y4M) {
        with_file(data, frames);
    }
}

/// A goal and frames of any size: the first bytes say how large they are and how they are compared, the
/// others are pixels.
pub fn goal(data: &[u8]) {
    let Some((&[width, height, other_width, other_height, cell, norm], pixels)) = data.split_first_chunk() else {
        return;
    };
    let goal = frame_of(width, height, pixels);
    let hog = HogParams {
        cell: CellSize::Px(usize::from(cell % 16) + 1),
        norm: [Norm::None, Norm::L1, Norm::L1Sqrt, Norm::L2, Norm::L2Hys][usize::from(norm % 5)],
        block_cells: usize::from(norm / 5 % 3) + 1,
        ..HogParams::default()
    };
    let Ok(mut descriptor) = DirectDescriptor::new(&goal, RewardParams { hog, ..RewardParams::default() }) else {
        return;
    };
    assert_eq!(descriptor.observe(goal.view()).expect("any frame will do").reward, 1.0);
    let other = frame_of(other_width, other_height, pixels);
    let score = descriptor.observe(other.view()).expect("any frame will do");
    assert!(score.reward > 0.0 && score.reward <= 1.0 && score.distance >= 0.0, "{score:?}");
}

/// Sides of 1 to 32, the pixels over and over again.
fn frame_of(width: u8, height: u8, pixels: &[u8]) -> Frame {
    let mut frame = Frame::new(usize::from(width % 32) + 1, usize::from(height % 32) + 1);
    for (to, &from) in frame.as_mut_slice().iter_mut().zip(pixels.iter().cycle()) {
        *to = from;
    }
    frame
}

fn frames(path: &Path) {
    let Ok(mut source) = FrameSource::open_within(path, LIMITS) else { return };
    let mut frame = Frame::new(1, 1);
    let mut size = None;
    let mut count = 0;
    while let Some(Ok(info)) = source.next_into(&mut frame) {
        assert_eq!(info.index, count);
        check(&frame);
        assert_eq!(*size.get_or_insert((frame.width(), frame.height())), (frame.width(), frame.height()));
        count += 1;
    }
    assert!(count <= LIMITS.max_frames);
    assert!(source.next_into(&mut frame).is_none(), "the first error is the end");
}

fn check(frame: &Frame) {
    let side = frame.width().max(frame.height()) as u64;
    assert!(side <= u64::from(LIMITS.max_side) && frame.as_slice().len() as u64 <= LIMITS.max_pixels);
}

fn with_file(data: &[u8], read: impl Fn(&Path)) {
    let mut file = NamedTempFile::new().expect("there is a folder for temporary files");
    file.write_all(data).expect("the file is new");
    read(file.path());
}
