//! Sequences as goals of motion: `prf goal ck-plus`, `prf goal motion` and goals in configs, run as a user runs them.

use std::fs;
use std::path::Path;

use image::{Delay, Frame as GifFrame, GrayImage, Luma};
use predicates::prelude::*;
use predicates::str::{contains, is_empty, starts_with};
use serde_json::Value;
use tempfile::TempDir;

mod common;

use common::prf;

fn temporary() -> TempDir {
    tempfile::tempdir().expect("a temporary folder can be made")
}

/// A face whose mouth is open by `open` rows.
fn face(open: u32) -> GrayImage {
    let is_eye = |x: u32, y: u32| (12..15).contains(&y) && ((10..14).contains(&x) || (26..30).contains(&x));
    let is_mouth = |x: u32, y: u32| (14..26).contains(&x) && (26..27 + open).contains(&y);
    GrayImage::from_fn(40, 44, |x, y| Luma([if is_eye(x, y) || is_mouth(x, y) { 30 } else { 180 }]))
}

fn save(picture: &GrayImage, path: &Path) {
    picture.save(path).expect("the folder is ours");
}

fn make_folder(path: &Path) {
    fs::create_dir_all(path).expect("the folder is ours");
}

/// A sequence of faces that open their mouths, with a file of a desktop among them.
fn faces(root: &Path, subject: &str, session: &str, frames: u32) {
    let folder = root.join("cohn-kanade-images").join(subject).join(session);
    make_folder(&folder);
    fs::write(folder.join(".DS_Store"), "no picture").expect("the folder is ours");
    for frame in 0..frames {
        save(&face(2 * frame), &folder.join(format!("{subject}_{session}_{:08}.png", frame + 1)));
    }
}

fn label(root: &Path, subject: &str, session: &str, text: &str) {
    let folder = root.join("Emotion").join(subject).join(session);
    make_folder(&folder);
    fs::write(folder.join(format!("{subject}_{session}_00000006_emotion.txt")), text).expect("the folder is ours");
}

/// A folder with `ck`, in which there are four sequences with three labels.
fn ck_plus() -> TempDir {
    let folder = temporary();
    let root = folder.path().join("ck");
    for (subject, session, frames) in [("S005", "001", 6), ("S010", "001", 4), ("S010", "002", 5), ("S011", "001", 3)] {
        faces(&root, subject, session, frames);
    }
    label(&root, "S005", "001", "   7.0000000e+00\n");
    label(&root, "S010", "001", "   5.0000000e+00\n");
    label(&root, "S010", "002", "   7.0000000e+00\n");
    folder
}

const FIRST: &str = "ck/cohn-kanade-images/S005/001";

fn read(path: &Path) -> GrayImage {
    image::open(path).expect("a PNG was written").into_luma8()
}

fn json(folder: &Path, args: &[&str]) -> Vec<Value> {
    let output = prf(folder).args(args).args(["--format", "json"]).assert().success().get_output().stdout.clone();
    let text = String::from_utf8(output).expect("text");
    text.lines().map(|line| serde_json::from_str(line).expect("JSON")).collect()
}

#[test]
fn the_one_sequence_that_fits_becomes_a_goal_by_the_schedule_for_people() {
    let folder = ck_plus();
    let path = folder.path();
    prf(path)
        .args(["goal", "ck-plus", "ck", "--emotion", "happy"])
        .assert()
        .success()
        .stdout("goal.png\n")
        .stderr(is_empty());
    let human = ["--tau-step", "0.3", "--delta-divisor", "4"];
    for (name, options) in [("human.png", &human[..]), ("robot.png", &[])] {
        let motion = ["goal", "motion", "ck/cohn-kanade-images/S010/001", "--out", name];
        prf(path).args(motion).args(options).assert().success();
    }
    let goal = read(&path.join("goal.png"));
    assert_eq!(goal, read(&path.join("human.png")));
    assert_ne!(goal, read(&path.join("robot.png")));
    // The mouth opened downwards by two rows a frame, at τ = 0.1, 0.4 and 0.7.
    assert_eq!([27, 29, 31, 33].map(|y| goal.get_pixel(20, y)[0]), [36, 146, 255, 0]);

    let made = json(path, &["goal", "ck-plus", "ck", "--subject", "S005", "--out", "surprise.png"]);
    let expected = serde_json::json!([{
        "goal": "surprise.png", "subject": "S005", "session": "001", "emotion": "surprise", "frames": 6,
        "folder": FIRST, "movements": 5, "remembered": 5, "damaged": 0,
    }]);
    assert_eq!(Value::from(made), expected);
}

#[test]
fn sequences_are_listed_for_people_and_for_programs() {
    let folder = ck_plus();
    let list = ["goal", "ck-plus", "ck", "--list"];
    prf(folder.path())
        .args(list)
        .assert()
        .success()
        .stdout(
            starts_with("subject  session  emotion")
                .and(contains(format!("S005     001      surprise       6  {FIRST}\n"))),
        )
        .stdout(contains("S011     001      -              3  "))
        .stderr(is_empty());
    let listed = json(folder.path(), &list);
    assert_eq!(listed.len(), 4);
    assert_eq!((&listed[2]["session"], &listed[2]["frames"]), (&Value::from("002"), &Value::from(5)));
    assert_eq!(listed[3]["emotion"], Value::Null);
    let narrowed = json(folder.path(), &[&list[..], &["--emotion", "surprise", "--subject", "s010"]].concat());
    assert_eq!(narrowed.len(), 1);
    assert!(!folder.path().join("goal.png").exists());
}

#[test]
fn a_choice_that_is_not_one_sequence_is_misuse() {
    let folder = ck_plus();
    let ck = |args: &[&str]| prf(folder.path()).args(["goal", "ck-plus", "ck"]).args(args).assert().code(2);
    ck(&["--emotion", "surprise"])
        .stdout(is_empty())
        .stderr(starts_with("error: 2 sequences of ck fit, expected one\n  S005 001  surprise, 6 frames\n  S010 002"))
        .stderr(contains("hint: narrow them with --emotion, --subject and --session"));
    ck(&["--emotion", "fear"]).stderr(contains("no sequence of ck fits --emotion fear").and(contains("--list")));
    ck(&["--subject", "S011", "--emotion", "fear"]).stderr(contains("has no label; does the folder Emotion lie"));
    ck(&["--subject", "S999"]).stderr(contains("no sequence of ck fits --subject S999"));
    ck(&["--emotion", "joy"]).stderr(contains("possible values: neutral, anger"));
    ck(&["--list", "--out", "goal.png"]).stderr(contains("cannot be used with"));
    ck(&["--subject", "S005", "--threshold", "255"]).stderr(contains("--threshold: got 255"));
    (10..35).for_each(|session| faces(&folder.path().join("ck"), "S020", &format!("0{session}"), 1));
    ck(&[]).stderr(contains("29 sequences of ck fit").and(contains("and 9 more, which --list prints")));
    assert!(!folder.path().join("goal.png").exists());
}

#[test]
fn a_tree_that_is_none_is_told_from_what_was_expected() {
    let folder = ck_plus();
    make_folder(&folder.path().join("empty/cohn-kanade-images/S005/001"));
    for (root, got) in [
        ("ck/cohn-kanade-images/S010", "got a folder with 001, 002, expected the pictures of CK+"),
        ("empty", "empty/cohn-kanade-images/S005/001: got an empty folder"),
        ("nowhere", "nowhere: got nothing at this path"),
    ] {
        prf(folder.path())
            .args(["goal", "ck-plus", root, "--list"])
            .assert()
            .code(1)
            .stdout(is_empty())
            .stderr(contains(got).and(contains("cohn-kanade-images/S005/001/S005_001_00000001.png")));
    }
    // The folder of pictures itself is understood, also as the current one.
    let images = folder.path().join("ck/cohn-kanade-images");
    prf(&images).args(["goal", "ck-plus", ".", "--emotion", "happy", "--list"]).assert().success();

    label(&folder.path().join("ck"), "S005", "001", "happy\n");
    let ck = |args: &[&str]| prf(folder.path()).args(["goal", "ck-plus", "ck", "--list"]).args(args).assert();
    ck(&[]).code(1).stderr(contains(
        "S005_001_00000006_emotion.txt: got \"happy\", expected the number of an emotion from 0 (neutral) to 7",
    ));
    ck(&["--subject", "S010"]).success();
}

/// A config whose goal is `goal`, at 6:8; a table of its own follows.
fn config(folder: &Path, goal: &str, table: &str) {
    let text = format!(
        "[env]\nname = \"breakout\"\n[reward]\nsource = \"perceptual\"\ndescriptor = \"motion\"\ngoal = \"{goal}\"\n{table}"
    );
    fs::write(folder.join("c.toml"), text).expect("the folder is ours");
}

#[test]
fn a_folder_of_ck_plus_is_a_goal_by_itself() {
    let folder = ck_plus();
    let path = folder.path();
    config(path, FIRST, "[reward.motion]\ntau_step = 0.3\ndelta = { divisor = 4 }\n");
    let inspected = json(path, &["inspect", "c.toml", "--goal-only"]);
    prf(path).args(["goal", "ck-plus", "ck", "--subject", "S005"]).assert().success();
    config(path, "goal.png", "");
    assert_eq!(json(path, &["inspect", "c.toml", "--goal-only"]), inspected);
    let rewards = json(path, &["score", FIRST, FIRST, "--descriptor", "motion"]);
    assert_eq!(rewards[5]["reward"], 1.0);
}

/// A light that goes to the right, three px a frame.
fn lights(folder: &Path, frames: u32) {
    make_folder(folder);
    (0..frames).for_each(|frame| save(&light(frame, 200), &folder.join(format!("{frame}.png"))));
}

fn light(frame: u32, grey: u8) -> GrayImage {
    GrayImage::from_fn(48, 20, |x, y| {
        Luma([if (3 * frame..3 * frame + 6).contains(&x) && (6..14).contains(&y) { grey } else { 0 }])
    })
}

/// What is wrong with each sequence of [`bad_sequences`]: its name, the code and the words for it.
const BAD: [(&str, i32, &str); 6] = [
    ("one", 1, "one: got 1 frame, expected at least 2"),
    ("one.gif", 1, "one.gif: got 1 frame, expected at least 2"),
    ("sizes", 1, "sizes/2.png: the frame is 30x20 px, expected 48x20 as the frames before it"),
    (
        "faint",
        1,
        "faint: nothing moves: the largest change of a pixel from one frame to the next is 12, the threshold 30",
    ),
    (
        "still",
        1,
        "still: nothing moves: the largest change of a pixel from one frame to the next is 0, the threshold 30",
    ),
    ("damaged", 1, "damaged/2.png: the PNG is cut short"),
];

fn bad_sequences(folder: &Path) {
    lights(&folder.join("one"), 1);
    gif(&folder.join("one.gif"), 1);
    lights(&folder.join("sizes"), 4);
    save(&GrayImage::new(30, 20), &folder.join("sizes/2.png"));
    for (name, greys) in [("faint", [8, 20, 9]), ("still", [9, 9, 9])] {
        make_folder(&folder.join(name));
        for (index, grey) in greys.into_iter().enumerate() {
            save(&light(1, grey), &folder.join(format!("{name}/{index}.png")));
        }
    }
    lights(&folder.join("damaged"), 5);
    cut(&folder.join("damaged/2.png"));
}

fn gif(path: &Path, frames: u32) {
    let mut gif = image::codecs::gif::GifEncoder::new(fs::File::create(path).expect("the folder is ours"));
    for frame in 0..frames {
        let picture = image::DynamicImage::ImageLuma8(light(frame, 200)).into_rgba8();
        let delay = Delay::from_numer_denom_ms(100, 1);
        gif.encode_frame(GifFrame::from_parts(picture, 0, 0, delay)).expect("it is a frame");
    }
}

/// Leaves half of a file.
fn cut(path: &Path) {
    let bytes = fs::read(path).expect("it is there");
    fs::write(path, &bytes[..bytes.len() / 2]).expect("the folder is ours");
}

#[test]
fn bad_sequences_are_refused_wherever_a_goal_is_named() {
    let folder = temporary();
    let path = folder.path();
    bad_sequences(path);
    save(&light(0, 200), &path.join("frame.png"));
    for (goal, code, words) in BAD {
        prf(path).args(["goal", "motion", goal]).assert().code(code).stdout(is_empty()).stderr(contains(words));
        for command in [&["score", goal, "frame.png"][..], &["inspect", goal]] {
            let mut command = prf(path).args(command).args(["--descriptor", "motion"]).assert();
            command = command.code(code).stdout(is_empty());
            command.stderr(starts_with(format!("error: {words}")));
        }
        config(path, goal, "");
        prf(path)
            .args(["inspect", "c.toml"])
            .assert()
            .code(code)
            .stderr(starts_with("error: c.toml:6:8: `reward.goal`: ").and(contains(words)));
    }
    assert!(!path.join("goal.png").exists());
    let faint = ["goal", "motion", "faint"];
    prf(path).args(faint).assert().stderr(contains("`threshold` to 11 or less").and(contains("try --threshold 11")));
    prf(path).args(faint).args(["--threshold", "11"]).assert().success();
    prf(path).args(["goal", "motion", "still"]).assert().stderr(contains("all frames are the same"));
}

#[test]
fn damaged_frames_are_left_out_if_asked_for() {
    let folder = ck_plus();
    let path = folder.path();
    lights(&path.join("right"), 6);
    let motion = ["goal", "motion", "right", "--skip-damaged"];
    prf(path).args(motion).assert().success().stderr(is_empty());
    cut(&path.join("right/3.png"));
    prf(path).args(["goal", "motion", "right", "--force"]).assert().code(1).stderr(contains("hint: --skip-damaged"));
    prf(path)
        .args(motion)
        .arg("--force")
        .assert()
        .code(3)
        .stdout("goal.png\n")
        .stderr(contains("error: right/3.png: the PNG is cut short").and(contains("the 5 frames that can be read")));

    cut(&path.join(FIRST).join("S005_001_00000002.png"));
    let ck = ["goal", "ck-plus", "ck", "--subject", "S005", "--out", "face.png"];
    prf(path).args(ck).assert().code(1).stderr(contains("S005_001_00000002.png: the PNG is cut short"));
    prf(path).args(ck).arg("--skip-damaged").assert().code(3).stdout("face.png\n");

    [0, 1, 2, 4].iter().for_each(|frame| cut(&path.join(format!("right/{frame}.png"))));
    prf(path)
        .args(motion)
        .assert()
        .code(1)
        .stdout(is_empty())
        .stderr(contains("right/2.png").and(contains("got 1 frame that can be read (5 damaged)")));

    // Of an animation what comes before the damage is left.
    gif(&path.join("right.gif"), 8);
    cut(&path.join("right.gif"));
    prf(path)
        .args(["goal", "motion", "right.gif"])
        .assert()
        .code(1)
        .stderr(contains("error: right.gif: the GIF is cut"));
    prf(path).args(["goal", "motion", "right.gif", "--skip-damaged", "--force"]).assert().code(3);
}

#[test]
fn a_schedule_that_forgets_everything_is_misuse_and_names_its_key() {
    let folder = temporary();
    let path = folder.path();
    lights(&path.join("stops"), 9);
    (9..15).for_each(|frame| save(&light(8, 200), &path.join(format!("stops/{frame}.png"))));
    let motion = |args: &[&str]| prf(path).args(["goal", "motion", "stops", "--force"]).args(args).assert();
    motion(&["--duration", "0.5"])
        .code(2)
        .stderr(contains("stops: 8 movements were seen, but forgotten by the sequence's end"))
        .stderr(contains("`delta.duration` is 0.5, expected at least 2.4;").and(contains("hint: try --duration 2.4")));
    motion(&["--delta-divisor", "90"]).code(2).stderr(contains("hint: try --delta-divisor 5.83"));
    // The advice helps, but only the newest movement is remembered then.
    motion(&["--duration", "2.4"])
        .success()
        .stderr(contains("warning: of 8 movements the template holds only the newest: the others are forgotten"))
        .stderr(contains("hint: take a larger `delta.duration`"));
    motion(&[]).success().stderr(is_empty());

    config(path, "stops", "[reward.motion]\ndelta = { duration = 0.5 }\n");
    prf(path)
        .args(["inspect", "c.toml", "--goal-only"])
        .assert()
        .code(2)
        .stderr(starts_with("error: c.toml:8:22: `reward.motion.delta.duration`: stops: 8 movements were seen"));
    config(path, "stops", "[reward.motion]\ndelta = { duration = 2.4 }\n");
    prf(path).args(["inspect", "c.toml", "--goal-only"]).assert().stderr(contains("warning: stops: of 8 movements"));
}

#[test]
fn a_window_larger_than_the_screen_is_named_with_sizes_and_its_line() {
    let folder = temporary();
    let path = folder.path();
    save(&GrayImage::from_fn(100, 90, |x, y| Luma([(x * y % 251) as u8])), &path.join("large.png"));
    let text = "[env]\nname = \"breakout\"\n[reward]\nsource = \"perceptual\"\ndescriptor = \"window\"\ngoal = \"large.png\"\n";
    fs::write(path.join("c.toml"), text).expect("the folder is ours");
    for command in ["inspect", "tune"] {
        prf(path).args([command, "c.toml", "--sample", "50"]).assert().code(2).stdout(is_empty()).stderr(starts_with(
            "error: c.toml:6:8: `reward.goal`: a template of 100x90 px doesn't fit into a frame of 84x84 px",
        ));
    }
}
