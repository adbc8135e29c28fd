//! Training and evaluation as a user runs them: whole small runs, interruptions, damage.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use predicates::prelude::*;
use predicates::str::contains;
use serde_json::Value;
use tempfile::TempDir;

mod common;

use common::prf;

/// Small in every respect, yet with updates, evaluations and checkpoints.
const CONFIG: &str = "\
seed = 5
[env]
name = \"breakout\"
limit_steps = 40
[reward]
source = \"perceptual\"
descriptor = \"direct\"
goal = \"black.png\"
[train]
steps = 640
environments = 4
batch_size = 8
replay_steps = 400
learning_starts = 100
steps_per_update = 16
threads = 1
checkpoint_every_steps = 100
[evaluation]
every_episodes = 8
episodes = 3
";

fn folder() -> TempDir {
    let folder = tempfile::tempdir().expect("a temporary folder can be made");
    image::GrayImage::new(84, 84).save(folder.path().join("black.png")).expect("the folder is ours");
    fs::write(folder.path().join("c.toml"), CONFIG).expect("the folder is ours");
    folder
}

fn train(folder: &Path, args: &[&str]) -> assert_cmd::assert::Assert {
    prf(folder).args(["train", "c.toml"]).args(args).assert()
}

/// `metrics.jsonl` of a run without what depends on the clock.
fn metrics(run: &Path) -> Vec<Value> {
    let text = fs::read_to_string(run.join("metrics.jsonl")).expect("a run has metrics");
    let without_times = |line: &str| {
        let mut record: Value = serde_json::from_str(line).expect("each line is JSON");
        let fields = record.as_object_mut().expect("each line is an object");
        fields.retain(|key, _| key != "time_s" && key != "steps_per_s");
        record
    };
    text.lines().map(without_times).collect()
}

/// The run's newest checkpoint.
fn newest(run: &Path) -> PathBuf {
    let names = fs::read_dir(run.join("checkpoints")).expect("a run has checkpoints");
    let paths = names.map(|entry| entry.expect("it can be listed").path());
    paths.filter(|path| path.to_string_lossy().contains("step-")).max().expect("there is one")
}

/// Starts a run and waits until it has written its first checkpoint.
fn start(folder: &Path) -> std::process::Child {
    start_as(Command::new(assert_cmd::cargo::cargo_bin!("prf")).current_dir(folder), folder)
}

fn start_as(command: &mut Command, folder: &Path) -> std::process::Child {
    command.args(["train", "c.toml", "--out", "run", "--set", "train.steps=100000"]);
    let child = command.stdout(Stdio::null()).stderr(Stdio::piped()).spawn().expect("prf starts");
    let deadline = Instant::now() + Duration::from_secs(240);
    let saved = |entry: std::io::Result<fs::DirEntry>| {
        entry.is_ok_and(|e| e.file_name().to_string_lossy().starts_with("step-"))
    };
    while !fs::read_dir(folder.join("run/checkpoints")).is_ok_and(|mut entries| entries.any(saved)) {
        assert!(Instant::now() < deadline, "no checkpoint was written");
        std::thread::sleep(Duration::from_millis(20));
    }
    child
}

fn signal(child: &std::process::Child, name: &str) {
    let status = Command::new("kill").args([name, &child.id().to_string()]).status().expect("kill runs");
    assert!(status.success());
}

#[test]
fn a_run_folder_holds_everything_and_can_be_evaluated() {
    let folder = folder();
    let run = folder.path().join("run");
    train(folder.path(), &["--out", "run"])
        .success()
        .stdout("run\n")
        .stderr(contains("greedy score").and(contains("finished")).and(contains("updates")));
    for name in ["config.toml", "goal.png", "metrics.jsonl", "manifest.json", "checkpoints/best/model.safetensors"] {
        assert!(run.join(name).is_file(), "{name} is missing");
    }
    let kinds: Vec<Value> = metrics(&run).iter().map(|record| record["kind"].clone()).collect();
    assert!(kinds.len() >= 4 && kinds.iter().all(|kind| kind == "train" || kind == "evaluation"), "{kinds:?}");

    let output = prf(folder.path())
        .args(["eval", "run", "--episodes", "5", "--format", "json", "--render", "play.gif"])
        .assert()
        .success();
    let report: Value = serde_json::from_slice(&output.get_output().stdout).expect("one JSON object");
    assert_eq!(report["episodes"], 5);
    for key in ["mean_score", "std_score", "oracle_score", "random_score", "mean_reward", "mean_steps"] {
        assert!(report[key].is_number(), "{key} is missing in {report}");
    }
    assert!(report["oracle_score"].as_f64() > report["random_score"].as_f64());
    let gif = fs::File::open(folder.path().join("play.gif")).expect("it was drawn");
    let gif = image::codecs::gif::GifDecoder::new(std::io::BufReader::new(gif)).expect("it is a GIF");
    let frames = image::AnimationDecoder::into_frames(gif).collect_frames().expect("whole frames");
    assert!((2..=41).contains(&frames.len()), "{} frames", frames.len());
    assert_eq!(frames[0].buffer().dimensions(), (336, 336));

    for path in [newest(&run), newest(&run).join("model.safetensors"), run.join("checkpoints/best")] {
        prf(folder.path())
            .arg("eval")
            .arg(path)
            .args(["--episodes", "1"])
            .assert()
            .success()
            .stdout(contains("oracle"));
    }
}

#[test]
fn a_run_folder_that_exists_is_left_alone() {
    let folder = folder();
    fs::create_dir(folder.path().join("run")).expect("the folder is ours");
    fs::write(folder.path().join("run/mine.txt"), "precious").expect("the folder is ours");
    train(folder.path(), &["--out", "run"]).code(2).stderr(contains("run is there already").and(contains("--resume")));
    let left: Vec<_> = fs::read_dir(folder.path().join("run")).expect("it is there").collect();
    assert_eq!(left.len(), 1, "something was written");
}

#[test]
fn an_interrupted_run_is_saved_and_resumes_to_the_same_records() {
    let folder = folder();
    let child = start(folder.path());
    signal(&child, "-INT");
    let output = child.wait_with_output().expect("prf ends");
    let words = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(130), "{words}");
    assert!(words.contains("prf train c.toml --out run --resume --set train.steps=100000"), "{words}");
    resumes_like_an_uninterrupted_run(&folder);
}

#[test]
fn a_run_outlives_its_terminal_if_it_was_told_to() {
    let folder = folder();
    let run = folder.path().join("run");
    let mut command = Command::new("sh");
    // What `nohup` does.
    command.current_dir(folder.path()).args(["-c", "trap '' HUP; exec \"$0\" \"$@\""]);
    let mut child = start_as(command.arg(assert_cmd::cargo::cargo_bin!("prf")), folder.path());
    let written = metrics_lines(&run);
    signal(&child, "-HUP");
    let deadline = Instant::now() + Duration::from_secs(240);
    while metrics_lines(&run) < written + 2 {
        assert!(Instant::now() < deadline, "the run stands still");
        assert!(child.try_wait().expect("it is ours").is_none(), "it has ended");
        std::thread::sleep(Duration::from_millis(20));
    }
    signal(&child, "-TERM");
    assert_eq!(child.wait_with_output().expect("prf ends").status.code(), Some(130));
}

#[test]
fn a_killed_run_resumes_to_the_same_records() {
    let folder = folder();
    let child = start(folder.path());
    signal(&child, "-KILL");
    child.wait_with_output().expect("prf ends");
    resumes_like_an_uninterrupted_run(&folder);
}

/// Resumes the run that was stopped, stops it again a little later, and compares its records with those of another
/// run of the same seed.
fn resumes_like_an_uninterrupted_run(folder: &TempDir) {
    let run = folder.path().join("run");
    let before = metrics_lines(&run);
    let mut command = Command::new(assert_cmd::cargo::cargo_bin!("prf"));
    command.current_dir(folder.path()).args([
        "train",
        "c.toml",
        "--out",
        "run",
        "--set",
        "train.steps=100000",
        "--resume",
    ]);
    let child = command.stdout(Stdio::null()).stderr(Stdio::piped()).spawn().expect("prf starts");
    let deadline = Instant::now() + Duration::from_secs(240);
    while metrics_lines(&run) < before + 4 {
        assert!(Instant::now() < deadline, "the resumed run does not go on");
        std::thread::sleep(Duration::from_millis(20));
    }
    signal(&child, "-INT");
    let output = child.wait_with_output().expect("prf ends");
    assert_eq!(output.status.code(), Some(130));
    assert!(String::from_utf8_lossy(&output.stderr).contains("going on from step"), "it started over");

    let resumed = metrics(&run);
    let steps = resumed.iter().filter_map(|record| record["step"].as_u64()).max().expect("records have steps");
    let steps = format!("train.steps={}", steps + 400);
    // The length of the run decides nothing but when it ends: no learning rate decays here.
    train(folder.path(), &["--out", "whole", "--set", &steps]).success();
    let whole = metrics(&folder.path().join("whole"));
    assert_eq!(resumed[..], whole[..resumed.len()]);
}

fn metrics_lines(run: &Path) -> usize {
    fs::read_to_string(run.join("metrics.jsonl")).map_or(0, |text| text.lines().count())
}

#[test]
fn resuming_needs_the_run_and_its_own_config() {
    let folder = folder();
    train(folder.path(), &["--out", "run", "--resume"]).code(2).stderr(contains("no run to resume in run"));
    train(folder.path(), &["--out", "run"]).success();
    train(folder.path(), &["--out", "run", "--resume", "--seed", "6"])
        .code(2)
        .stderr(contains("another config or seed").and(contains("prf train run/config.toml --out run --resume")));
    train(folder.path(), &["--out", "run", "--resume"]).success();
    prf(folder.path()).args(["train", "run/config.toml", "--out", "run", "--resume"]).assert().success();
}

#[test]
fn a_checkpoint_cut_short_is_named_and_the_one_before_it_serves() {
    let folder = folder();
    let run = folder.path().join("run");
    train(folder.path(), &["--out", "run"]).success();
    let model = newest(&run).join("model.safetensors");
    let bytes = fs::read(&model).expect("it was written");
    fs::write(&model, &bytes[..bytes.len() / 2]).expect("the folder is ours");
    let named = || contains("model.safetensors").and(contains("expected a whole")).and(contains("hint: "));
    train(folder.path(), &["--out", "run", "--resume"]).code(1).stderr(named());
    prf(folder.path()).args(["eval", "run"]).assert().code(1).stderr(named());
    fs::remove_dir_all(newest(&run)).expect("the folder is ours");
    train(folder.path(), &["--out", "run", "--resume"]).success();
}

#[test]
fn a_checkpoint_of_another_network_is_refused_with_both_shapes() {
    let folder = folder();
    train(folder.path(), &["--out", "run"]).success();
    let model = newest(&folder.path().join("run")).join("model.safetensors");
    // The same network, but its header now says that it was made for another picture.
    let bytes = fs::read(&model).expect("it was written");
    let at = bytes.windows(7).position(|window| window == b"[84,84]").expect("the header names the input");
    let mut other = bytes.clone();
    other[at..at + 7].copy_from_slice(b"[92,92]");
    fs::write(&model, other).expect("the folder is ours");
    prf(folder.path())
        .args(["eval", "run"])
        .assert()
        .code(1)
        .stderr(contains("model.safetensors").and(contains("got")).and(contains("expected")));
}

/// `prf train c.toml` with `args` where no file may grow beyond 8 MB, half of a checkpoint: what a full disk does to a write in
/// mid-file.
fn train_on_a_full_disk(folder: &Path, args: &str) -> assert_cmd::assert::Assert {
    let prf = assert_cmd::cargo::cargo_bin!("prf");
    let script = format!("ulimit -f 8192; exec '{}' train c.toml {args}", prf.display());
    assert_cmd::Command::new("bash").args(["-c", &script]).current_dir(folder).assert()
}

/// Every file below a folder with what it holds.
fn contents(folder: &Path) -> Vec<(PathBuf, Vec<u8>)> {
    let entries = fs::read_dir(folder).expect("it is there").map(|entry| entry.expect("it can be listed").path());
    let mut files: Vec<_> = entries
        .flat_map(|path| {
            if path.is_dir() { contents(&path) } else { vec![(path.clone(), fs::read(&path).expect("it is ours"))] }
        })
        .collect();
    files.sort();
    files
}

#[test]
fn a_full_disk_ends_the_run_and_leaves_no_half_checkpoint() {
    let folder = folder();
    train_on_a_full_disk(folder.path(), "--out full").code(1).stderr(
        contains("cannot write full/checkpoints/")
            .and(contains("make room, then go on with\n"))
            .and(contains("--resume")),
    );
    assert_eq!(contents(&folder.path().join("full/checkpoints")), []);
    // With room again, the run goes on.
    train(folder.path(), &["--out", "full", "--resume"])
        .success()
        .stderr(contains("the run has no checkpoint yet: starting from its beginning"));
}

#[test]
fn a_disk_that_fills_up_leaves_the_checkpoints_before_as_they_were() {
    let folder = folder();
    let run = folder.path().join("run");
    train(folder.path(), &["--out", "run"]).success();
    let (whole, last) = (metrics(&run), contents(&newest(&run)));
    fs::remove_dir_all(newest(&run)).expect("the folder is ours");
    let before = contents(&newest(&run));
    train_on_a_full_disk(folder.path(), "--out run --resume")
        .code(1)
        .stderr(contains("what was saved before is whole"));
    assert_eq!(contents(&newest(&run)), before);
    train(folder.path(), &["--out", "run", "--resume"]).success().stderr(contains("going on from step"));
    let model =
        |files: &[(PathBuf, Vec<u8>)]| files.iter().find(|(path, _)| path.ends_with("model.safetensors")).cloned();
    assert_eq!(metrics(&run), whole);
    assert!(model(&contents(&newest(&run))) == model(&last), "the models differ");
}

#[test]
fn a_run_that_diverges_says_where_and_saves_that_moment() {
    let folder = folder();
    train(folder.path(), &["--out", "run", "--set", "train.reward_scale=1e39", "--set", "train.learning_rate=1"])
        .code(1)
        .stderr(
            contains("learning diverged at step 116: the loss of update 0 is inf, with rewards from ")
                .and(contains("targets 8 of 8 infinite or NaN"))
                .and(contains("hint: start anew with a lower train.learning_rate"))
                .and(contains("run/diverged has the network and the batch of that moment")),
        );
    let names: Vec<_> = contents(&folder.path().join("run/diverged")).into_iter().map(|(path, _)| path).collect();
    let expected = ["batch.safetensors", "model.safetensors", "report.json", "state.safetensors"];
    assert_eq!(names, expected.map(|name| folder.path().join("run/diverged").join(name)));
    // The network of before can be played.
    prf(folder.path()).args(["eval", "run/diverged", "--episodes", "1"]).assert().success();
}

#[test]
fn a_run_stays_with_its_precision_wherever_it_is_resumed() {
    for (precision, other) in [("bf16", "f32"), ("f32", "bf16")] {
        let folder = folder();
        train(folder.path(), &["--out", "run", "--set", &format!("train.precision={precision:?}")]).success();
        // The config says nothing of it, which is `auto`.
        train(folder.path(), &["--out", "run", "--resume"]).success();
        train(folder.path(), &["--out", "run", "--resume", "--set", &format!("train.precision={other:?}")])
            .code(2)
            .stderr(contains("was started with another config"));
        let config = fs::read_to_string(folder.path().join("run/config.toml")).expect("it was written");
        assert!(config.contains(&format!("precision = {precision:?}")), "{config}");
    }
}

#[test]
fn a_checkpoint_of_another_prf_is_refused_with_what_to_do() {
    let folder = folder();
    let run = folder.path().join("run");
    train(folder.path(), &["--out", "run"]).success();
    let model = newest(&run).join("model.safetensors");
    let whole = fs::read(&model).expect("it was written");
    let ours = br#"\"format\":3,"#;
    let at = whole.windows(ours.len()).position(|window| window == ours).expect("the header names the format");
    let cases: [(&[u8], &str, &str); 2] = [
        (br#"\"format\":7,"#, "got format 7 of prf 0.1.0", "hint: use prf 0.1.0 or a newer one"),
        (br#"\"former\":1,"#, "got format 1 of prf 0.1.0", "hint: train anew with another --out"),
    ];
    for (other, got, hint) in cases {
        let mut bytes = whole.clone();
        bytes[at..at + other.len()].copy_from_slice(other);
        fs::write(&model, bytes).expect("the folder is ours");
        let before = contents(&run);
        let refused =
            || contains("model.safetensors").and(contains(got)).and(contains("expected format 3")).and(contains(hint));
        train(folder.path(), &["--out", "run", "--resume"]).code(1).stderr(refused());
        prf(folder.path()).args(["eval", "run"]).assert().code(1).stderr(refused());
        assert!(contents(&run) == before, "something was changed");
    }
}

#[test]
fn of_two_runs_begun_in_one_folder_at_once_one_is_refused() {
    let folder = folder();
    let begin = |seed: &str| {
        let mut command = Command::new(assert_cmd::cargo::cargo_bin!("prf"));
        command.current_dir(folder.path()).args(["train", "c.toml", "--out", "run", "--seed", seed]);
        command.stdout(Stdio::null()).stderr(Stdio::piped()).spawn().expect("prf starts")
    };
    let outputs = [begin("1"), begin("2")].map(|child| child.wait_with_output().expect("prf ends"));
    let winner = outputs.iter().position(|output| output.status.success()).expect("one of them trains");
    let refused = &outputs[1 - winner];
    let words = String::from_utf8_lossy(&refused.stderr);
    assert!(matches!(refused.status.code(), Some(1 | 2)) && words.contains("hint: "), "{words}");
    let config = fs::read_to_string(folder.path().join("run/config.toml")).expect("a run has a config");
    assert!(config.contains(&format!("seed = {}\n", winner + 1)), "{config}");
    let seed = (winner + 1).to_string();
    train(folder.path(), &["--out", "run", "--resume", "--seed", &seed]).success();
}

#[test]
fn a_run_folder_in_use_is_refused() {
    let folder = folder();
    let child = start(folder.path());
    let more = ["--out", "run", "--resume", "--set", "train.steps=100000"];
    let second = train(folder.path(), &more);
    signal(&child, "-KILL");
    child.wait_with_output().expect("prf ends");
    second.code(1).stderr(contains("metrics.jsonl is being written by another prf").and(contains("hint: wait until")));
}

#[test]
fn a_goal_too_small_for_the_cells_is_refused_before_anything_is_written() {
    let folder = folder();
    train(folder.path(), &["--out", "run", "--set", "reward.hog.cell={px=100}"])
        .code(2)
        .stderr(contains("`reward.hog`").and(contains("84")));
    assert!(!folder.path().join("run").exists());
}

#[test]
fn a_dry_run_prints_config_memory_and_time_and_starts_nothing() {
    let folder = folder();
    let output = train(folder.path(), &["--dry-run", "--out", "run", "--set", "train.replay_steps=1000000"]).success();
    let text = String::from_utf8_lossy(&output.get_output().stdout).into_owned();
    assert!(text.contains("# replay memory: 7.0") && text.contains("# time on this machine: about"), "{text}");
    let config: toml::Table = text.parse().expect("what is printed is a config");
    assert_eq!(config["train"]["gamma"].as_float(), Some(0.99));
    assert!(!folder.path().join("run").exists() && !folder.path().join("runs").exists());
}

#[cfg(not(target_os = "macos"))]
#[test]
fn a_device_that_is_not_there_is_refused() {
    let folder = folder();
    train(folder.path(), &["--device", "mps"]).code(1).stderr(contains("device mps is not available, expected cpu"));
    assert!(!folder.path().join("runs").exists());
}

#[test]
fn there_is_nothing_to_evaluate_in_an_empty_folder() {
    let folder = folder();
    prf(folder.path())
        .args(["eval", "nowhere"])
        .assert()
        .code(2)
        .stderr(contains("no run with a checkpoint in nowhere"));
}
