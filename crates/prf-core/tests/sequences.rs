//! Sequences in files as goals of motion: what becomes of them, and what is refused.
#![cfg(feature = "io")]
#![expect(clippy::unwrap_used, reason = "a test may stop at the first surprise")]

use std::fs;
use std::path::Path;

use prf_core::io::{MotionSequence, SequenceWarning, read_motion};
use prf_core::{DeltaSchedule, Error, Frame, MotionParams, PictureProblem, SequenceProblem, io};
use tempfile::TempDir;

/// A folder with a picture for each row of pixels, named 1.png and so on.
fn folder(frames: &[&[u8]]) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    for (index, pixels) in frames.iter().enumerate() {
        write(&folder.path().join(format!("{}.png", index + 1)), pixels);
    }
    folder
}

fn write(path: &Path, pixels: &[u8]) {
    io::write_frame(Frame::from_vec(pixels.len(), 1, pixels.to_vec()).unwrap().view(), path).unwrap();
}

/// A light that walks over `len` pixels, one a frame.
fn walk(len: usize) -> Vec<Vec<u8>> {
    (0..len).map(|lit| (0..len).map(|x| if x == lit { 200 } else { 0 }).collect()).collect()
}

fn slices(frames: &[Vec<u8>]) -> Vec<&[u8]> {
    frames.iter().map(Vec::as_slice).collect()
}

fn with_delta(delta: DeltaSchedule) -> MotionParams {
    MotionParams { delta, ..MotionParams::default() }
}

/// The problem of this sequence, which the error has to name.
fn refused(path: &Path, params: MotionParams) -> SequenceProblem {
    match read_motion(path, params, false) {
        Err(Error::Sequence { path: named, problem }) => {
            assert!(named.starts_with(path), "{}", named.display());
            problem
        }
        other => panic!("got {other:?}"),
    }
}

fn good(path: &Path, params: MotionParams) -> MotionSequence {
    read_motion(path, params, false).unwrap()
}

/// What counts as a movement is what the template takes for one.
#[test]
fn pauses_and_slow_movements_are_counted_as_the_template_does() {
    let params = MotionParams { skip_still: true, ..MotionParams::default() };
    let slow = folder(&[&[0], &[20], &[40], &[60], &[80], &[80], &[80]]);
    let sequence = good(slow.path(), params);
    assert_eq!((sequence.frames, sequence.movements, sequence.template.as_slice()), (7, 2, &[255][..]));
    let problem = refused(slow.path(), MotionParams::default());
    assert!(matches!(problem, SequenceProblem::Still { largest: 20, threshold: 30 }), "{problem:?}");
    let back = folder(&[&[100], &[120], &[89]]);
    let problem = refused(back.path(), params);
    assert!(matches!(problem, SequenceProblem::Still { largest: 20, threshold: 30 }), "{problem:?}");
}

#[test]
fn the_template_is_that_of_the_frames_in_natural_order() {
    let frames = walk(12);
    let folder = folder(&slices(&frames));
    let sequence = good(folder.path(), MotionParams::default());
    let views = frames.iter().map(|pixels| prf_core::FrameView::new(12, 1, pixels).unwrap());
    let mut expected = Frame::new(1, 1);
    prf_core::MotionTemplate::of(MotionParams::default(), views).unwrap().history_into(&mut expected);
    assert_eq!(sequence.template, expected);
    // The first is older than δ at the end: 0.1 is below 4.1 − 11/3.
    assert_eq!((sequence.frames, sequence.movements, sequence.remembered), (12, 11, 10));
    assert!(sequence.damaged.is_empty() && sequence.warning.is_none());
}

#[test]
fn too_few_frames_are_refused() {
    let one = folder(&[&[1, 2, 3]]);
    let problem = refused(one.path(), MotionParams::default());
    assert!(matches!(problem, SequenceProblem::TooFewFrames { readable: 1, .. }), "{problem:?}");
    assert!(problem.to_string().starts_with("got 1 frame, expected at least 2"), "{problem}");
}

#[test]
fn a_frame_of_another_size_is_named() {
    let folder = folder(&[&[1, 2, 3], &[100, 2, 3], &[1, 2], &[1, 2, 3]]);
    let error = read_motion(folder.path(), MotionParams::default(), true).unwrap_err().to_string();
    assert!(error.contains("3.png: the frame is 2x1 px, expected 3x1"), "{error}");
}

#[test]
fn a_sequence_without_motion_is_told_from_one_below_the_threshold() {
    let faint = folder(&[&[50, 50], &[62, 50], &[55, 51]]);
    let problem = refused(faint.path(), MotionParams::default());
    assert!(matches!(problem, SequenceProblem::Still { largest: 12, threshold: 30 }), "{problem:?}");
    assert!(problem.to_string().contains("is 12, the threshold 30"), "{problem}");
    assert!(problem.to_string().contains("lower `threshold` to 11 or less"), "{problem}");
    let advised = MotionParams { threshold: 11, ..MotionParams::default() };
    assert_eq!(good(faint.path(), advised).movements, 1);

    let still = folder(&[&[50, 50], &[50, 50]]);
    let problem = refused(still.path(), MotionParams { threshold: 0, ..MotionParams::default() });
    assert!(problem.to_string().contains("all frames are the same"), "{problem}");
}

#[test]
fn damaged_frames_are_named_or_left_out() {
    let frames = walk(5);
    let folder = folder(&slices(&frames));
    let bytes = fs::read(folder.path().join("3.png")).unwrap();
    fs::write(folder.path().join("3.png"), &bytes[..bytes.len() / 2]).unwrap();
    let is_third = |error: &Error| matches!(error, Error::Picture { path, problem: PictureProblem::Truncated { .. } } if path.ends_with("3.png"));
    let error = read_motion(folder.path(), MotionParams::default(), false).unwrap_err();
    assert!(is_third(&error), "{error}");

    let sequence = read_motion(folder.path(), MotionParams::default(), true).unwrap();
    assert_eq!((sequence.frames, sequence.movements, sequence.damaged.len()), (4, 3, 1));
    assert!(is_third(&sequence.damaged[0]));
    fs::remove_file(folder.path().join("3.png")).unwrap();
    assert_eq!(good(folder.path(), MotionParams::default()).template, sequence.template);
}

#[test]
fn too_few_that_can_be_read_are_refused_with_the_others_at_hand() {
    let folder = folder(&[&[1, 2], &[200, 2]]);
    for damaged in ["2.png", "3.png"] {
        fs::write(folder.path().join(damaged), b"").unwrap();
    }
    match read_motion(folder.path(), MotionParams::default(), true) {
        Err(error @ Error::Sequence { problem: SequenceProblem::TooFewFrames { .. }, .. }) => {
            assert!(error.to_string().contains("got 1 frame that can be read (2 damaged)"), "{error}");
        }
        other => panic!("got {other:?}"),
    }
}

/// Ten frames of a walk and eight in which nothing moves.
fn still_end() -> TempDir {
    let mut frames = walk(10);
    (0..8).for_each(|_| frames.push(frames[9].clone()));
    folder(&slices(&frames))
}

#[test]
fn a_schedule_that_forgets_everything_is_refused_and_the_advice_helps() {
    let folder = still_end();
    for (delta, named) in [
        (DeltaSchedule::Duration(0.5), "delta.duration"),
        (DeltaSchedule::Duration(3.0), "delta.duration"),
        (DeltaSchedule::Divisor(100.0), "delta.divisor"),
        (DeltaSchedule::Divisor(6.0), "delta.divisor"),
    ] {
        let problem = refused(folder.path(), with_delta(delta));
        let SequenceProblem::Forgotten { movements, key, needed, .. } = problem else { panic!("got {problem:?}") };
        assert_eq!((movements, key), (9, named));
        let (advised, beyond) = match delta {
            DeltaSchedule::Duration(_) => (DeltaSchedule::Duration(needed), DeltaSchedule::Duration(needed - 0.01)),
            DeltaSchedule::Divisor(_) => (DeltaSchedule::Divisor(needed), DeltaSchedule::Divisor(needed + 0.01)),
        };
        assert_eq!(good(folder.path(), with_delta(advised)).remembered, 1, "{advised:?}");
        assert!(matches!(refused(folder.path(), with_delta(beyond)), SequenceProblem::Forgotten { .. }), "{beyond:?}");
    }
    let problem = refused(folder.path(), with_delta(DeltaSchedule::Duration(0.5))).to_string();
    assert!(problem.contains("`delta.duration` is 0.5, expected at least 3.2;"), "{problem}");
    let problem = refused(folder.path(), with_delta(DeltaSchedule::Divisor(100.0))).to_string();
    assert!(problem.contains("`delta.divisor` is 100, expected at most 5.31;"), "{problem}");
}

#[test]
fn a_template_without_history_gets_a_warning() {
    let frames = walk(5);
    let walked = folder(&slices(&frames));
    let forgetful = |delta| good(walked.path(), with_delta(delta)).warning;
    let warning = forgetful(DeltaSchedule::Duration(0.1)).unwrap();
    assert_eq!(warning, SequenceWarning::OnlyNewest { movements: 4, forgotten_by: Some("delta.duration") });
    assert!(warning.to_string().contains("of 4 movements") && warning.hint().contains("larger"), "{warning}");
    assert!(forgetful(DeltaSchedule::Divisor(50.0)).unwrap().hint().contains("smaller `delta.divisor`"));
    assert_eq!(forgetful(DeltaSchedule::Duration(0.4)), None);

    // Two movements are no history yet.
    let short = folder(&slices(&frames)[..3]);
    assert_eq!(good(short.path(), with_delta(DeltaSchedule::Duration(0.1))).warning, None);

    let blinking = folder(&[&[0, 0], &[200, 200], &[0, 0], &[200, 200]]);
    let warning = good(blinking.path(), MotionParams::default()).warning.unwrap();
    assert_eq!(warning, SequenceWarning::OnlyNewest { movements: 3, forgotten_by: None });
    assert!(warning.to_string().contains("lies over all others"), "{warning}");
}
