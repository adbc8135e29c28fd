//! What `prf train` leaves in a run folder for other programs.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use predicates::prelude::*;
use predicates::str::contains;
use tempfile::TempDir;

mod common;

use common::prf;

const CONFIG: &str = "\
seed = 5
[env]
name = \"breakout\"
limit_steps = 30
[reward]
source = \"perceptual\"
descriptor = \"direct\"
goal = \"black.png\"
[train]
steps = 600
environments = 4
batch_size = 8
replay_steps = 400
learning_starts = 100
steps_per_update = 16
threads = 1
checkpoint_every_steps = 200
[evaluation]
every_episodes = 8
episodes = 3
[record]
training_every_episodes = 5
";

fn folder() -> TempDir {
    let folder = tempfile::tempdir().expect("a temporary folder can be made");
    image::GrayImage::new(84, 84).save(folder.path().join("black.png")).expect("the folder is ours");
    fs::write(folder.path().join("c.toml"), CONFIG).expect("the folder is ours");
    folder
}

fn train(folder: &Path, more: &[&str]) -> assert_cmd::assert::Assert {
    prf(folder).args(["train", "c.toml", "--out", "run"]).args(more).assert()
}

fn topics(recording: &[u8]) -> BTreeSet<String> {
    let messages = mcap::MessageStream::new(recording).expect("a whole recording");
    messages.map(|message| message.expect("a whole message").channel.topic.clone()).collect()
}

#[test]
fn a_run_is_recorded_for_other_programs() {
    let folder = folder();
    train(folder.path(), &[]).success();
    let run = folder.path().join("run");
    let recording = fs::read(run.join("run.mcap")).expect("it was recorded");
    let expected = [
        "/goal",
        "/evaluation/mirror",
        "/evaluation/step",
        "/evaluation/summary",
        "/evaluation/template",
        "/training/mirror",
        "/training/step",
        "/training/summary",
        "/training/template",
    ];
    assert_eq!(topics(&recording), expected.map(str::to_owned).into());

    let summary = mcap::Summary::read(&recording).expect("whole").expect("a finished recording has a summary");
    let attached: BTreeSet<&str> = summary.attachment_indexes.iter().map(|index| index.name.as_str()).collect();
    assert_eq!(attached, ["config.toml", "goal.png"].into());
    let metadata = mcap::read::metadata(&recording, &summary.metadata_indexes[0]).expect("whole");
    assert_eq!((metadata.name.as_str(), metadata.metadata["seed"].as_str()), ("prf", "5"));
    let events = fs::read_dir(run.join("tensorboard")).expect("it was recorded").next().expect("a file").expect("ours");
    assert!(events.metadata().expect("ours").len() > 84 * 84);
}

#[test]
fn recordings_can_be_left_out() {
    let folder = folder();
    train(folder.path(), &["--set", "record.mcap=false", "--set", "record.tensorboard=false"]).success();
    let run = folder.path().join("run");
    assert!(run.join("metrics.jsonl").is_file());
    assert!(!run.join("run.mcap").exists() && !run.join("tensorboard").exists());
}

#[test]
fn a_damaged_recording_is_told_and_does_not_stop_the_run() {
    let folder = folder();
    train(folder.path(), &[]).success();
    let path = folder.path().join("run/run.mcap");
    let whole = fs::read(&path).expect("it was recorded");
    let mut damaged = whole[..whole.len() / 2].to_vec();
    damaged.extend([0x5a; 1000]);
    fs::write(&path, damaged).expect("the folder is ours");
    train(folder.path(), &["--resume"]).success().stderr(contains("warning:").and(contains("run.mcap")));
    let mended = fs::read(&path).expect("it is there");
    assert!(topics(&mended).contains("/evaluation/mirror"));
    assert!(mended.len() < whole.len());
    // Nothing more is lost the next time.
    train(folder.path(), &["--resume"]).success();
}

#[test]
fn what_cannot_be_recorded_is_misuse() {
    let folder = folder();
    train(folder.path(), &["--set", "record.evaluation_episodes=4"])
        .code(2)
        .stderr(contains("record.evaluation_episodes").and(contains("got 4")));
    assert!(!folder.path().join("run").exists());
}
