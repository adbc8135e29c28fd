//! Wrong configs, as `prf train CONFIG --dry-run` explains them.

use std::fs;
use std::path::Path;

use assert_cmd::assert::Assert;
use image::{GrayImage, Luma};
use predicates::prelude::*;
use predicates::str::{contains, is_empty, starts_with};
use tempfile::TempDir;

mod broken;
mod common;
mod pictures;

use common::prf;

/// Line numbers below count from this config's first line.
const CONFIG: &str = "\
seed = 1
[env]
name = \"breakout\"
[reward]
source = \"perceptual\"
descriptor = \"direct\"
goal = \"goal.png\"
[reward.hog]
cell = { px = 4 }
[state]
lambda = 0.7
[train]
steps = 1000
environments = 2
replay_steps = 1000
[train.epsilon]
start = 1.0
[evaluation]
episodes = 2
";

/// A folder with the goal that `CONFIG` names.
fn folder() -> TempDir {
    let folder = tempfile::tempdir().expect("a temporary folder can be made");
    pictures::flat(&folder.path().join("goal.png"), 0);
    folder
}

/// `prf train c.toml --dry-run` with `from` replaced by `to` in the config.
fn dry_run(folder: &Path, from: &str, to: &str, args: &[&str]) -> Assert {
    assert!(CONFIG.contains(from), "{from} is to be replaced");
    fs::write(folder.join("c.toml"), CONFIG.replacen(from, to, 1)).expect("the folder is ours");
    prf(folder).args(["train", "c.toml", "--dry-run"]).args(args).assert()
}

/// The config is refused as misuse, and the words start and go on as given.
fn refused(from: &str, to: &str, start: &str, part: &str) {
    let folder = folder();
    dry_run(folder.path(), from, to, &[]).code(2).stdout(is_empty()).stderr(starts_with(start).and(contains(part)));
    assert!(!folder.path().join("runs").exists(), "nothing is begun");
}

#[test]
fn the_config_itself_is_good() {
    let folder = folder();
    dry_run(folder.path(), "seed", "seed", &["--set", "train.steps=2000", "--seed", "3"])
        .success()
        .stdout(contains("steps = 2000").and(contains("seed = 3")));
}

#[test]
fn every_committed_config_is_good() {
    let configs = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../configs");
    let elsewhere = tempfile::tempdir().expect("a temporary folder can be made");
    for config in [
        "breakout.toml",
        "breakout-vrf.toml",
        "paper/breakout.toml",
        "paper/breakout-vrf.toml",
        "experiments/kobian-happy-potential.toml",
    ] {
        let mut train = prf(elsewhere.path());
        train.arg("train").arg(configs.join(config)).arg("--dry-run").assert().success();
    }
}

#[test]
fn what_the_paper_did_not_have_is_off_in_its_configs() {
    let configs = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../configs/paper");
    let elsewhere = tempfile::tempdir().expect("a temporary folder can be made");
    for config in ["breakout.toml", "breakout-vrf.toml"] {
        let mut train = prf(elsewhere.path());
        let resolved = train.arg("train").arg(configs.join(config)).arg("--dry-run").assert().success();
        let off = contains("n_step = 1\n").and(contains("double = false")).and(contains("dueling = false"));
        resolved.stdout(off.and(contains("form = \"state\"")).and(contains("[train.prioritized]").not()));
    }
}

#[test]
fn unknown_keys() {
    refused("steps", "stepz", "error: c.toml:13:1: unknown key `train.stepz`\n", "did you mean `steps`?");
    refused("[state]", "[sate]", "error: c.toml:10:2: unknown key `sate`\n", "did you mean `state`?");
    refused("name", "nmae", "error: c.toml:3:1: unknown key `env.nmae`\n", "did you mean `name`?");
    refused("px", "pixels", "error: c.toml:9:10: unknown key `reward.hog.cell.pixels`\n", "px, fraction");
    refused("start", "begin", "error: c.toml:17:1: unknown key `train.epsilon.begin`\n", "start");
}

#[test]
fn wrong_types() {
    refused("1000", "\"1000\"", "error: c.toml:13:9: `train.steps`: got string", "without quotes");
    refused("0.7", "true", "error: c.toml:11:10: `state.lambda`: got boolean true", "a number");
    refused("1000", "-5", "error: c.toml:13:9: `train.steps`: got integer -5", "0 or more");
    refused("{ px = 4 }", "4", "error: c.toml:9:8: ", "`reward.hog.cell`");
    refused("seed = 1", "env = 1", "error: c.toml:2:2: this is not TOML", "duplicate key");
}

#[test]
fn values_out_of_range() {
    refused("px = 4", "px = 0", "error: c.toml:9:15: `reward.hog.cell.px`: got 0", "at least 1");
    refused("0.7", "1.0", "error: c.toml:11:10: `state.lambda`: got 1", "below 1");
    refused("environments = 2", "environments = 0", "error: c.toml:14:16: `train.environments`: got 0", "from 1");
    refused("start = 1.0", "start = 2.0", "error: c.toml:17:9: `train.epsilon.start`: got 2", "from 0 to 1");
    refused("episodes = 2", "episodes = 0", "error: c.toml:19:12: `evaluation.episodes`: got 0", "from 1");
}

#[test]
fn unknown_names() {
    refused("breakout", "brakeout", "error: c.toml:3:8: `env.name`: got \"brakeout\"", "\"breakout\"");
    refused("\"perceptual\"", "\"visual\"", "error: c.toml:5:10: `reward.source`: got \"visual\"", "\"variable\"");
}

#[test]
fn missing_keys() {
    refused("name = \"breakout\"\n", "", "error: c.toml:2:1: the key `env.name` is missing\n", "hint: ");
    refused("goal = \"goal.png\"\n", "", "error: c.toml:4:1: `reward.goal`: got nothing", "a picture");
}

#[test]
fn text_that_is_no_toml() {
    refused("[env]", "[env", "error: c.toml:2:5: this is not TOML: ", "");
    let folder = folder();
    fs::write(folder.path().join("c.toml"), b"seed = 1\n# \xff\n").expect("the folder is ours");
    prf(folder.path())
        .args(["train", "c.toml", "--dry-run"])
        .assert()
        .code(2)
        .stderr(starts_with("error: c.toml:2:3: this is not UTF-8 text"));
}

#[test]
fn a_config_that_is_not_there() {
    let folder = folder();
    for config in ["missing.toml", "."] {
        prf(folder.path())
            .args(["train", config, "--dry-run"])
            .assert()
            .code(2)
            .stderr(contains(format!("cannot read the config {config}")).and(contains("prf init")));
    }
}

#[test]
fn a_goal_that_is_not_there_is_misuse() {
    refused("goal.png", "gaol.png", "error: c.toml:7:8: `reward.goal`: there is no file gaol.png", "hint: ");
}

#[test]
fn a_goal_that_is_broken_is_a_failure() {
    let folder = folder();
    for (goal, told) in broken::files(folder.path()) {
        dry_run(folder.path(), "goal.png", goal, &[])
            .code(1)
            .stdout(is_empty())
            .stderr(starts_with("error: c.toml:7:8: ").and(contains(goal)).and(contains(told)));
    }
}

#[test]
fn a_window_larger_than_the_screen_is_misuse() {
    let folder = folder();
    GrayImage::from_fn(100, 90, |x, y| Luma([(x * y % 251) as u8]))
        .save(folder.path().join("goal.png"))
        .expect("the folder is ours");
    dry_run(folder.path(), "\"direct\"", "\"window\"", &[]).code(2).stdout(is_empty()).stderr(
        starts_with("error: c.toml:7:8: `reward.goal`: a template of 100x90 px doesn't fit into a frame of 84x84 px")
            .and(contains("hint: `prf goal crop`")),
    );
}

#[test]
fn a_sequence_in_which_nothing_can_move_is_a_failure() {
    let folder = folder();
    fs::create_dir(folder.path().join("one")).expect("the folder is ours");
    pictures::flat(&folder.path().join("one/1.png"), 0);
    let goal = |words: &str| {
        let (direct, motion) = ("direct\"\ngoal = \"goal.png", "motion\"\ngoal = \"one");
        dry_run(folder.path(), direct, motion, &[])
            .code(1)
            .stdout(is_empty())
            .stderr(starts_with("error: c.toml:7:8: `reward.goal`: one: ").and(contains(words)));
    };
    goal("got 1 frame, expected at least 2");
    pictures::flat(&folder.path().join("one/2.png"), 12);
    goal("the largest change of a pixel from one frame to the next is 12, the threshold 30");
}

#[test]
fn a_goal_starts_at_the_configs_folder_or_where_it_was_typed() {
    let folder = folder();
    let below = folder.path().join("below");
    fs::create_dir(&below).expect("the folder is ours");
    fs::write(below.join("c.toml"), CONFIG).expect("the folder is ours");
    let mut in_file = prf(folder.path());
    in_file.args(["train", "below/c.toml", "--dry-run"]);
    in_file.assert().code(2).stderr(contains("there is no file below/goal.png"));
    let mut typed = prf(folder.path());
    typed.args(["train", "below/c.toml", "--dry-run", "--set", "reward.goal=goal.png"]);
    typed.assert().success();
}

#[test]
fn errors_in_set_show_it_as_it_was_typed() {
    let cases = [
        ("train.steps=abc", "`train.steps`: got string \"abc\", expected a whole number"),
        ("train.stepz=5", "unknown key `train.stepz`"),
        ("train.gamma=1.5", "`train.gamma`: got 1.5, expected "),
        ("train.prioritized.alpha=1.5", "`train.prioritized.alpha`: got 1.5, expected a number from 0 to 1"),
        ("train.prioritized.beta=0.5", "unknown key `train.prioritized.beta`"),
        ("train.keep_checkpoints=0", "`train.keep_checkpoints`: got 0, expected from 1 to 1000"),
        ("reward.form=difference", "`reward.form`: got \"difference\", expected \"state\" or \"potential\""),
        (
            "env.solved_within=1",
            "`env.solved_within`: got 1, expected nothing, because \"breakout\" has no end by success",
        ),
        ("train.reward_scale=0", "`train.reward_scale`: got 0, expected a finite number above 0"),
        (
            "env.name=pong",
            "`env.name`: got \"pong\", expected \"breakout\" or \"flappy\" or \"kobian-happy\" or \"kobian-surprise\"",
        ),
        ("train.steps", "there is no `=`"),
    ];
    for (set, told) in cases {
        let folder = folder();
        dry_run(folder.path(), "seed", "seed", &["--set", set])
            .code(2)
            .stdout(is_empty())
            .stderr(starts_with(format!("error: --set {set}: {told}")));
    }
}
