//! `prf goal`, run as a user runs it.

use std::path::Path;

use image::{Delay, Frame as GifFrame, GrayAlphaImage, GrayImage, Luma, LumaA};
use predicates::prelude::*;
use predicates::str::{contains, is_empty};
use tempfile::TempDir;

mod common;

use common::prf;

fn folder() -> TempDir {
    tempfile::tempdir().expect("a temporary folder can be made")
}

/// 20×10 px; the grey of a pixel says where it is.
fn screenshot(path: &Path) {
    GrayImage::from_fn(20, 10, |x, y| Luma([(10 * y + x) as u8 + 1])).save(path).expect("a PNG can be written");
}

fn read(path: &Path) -> GrayImage {
    image::open(path).expect("a PNG was written").into_luma8()
}

#[test]
fn crop_cuts_out_exactly_that_part() {
    let folder = folder();
    screenshot(&folder.path().join("screen.png"));
    prf(folder.path())
        .args(["goal", "crop", "screen.png", "--rect", "3,2,5,4", "--out", "part.png"])
        .assert()
        .success()
        .stdout("part.png\n")
        .stderr(is_empty());
    let part = read(&folder.path().join("part.png"));
    assert_eq!(part.dimensions(), (5, 4));
    assert_eq!([part.get_pixel(0, 0)[0], part.get_pixel(4, 3)[0]], [24, 58]);
}

#[test]
fn paste_leaves_the_picture_where_the_cut_out_is_transparent() {
    let folder = folder();
    screenshot(&folder.path().join("screen.png"));
    let bird = GrayAlphaImage::from_fn(3, 2, |x, _| LumaA([200, if x == 1 { 0 } else { 255 }]));
    bird.save(folder.path().join("bird.png")).expect("a PNG can be written");
    let paste = ["goal", "paste", "screen.png", "bird.png", "--at", "6,5", "--out"];
    prf(folder.path()).args(paste).arg("whole.png").assert().success();
    let whole = read(&folder.path().join("whole.png"));
    assert_eq!(whole.dimensions(), (20, 10));
    assert_eq!([5, 6, 7, 8, 9].map(|x| whole.get_pixel(x, 5)[0]), [56, 200, 58, 200, 60]);

    prf(folder.path()).args(paste).args(["part.png", "--crop", "5,4,6,5"]).assert().success();
    let part = read(&folder.path().join("part.png"));
    assert_eq!(part.dimensions(), (6, 5));
    assert_eq!([0, 1, 2, 3, 4].map(|x| part.get_pixel(x, 1)[0]), [56, 200, 58, 200, 60]);
}

/// A bar that moves down by `step` rows a frame.
fn animation(path: &Path, step: u32) {
    let file = std::fs::File::create(path).expect("a file can be made");
    let mut gif = image::codecs::gif::GifEncoder::new(file);
    for index in 0..4 {
        let bar = GrayImage::from_fn(24, 24, |x, y| {
            Luma([if (4..20).contains(&x) && (0..4).contains(&(y.wrapping_sub(2 + index * step))) { 255 } else { 0 }])
        });
        let rgba = image::DynamicImage::ImageLuma8(bar).into_rgba8();
        gif.encode_frame(GifFrame::from_parts(rgba, 0, 0, Delay::from_numer_denom_ms(100, 1))).expect("it is a frame");
    }
}

#[test]
fn motion_draws_the_newest_movement_brightest() {
    let folder = folder();
    animation(&folder.path().join("bar.gif"), 4);
    prf(folder.path()).args(["goal", "motion", "bar.gif"]).assert().success().stdout("goal.png\n").stderr(is_empty());
    let goal = read(&folder.path().join("goal.png"));
    // Movements at τ = 0.1, 0.5 and 0.9; each takes in where the bar was and where it came to be.
    let grey = |tau: f64| (255.0 * tau / 0.9f64).round() as u8;
    assert_eq!([3, 7, 11, 15, 19].map(|y| goal.get_pixel(10, y)[0]), [grey(0.1), grey(0.5), 255, 255, 0]);
}

#[test]
fn bad_goals_are_written_with_a_warning() {
    let folder = folder();
    screenshot(&folder.path().join("screen.png"));
    GrayImage::new(30, 30).save(folder.path().join("black.png")).expect("a PNG can be written");
    for (args, words) in [
        (&["crop", "black.png", "--rect", "1,1,9,9"][..], "all black, which matches nothing"),
        (&["crop", "screen.png", "--rect", "3,3,1,1"], "one even grey (34)"),
    ] {
        prf(folder.path())
            .arg("goal")
            .args(args)
            .arg("--force")
            .assert()
            .success()
            .stderr(contains(words).and(contains("hint: ")));
    }
}

#[test]
fn mistakes_are_named_and_write_nothing() {
    let folder = folder();
    screenshot(&folder.path().join("screen.png"));
    animation(&folder.path().join("still.gif"), 0);
    for (args, code, words) in [
        (
            &["crop", "screen.png", "--rect", "18,2,5,4"][..],
            2,
            "reach over the border of screen.png, which is 20x10 px",
        ),
        (&["crop", "screen.png", "--rect", "3,2,5"], 2, "expected X,Y,WIDTH,HEIGHT"),
        (&["crop", "screen.png", "--rect", "3,2,0,4"], 2, "at least 1"),
        (&["crop", "screen.png", "--rect", "18446744073709551615,2,5,4"], 2, "reach over the border"),
        (&["paste", "screen.png", "screen.png", "--at", "1,0"], 2, "--at: 20x10 px at (1, 0) reach over"),
        (&["paste", "screen.png", "screen.png", "--at", "0,0", "--crop", "0,0,21,1"], 2, "--crop: "),
        (&["motion", "screen.png"], 2, "a single picture, in which nothing can move"),
        (&["motion", "still.gif"], 1, "nothing moves: the largest change of a pixel"),
        (&["motion", "nowhere.gif"], 1, "no such file"),
        (&["motion", "screen.png", "--tau-step", "0"], 2, "--tau-step: got 0"),
        (&["crop", "nowhere.png", "--rect", "0,0,1,1"], 1, "no such file"),
    ] {
        prf(folder.path()).arg("goal").args(args).assert().code(code).stdout(is_empty()).stderr(contains(words));
    }
    assert!(!folder.path().join("goal.png").exists());

    std::fs::write(folder.path().join("goal.png"), "mine").expect("a file can be written");
    prf(folder.path())
        .args(["goal", "crop", "screen.png", "--rect", "0,0,9,9"])
        .assert()
        .code(1)
        .stderr(contains("exists already").and(contains("--force")));
    assert_eq!(std::fs::read(folder.path().join("goal.png")).expect("it is there"), b"mine");
}
