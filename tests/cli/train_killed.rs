//! `kill -9` at any moment: a run that was killed again and again ends as one that was left alone.
#![cfg(unix)]

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant, SystemTime};

use serde_json::Value;

/// Small, with a replay that overflows and everything that has to be remembered.
const CONFIG: &str = "\
seed = 5
[env]
name = \"breakout\"
limit_steps = 40
[reward]
source = \"perceptual\"
descriptor = \"direct\"
goal = \"black.png\"
form = \"potential\"
[train]
steps = 1000
environments = 4
batch_size = 4
replay_steps = 400
learning_starts = 100
steps_per_update = 20
target_every_updates = 10
n_step = 3
dueling = true
threads = 1
checkpoint_every_steps = 200
prioritized = {}
[evaluation]
every_episodes = 8
episodes = 2
";
const KILLS: usize = 6;

/// Names the seed of the moments, to try the same again.
const SEED: &str = "PRF_KILL_SEED";

/// Where moments come from: SplitMix64.
struct Moments(u64);

impl Moments {
    fn of_this_run() -> Self {
        let now = || SystemTime::now().duration_since(SystemTime::UNIX_EPOCH).map_or(0, |time| time.as_nanos() as u64);
        let seed = std::env::var(SEED).ok().and_then(|text| text.parse().ok()).unwrap_or_else(now);
        println!("{SEED}={seed}");
        Self(seed)
    }

    /// A time from nothing to `longest`.
    fn within(&mut self, longest: Duration) -> Duration {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mixed = (self.0 ^ self.0 >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let mixed = (mixed ^ mixed >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        longest.mul_f64((mixed >> 11) as f64 / (1u64 << 53) as f64)
    }
}

/// Starts the run in `out`, or goes on with it if it has begun.
fn start(folder: &Path, out: &str) -> Child {
    let mut command = Command::new(assert_cmd::cargo::cargo_bin!("prf"));
    command.current_dir(folder).args(["train", "c.toml", "--out", out]);
    if folder.join(out).join("config.toml").exists() {
        command.arg("--resume");
    }
    command.stdout(Stdio::null()).stderr(Stdio::piped()).spawn().expect("prf starts")
}

fn finish(child: Child) {
    let output = child.wait_with_output().expect("prf ends");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
}

/// Waits until something is being written that is not yet whole, or the child has ended.
fn wait_for_a_write(child: &mut Child, run: &Path) {
    let is_partial = |entry: std::io::Result<fs::DirEntry>| {
        entry.is_ok_and(|entry| entry.file_name().to_string_lossy().starts_with(".partial-"))
    };
    let writes = |name: &str| fs::read_dir(run.join(name)).is_ok_and(|mut entries| entries.any(is_partial));
    let deadline = Instant::now() + Duration::from_secs(240);
    while child.try_wait().expect("it is our child").is_none() && !["checkpoints", "replay"].into_iter().any(writes) {
        assert!(Instant::now() < deadline, "nothing was written");
        sleep(Duration::from_millis(1));
    }
}

fn kill(mut child: Child) -> bool {
    let running = child.try_wait().expect("it is our child").is_none();
    // SIGKILL; the child may have ended a moment ago.
    drop(child.kill());
    let output = child.wait_with_output().expect("it has ended");
    let words = String::from_utf8_lossy(&output.stderr);
    assert!(running || output.status.success(), "{words}");
    assert!(!words.contains("error"), "{words}");
    running
}

/// The run's records without what depends on the clock.
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

/// The run's checkpoints and its best model: their models by name.
fn models(run: &Path) -> Vec<(PathBuf, Vec<u8>)> {
    let names = fs::read_dir(run.join("checkpoints")).expect("a run has checkpoints");
    let mut names: Vec<PathBuf> = names.map(|entry| entry.expect("it can be listed").file_name().into()).collect();
    names.sort();
    let model = |name: &PathBuf| fs::read(run.join("checkpoints").join(name).join("model.safetensors"));
    names.into_iter().map(|name| (name.clone(), model(&name).expect("it is there"))).collect()
}

#[test]
fn a_run_that_is_killed_again_and_again_ends_as_one_left_alone() {
    let folder = tempfile::tempdir().expect("a temporary folder can be made");
    let path = folder.path();
    image::GrayImage::new(84, 84).save(path.join("black.png")).expect("the folder is ours");
    fs::write(path.join("c.toml"), CONFIG).expect("the folder is ours");
    let began = Instant::now();
    finish(start(path, "whole"));
    let duration = began.elapsed();

    let mut moments = Moments::of_this_run();
    let mut kills = 0;
    for round in 0..KILLS {
        let mut child = start(path, "killed");
        if round % 2 == 0 {
            sleep(moments.within(duration / 2));
        } else {
            wait_for_a_write(&mut child, &path.join("killed"));
            sleep(moments.within(Duration::from_millis(30)));
        }
        kills += usize::from(kill(child));
    }
    assert!(kills > 0, "every run had ended before it was killed");
    finish(start(path, "killed"));

    let (whole, killed) = (path.join("whole"), path.join("killed"));
    assert!(metrics(&whole).len() >= 4, "too few records to compare");
    assert_eq!(metrics(&killed), metrics(&whole));
    let (whole, killed) = (models(&whole), models(&killed));
    assert_eq!(whole.len(), 3, "two checkpoints and the best model");
    assert!(whole == killed, "the models differ");
}
