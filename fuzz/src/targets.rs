//! The targets' bodies. `crates/prf-core/tests/decoders.rs` runs them on stable Rust too.
//!
//! Nothing may panic, and whatever is accepted must keep to the limits.

use std::io::Write;
use std::path::Path;

use prf_core::io::{self, FrameSource, Limits};
use prf_core::{
    CellSize, DescriptorKind, DescriptorParams, Error, Frame, Goal, HogParams, Match, MatchMethod, MotionParams, Norm,
    RewardParams, TaskDescriptor, WindowParams, check_goal,
};
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

/// A goal and frames of any shape and size, for every descriptor: the first bytes say how large they are and how they
/// are compared, the others are pixels.
pub fn goal(data: &[u8]) {
    let Some((&[width, height, other_width, other_height, cell, norm, kind], pixels)) = data.split_first_chunk() else {
        return;
    };
    let mask = (kind >= 128).then(|| frame_of(width, height, pixels.get(1..).unwrap_or_default()));
    let goal = Goal { picture: frame_of(width, height, pixels), mask };
    let (descriptor, params) = (descriptor_of(kind), reward_of(cell, norm));
    // Whatever it finds suspicious, it has to find it.
    let _ = check_goal(&goal, descriptor.kind(), params);
    let Ok(mut scored) = descriptor.describe(&goal, params) else { return };
    if descriptor.kind() != DescriptorKind::Motion {
        let itself = scored.observe(goal.picture.view()).expect("a goal fits into itself");
        assert_eq!(itself.reward, 1.0);
    }
    for start in 0..4 {
        let frame = frame_of(other_width, other_height, pixels.get(start..).unwrap_or_default());
        observe(scored.as_mut(), &goal.picture, &frame);
    }
}

/// Scores a frame, which only a window that doesn't fit into it may refuse.
fn observe(descriptor: &mut dyn TaskDescriptor, goal: &Frame, frame: &Frame) {
    let score = match descriptor.observe(frame.view()) {
        Ok(score) => score,
        Err(error) => {
            let fits = goal.width() <= frame.width() && goal.height() <= frame.height();
            assert!(matches!(error, Error::TemplateTooLarge { .. }) && !fits, "{error}");
            return;
        }
    };
    assert!(score.reward > 0.0 && score.reward <= 1.0 && score.distance >= 0.0, "{score:?}");
    if let Some(Match { rect, score }) = descriptor.explain(frame.view()).matched {
        assert!((-1.0..=1.0).contains(&score), "{score}");
        assert_eq!((rect.width, rect.height), (goal.width(), goal.height()));
        assert!(rect.x + rect.width <= frame.width() && rect.y + rect.height <= frame.height(), "{rect:?}");
    }
}

fn descriptor_of(kind: u8) -> DescriptorParams {
    let window = |method| DescriptorParams::Window(WindowParams { method });
    match kind % 4 {
        0 => DescriptorParams::Direct,
        1 => window(MatchMethod::CcorrNormed),
        2 => window(MatchMethod::CcoeffNormed),
        _ => DescriptorParams::Motion(MotionParams { threshold: kind / 4 * 4, ..MotionParams::default() }),
    }
}

fn reward_of(cell: u8, norm: u8) -> RewardParams {
    let hog = HogParams {
        cell: match cell {
            0..128 => CellSize::Px(usize::from(cell % 16) + 1),
            128.. => CellSize::Fraction(f32::from(cell - 127) / 128.0),
        },
        norm: [Norm::None, Norm::L1, Norm::L1Sqrt, Norm::L2, Norm::L2Hys][usize::from(norm % 5)],
        block_cells: usize::from(norm / 5 % 3) + 1,
        signed: norm >= 128,
        ..HogParams::default()
    };
    RewardParams { hog, ..RewardParams::default() }
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
