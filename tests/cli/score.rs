//! `prf score`, run as a user runs it.

use std::fs;
use std::io::{BufRead as _, BufReader, Read as _};
use std::path::Path;
use std::process::{self, Stdio};

use image::GrayImage;
use predicates::prelude::*;
use predicates::str::{contains, is_empty, starts_with};
use serde_json::Value;
use tempfile::TempDir;

mod broken;
mod common;
mod pictures;
mod score_plot;

use common::prf;

/// A folder with a goal of no bars (`goal.png`, all black) and frames of 1, 5 and 9 bars.
fn folder() -> TempDir {
    let folder = tempfile::tempdir().expect("a temporary folder can be made");
    pictures::flat(&folder.path().join("goal.png"), 0);
    for count in [1, 5, 9] {
        pictures::bars(&folder.path().join(format!("bars{count}.png")), count);
    }
    folder
}

/// The JSON objects that `prf score` prints for these arguments.
fn scores(folder: &Path, args: &[&str]) -> Vec<Value> {
    let output =
        prf(folder).args(["score", "--format", "json"]).args(args).assert().success().get_output().stdout.clone();
    let text = String::from_utf8(output).expect("JSON is UTF-8");
    text.lines().map(|line| serde_json::from_str(line).expect("each line is one object")).collect()
}

fn rewards(folder: &Path, args: &[&str]) -> Vec<f64> {
    let reward = |record: &Value| record["reward"].as_f64().expect("a reward is a number");
    scores(folder, args).iter().map(reward).collect()
}

#[test]
fn one_frame_is_one_sentence() {
    let folder = folder();
    prf(folder.path())
        .args(["score", "goal.png", "goal.png"])
        .assert()
        .success()
        .stdout("goal.png: reward 1.000000, distance 0.000000\n");
}

#[test]
fn several_frames_are_a_table() {
    let folder = folder();
    let assert = prf(folder.path()).args(["score", "goal.png", "goal.png", "bars5.png"]).assert().success();
    let text = String::from_utf8_lossy(&assert.get_output().stdout).into_owned();
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!(lines[0], "source        reward   distance");
    assert_eq!(lines[1], "goal.png    1.000000   0.000000");
    assert!(lines[2].starts_with("bars5.png"), "{text}");
    assert!(lines.iter().all(|line| line.len() == lines[0].len()), "{text}");
}

#[test]
fn json_has_the_names_that_scripts_rely_on() {
    let folder = folder();
    let records = scores(folder.path(), &["goal.png", "bars1.png", "goal.png"]);
    let keys: Vec<&str> = records[0].as_object().expect("an object").keys().map(String::as_str).collect();
    let mut expected = ["source", "index", "reward", "distance"];
    expected.sort_unstable();
    assert_eq!(keys, expected);
    assert_eq!(records[0]["source"], "bars1.png");
    assert_eq!(records[1]["index"], 1);
    assert_eq!(records[1]["reward"], 1.0);
    let reward = records[0]["reward"].as_f64().expect("a number");
    let distance = records[0]["distance"].as_f64().expect("a number");
    assert!((reward - (-distance).exp()).abs() < 1e-6, "F = exp(-D)");
}

#[test]
fn emptier_frames_are_nearer_to_a_black_goal() {
    let folder = folder();
    let found = rewards(folder.path(), &["goal.png", "bars9.png", "bars5.png", "bars1.png"]);
    assert!(found.is_sorted() && found[0] < found[2], "{found:?}");
}

#[test]
fn options_reach_the_reward() {
    let folder = folder();
    let scored = |options: &[&str]| rewards(folder.path(), &[&["bars9.png", "bars5.png"], options].concat());
    let cells_of_4 = scored(&["--cell-px", "4"]);
    assert_eq!(cells_of_4, scored(&["--cell", "0.1"]), "the pictures are 40 px high");
    assert_ne!(cells_of_4, scored(&[]));
    let options: [&[&str]; 5] = [
        &["--orientations", "4"],
        &["--signed"],
        &["--block-cells", "2"],
        &["--norm", "l1-sqrt"],
        &["--scale", "none"],
    ];
    for option in options {
        assert_ne!(cells_of_4, scored(&[&["--cell-px", "4"], option].concat()), "{option:?}");
    }
}

#[test]
fn a_config_gives_the_reward_and_options_change_it() {
    let folder = folder();
    let config = "[env]\nname = \"breakout\"\n[reward]\nsource = \"variable\"\nscale = \"none\"\n\
                  [reward.hog]\ncell = { px = 4 }\nnorm = \"l1\"\n";
    fs::write(folder.path().join("c.toml"), config).expect("the folder is ours");
    let frames = ["goal.png", "bars5.png"];
    let by_config = rewards(folder.path(), &[&frames[..], &["--config", "c.toml"]].concat());
    let by_options = ["--scale", "none", "--cell-px", "4", "--norm", "l1"];
    assert_eq!(by_config, rewards(folder.path(), &[&frames[..], &by_options].concat()));
    let changed = ["--config", "c.toml", "--norm", "l2"];
    assert_ne!(by_config, rewards(folder.path(), &[&frames[..], &changed].concat()));
}

#[test]
fn options_out_of_range_are_misuse() {
    let folder = folder();
    let cases = [
        ("--cell=0", "--cell: got 0, expected above 0"),
        ("--cell=-1", "--cell: got -1"),
        ("--cell=nan", "--cell: got NaN"),
        ("--cell-px=0", "--cell-px: got 0, expected at least 1"),
        ("--orientations=0", "--orientations: got 0"),
        ("--block-cells=0", "--block-cells: got 0"),
        ("--norm=l3", "possible values: none, l1, l1-sqrt, l2, l2-hys"),
        ("--orientations=many", "--orientations"),
        ("--descriptor=windows", "possible values: direct, window, motion"),
        ("--method=ccoeff-normed", "--method is for --descriptor window"),
        ("--mask=goal.png", "--mask is for --descriptor window"),
        ("--tau-step=0.3", "--tau-step is for --descriptor motion"),
        ("--max-frames=few", "--max-frames"),
    ];
    for (option, told) in cases {
        prf(folder.path())
            .args(["score", "goal.png", "bars1.png", option])
            .assert()
            .code(2)
            .stdout(is_empty())
            .stderr(contains(told));
    }
}

#[test]
fn a_config_out_of_range_is_misuse_at_its_line() {
    let folder = folder();
    let config = "[reward]\nsource = \"variable\"\n[reward.hog]\norientations = 0\n";
    fs::write(folder.path().join("c.toml"), config).expect("the folder is ours");
    let mut score = prf(folder.path());
    score.args(["score", "goal.png", "bars1.png", "--config", "c.toml"]);
    score.assert().code(2).stderr(starts_with("error: c.toml:4:16: `reward.hog.orientations`: got 0, expected "));
}

#[test]
fn cells_that_the_goal_has_no_room_for_are_misuse() {
    let folder = folder();
    prf(folder.path())
        .args(["score", "bars1.png", "bars5.png", "--cell-px", "50"])
        .assert()
        .code(2)
        .stderr(starts_with("error: bars1.png: ").and(contains("smaller cells")));
}

#[test]
fn both_kinds_of_cell_are_misuse() {
    let folder = folder();
    prf(folder.path())
        .args(["score", "goal.png", "bars1.png", "--cell", "0.1", "--cell-px", "3"])
        .assert()
        .code(2)
        .stderr(contains("cannot be used with"));
}

#[test]
fn a_bad_goal_fails_and_says_why() {
    let folder = folder();
    let mut cases = broken::files(folder.path());
    cases.push(("missing.png", "no such file"));
    for (goal, told) in cases {
        prf(folder.path())
            .args(["score", goal, "bars1.png"])
            .assert()
            .code(1)
            .stdout(is_empty())
            .stderr(starts_with(format!("error: {goal}: ")).and(contains(told)));
    }
}

#[test]
fn bad_frames_among_good_ones_are_a_loss() {
    let folder = folder();
    let mut cases = broken::files(folder.path());
    cases.push(("missing.png", "no such file"));
    for (frame, told) in cases {
        prf(folder.path())
            .args(["score", "--format", "json", "goal.png", frame, "goal.png"])
            .assert()
            .code(3)
            .stdout("{\"source\":\"goal.png\",\"index\":1,\"reward\":1.0,\"distance\":0.0}\n")
            .stderr(contains(format!("error: {frame}: ")).and(contains(told)));
    }
}

#[test]
fn nothing_but_bad_frames_is_a_failure() {
    let folder = folder();
    prf(folder.path())
        .args(["score", "goal.png", "missing.png"])
        .assert()
        .code(1)
        .stdout(is_empty())
        .stderr(contains("missing.png: no such file").and(contains("no frame could be scored")));
}

#[test]
fn goals_that_say_nothing_are_pointed_out() {
    let folder = folder();
    pictures::flat(&folder.path().join("grey.png"), 128);
    let told = |goal: &str| {
        let mut score = prf(folder.path());
        score.args(["score", goal, "bars1.png"]);
        String::from_utf8_lossy(&score.assert().success().get_output().stderr).into_owned()
    };
    assert!(told("grey.png").starts_with("warning: grey.png: what is compared of the goal is one even grey (128)"));
    assert!(told("goal.png").starts_with("note: goal.png: the goal is all black"));
    assert_eq!(told("bars5.png"), "");
}

#[test]
fn rewards_that_say_nothing_are_pointed_out() {
    let folder = folder();
    prf(folder.path())
        .args(["score", "bars5.png", "bars1.png", "bars1.png"])
        .assert()
        .success()
        .stderr(starts_with("warning: all 2 rewards are "));
    prf(folder.path())
        .args(["score", "goal.png", "bars5.png", "--scale", "none", "--cell-px", "1"])
        .assert()
        .success()
        .stderr(contains("warning: no reward is above ").and(contains("--scale sqrt-blocks")));
}

/// `bars5.png` cut out at (4, 4), 30×20 px.
fn window(folder: &TempDir) {
    prf(folder.path())
        .args(["goal", "crop", "bars5.png", "--rect", "4,4,30,20", "--out", "window.png"])
        .assert()
        .success();
}

#[test]
fn a_window_is_found_and_its_place_is_told() {
    let folder = folder();
    window(&folder);
    for method in ["ccorr-normed", "ccoeff-normed"] {
        let args = ["window.png", "bars5.png", "--descriptor", "window", "--method", method];
        let records = scores(folder.path(), &args);
        assert_eq!(records[0]["reward"], 1.0, "{records:?}");
        let found = &records[0]["match"];
        let place = ["x", "y", "width", "height"].map(|key| found[key].as_u64().expect("a whole number"));
        assert_eq!(place, [4, 4, 30, 20]);
        assert!((found["score"].as_f64().expect("a number") - 1.0).abs() < 1e-4);
    }
    prf(folder.path())
        .args(["score", "window.png", "bars5.png", "--descriptor", "window"])
        .assert()
        .stdout("bars5.png: reward 1.000000, distance 0.000000, best match 1.000 at (4, 4)\n");
}

#[test]
fn a_mask_takes_pixels_out_of_the_window() {
    let folder = folder();
    window(&folder);
    let mut mask = GrayImage::new(30, 20);
    (0..20).for_each(|y| (0..15).for_each(|x| mask.put_pixel(x, y, image::Luma([255]))));
    mask.save(folder.path().join("mask.png")).expect("the folder is ours");
    let mut frame = image::open(folder.path().join("bars5.png")).expect("a picture").into_luma8();
    (4..24).for_each(|y| (20..34).for_each(|x| frame.put_pixel(x, y, image::Luma([255]))));
    frame.save(folder.path().join("half.png")).expect("the folder is ours");
    let score =
        |more: &[&str]| rewards(folder.path(), &[&["window.png", "half.png", "--descriptor=window"], more].concat())[0];
    assert_eq!(score(&["--mask=mask.png"]), 1.0);
    assert!(score(&[]) < 0.9);
}

#[test]
fn a_window_larger_than_a_frame_is_a_loss() {
    let folder = folder();
    window(&folder);
    GrayImage::new(29, 40).save(folder.path().join("narrow.png")).expect("the folder is ours");
    prf(folder.path())
        .args(["score", "window.png", "narrow.png", "bars5.png", "--descriptor", "window"])
        .assert()
        .code(3)
        .stderr(contains("30x20").and(contains("29x40")));
}

#[test]
fn an_animation_and_a_folder_are_scored_frame_by_frame() {
    let folder = folder();
    fs::create_dir(folder.path().join("frames")).expect("the folder is ours");
    for count in [1, 5, 9, 10] {
        pictures::bars(&folder.path().join(format!("frames/bar{count}.png")), count);
    }
    fs::write(folder.path().join("frames/notes.txt"), "not a picture").expect("the folder is ours");
    let records = scores(folder.path(), &["goal.png", "frames", "bars1.png"]);
    let sources: Vec<_> = records.iter().map(|record| record["source"].as_str().expect("a name")).collect();
    let expected = ["frames/bar1.png", "frames/bar5.png", "frames/bar9.png", "frames/bar10.png", "bars1.png"];
    assert_eq!(sources, expected);
    assert_eq!(records[0]["reward"], records[4]["reward"]);

    let mut gif = image::codecs::gif::GifEncoder::new(fs::File::create(folder.path().join("a.gif")).expect("ours"));
    for name in ["bars1.png", "bars5.png"] {
        let frame = image::open(folder.path().join(name)).expect("a picture").into_rgba8();
        let delay = image::Delay::from_numer_denom_ms(250, 1);
        gif.encode_frame(image::Frame::from_parts(frame, 0, 0, delay)).expect("it is a frame");
    }
    drop(gif);
    let records = scores(folder.path(), &["goal.png", "a.gif"]);
    assert_eq!(records.iter().map(|record| record["time_s"].as_f64()).collect::<Vec<_>>(), [Some(0.0), Some(0.25)]);
    let table = prf(folder.path()).args(["score", "goal.png", "a.gif"]).assert().success();
    let text = String::from_utf8_lossy(&table.get_output().stdout).into_owned();
    assert!(text.starts_with("source ") && text.contains("a.gif #1 (0.25 s)"), "{text}");
    prf(folder.path())
        .args(["score", "goal.png", "a.gif", "--max-frames", "1"])
        .assert()
        .code(3)
        .stderr(contains("--max-frames").or(contains("frames")));
}

#[test]
fn the_motion_of_the_goal_itself_is_the_goal() {
    let folder = folder();
    for name in ["right", "down"] {
        fs::create_dir(folder.path().join(name)).expect("the folder is ours");
        for step in 0..5 {
            let [dx, dy] = if name == "right" { [3 * step, 0] } else { [0, 3 * step] };
            let lit = |x: u32, y: u32| (4 + dx..12 + dx).contains(&x) && (4 + dy..10 + dy).contains(&y);
            GrayImage::from_fn(32, 32, |x, y| image::Luma([if lit(x, y) { 255 } else { 0 }]))
                .save(folder.path().join(format!("{name}/{step}.png")))
                .expect("the folder is ours");
        }
    }
    let motion = |frames| rewards(folder.path(), &["right", frames, "--descriptor", "motion"]);
    let (right, down) = (motion("right"), motion("down"));
    assert_eq!(right[4], 1.0);
    assert!(down[4] < 0.9, "{down:?}");
    // A template made before is taken as it is.
    prf(folder.path()).args(["goal", "motion", "right", "--out", "right.png"]).assert().success();
    assert_eq!(rewards(folder.path(), &["right.png", "right", "--descriptor", "motion"]), right);
}

#[test]
fn explanations_are_drawn() {
    let folder = folder();
    window(&folder);
    prf(folder.path())
        .args(["score", "window.png", "bars1.png", "bars5.png", "--descriptor", "window", "--explain", "why.png"])
        .assert()
        .success()
        .stderr(contains("drew what was compared in bars5.png into why.png"));
    let picture = image::open(folder.path().join("why.png")).expect("a PNG").into_rgb8();
    let orange = picture.pixels().filter(|pixel| pixel.0 == [255, 150, 0]).count();
    assert!(picture.dimensions() == (1160, 882) && orange > 100, "{:?}, {orange}", picture.dimensions());
}

#[test]
fn a_closed_pipe_ends_quietly() {
    let folder = folder();
    let mut child = process::Command::new(assert_cmd::cargo::cargo_bin!("prf"))
        .current_dir(folder.path())
        .args(["score", "bars1.png"])
        .args(["bars5.png"; 500])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("prf starts");
    let stdout = child.stdout.take().expect("it is piped");
    let mut first = String::new();
    let mut reader = BufReader::with_capacity(64, stdout);
    reader.read_line(&mut first).expect("there is a first line");
    drop(reader);
    let mut told = String::new();
    let mut stderr = child.stderr.take().expect("it is piped");
    stderr.read_to_string(&mut told).expect("stderr is UTF-8");
    assert!(first.starts_with("source"), "{first}");
    assert_eq!(told, "");
    assert_eq!(child.wait().expect("prf ends").code(), Some(0));
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_a_failure() {
    let folder = folder();
    let full = fs::OpenOptions::new().write(true).open("/dev/full").expect("Linux has it");
    let mut score = process::Command::new(assert_cmd::cargo::cargo_bin!("prf"));
    score.current_dir(folder.path()).args(["score", "bars1.png", "bars5.png"]);
    let output = score.stdout(full).output().expect("prf starts");
    assert_eq!(output.status.code(), Some(1));
    let told = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(told.starts_with("error: cannot write to stdout: "), "{told}");
}

#[cfg(target_os = "linux")]
#[test]
fn names_that_are_no_text_are_scored_too() {
    use std::ffi::OsStr;
    use std::os::unix::ffi::OsStrExt as _;

    let folder = folder();
    let name = OsStr::from_bytes(b"\xff\xfe.png");
    fs::copy(folder.path().join("bars1.png"), folder.path().join(name)).expect("Linux takes any name");
    prf(folder.path())
        .args([OsStr::new("score"), OsStr::new("bars1.png"), name, OsStr::new("bars1.png")])
        .assert()
        .success();
    prf(folder.path())
        .args([OsStr::new("score"), OsStr::new("bars1.png"), OsStr::from_bytes(b"\xff")])
        .assert()
        .code(1);
}
