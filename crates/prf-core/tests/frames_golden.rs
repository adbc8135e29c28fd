//! Pictures and animations against what others show of them. `tests/reference/make_frames.py` made the data.
#![cfg(feature = "io")]
#![expect(clippy::unwrap_used, reason = "a test may stop at the first surprise")]

use std::fs;
use std::path::PathBuf;

use prf_core::{Frame, io};
use serde::Deserialize;

#[derive(Debug, Deserialize)]
struct Case {
    file: String,
    width: usize,
    height: usize,
    times_ms: Vec<Option<u32>>,
}

fn golden(name: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../tests/golden/frames").join(name)
}

/// Every file with the frames that it shall show.
fn cases() -> Vec<(Case, Vec<Vec<u8>>)> {
    let index: Vec<Case> = serde_json::from_slice(&fs::read(golden("index.json")).unwrap()).unwrap();
    let pixels = fs::read(golden("frames.u8")).unwrap();
    let mut rest = &pixels[..];
    let mut take = |len| {
        let (frame, behind) = rest.split_at(len);
        rest = behind;
        frame.to_vec()
    };
    let frames = |case: Case| {
        let frames = case.times_ms.iter().map(|_| take(case.width * case.height)).collect();
        (case, frames)
    };
    let cases = index.into_iter().map(frames).collect();
    assert!(rest.is_empty(), "the index covers all frames");
    cases
}

/// Grey that is rounded once or twice, decoders of lossy formats, and what is half transparent.
fn tolerance(file: &str) -> u8 {
    match file {
        "still.jpg" | "still-lossy.webp" | "moving-lossy.webp" => 3,
        _ => 2,
    }
}

fn assert_close(got: &Frame, expected: &[u8], case: &Case, index: usize) {
    assert_eq!((got.width(), got.height()), (case.width, case.height), "{}", case.file);
    let off = got.as_slice().iter().zip(expected).map(|(a, b)| a.abs_diff(*b)).max();
    assert!(off <= Some(tolerance(&case.file)), "{}, frame {index}: off by {off:?}", case.file);
}

#[test]
fn every_frame_is_what_others_show() {
    for (case, expected) in cases() {
        let frames: Vec<_> = io::FrameSource::open(golden(&case.file)).unwrap().map(Result::unwrap).collect();
        assert_eq!(frames.len(), expected.len(), "{}", case.file);
        for (i, ((info, frame), expected)) in frames.iter().zip(&expected).enumerate() {
            assert_close(frame, expected, &case, i);
            assert_eq!(info.index, i as u64);
            let time_ms = info.time_s.map(|time_s| (time_s * 1000.0).round() as u32);
            assert_eq!(time_ms, case.times_ms[i], "{}, frame {i}", case.file);
        }
    }
}

#[test]
fn a_picture_is_the_first_frame() {
    for (case, expected) in cases() {
        assert_close(&io::read_frame(golden(&case.file)).unwrap(), &expected[0], &case, 0);
    }
}
