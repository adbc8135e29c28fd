//! `prf play` without a terminal, run as a user runs it.

use std::fs;
use std::path::Path;

use image::AnimationDecoder as _;
use image::codecs::gif::GifDecoder;
use predicates::prelude::*;
use predicates::str::{contains, is_empty};
use prf_core::{Frame, io};
use prf_envs::{EnvConfig, Environment, registry};
use tempfile::TempDir;

mod common;

use common::prf;

fn folder() -> TempDir {
    tempfile::tempdir().expect("a temporary folder can be made")
}

/// The frames, `scale` times their own size, that the oracle sees in the first `steps` steps of an episode.
fn oracle_frames(name: &str, seed: u64, steps: usize, scale: usize) -> Vec<Frame> {
    let mut world = registry::make(&EnvConfig::new(name)).expect("it is registered");
    world.reset(seed);
    let draw = |world: &dyn Environment| {
        let mut frame = Frame::new(world.spec().width * scale, world.spec().height * scale);
        world.draw_into(&mut frame);
        frame
    };
    let mut frames = vec![draw(world.as_ref())];
    for _ in 0..steps {
        world.step(world.oracle_action()).expect("the episode is long enough");
        frames.push(draw(world.as_ref()));
    }
    frames
}

/// Each frame of a GIF as greys, and for how many ms it is shown.
fn gif_frames(path: &Path) -> Vec<(Frame, u32)> {
    let file = std::io::BufReader::new(fs::File::open(path).expect("it was written"));
    let frames = GifDecoder::new(file).expect("it is a GIF").into_frames().collect_frames().expect("it is whole");
    let grey = |frame: image::Frame| {
        let (numerator, denominator) = frame.delay().numer_denom_ms();
        let rgba = frame.into_buffer();
        let (width, height) = rgba.dimensions();
        assert!(rgba.pixels().all(|pixel| pixel[0] == pixel[1] && pixel[1] == pixel[2] && pixel[3] == 255));
        let greys = rgba.pixels().map(|pixel| pixel[0]).collect();
        (Frame::from_vec(width as usize, height as usize, greys).expect("that is its size"), numerator / denominator)
    };
    frames.into_iter().map(grey).collect()
}

#[test]
fn the_score_is_the_result() {
    prf(".".as_ref())
        .args(["play", "breakout", "--player", "oracle", "--seed", "3"])
        .assert()
        .success()
        .stdout("breakout, seed 3, played by oracle\n  score   3\n  reward  3.00\n  steps   100, truncated\n")
        .stderr(is_empty());
    prf(".".as_ref())
        .args(["play", "flappy", "--player", "random", "--format", "json"])
        .assert()
        .success()
        .stdout(
            contains(r#"{"world":"flappy","player":"random","seed":0,"steps":"#)
                .and(contains(r#""ending":"terminated"}"#)),
        )
        .stderr(is_empty());
}

#[test]
fn steps_cut_the_episode_off_or_lengthen_it() {
    for (steps, ending) in [("7", "truncated"), ("150", "truncated")] {
        prf(".".as_ref())
            .args(["play", "breakout", "--player", "oracle", "--steps", steps])
            .assert()
            .success()
            .stdout(contains(format!("steps   {steps}, {ending}\n")));
    }
}

#[test]
fn the_gif_shows_every_frame_as_the_world_draws_it() {
    let folder = folder();
    for (world, scale, args) in
        [("breakout", 4, &["--fps", "20"][..]), ("flappy", 2, &["--scale", "2", "--steps", "40", "--fps", "20"])]
    {
        let name = format!("{world}.gif");
        prf(folder.path())
            .args(["play", world, "--player", "oracle", "--seed", "3", "--gif", &name])
            .args(args)
            .assert()
            .success()
            .stderr(contains(format!("frames into {name}")));
        let steps = if world == "breakout" { 100 } else { 40 };
        let expected: Vec<_> = oracle_frames(world, 3, steps, scale).into_iter().map(|frame| (frame, 50)).collect();
        let drawn = gif_frames(&folder.path().join(&name));
        assert_eq!(drawn.len(), steps + 1);
        assert!(drawn == expected, "{world}: every pixel of every frame");
    }
}

#[test]
fn long_gifs_stay_small() {
    let folder = folder();
    for world in ["breakout", "flappy"] {
        prf(folder.path())
            .args(["play", world, "--player", "oracle", "--steps", "299", "--scale", "2", "--force", "--gif", "a.gif"])
            .assert()
            .success();
        let bytes = fs::metadata(folder.path().join("a.gif")).expect("it was written").len();
        assert!(bytes < 600_000, "{world}: {bytes} bytes");
    }
}

#[test]
fn frames_are_numbered_by_their_step() {
    let folder = folder();
    prf(folder.path())
        .args(["play", "breakout", "--player", "oracle", "--steps", "12", "--frames", "new/frames"])
        .assert()
        .success()
        .stderr("note: wrote 13 frames into new/frames\n");
    for (step, expected) in oracle_frames("breakout", 0, 12, 1).iter().enumerate() {
        let path = folder.path().join(format!("new/frames/{step:04}.png"));
        assert_eq!(&io::read_frame(&path).expect("it was written"), expected, "{}", path.display());
    }
    assert_eq!(fs::read_dir(folder.path().join("new/frames")).expect("it is there").count(), 13);
}

#[test]
fn the_motion_goal_is_that_of_the_frames() {
    let folder = folder();
    let options: [&[&str]; 2] = [&[], &["--tau-step", "0.3", "--delta-divisor", "4", "--threshold", "10"]];
    for options in options {
        prf(folder.path())
            .args(["play", "flappy", "--player", "oracle", "--steps", "25", "--force"])
            .args(["--frames", "frames", "--motion-goal", "played.png"])
            .args(options)
            .assert()
            .success()
            .stderr(contains("wrote the motion template of 26 frames into played.png"));
        let made = ["goal", "motion", "frames", "--out", "made.png", "--force"];
        prf(folder.path()).args(made).args(options).assert().success();
        let [played, made] = ["played.png", "made.png"].map(|name| fs::read(folder.path().join(name)).expect(name));
        assert_eq!(played, made);
    }
}

#[test]
fn motion_goals_in_which_nothing_moves_are_warned_of() {
    let folder = folder();
    prf(folder.path())
        .args(["play", "flappy", "--player", "oracle", "--steps", "2", "--threshold", "254", "--motion-goal", "g.png"])
        .assert()
        .success()
        .stderr(contains("nothing moves in the goal").and(contains("hint: ")));
}

#[test]
fn what_is_there_is_kept_unless_forced() {
    let folder = folder();
    let recorded = ["play", "breakout", "--player", "oracle", "--steps", "3"];
    fs::write(folder.path().join("mine.gif"), "mine").expect("a file can be written");
    fs::write(folder.path().join("mine.png"), "mine").expect("a file can be written");
    fs::create_dir(folder.path().join("filled")).expect("a folder can be made");
    fs::write(folder.path().join("filled/0007.png"), "old").expect("a file can be written");
    fs::write(folder.path().join("filled/notes.txt"), "mine").expect("a file can be written");
    let places: [[&str; 2]; 3] = [["--gif", "mine.gif"], ["--motion-goal", "mine.png"], ["--frames", "filled"]];
    for place in places {
        prf(folder.path())
            .args(recorded)
            .args(place)
            .args(["--format", "json"])
            .assert()
            .code(1)
            .stdout(is_empty())
            .stderr(contains(format!("{} ", place[1])).and(contains("left as it is")).and(contains("--force")));
    }
    assert_eq!(fs::read(folder.path().join("mine.gif")).expect("it is there"), b"mine");

    prf(folder.path()).args(recorded).args(places.concat()).arg("--force").assert().success();
    assert_eq!(gif_frames(&folder.path().join("mine.gif")).len(), 4);
    let mut names: Vec<_> = fs::read_dir(folder.path().join("filled"))
        .expect("it is there")
        .map(|entry| entry.expect("it can be read").file_name().into_string().expect("it is text"))
        .collect();
    names.sort();
    assert_eq!(names, ["0000.png", "0001.png", "0002.png", "0003.png", "notes.txt"]);
}

#[test]
fn what_can_be_written_is_written_although_another_place_fails() {
    let folder = folder();
    fs::write(folder.path().join("file"), "").expect("a file can be written");
    prf(folder.path())
        .args(["play", "breakout", "--player", "oracle", "--steps", "3"])
        .args(["--gif", "file/below.gif", "--motion-goal", "goal.png"])
        .assert()
        .code(1)
        .stdout(contains("score   "))
        .stderr(contains("cannot write file/below.gif").and(contains("wrote the motion template")));
    assert!(folder.path().join("goal.png").is_file());
}

#[test]
fn mistakes_are_named() {
    let folder = folder();
    fs::write(folder.path().join("file"), "").expect("a file can be written");
    let oracle = |args: &[&'static str]| [&["breakout", "--player", "oracle"], args].concat();
    for (args, words) in [
        (vec!["brekout"], "possible values: breakout, flappy"),
        (vec!["brekout"], "a similar value exists: 'breakout'"),
        (vec!["breakout"], "you can only play in a terminal"),
        (vec!["breakout", "--gif", "a.gif"], "hint: let another player play: --player oracle"),
        (oracle(&["--steps", "0"]), "0 is not in 1.."),
        (oracle(&["--fps", "51"]), "51 is not in 1..=50"),
        (oracle(&["--gif", "a.gif", "--scale", "17"]), "17 is not in 1..=16"),
        (oracle(&["--gif", "a.png"]), "expected a name that ends in .gif"),
        (oracle(&["--motion-goal", "a.gif"]), "expected a name that ends in .png"),
        (oracle(&["--scale", "2"]), "--gif <FILE.gif>"),
        (oracle(&["--tau-step", "0.3"]), "--motion-goal <FILE.png>"),
        (oracle(&["--motion-goal", "a.png", "--tau-step", "0"]), "--tau-step: got 0"),
        (oracle(&["--frames", "file"]), "--frames: file is a file, expected a folder"),
    ] {
        prf(folder.path()).arg("play").args(&args).assert().code(2).stdout(is_empty()).stderr(contains(words));
    }
    assert_eq!(fs::read_dir(folder.path()).expect("it is there").count(), 1, "nothing was written");
}

/// The same exit code and the same care as where a person interrupts.
#[cfg(unix)]
#[test]
fn an_interrupted_episode_is_recorded_up_to_there() {
    use std::process::{Command, Stdio};

    let folder = folder();
    let child = Command::new(assert_cmd::cargo::cargo_bin!("prf"))
        .current_dir(folder.path())
        .args(["play", "flappy", "--player", "oracle", "--steps", "4000000000", "--motion-goal", "goal.png"])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("prf starts");
    std::thread::sleep(std::time::Duration::from_millis(1_500));
    let kill = Command::new("kill").args(["-INT", &child.id().to_string()]).status();
    assert!(kill.expect("the tests need kill").success());
    let output = child.wait_with_output().expect("prf ends");
    assert_eq!(output.status.code(), Some(130));
    assert!(String::from_utf8_lossy(&output.stdout).contains("stopped\n"));
    assert!(folder.path().join("goal.png").is_file());
}
