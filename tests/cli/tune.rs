//! `prf tune` as a user runs it.

use std::fs;
use std::path::Path;

use predicates::prelude::*;
use predicates::str::contains;
use serde_json::Value;

mod common;
mod flappy;
mod more_bars;
mod pictures;

use common::prf;

const FLAPPY: [&str; 11] = [
    "tune",
    "goal.png",
    "frames.png",
    "--scores",
    "scores.csv",
    "--descriptor",
    "window",
    "--screen",
    "screen.png",
    "--out",
    "reward.toml",
];

fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    flappy::put_into(folder.path());
    folder
}

fn stdout(folder: &Path, args: &[&str]) -> String {
    let output = prf(folder).args(args).assert().success().get_output().stdout.clone();
    String::from_utf8(output).expect("text")
}

fn record(folder: &Path, args: &[&str]) -> Value {
    let text = stdout(folder, &[args, &["--format", "json"]].concat());
    serde_json::from_str(text.trim()).unwrap_or_else(|error| panic!("{error}: {text}"))
}

#[test]
fn what_it_recommends_is_good_and_is_taken_as_it_is() {
    let folder = folder();
    let path = folder.path();
    let text = stdout(path, &[&FLAPPY[..], &["--plot", "all.svg", "--picture", "ends.png"]].concat());
    assert!(text.contains("# as given: l2, 1x1 blocks, cells of 0.1 h (3 px): misleading"), "{text}");
    assert!(text.contains("# good: the reward orders the frames as the task does"), "{text}");
    let written = fs::read_to_string(path.join("reward.toml")).expect("it was asked for");
    let table: toml::Table = written.parse().expect("TOML");
    let goal = table["reward"]["goal"].as_str().expect("a path").to_owned();
    assert!(path.join(&goal).is_file() && goal != "goal.png", "a window of its own: {goal}");
    // As a whole subject, and by `prf score`.
    let judged = record(path, &["inspect", "reward.toml", "frames.png", "--scores", "scores.csv"]);
    assert_eq!(judged["verdict"], "good");
    let (auc, rho) = (judged["success_auc"].as_f64(), judged["rank_correlation"].as_f64());
    assert!(auc >= Some(0.9) && rho >= Some(0.8), "{judged}");
    let score = stdout(path, &["score", "--config", "reward.toml", &goal, "screen.png"]);
    assert!(score.starts_with("screen.png: reward 1.000000"), "{score}");
    assert_eq!(text, written, "what is printed is what is written");
    assert!(text.contains("# prf goal crop screen.png --rect 7,24,32,36 --out reward-32x36.png"), "{text}");

    let svg = fs::read_to_string(path.join("all.svg")).expect("it was asked for");
    let document = roxmltree::Document::parse(&svg).expect("XML");
    let words: String = document.descendants().filter_map(|node| node.text()).collect();
    assert!(words.contains("windows of other widths and heights") && words.contains("l1-sqrt"), "{words}");
    assert!(image::open(path.join("ends.png")).is_ok());
}

#[test]
fn files_are_left_alone_unless_forced() {
    let folder = folder();
    let path = folder.path();
    fs::write(path.join("reward.toml"), "mine").expect("the folder is ours");
    let args: Vec<&str> = FLAPPY.iter().copied().chain(["--sample", "60"]).collect();
    prf(path).args(&args).assert().code(1).stderr(contains("reward.toml exists already"));
    assert_eq!(fs::read_to_string(path.join("reward.toml")).expect("it is there"), "mine");
    let pictures = || {
        fs::read_dir(path)
            .expect("a folder")
            .flatten()
            .filter(|file| file.file_name().to_string_lossy().starts_with("reward-"))
    };
    assert_eq!(pictures().count(), 0, "nothing is written by halves");
    prf(path).args(&args).arg("--force").assert().success();
    assert!(fs::read_to_string(path.join("reward.toml")).expect("it is there").contains("[reward.hog]"));
}

#[test]
fn json_has_a_line_for_each_setting_and_one_is_recommended() {
    let folder = folder();
    let args = ["tune", "goal.png", "--descriptor", "window", "--format", "json"];
    let text = stdout(folder.path(), &args);
    let records: Vec<Value> = text.lines().map(|line| serde_json::from_str(line).expect("JSON")).collect();
    assert!(records.len() > 300, "{}", records.len());
    let best: Vec<&Value> = records.iter().filter(|record| record["recommended"] == true).collect();
    assert_eq!(best.len(), 1);
    assert_eq!((best[0]["verdict"].as_str(), best[0]["evidence"].as_str()), (Some("good"), Some("goal")));
    for key in ["window", "hog", "cell_px", "quality", "reward", "absence_auc", "displacement_correlation"] {
        assert!(best[0].get(key).is_some(), "{key} in {}", best[0]);
    }
    // The settings that punish progress on the frames are not called good by the goal alone.
    let naive = &records[0];
    assert_eq!((naive["hog"]["norm"].as_str(), naive["verdict"].as_str()), (Some("l2"), Some("misleading")));
}

#[test]
fn a_world_is_tuned_from_any_start_and_trains_with_the_result() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path();
    prf(path).args(["init", "breakout"]).assert().success();
    let start = ["--norm", "l1", "--block-cells", "3", "--cell", "0.1"];
    let text = stdout(path, &[&["tune", "breakout.toml", "--sample", "500"][..], &start].concat());
    let table: toml::Table = text.parse().expect("TOML");
    let hog = &table["reward"]["hog"];
    assert_eq!((hog["norm"].as_str(), hog["block_cells"].as_integer()), (Some("l2"), Some(1)));
    assert_eq!(hog["cell"]["fraction"].as_float(), Some(0.03));
    assert_eq!(table["reward"]["goal"].as_str(), Some("goals/black.png"), "as the config has it");
    // In place of the config's own table.
    let mut config: toml::Table =
        fs::read_to_string(path.join("breakout.toml")).expect("it was written").parse().expect("TOML");
    config.insert("reward".to_owned(), table["reward"].clone());
    fs::write(path.join("tuned.toml"), config.to_string()).expect("the folder is ours");
    let judged = record(path, &["inspect", "tuned.toml", "--sample", "500"]);
    assert_eq!(judged["verdict"], "good");
    #[cfg(feature = "train")]
    prf(path).args(["train", "tuned.toml", "--dry-run"]).assert().success();
}

#[test]
fn goals_screens_and_options_that_do_not_fit_are_refused() {
    let folder = folder();
    let path = folder.path();
    pictures::bars(&path.join("other.png"), 5);
    prf(path)
        .args(["tune", "goal.png", "--descriptor", "window", "--screen", "other.png"])
        .assert()
        .code(2)
        .stderr(contains("--screen other.png: the goal is no part of it").and(contains("matches by 0.")));
    prf(path)
        .args(["tune", "screen.png", "--descriptor", "window", "--screen", "goal.png"])
        .assert()
        .code(2)
        .stderr(contains("84x84").and(contains("20x32")));
    prf(path)
        .args(["tune", "goal.png", "--screen", "screen.png"])
        .assert()
        .code(2)
        .stderr(contains("--screen is for --descriptor window"));
    pictures::flat(&path.join("flat.png"), 90);
    prf(path).args(["tune", "flat.png"]).assert().code(2).stderr(contains("the goal shows nothing of 4 px or more"));
    prf(path).args(["tune", "goal.png", "--out", "reward.txt"]).assert().code(2).stderr(contains("ends in .toml"));
    prf(path).args(["init", "breakout"]).assert().success();
    let before = fs::read(path.join("breakout.toml")).expect("it was written");
    prf(path)
        .args(["tune", "breakout.toml", "--out", "breakout.toml", "--force"])
        .assert()
        .code(2)
        .stderr(contains("--out: breakout.toml would lose all but its [reward]"));
    assert_eq!(fs::read(path.join("breakout.toml")).expect("it is there"), before);
}

#[test]
fn a_screen_is_searched_for_the_goal_itself() {
    let folder = folder();
    let path = folder.path();
    // A dimmer copy of the goal comes first, and correlation takes both for the same.
    let goal = image::open(path.join("goal.png")).expect("a picture").to_luma8();
    let mut screen = image::GrayImage::new(120, 84);
    for (x, y, &image::Luma([value])) in goal.enumerate_pixels() {
        screen.put_pixel(x + 5, y + 5, image::Luma([value / 2]));
        screen.put_pixel(x + 60, y + 30, image::Luma([value]));
    }
    screen.save(path.join("two.png")).expect("the folder is ours");
    let args = ["tune", "goal.png", "--descriptor", "window", "--screen", "two.png", "--format", "json"];
    let text = stdout(path, &args);
    let first: Value = serde_json::from_str(text.lines().next().expect("a line")).expect("JSON");
    assert_eq!((first["window"]["x"].as_u64(), first["window"]["y"].as_u64()), (Some(60), Some(30)));
}

#[test]
fn where_nothing_is_good_nothing_is_written() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path();
    // Scores that fall as the frames come nearer to the goal.
    more_bars::folder(&path.join("frames"), 1..=9);
    pictures::bars(&path.join("goal.png"), 9);
    let scores: String = (1..=9).map(|bars| format!("{}\n", -bars)).collect();
    fs::write(path.join("scores.csv"), "score\n".to_owned() + &scores).expect("the folder is ours");
    prf(path)
        .args(["tune", "goal.png", "frames", "--scores", "scores.csv", "--out", "reward.toml"])
        .assert()
        .code(1)
        .stderr(contains("settings makes a reward to learn from").and(contains("hint: ")));
    assert!(!path.join("reward.toml").exists());
}
