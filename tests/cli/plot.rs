//! `prf plot` as a user runs it.

use std::fs::{self, OpenOptions};
use std::io::Write as _;
use std::path::Path;

use predicates::prelude::*;
use predicates::str::{contains, is_empty};
use serde_json::Value;
use tempfile::TempDir;

mod common;
mod run_folders;

use common::prf;
use run_folders::{CONFIG, make_run, save};

/// Two seeds of one config and one of another.
fn folder() -> TempDir {
    let folder = tempfile::tempdir().expect("a temporary folder can be made");
    let first = make_run(folder.path(), "ball-1", (1, CONFIG), &[(100, 0.0), (300, 2.0), (500, 3.0)]);
    save(&first, 500, false);
    make_run(folder.path(), "ball-2", (2, CONFIG), &[(100, 1.0), (500, 2.0)]);
    make_run(folder.path(), "fast-1", (1, &format!("{CONFIG}gamma = 0.9\n")), &[(200, 1.0), (400, 1.5)]);
    folder
}

fn plot(folder: &Path, args: &[&str]) -> assert_cmd::assert::Assert {
    prf(folder).arg("plot").args(args).assert()
}

fn records(folder: &Path, args: &[&str]) -> Vec<Value> {
    let output = plot(folder, &[args, &["--format", "json"]].concat()).success();
    let text = String::from_utf8(output.get_output().stdout.clone()).expect("JSON is UTF-8");
    text.lines().map(|line| serde_json::from_str(line).expect("one object a line")).collect()
}

fn append(run: &Path, text: &str) {
    let file = OpenOptions::new().append(true).open(run.join("metrics.jsonl"));
    file.and_then(|mut file| file.write_all(text.as_bytes())).expect("the folder is ours");
}

#[test]
fn seeds_become_a_curve_with_an_interval() {
    let folder = folder();
    let records = records(folder.path(), &["ball-1", "ball-2", "fast-1"]);
    let point = |curve: &str, seeds: u64, x: f64, y: f64, interval: Option<[f64; 2]>| {
        let [low, high] = [0, 1].map(|end| interval.map_or(Value::Null, |interval| interval[end].into()));
        serde_json::json!({"kind": "point", "curve": curve, "seeds": seeds, "x": x, "y": y, "low": low, "high": high})
    };
    let expected = [
        point("gamma = 0.99", 2, 100.0, 0.5, Some([0.0, 1.0])),
        // The second seed is halfway from 1 to 2.
        point("gamma = 0.99", 2, 300.0, 1.75, Some([1.5, 2.0])),
        point("gamma = 0.99", 2, 500.0, 2.5, Some([2.0, 3.0])),
        point("gamma = 0.9", 1, 200.0, 1.0, None),
        point("gamma = 0.9", 1, 400.0, 1.5, None),
    ];
    assert_eq!(records[..5], expected);
    let players: Vec<&Value> = records[5..].iter().map(|record| &record["player"]).collect();
    assert_eq!(players, ["oracle", "random"]);
    assert!(records[5]["score"].as_f64() > records[6]["score"].as_f64(), "{records:?}");
    // The oracle in the runs' own evaluations, of 20 episodes by default.
    assert_eq!([&records[5]["episodes"], &records[6]["episodes"]], [20, 100]);
    assert!(!folder.path().join("curves.svg").exists(), "no picture was asked for");
}

#[test]
fn the_picture_shows_curves_bands_and_players() {
    let folder = folder();
    plot(folder.path(), &["ball-1", "ball-2", "fast-1"])
        .success()
        .stdout(contains("gamma = 0.99  2.500 [2.000, 3.000]  2 seeds, step 500").and(contains("oracle")))
        .stderr(contains("drew 2 curves into curves.svg"));
    let svg = fs::read_to_string(folder.path().join("curves.svg")).expect("it was drawn");
    let document = roxmltree::Document::parse(&svg).expect("it is XML");
    let texts: Vec<&str> =
        document.descendants().filter(|node| node.has_tag_name("text")).filter_map(|node| node.text()).collect();
    let has = |words: &str| texts.iter().any(|text| text.trim() == words);
    for words in [
        "breakout: greedy score",
        "gamma = 0.99 (2 seeds)",
        "gamma = 0.9 (1 seed)",
        "oracle",
        "random",
        "steps of training",
    ] {
        assert!(has(words), "{words} is missing in {texts:?}");
    }
    // One band, of the two seeds alone.
    assert_eq!(document.descendants().filter(|node| node.has_tag_name("polygon")).count(), 1);

    plot(folder.path(), &["ball-1", "ball-2", "fast-1", "--out", "again.svg"]).success();
    assert_eq!(
        fs::read_to_string(folder.path().join("again.svg")).expect("it was drawn"),
        svg,
        "the same data, the same picture"
    );
}

#[test]
fn a_png_is_drawn_by_its_ending() {
    let folder = folder();
    plot(folder.path(), &["ball-1", "-o", "curve.PNG", "--y", "reward", "--x", "episodes"]).success();
    let picture = image::load_from_memory(&fs::read(folder.path().join("curve.PNG")).expect("it was drawn"));
    let picture = picture.expect("it is a PNG").to_rgb8();
    assert_eq!(picture.width(), 1800);
    let blue = picture.pixels().filter(|pixel| pixel.0 == [0, 114, 178]).count();
    assert!(blue > 1000, "there is no curve, only {blue} pixels of its colour");
    plot(folder.path(), &["ball-1", "-o", "curve.pdf"]).code(2).stderr(contains("ends in .svg or .png"));
}

#[test]
fn a_killed_run_is_drawn_and_damage_is_named() {
    let folder = folder();
    append(&folder.path().join("ball-1"), "{\"kind\":\"evaluation\",\"step\":60");
    let killed = plot(folder.path(), &["ball-1"]).success();
    killed.stdout(contains("3.000  1 seed, step 500")).stderr(contains("damaged").not().and(contains("warning").not()));
    append(&folder.path().join("ball-1"), "\n{\"kind\":\"evaluation\"}\n");
    plot(folder.path(), &["ball-1"])
        .code(3)
        .stdout(contains("3.000  1 seed, step 500"))
        .stderr(contains("2 lines of ball-1/metrics.jsonl, the first of them 4, are no records"));
}

#[test]
fn runs_with_nothing_to_draw_are_left_out() {
    let folder = folder();
    make_run(folder.path(), "ball-3", (3, CONFIG), &[]);
    plot(folder.path(), &["ball-1", "ball-3"])
        .success()
        .stdout(contains("1 seed"))
        .stderr(contains("warning: ball-3 is left out: it has no evaluation yet"));
    plot(folder.path(), &["ball-3"]).code(1).stdout(is_empty()).stderr(contains("there is no greedy score to draw"));
    plot(folder.path(), &["ball-1", "--y", "loss"]).code(1).stderr(contains("nothing of this kind is recorded yet"));
    // The same run twice is one, and another with the same seed is not a second.
    make_run(folder.path(), "copy", (1, CONFIG), &[(100, 0.0)]);
    plot(folder.path(), &["ball-1", "./ball-1", "copy"])
        .success()
        .stdout(contains("1 seed"))
        .stderr(contains("copy has the config and the seed of ball-1 and is left out"));
}

#[test]
fn what_cannot_be_compared_is_refused() {
    let folder = folder();
    make_run(folder.path(), "bird", (1, &CONFIG.replace("breakout", "flappy")), &[(100, 1.0)]);
    plot(folder.path(), &["ball-1", "bird"])
        .code(2)
        .stderr(contains("got breakout of ball-1 and flappy of bird").and(contains("hint: ")));
    plot(folder.path(), &["nowhere"]).code(2).stderr(contains("there is no folder nowhere"));
    plot(folder.path(), &["."])
        .code(2)
        .stderr(contains(". is no run, but has 4 in it").and(contains("such as ./ball-1")));
    fs::create_dir(folder.path().join("empty")).expect("the folder is ours");
    plot(folder.path(), &["empty"]).code(2).stderr(contains("empty is no run: it has no config.toml"));
    fs::write(folder.path().join("bird/config.toml"), "seed = 1\n").expect("the folder is ours");
    plot(folder.path(), &["bird"]).code(2).stderr(contains("bird/config.toml:1:1").and(contains("`env`")));
    // The same world with another limit: its players score something else.
    make_run(folder.path(), "long", (1, &CONFIG.replace("= 40", "= 60")), &[(100, 1.0)]);
    plot(folder.path(), &["ball-1", "long"])
        .success()
        .stdout(contains("oracle").not())
        .stderr(contains("no player is drawn"));
}
