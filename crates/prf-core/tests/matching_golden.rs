//! Scores of windows against OpenCV's, on natural pictures. `tests/reference/make_matching.py` made the data.
#![cfg(feature = "io")]

use std::path::PathBuf;

use prf_core::{Frame, MatchMethod, Plane, TemplateMatcher, io};
use serde::Deserialize;

const TOLERANCE: f32 = 1e-4;

#[derive(Debug, Deserialize)]
struct Case {
    frame: String,
    template: String,
    mask: Option<String>,
    method: MatchMethod,
    shape: [usize; 2],
    best: [usize; 2],
}

fn golden(name: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../tests/golden/matching").join(name)
}

fn picture(name: &str) -> Frame {
    io::read_frame(golden(&format!("{name}.png"))).expect("the picture is committed")
}

/// Every case with the scores it shall have.
fn cases() -> Vec<(Case, Vec<f32>)> {
    let index = std::fs::read(golden("index.json")).expect("the index is committed");
    let index: Vec<Case> = serde_json::from_slice(&index).expect("the index holds cases");
    let scores = std::fs::read(golden("scores.f32")).expect("the scores are committed");
    let (values, rest) = scores.as_chunks::<4>();
    assert!(rest.is_empty());
    let mut values = values.iter().map(|&bytes| f32::from_le_bytes(bytes));
    let mut scores = |case: &Case| values.by_ref().take(case.shape[0] * case.shape[1]).collect();
    let cases = index.into_iter().map(|case| (scores(&case), case)).map(|(scores, case)| (case, scores)).collect();
    assert_eq!(values.len(), 0, "the index covers all scores");
    cases
}

#[test]
fn scores_and_best_matches_are_those_of_opencv() {
    let cases = cases();
    assert!(cases.len() >= 20, "{} cases", cases.len());
    let mut map = Plane::from_vec(1, 1, vec![0.0]).expect("one pixel");
    for (case, expected) in cases {
        let (frame, mask) = (picture(&case.frame), case.mask.as_deref().map(picture));
        let mut matcher =
            TemplateMatcher::new(&picture(&case.template), mask.as_ref(), case.method).expect("a mask that fits");
        matcher.scores_into(frame.view(), &mut map).expect("a template that fits");
        assert_eq!([map.height(), map.width()], case.shape);
        for (at, (got, expected)) in map.as_slice().iter().zip(&expected).enumerate() {
            assert!((got - expected).abs() <= TOLERANCE, "score {at} is {got}, expected {expected}: {case:?}");
        }
        let found = matcher.best(frame.view()).expect("a template that fits");
        assert_eq!([found.rect.x, found.rect.y], case.best, "{case:?}");
    }
}
