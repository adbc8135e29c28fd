//! Motion templates against OpenCV's motion history. `tests/reference/make_motion.py` made the data.

use std::path::PathBuf;

use prf_core::{FrameView, MotionParams, MotionTemplate};
use serde::Deserialize;

#[derive(Debug, Deserialize)]
struct Case {
    width: usize,
    height: usize,
    pictures: usize,
    input: Input,
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum Input {
    /// Frames.
    Observe(MotionParams),
    /// Silhouettes, each with its time and duration.
    Update(Vec<(f32, f32)>),
}

fn golden(name: &str) -> Vec<u8> {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../tests/golden/motion").join(name);
    std::fs::read(path).expect("the golden data is committed")
}

/// A case with its pictures and the history after each of its iterations.
struct Sequence {
    case: Case,
    pictures: Vec<Vec<u8>>,
    histories: Vec<Vec<f32>>,
}

fn sequences() -> Vec<Sequence> {
    let index: Vec<Case> = serde_json::from_slice(&golden("index.json")).expect("the index holds cases");
    let (pictures, histories) = (golden("pictures.u8"), golden("history.f32"));
    let (values, rest) = histories.as_chunks::<4>();
    assert!(rest.is_empty());
    let mut pixels = pictures.into_iter();
    let mut values = values.iter().map(|&bytes| f32::from_le_bytes(bytes));
    let sequences = index.into_iter().map(|case| {
        let len = case.width * case.height;
        let iterations = case.pictures - usize::from(matches!(case.input, Input::Observe(_)));
        let pictures = (0..case.pictures).map(|_| pixels.by_ref().take(len).collect()).collect();
        let histories = (0..iterations).map(|_| values.by_ref().take(len).collect()).collect();
        Sequence { case, pictures, histories }
    });
    let sequences = sequences.collect();
    assert_eq!((pixels.len(), values.len()), (0, 0), "the index covers all data");
    sequences
}

#[test]
fn every_iteration_has_the_history_of_opencv_to_the_bit() {
    let (mut observed, mut updated) = (0, 0);
    for Sequence { case, pictures, histories } in sequences() {
        let mut views = pictures.iter().map(|p| FrameView::new(case.width, case.height, p).expect("a whole picture"));
        let mut template = MotionTemplate::new(MotionParams::default()).expect("valid parameters");
        if let Input::Observe(params) = &case.input {
            template = MotionTemplate::of(*params, views.next()).expect("valid parameters");
        }
        for (t, (view, expected)) in views.zip(&histories).enumerate() {
            match &case.input {
                Input::Observe(_) => template.observe(view).expect("frames of one size"),
                Input::Update(times) => template.update(view, times[t].0, times[t].1).expect("times in order"),
            }
            assert_eq!(template.history(), expected, "iteration {t} of {case:?}");
        }
        match case.input {
            Input::Observe(_) => observed += histories.len(),
            Input::Update(_) => updated += histories.len(),
        }
    }
    assert!(observed >= 50 && updated >= 20, "{observed} and {updated} iterations");
}
