//! `prf inspect` as a user runs it.

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

const FLAPPY: [&str; 7] = ["inspect", "goal.png", "frames.png", "--scores", "scores.csv", "--descriptor", "window"];
const GOOD: [&str; 6] = ["--norm", "l2-hys", "--block-cells", "2", "--cell", "0.3"];

fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    flappy::put_into(folder.path());
    folder
}

/// The only line of JSON that a command prints.
fn record(folder: &Path, args: &[&str]) -> Value {
    let output = prf(folder).args(args).args(["--format", "json"]).assert().success().get_output().stdout.clone();
    let text = String::from_utf8(output).expect("text");
    assert_eq!(text.lines().count(), 1, "{text}");
    serde_json::from_str(&text).expect("JSON")
}

fn number(record: &Value, key: &str) -> f64 {
    record[key].as_f64().unwrap_or_else(|| panic!("no {key} in {record}"))
}

/// A config of Breakout whose goal is black.
fn breakout(folder: &Path) {
    prf(folder).args(["init", "breakout"]).assert().success();
}

#[test]
fn scores_beside_frames_show_that_the_usual_settings_punish_progress() {
    let folder = folder();
    prf(folder.path())
        .args(FLAPPY)
        .assert()
        .success()
        .stdout(contains("window, l2, 1x1 blocks, cells of 0.1 h (3 px)"))
        .stdout(contains("judged by 400 of 400 frames with scores"))
        .stdout(contains("misleading: the reward punishes progress (AUC of success: 0.2"));
    let naive = record(folder.path(), &FLAPPY);
    assert_eq!((naive["evidence"].as_str(), naive["frames"].as_u64()), (Some("scores"), Some(400)));
    assert!(number(&naive, "success_auc") < 0.3 && number(&naive, "rank_correlation") < 0.0, "{naive}");
    let better = record(folder.path(), &[&FLAPPY[..], &GOOD].concat());
    assert!(number(&better, "success_auc") > 0.75 && number(&better, "rank_correlation") > 0.6, "{better}");
}

#[test]
fn rows_are_found_by_order_by_name_and_by_number() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path();
    more_bars::folder(&path.join("frames"), 1..=9);
    pictures::bars(&path.join("goal.png"), 9);
    let rows = |name: &dyn Fn(u32) -> String| (1..=9).map(|bars| format!("{}{bars}\n", name(bars))).collect::<String>();
    let write = |name: &str, text: String| fs::write(path.join(name), text).expect("the folder is ours");
    write("order.csv", "score\n".to_owned() + &rows(&|_| String::new()));
    write("name.csv", "frame,score\n".to_owned() + &rows(&|bars| format!("{bars}.png,")));
    write("stem.csv", "score,Frame\n".to_owned() + &(1..=9).rev().map(|n| format!("{n}, {n}\n")).collect::<String>());
    write("few.csv", "frame,score\n7.png,7\n2.png,2\n5.png,\n9.png,8\n".to_owned());
    let judged = |csv: &str| record(path, &["inspect", "goal.png", "frames", "--scores", csv]);
    let order = judged("order.csv");
    assert_eq!(order["rank_correlation"], 1.0);
    assert_eq!((judged("name.csv"), judged("stem.csv")), (order.clone(), order));
    let few = judged("few.csv");
    assert_eq!((&few["frames"], &few["rank_correlation"]), (&Value::from(3), &Value::from(1.0)));

    // The frames of a video have numbers, also where it doesn't say their times.
    let bars = |count: u32| image::open(path.join(format!("frames/{count}.png"))).expect("a picture").to_luma8();
    let video = (1..=9).flat_map(|count| [b"FRAME\n".to_vec(), bars(count).into_raw()].concat());
    let video: Vec<u8> = b"YUV4MPEG2 W40 H40 Cmono XCOLORRANGE=FULL\n".iter().copied().chain(video).collect();
    fs::write(path.join("timeless.y4m"), video).expect("the folder is ours");
    let lines: String = (0..9).map(|number| format!("{number},{number}\n")).collect();
    write("timeless.csv", "frame,score\n".to_owned() + &lines);
    let timeless = record(path, &["inspect", "goal.png", "timeless.y4m", "--scores", "timeless.csv"]);
    assert_eq!((&timeless["frames"], &timeless["rank_correlation"]), (&Value::from(9), &Value::from(1.0)));

    // So have those of an animation.
    flappy::put_into(path);
    let table = fs::read_to_string(path.join("scores.csv")).expect("a table");
    let mut numbered: Vec<String> =
        table.lines().skip(1).enumerate().map(|(number, line)| format!("{number},{line}\n")).collect();
    numbered.reverse();
    write("numbered.csv", "frame,score,success\n".to_owned() + &numbered.concat());
    let args: Vec<&str> = FLAPPY.iter().map(|&word| if word == "scores.csv" { "numbered.csv" } else { word }).collect();
    assert_eq!(record(path, &args), record(path, &FLAPPY));
}

#[test]
fn a_threshold_makes_successes_of_scores() {
    let folder = folder();
    let args = ["--success-at", "-5"];
    let scores: String = fs::read_to_string(folder.path().join("scores.csv"))
        .expect("a table")
        .lines()
        .map(|line| format!("{}\n", line.split(',').next().unwrap_or_default()))
        .collect();
    fs::write(folder.path().join("scores.csv"), scores.replace("\n\n", "\n\"\"\n").replace("\n\n", "\n\"\"\n"))
        .expect("the folder is ours");
    let judged = record(folder.path(), &[&FLAPPY[..], &GOOD, &args].concat());
    assert!(number(&judged, "success_auc") > 0.7, "{judged}");
    assert!(record(folder.path(), &FLAPPY).get("success_auc").is_none());
    let far = [&FLAPPY[..], &["--success-at", "1"]].concat();
    let told = "--success-at 1 tells no frames apart: the highest score is 0";
    prf(folder.path()).args(far).assert().success().stderr(contains(told));
    for wrong in [&["--success-at", "nan"][..], &["--success-at", "1", "--goal-only"], &["--sample", "3"]] {
        prf(folder.path()).args(["inspect", "goal.png"]).args(wrong).assert().code(2);
    }
}

#[test]
fn a_demonstration_is_judged_by_its_order() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path();
    more_bars::folder(&path.join("demo"), 1..=9);
    pictures::bars(&path.join("goal.png"), 9);
    let args = ["inspect", "goal.png", "demo", "--demo", "--plot", "order.svg"];
    prf(path).args(args).assert().success().stdout(contains("rank correlation with time")).stdout(contains("1.000"));
    let svg = fs::read_to_string(path.join("order.svg")).expect("a diagram");
    let document = roxmltree::Document::parse(&svg).expect("XML");
    assert!(document.descendants().any(|node| node.text().is_some_and(|text| text.contains("demonstration 1"))));
    let judged = record(path, &["inspect", "goal.png", "demo", "demo", "--demo"]);
    assert_eq!((&judged["value_order_correlation"], &judged["frames"]), (&Value::from(1.0), &Value::from(18)));
}

#[test]
fn the_goal_alone_tells_the_same_and_draws_it() {
    let folder = folder();
    let args = ["inspect", "goal.png", "--descriptor", "window", "--plot", "alone.svg", "--picture", "alone.png"];
    prf(folder.path()).args(args).assert().success().stdout(contains("the goal alone")).stdout(contains("misleading"));
    let svg = fs::read_to_string(folder.path().join("alone.svg")).expect("a diagram");
    assert!(svg.contains("thing 1 displaced") && svg.contains("displaced by (px)"), "{svg}");
    let picture = image::open(folder.path().join("alone.png")).expect("a picture");
    assert_eq!((picture.width(), picture.height()), (1096, 632));
    let good = record(folder.path(), &[&["inspect", "goal.png", "--descriptor", "window"][..], &GOOD].concat());
    assert_eq!(good["verdict"], "good");
    assert!(number(&good, "absence_auc") > 0.9 && number(&good, "displacement_correlation") > 0.8, "{good}");
}

#[test]
fn a_config_is_judged_in_its_world() {
    let folder = tempfile::tempdir().expect("a folder");
    breakout(folder.path());
    let judged = record(folder.path(), &["inspect", "breakout.toml", "--sample", "300", "--picture", "ends.png"]);
    assert_eq!((judged["evidence"].as_str(), judged["verdict"].as_str()), (Some("world"), Some("good")));
    assert!(number(&judged, "early_rank_correlation") > 0.8, "{judged}");
    assert!(folder.path().join("ends.png").is_file());
    let again = record(folder.path(), &["inspect", "breakout.toml", "--sample", "300"]);
    assert_eq!(again, judged);
    assert_ne!(record(folder.path(), &["inspect", "breakout.toml", "--sample", "300", "--seed", "5"]), judged);
    let worse = ["--norm", "l1", "--block-cells", "3", "--cell", "0.1"];
    let worse = record(folder.path(), &[&["inspect", "breakout.toml", "--sample", "300"][..], &worse].concat());
    assert!(number(&worse, "rank_correlation") < 0.3, "{worse}");
}

#[test]
fn frames_of_which_nothing_is_known_are_refused() {
    let folder = folder();
    prf(folder.path())
        .args(["inspect", "goal.png", "frames.png", "--descriptor", "window"])
        .assert()
        .code(2)
        .stdout("")
        .stderr(contains("nothing is known of the frames").and(contains("--scores FILE.csv, or --demo")));
}

#[test]
fn bad_tables_are_refused_with_their_line() {
    let folder = folder();
    for (text, told) in [
        ("", "scores.csv:1: got the columns \"\", expected score or success"),
        ("points\n3\n", "scores.csv:1: got the columns \"points\", expected score or success"),
        ("score\n", "scores.csv has no line for any frame"),
        ("score\n1\nmany\n", "scores.csv:3: score: got \"many\", expected a number or nothing"),
        ("score\nNaN\n", "scores.csv:2: score: got \"NaN\""),
        ("score,success\n1,2\n", "scores.csv:2: success: got \"2\", expected 1, 0 or nothing"),
        ("score,success\n1\n", "scores.csv: CSV error: record 1"),
        ("score\n1\n2\n", "scores.csv has lines for 2 frames, expected 400: one for each, in their order"),
        ("frame,score\na.png,1\na.png,2\n", "scores.csv:3: the frame \"a.png\" has a line already"),
        ("frame,score\n3,1\n7,2\n400,1\n", "scores.csv has a line for \"400\", which is none of the 400 frames"),
    ] {
        fs::write(folder.path().join("scores.csv"), text).expect("the folder is ours");
        prf(folder.path()).args(FLAPPY).assert().code(2).stdout("").stderr(contains(told));
    }
    fs::remove_file(folder.path().join("scores.csv")).expect("it was there");
    prf(folder.path()).args(FLAPPY).assert().code(2).stderr(contains("cannot read scores.csv"));
}

#[test]
fn scores_that_are_all_the_same_are_no_evidence() {
    let folder = folder();
    fs::write(folder.path().join("scores.csv"), "score\n".to_owned() + &"7\n".repeat(400)).expect("the folder is ours");
    prf(folder.path())
        .args(FLAPPY)
        .assert()
        .code(2)
        .stderr(contains("all 400 frames have the score 7, expected frames of different scores"));
}

#[test]
fn goals_and_configs_that_cannot_be_judged_say_why() {
    let folder = folder();
    let path = folder.path();
    pictures::flat(&path.join("flat.png"), 90);
    prf(path).args(["inspect", "flat.png"]).assert().code(2).stderr(contains("the goal shows nothing of 4 px or more"));
    prf(path).args(["inspect", "nowhere.png"]).assert().code(1).stderr(contains("nowhere.png: no such file"));
    prf(path)
        .args(["inspect", "nowhere.toml"])
        .assert()
        .code(2)
        .stderr(contains("cannot read the config nowhere.toml"));
    prf(path).args(["init", "breakout-vrf"]).assert().success();
    prf(path)
        .args(["inspect", "breakout-vrf.toml"])
        .assert()
        .code(2)
        .stderr(contains("`reward.source` is \"variable\""));
    breakout(path);
    prf(path)
        .args(["inspect", "breakout.toml", "--goal-only"])
        .assert()
        .code(2)
        .stderr(contains("the goal shows nothing of 4 px or more"));
    more_bars::folder(&path.join("demo"), 1..=3);
    let large = ["inspect", "screen.png", "demo", "--demo", "--descriptor", "window"];
    prf(path).args(large).assert().code(1).stderr(contains("1.png").and(contains("84x84")).and(contains("40x40")));
}

#[test]
fn frames_that_cannot_be_read_are_left_out_with_exit_code_3() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path();
    more_bars::folder(&path.join("frames"), [1, 2, 3, 5, 6]);
    fs::write(path.join("frames/4.png"), "no picture").expect("the folder is ours");
    pictures::bars(&path.join("goal.png"), 6);
    fs::write(path.join("scores.csv"), "score\n1\n2\n3\n4\n5\n6\n").expect("the folder is ours");
    prf(path)
        .args(["inspect", "goal.png", "frames", "--scores", "scores.csv"])
        .assert()
        .code(3)
        .stdout(contains("judged by 5 of 5 frames"))
        .stderr(contains("4.png"));
    prf(path)
        .args(["inspect", "goal.png", "nothing", "--demo"])
        .assert()
        .code(1)
        .stderr(contains("no frame could be read"));
    // A shell's `frames/*.png` is the same.
    let files = (1..=6).map(|bars| format!("frames/{bars}.png"));
    prf(path)
        .args(["inspect", "goal.png", "--scores", "scores.csv"])
        .args(files)
        .assert()
        .code(3)
        .stdout(contains("1.000").and(contains("judged by 5 of 5 frames")));
}

#[test]
fn lines_behind_a_cut_animation_are_not_guessed() {
    let folder = folder();
    let path = folder.path();
    let whole = fs::read(path.join("frames.png")).expect("an animation");
    fs::write(path.join("cut.png"), &whole[..whole.len() / 2]).expect("the folder is ours");
    // The lines of the frames that were read are certain, and the table is not blamed for the others.
    let cut: Vec<&str> = FLAPPY.iter().map(|&word| if word == "frames.png" { "cut.png" } else { word }).collect();
    prf(path).args(&cut).assert().code(3).stdout(contains("frames with scores")).stderr(contains("cut.png"));
    let behind = [&cut[..3], &["frames.png"], &cut[3..]].concat();
    let told = "which line of scores.csv belongs to frames.png can't be told";
    prf(path).args(behind).assert().code(1).stderr(contains(told));
}

#[test]
fn what_cannot_be_moved_is_not_called_misleading() {
    let folder = tempfile::tempdir().expect("a folder");
    let ring = image::GrayImage::from_fn(40, 40, |x, y| {
        image::Luma([if x == 0 || y == 0 || x == 39 || y == 39 { 200 } else { 0 }])
    });
    ring.save(folder.path().join("ring.png")).expect("the folder is ours");
    prf(folder.path())
        .args(["inspect", "ring.png"])
        .assert()
        .success()
        .stdout(contains("weak: nothing in the goal can be moved").and(contains("displaced over absent").not()));
}

#[test]
fn pictures_one_by_one_are_one_movement() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path();
    more_bars::folder(&path.join("move"), 1..=9);
    let files: Vec<String> = (1..=9).map(|bars| format!("move/{bars}.png")).collect();
    let files: Vec<&str> = files.iter().map(String::as_str).collect();
    let motion = ["inspect", "move", "--descriptor", "motion", "--demo"];
    let one_by_one = record(path, &[&motion[..], &files].concat());
    assert_eq!(one_by_one, record(path, &[&motion[..], &["move"]].concat()));
    assert_ne!(one_by_one["verdict"], "blind");
}
