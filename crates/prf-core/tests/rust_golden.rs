//! Bits that the Python package has to give too: `tests/golden/rust/values.f32` is what this crate made of the cases
//! beside it, and `crates/prf-py/tests/test_rust.py` expects the same of the package.
//!
//! After an intended change, `PRF_WRITE_GOLDEN=1 cargo test -p prf-core --test rust_golden` writes the file anew.

use std::fs;
use std::path::{Path, PathBuf};

use prf_core::io::{self, FrameSource};
use prf_core::{
    DescriptorKind, DescriptorParams, EmaState, Frame, Goal, Hog, HogParams, Match, MatchMethod, MotionParams,
    MotionTemplate, Plane, Rect, RewardParams, TaskDescriptor, TemplateMatcher, WindowParams,
};
use serde::Deserialize;

#[derive(Deserialize)]
struct Case {
    #[serde(flatten)]
    input: Input,
    len: usize,
}

#[derive(Deserialize)]
#[serde(rename_all = "kebab-case")]
enum Input {
    Hog { image: PathBuf, params: HogParams },
    Match { image: PathBuf, template: PathBuf, mask: Option<PathBuf>, method: MatchMethod },
    Score(Scored),
    Motion { params: MotionParams, frames: PathBuf, count: usize },
    Ema { lambda: f32, frames: PathBuf, count: usize },
}

#[derive(Deserialize)]
struct Scored {
    descriptor: DescriptorKind,
    goal: PathBuf,
    mask: Option<PathBuf>,
    #[serde(default)]
    method: MatchMethod,
    #[serde(default)]
    motion: MotionParams,
    params: RewardParams,
    frames: PathBuf,
    count: usize,
}

fn golden(path: impl AsRef<Path>) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../tests/golden").join(path)
}

fn picture(path: &Path) -> Frame {
    io::read_frame(golden(path)).expect("the picture is committed")
}

fn first_frames(path: &Path, count: usize) -> Vec<Frame> {
    let frames = FrameSource::open(golden(path)).expect("the animation is committed");
    frames.take(count).map(|frame| frame.expect("it is whole").1).collect()
}

impl Input {
    fn values(&self) -> Vec<f32> {
        match self {
            Input::Hog { image, params } => {
                let mut features = Vec::new();
                let mut hog = Hog::new(*params).expect("valid");
                hog.compute_bytes_into(picture(image).view(), &mut features).expect("a block fits");
                features
            }
            Input::Match { image, template, mask, method } => {
                let mask = mask.as_deref().map(picture);
                let mut matcher = TemplateMatcher::new(&picture(template), mask.as_ref(), *method).expect("valid");
                let mut scores = Plane::from_vec(1, 1, vec![0.0]).expect("one value");
                matcher.scores_into(picture(image).view(), &mut scores).expect("it fits");
                scores.as_slice().to_vec()
            }
            Input::Score(scored) => scored.values(),
            Input::Motion { params, frames, count } => {
                let frames = first_frames(frames, *count);
                let template = MotionTemplate::of(*params, frames.iter().map(Frame::view)).expect("one size");
                template.history().to_vec()
            }
            Input::Ema { lambda, frames, count } => {
                let frames = first_frames(frames, *count);
                let mut state = EmaState::new(frames[0].width(), frames[0].height(), *lambda).expect("valid");
                for frame in &frames {
                    state.update(frame.view());
                }
                state.values().to_vec()
            }
        }
    }
}

impl Scored {
    fn goal(&self) -> Goal {
        let picture = match self.descriptor {
            DescriptorKind::Motion => io::read_motion(golden(&self.goal), self.motion, false).expect("moving").template,
            DescriptorKind::Direct | DescriptorKind::Window => picture(&self.goal),
        };
        Goal { picture, mask: self.mask.as_deref().map(self::picture) }
    }

    fn descriptor(&self) -> Box<dyn TaskDescriptor> {
        let descriptor = match self.descriptor {
            DescriptorKind::Direct => DescriptorParams::Direct,
            DescriptorKind::Window => DescriptorParams::Window(WindowParams { method: self.method }),
            DescriptorKind::Motion => DescriptorParams::Motion(self.motion),
        };
        descriptor.describe(&self.goal(), self.params).expect("valid")
    }

    /// Reward, distance and, of a window, the match of each frame.
    fn values(&self) -> Vec<f32> {
        let mut descriptor = self.descriptor();
        let mut values = Vec::new();
        for frame in first_frames(&self.frames, self.count) {
            let score = descriptor.observe(frame.view()).expect("one size");
            values.extend([score.reward, score.distance]);
            if let Some(Match { rect: Rect { x, y, width, height }, score }) = descriptor.explain(frame.view()).matched
            {
                values.extend([x, y, width, height].map(|number| number as f32));
                values.push(score);
            }
        }
        values
    }
}

#[test]
fn every_value_is_the_same_to_the_bit() {
    let index = fs::read(golden("rust/index.json")).expect("the index is committed");
    let cases: Vec<Case> = serde_json::from_slice(&index).expect("the index holds cases");
    let got: Vec<Vec<f32>> = cases.iter().map(|case| case.input.values()).collect();
    let path = golden("rust/values.f32");
    if std::env::var_os("PRF_WRITE_GOLDEN").is_some() {
        let bytes: Vec<u8> = got.iter().flatten().flat_map(|value| value.to_le_bytes()).collect();
        fs::write(&path, bytes).expect("the folder is there");
    }
    let bytes = fs::read(path).expect("the values are committed");
    let mut values = bytes.as_chunks::<4>().0.iter().map(|&bytes| u32::from_le_bytes(bytes));
    for (number, (case, got)) in cases.iter().zip(&got).enumerate() {
        assert_eq!(got.len(), case.len, "case {number}");
        let expected: Vec<u32> = values.by_ref().take(case.len).collect();
        assert!(got.iter().map(|value| value.to_bits()).eq(expected), "case {number} has other bits");
    }
    assert_eq!(values.len(), 0, "the index covers all values");
}
