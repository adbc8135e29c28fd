//! Episodes that the Python package has to play too: `tests/golden/rust/tasks.json` is what this crate made of the configs,
//! and `crates/prf-py/tests/test_presets.py` expects the same of the environments.
//!
//! After an intended change, also one of a config, `PRF_WRITE_GOLDEN=1 cargo test -p prf-envs --test task_golden` writes the
//! file anew.

use std::fs;
use std::path::{Path, PathBuf};

use prf_core::io::{self, FrameSource, MotionSequence};
use prf_core::{DescriptorParams, Goal};
use prf_envs::{Task, TaskConfig};
use serde::{Deserialize, Serialize};
use toml::Table;

const SEEDS: [u64; 2] = [0, 7];
const STEPS: usize = 25;

/// One episode or its beginning.
#[derive(Debug, PartialEq, Serialize, Deserialize)]
struct Episode {
    /// The config's name.
    preset: String,
    seed: u64,
    steps: Vec<Played>,
}

#[derive(Debug, PartialEq, Serialize, Deserialize)]
struct Played {
    action: usize,
    reward: f32,
    score: f32,
    is_over: bool,
    /// CRC-32 of what the agent sees then.
    observation: u32,
}

fn repository() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// The configs' names, in order.
fn presets() -> Vec<String> {
    let files = fs::read_dir(repository().join("configs")).expect("the configs are committed");
    let paths = files.map(|file| file.expect("a folder that can be read").path());
    let mut names: Vec<_> = paths
        .filter(|path| path.extension().is_some_and(|extension| extension == "toml"))
        .map(|path| path.file_stem().expect("a file has a name").to_string_lossy().into_owned())
        .collect();
    names.sort();
    names
}

fn task(preset: &str) -> Task {
    let folder = repository().join("configs");
    let text = fs::read_to_string(folder.join(preset).with_extension("toml")).expect("the config is committed");
    let mut table: Table = text.parse().expect("it is TOML");
    table.retain(|key, _| ["env", "reward", "state"].contains(&key));
    let config: TaskConfig = table.try_into().expect("it describes a task");
    let goal = config.reward.goal.as_ref().map(|goal| {
        let path = folder.join(goal);
        Goal::from(match config.reward.descriptor_params() {
            Some(DescriptorParams::Motion(motion)) => {
                let source = FrameSource::open(path).expect("the goal is committed");
                MotionSequence::of(source, motion, false).expect("it shows a movement").template
            }
            _ => io::read_frame(path).expect("the goal is committed"),
        })
    });
    Task::new(&config, goal.as_ref()).expect("the config is valid")
}

fn play(preset: &str, seed: u64) -> Episode {
    let mut task = task(preset);
    let actions = task.spec().actions.len();
    task.reset(seed);
    let mut steps: Vec<Played> = Vec::new();
    while steps.len() < STEPS && !steps.last().is_some_and(|step| step.is_over) {
        let step = steps.len();
        let action = (step * step + 3 * step + seed as usize) % actions;
        let played = task.step(action).expect("the action exists and the episode goes on");
        let (reward, score, is_over) = (played.reward, played.score, played.status.is_over());
        steps.push(Played { action, reward, score, is_over, observation: crc32(task.observation()) });
    }
    Episode { preset: preset.to_owned(), seed, steps }
}

/// As zlib has it.
fn crc32(bytes: &[u8]) -> u32 {
    let byte = |crc: u32, byte: &u8| {
        (0..8).fold(crc ^ u32::from(*byte), |crc, _| (crc >> 1) ^ (0xedb8_8320 & 0u32.wrapping_sub(crc & 1)))
    };
    !bytes.iter().fold(!0, byte)
}

#[test]
fn episodes_are_as_they_were() {
    assert_eq!(crc32(b"123456789"), 0xcbf4_3926);
    let presets = presets();
    let played: Vec<_> = presets.iter().flat_map(|preset| SEEDS.map(|seed| play(preset, seed))).collect();
    let file = repository().join("tests/golden/rust/tasks.json");
    if std::env::var_os("PRF_WRITE_GOLDEN").is_some() {
        let lines: Vec<_> =
            played.iter().map(|episode| serde_json::to_string(episode).expect("plain values")).collect();
        fs::write(&file, format!("[\n{}\n]\n", lines.join(",\n"))).expect("the folder is committed");
    }
    let golden = fs::read_to_string(&file).expect("the file is committed");
    let golden: Vec<Episode> = serde_json::from_str(&golden).expect("this test wrote it");
    assert_eq!(golden.len(), played.len());
    for (golden, played) in golden.iter().zip(&played) {
        assert_eq!(golden, played);
    }
}
