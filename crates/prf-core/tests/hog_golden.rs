//! HOG against scikit-image's, on natural pictures. `tests/reference/make_hog.py` made the data.
#![cfg(feature = "io")]

use std::path::PathBuf;

use prf_core::{Frame, Hog, HogParams, Plane, io};
use serde::Deserialize;

const TOLERANCE: f32 = 1e-5;

#[derive(Debug, Deserialize)]
struct Case {
    picture: String,
    input: Input,
    hog: HogParams,
    len: usize,
}

#[derive(Debug, Deserialize, PartialEq)]
#[serde(rename_all = "kebab-case")]
enum Input {
    Bytes,
    Floats,
}

fn golden(name: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../tests/golden/hog").join(name)
}

fn picture(case: &Case) -> Frame {
    io::read_frame(golden(&format!("{}.png", case.picture))).expect("the picture is committed")
}

/// Every case with the features it shall have.
fn cases() -> Vec<(Case, Vec<f32>)> {
    let index = std::fs::read(golden("index.json")).expect("the index is committed");
    let index: Vec<Case> = serde_json::from_slice(&index).expect("the index holds cases");
    let features = std::fs::read(golden("features.f32")).expect("the features are committed");
    let (values, rest) = features.as_chunks::<4>();
    assert!(rest.is_empty());
    let mut values = values.iter().map(|&bytes| f32::from_le_bytes(bytes));
    let cases: Vec<_> = index
        .into_iter()
        .map(|case| {
            let expected: Vec<f32> = values.by_ref().take(case.len).collect();
            (case, expected)
        })
        .collect();
    assert_eq!(values.len(), 0, "the index covers all features");
    cases
}

fn assert_close(got: &[f32], expected: &[f32], case: &Case) {
    assert_eq!(got.len(), expected.len(), "{case:?}");
    for (at, (got, expected)) in got.iter().zip(expected).enumerate() {
        let off = (got - expected).abs();
        assert!(off <= TOLERANCE, "feature {at} is {got}, expected {expected}: {case:?}");
    }
}

#[test]
fn bytes_give_the_features_of_scikit_image() {
    let mut tried = 0;
    for (case, expected) in cases().iter().filter(|(case, _)| case.input == Input::Bytes) {
        let mut got = Vec::new();
        let mut hog = Hog::new(case.hog).expect("valid parameters");
        hog.compute_bytes_into(picture(case).view(), &mut got).expect("the picture is large enough");
        assert_close(&got, expected, case);
        tried += 1;
    }
    assert!(tried >= 50, "{tried} cases");
}

#[test]
fn floats_give_the_features_of_scikit_image() {
    let mut tried = 0;
    for (case, expected) in cases().iter().filter(|(case, _)| case.input == Input::Floats) {
        let mut got = Vec::new();
        let mut hog = Hog::new(case.hog).expect("valid parameters");
        let plane = Plane::from_frame(picture(case).view());
        hog.compute_into(plane.view(), &mut got).expect("the picture is large enough");
        assert_close(&got, expected, case);
        tried += 1;
    }
    assert!(tried >= 16, "{tried} cases");
}
