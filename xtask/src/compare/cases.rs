//! What is compared. Both workers read this as `cases.json`, so that one set of parameters holds for all sides.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use anyhow::{Context, Result};
use serde_json::{Value, json};

use super::pictures::{Pictures, THRESHOLD, breakout, motion_goal, texture};

/// One piece of work, on a few pictures.
#[derive(Clone, Debug)]
pub struct Case {
    /// Without blanks.
    pub name: String,
    /// The heading it stands under.
    pub group: &'static str,
    /// What stands in its row.
    pub title: String,
    /// Who else does it.
    pub peers: Vec<Peer>,
    /// What the workers are told.
    pub work: Value,
}

/// Someone to be compared with.
#[derive(Clone, Debug)]
pub struct Peer {
    /// What the worker calls it.
    pub side: &'static str,
    /// What the table calls it.
    pub title: &'static str,
    /// How many times faster we want to be.
    pub target: Option<f64>,
    /// How near our results have to be to theirs.
    pub check: Check,
}

/// How near results have to be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Check {
    /// Equal bits.
    Bits,
    /// At most so far apart.
    Within(f32),
    /// As many: the peer's definition is another.
    Count,
}

/// Pictures by the name of their file.
#[derive(Debug, Default)]
pub struct Gallery {
    pictures: BTreeMap<String, Pictures>,
}

impl Gallery {
    /// Takes in pictures, and says how a worker finds them.
    fn add(&mut self, name: &str, pictures: Pictures) -> Value {
        let file = format!("{name}-{}x{}.u8", pictures.width, pictures.height);
        let (width, height, count) = (pictures.width, pictures.height, pictures.count());
        let spec = json!({ "file": file, "width": width, "height": height, "count": count });
        self.pictures.insert(file, pictures);
        spec
    }

    /// Writes the pictures and `cases.json`.
    pub(super) fn write(&self, folder: &Path, cases: &[Case]) -> Result<()> {
        let complaint = || format!("can't write the pictures to {}", folder.display());
        fs::create_dir_all(folder).with_context(complaint)?;
        for (file, pictures) in &self.pictures {
            fs::write(folder.join(file), &pictures.pixels).with_context(complaint)?;
        }
        let works: Vec<&Value> = cases.iter().map(|case| &case.work).collect();
        fs::write(folder.join("cases.json"), serde_json::to_string_pretty(&works)?).with_context(complaint)
    }
}

/// From pixels to a reward, part by part and as a whole. Sizes are width × height.
pub fn perception_cases() -> (Vec<Case>, Gallery) {
    let mut gallery = Gallery::default();
    let mut cases = Vec::new();
    for size in [(64, 64), (208, 160), (288, 512), (640, 480)] {
        cases.push(hog(&mut gallery, size));
    }
    for method in ["ccorr-normed", "ccoeff-normed"] {
        for (frame, template) in
            [((84, 84), (28, 28)), ((160, 210), (64, 64)), ((288, 512), (52, 100)), ((640, 480), (200, 160))]
        {
            cases.push(matching(&mut gallery, "scores", method, frame, template));
            cases.push(matching(&mut gallery, "best", method, frame, template));
        }
    }
    for size in [(84, 84), (288, 512)] {
        cases.push(motion(&mut gallery, size));
    }
    for descriptor in ["direct", "window", "motion"] {
        for (frame, window) in [((84, 84), (28, 28)), ((160, 210), (64, 64)), ((288, 512), (52, 100))] {
            for scene in ["breakout", "texture"] {
                // What a window or a movement is cropped to can be too small for OpenCV's grid.
                if descriptor == "direct" {
                    cases.push(reward(&mut gallery, (descriptor, Grid::OpenCv), scene, frame, window));
                }
                cases.push(reward(&mut gallery, (descriptor, Grid::Paper), scene, frame, window));
            }
        }
    }
    (cases, gallery)
}

/// Pictures for what remembers nothing from one to the next.
const FEW: usize = 2;
/// Pictures of an episode.
const EPISODE: usize = 12;

fn opencv(target: f64, check: Check) -> Peer {
    Peer { side: "opencv", title: "OpenCV", target: Some(target), check }
}

fn case(group: &'static str, title: String, name: String, peers: Vec<Peer>, mut work: Value) -> Case {
    work["name"] = json!(name);
    Case { name, group, title, peers, work }
}

fn hog(gallery: &mut Gallery, (width, height): (usize, usize)) -> Case {
    let work = json!({
        "work": "hog",
        "frames": gallery.add("texture", texture(width, height, FEW)),
        "hog": { "orientations": 9, "cell": { "px": 8 }, "block_cells": 2, "norm": "l2-hys" },
    });
    let scikit_image = Peer { side: "scikit-image", title: "scikit-image", target: None, check: Check::Within(1e-5) };
    let peers = vec![opencv(3.0, Check::Count), scikit_image];
    case("HOG", format!("{width}×{height}"), format!("hog-{width}x{height}"), peers, work)
}

fn matching(
    gallery: &mut Gallery,
    what: &str,
    method: &str,
    (width, height): (usize, usize),
    (w, h): (usize, usize),
) -> Case {
    let frames = texture(width, height, FEW);
    let template = frames.part(width / 4, height / 3, w, h);
    let work = json!({
        "work": what,
        "method": method,
        "template": gallery.add(&format!("template-{width}x{height}"), template),
        "frames": gallery.add("texture", frames),
    });
    let kind = if method == "ccorr-normed" { "plain" } else { "zero-mean" };
    let title = format!("{width}×{height} with {w}×{h}, {kind}, {what}");
    case("Matching", title, format!("{what}-{method}-{width}x{height}"), vec![opencv(1.5, Check::Within(1e-4))], work)
}

/// Times that 32 bits hold exactly: where one isn't, OpenCV rounds before it subtracts, and we after.
fn motion_params() -> Value {
    json!({ "threshold": THRESHOLD, "tau_start": 1.0, "tau_step": 1.0, "delta": { "duration": 4.0 } })
}

fn motion(gallery: &mut Gallery, (width, height): (usize, usize)) -> Case {
    let work = json!({
        "work": "motion",
        "frames": gallery.add("breakout", breakout(width, height, EPISODE)),
        "motion": motion_params(),
    });
    let title = format!("{width}×{height}, silhouette and update");
    case("Motion template", title, format!("motion-{width}x{height}"), vec![opencv(1.0, Check::Bits)], work)
}

/// Cells and blocks of a reward.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Grid {
    /// Those that `HOGDescriptor` has by itself: cells of 8 px, 2×2 blocks.
    OpenCv,
    /// The paper's cell of each descriptor, and blocks of one cell, our default.
    Paper,
}

fn reward(
    gallery: &mut Gallery,
    (descriptor, grid): (&str, Grid),
    scene: &str,
    (width, height): (usize, usize),
    window: (usize, usize),
) -> Case {
    let frames = match scene {
        "breakout" => breakout(width, height, EPISODE),
        _ => texture(width, height, EPISODE),
    };
    let (cell, goal) = match descriptor {
        "direct" => (0.03, direct_goal(scene, &frames)),
        "window" => (0.1, window_goal(scene, &frames, window)),
        _ => (0.05, motion_goal(&frames)),
    };
    let name = format!("{descriptor}-{scene}-{width}x{height}");
    let (cell, block_cells, words) = match grid {
        Grid::OpenCv => (json!({ "px": 8 }), 2, "8 px, 2×2".to_owned()),
        Grid::Paper => (json!({ "fraction": cell }), 1, format!("{cell} h, 1×1")),
    };
    let work = json!({
        "work": "reward",
        "descriptor": descriptor,
        "frames": gallery.add(&format!("{scene}-episode"), frames),
        "goal": gallery.add(&format!("goal-{name}"), goal),
        "hog": { "orientations": 9, "cell": cell, "block_cells": block_cells, "norm": "l2-hys" },
        "motion": motion_params(),
    });
    let title = format!("{descriptor}, {width}×{height}, {scene}, {words}");
    let name = format!("{name}-{block_cells}");
    // The same boxes are compared, and as many features; OpenCV's features themselves are others.
    case("Reward", title, name, vec![opencv(5.0, Check::Bits)], work)
}

/// Breakout's is a cleared screen, to whose size each frame's crop is scaled. The other is smaller than the frames, so that
/// it is scaled itself, once.
fn direct_goal(scene: &str, frames: &Pictures) -> Pictures {
    let (width, height) = (frames.width, frames.height);
    match scene {
        "breakout" => Pictures::new(width, height, 1, |_, _, _| 0),
        _ => texture(width * 3 / 4, height * 3 / 4, 1),
    }
}

/// Breakout's is the paddle with the ball above it.
fn window_goal(scene: &str, frames: &Pictures, (width, height): (usize, usize)) -> Pictures {
    let (left, bottom) = match scene {
        "breakout" => (frames.width * 20 / 84, frames.height * 82 / 84),
        _ => (frames.width / 2, frames.height * 2 / 3),
    };
    frames.part(left, bottom - height, width, height)
}
