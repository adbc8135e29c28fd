//! `prf init`, run as a user runs it.

use std::fs;
use std::path::Path;

use predicates::prelude::*;
use predicates::str::{contains, is_empty};

mod common;

use common::prf;

fn read(path: &Path) -> String {
    fs::read_to_string(path).expect("the file was written")
}

#[test]
fn writes_a_config_with_the_goal_it_names() {
    let folder = tempfile::tempdir().expect("a temporary folder can be made");
    prf(folder.path())
        .args(["init", "breakout"])
        .assert()
        .success()
        .stdout("goals/black.png\nbreakout.toml\n")
        .stderr(contains("prf train breakout.toml"));
    let config: toml::Table = read(&folder.path().join("breakout.toml")).parse().expect("it is TOML");
    let goal = config["reward"]["goal"].as_str().expect("it names a goal");
    let mut score = prf(folder.path());
    score.args(["score", "--config", "breakout.toml", goal, goal]);
    score.assert().success().stdout(contains("reward 1.000000"));
}

#[test]
fn a_preset_without_goal_is_one_file() {
    let folder = tempfile::tempdir().expect("a temporary folder can be made");
    prf(folder.path()).args(["init", "breakout-vrf"]).assert().success().stdout("breakout-vrf.toml\n");
    assert!(!folder.path().join("goals").exists());
}

/// All of them, with goals that can be read: each perceptual one scores its own goal.
#[test]
fn all_presets_fit_into_one_folder() {
    let folder = tempfile::tempdir().expect("a temporary folder can be made");
    let faces = ["happy", "surprise"].map(|face| ["vrf", "kprf", "hprf"].map(|kind| format!("kobian-{face}-{kind}")));
    let worlds = ["breakout", "breakout-vrf", "flappy", "flappy-vrf"].map(str::to_owned);
    for preset in worlds.into_iter().chain(faces.into_iter().flatten()) {
        prf(folder.path()).args(["init", &preset]).assert().success();
        let file = format!("{preset}.toml");
        let config: toml::Table = read(&folder.path().join(&file)).parse().expect("it is TOML");
        let Some(goal) = config["reward"].get("goal").and_then(toml::Value::as_str) else { continue };
        let score = prf(folder.path()).args(["score", "--config", &file, goal, goal]).assert().success();
        let lines = String::from_utf8_lossy(&score.get_output().stdout).into_owned();
        assert!(lines.lines().last().is_some_and(|line| line.contains("1.000000")), "{preset}: {lines}");
    }
}

#[test]
fn out_is_a_file_or_a_folder() {
    let folder = tempfile::tempdir().expect("a temporary folder can be made");
    prf(folder.path())
        .args(["init", "breakout", "--out", "new/mine.toml"])
        .assert()
        .success()
        .stdout("new/goals/black.png\nnew/mine.toml\n");
    prf(folder.path())
        .args(["init", "breakout", "--out", "other"])
        .assert()
        .success()
        .stdout("other/goals/black.png\nother/breakout.toml\n");
}

#[test]
fn never_writes_over_a_file_unasked() {
    let folder = tempfile::tempdir().expect("a temporary folder can be made");
    let config = folder.path().join("breakout.toml");
    fs::write(&config, "mine").expect("the folder is ours");
    prf(folder.path())
        .args(["init", "breakout"])
        .assert()
        .code(1)
        .stdout(is_empty())
        .stderr(contains("breakout.toml exists already").and(contains("--force")));
    assert_eq!(read(&config), "mine");
    assert!(!folder.path().join("goals").exists(), "all or nothing");

    prf(folder.path()).args(["init", "breakout", "--force"]).assert().success();
    assert!(read(&config).contains("[train]"));
}

#[test]
fn a_goal_of_ones_own_is_kept() {
    let folder = tempfile::tempdir().expect("a temporary folder can be made");
    let goal = folder.path().join("goals/black.png");
    fs::create_dir(folder.path().join("goals")).expect("the folder is ours");
    fs::write(&goal, "mine").expect("the folder is ours");
    prf(folder.path()).args(["init", "breakout"]).assert().code(1).stderr(contains("black.png exists already"));
    assert_eq!(read(&goal), "mine");
}

#[test]
fn places_that_cannot_be_written_to_are_named() {
    let folder = tempfile::tempdir().expect("a temporary folder can be made");
    fs::write(folder.path().join("file"), "").expect("the folder is ours");
    prf(folder.path())
        .args(["init", "breakout-vrf", "--out", "file/below"])
        .assert()
        .code(1)
        .stderr(contains("cannot write file/below/breakout-vrf.toml").and(contains("hint: ")));
}

#[test]
fn unknown_presets_are_misuse_with_the_list() {
    let folder = tempfile::tempdir().expect("a temporary folder can be made");
    prf(folder.path())
        .args(["init", "brekout"])
        .assert()
        .code(2)
        .stderr(contains("possible values: breakout, breakout-vrf"));
}

/// The committed configs must not drift from what `init` writes, nor stop fitting `score --config`.
#[test]
fn every_committed_config_has_a_readable_reward() {
    let configs = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../configs");
    for config in ["breakout", "breakout-vrf", "paper/breakout", "paper/breakout-vrf"] {
        prf(&configs)
            .args(["score", "goals/black.png", "goals/black.png", "--config"])
            .arg(format!("{config}.toml"))
            .assert()
            .success();
    }
}
