//! `prf runs` as a user runs it.

use std::fs::{self, File};
use std::path::Path;
use std::process::Command;

use predicates::prelude::*;
use predicates::str::{contains, is_empty, is_match};
use serde_json::Value;

mod common;
mod run_folders;

use common::prf;
use run_folders::{CONFIG, make_run, save};

/// The runs in `runs`, by their names.
fn listed(folder: &Path) -> Vec<(String, Value)> {
    let output = prf(folder).args(["runs", "--format", "json"]).assert().success();
    let text = String::from_utf8(output.get_output().stdout.clone()).expect("JSON is UTF-8");
    let records = text.lines().map(|line| serde_json::from_str::<Value>(line).expect("one object a line"));
    records.map(|record| (record["run"].as_str().expect("it has a name").to_owned(), record)).collect()
}

#[test]
fn every_state_is_told_and_how_to_go_on() {
    let folder = tempfile::tempdir().expect("a temporary folder can be made");
    let runs = folder.path().join("runs");
    let make = |name: &str, seed| make_run(&runs, name, (seed, CONFIG), &[(400, 1.5), (900, 0.5)]);
    save(&make("done", 1), 1000, true);
    save(&make("deep/half way", 2), 500, false);
    make("fresh", 3);
    let cut = make("cut", 4);
    save(&cut, 500, false);
    fs::write(cut.join("checkpoints/step-000000000500/model.safetensors"), b"\x02\0\0\0").expect("the folder is ours");
    let wrong = make("wrong", 5);
    fs::write(wrong.join("config.toml"), "seed = true\n").expect("the folder is ours");
    // A run is going on while its records are locked.
    let going = File::open(make("going", 6).join("metrics.jsonl")).expect("it is there");
    going.lock().expect("nobody else has it");

    let listed = listed(folder.path());
    let told = |name: &str| {
        let (_, record) = listed.iter().find(|(run, _)| run == &format!("runs/{name}")).expect("it is listed");
        let of = |key: &str| record[key].clone();
        (of("state"), of("steps").as_u64(), of("resume"))
    };
    let again = |name: &str| {
        let quoted =
            |file: &str| if name.contains(' ') { format!("'runs/{name}{file}'") } else { format!("runs/{name}{file}") };
        Value::from(format!("prf train {} --out {} --resume", quoted("/config.toml"), quoted("")))
    };
    assert_eq!(listed.len(), 6);
    assert_eq!(told("done"), ("finished".into(), Some(1000), Value::Null));
    assert_eq!(told("deep/half way"), ("interrupted".into(), Some(500), again("deep/half way")));
    assert_eq!(told("fresh"), ("never saved".into(), Some(0), again("fresh")));
    assert_eq!(told("cut").0, "damaged");
    assert_eq!(told("wrong").0, "damaged");
    assert_eq!((told("going").0, told("going").2), ("running".into(), Value::Null));
    let (_, done) = &listed[listed.iter().position(|(run, _)| run == "runs/done").expect("it is there")];
    assert_eq!((&done["world"], &done["seed"], &done["total_steps"]), (&"breakout".into(), &1.into(), &1000.into()));
    assert_eq!((&done["best_score"], &done["last_score"]), (&1.5.into(), &0.5.into()));
    assert!(done["changed_s"].as_u64() > Some(1_700_000_000), "{done}");
    let (_, cut) = &listed[0];
    assert!(cut["problem"].as_str().is_some_and(|problem| problem.contains("model.safetensors: got 4 bytes")), "{cut}");

    let row =
        is_match(r"(?m)^done +breakout +finished +1000 of 1000 steps +1\.50 +0\.50 +\d+ s ago$").expect("a pattern");
    prf(folder.path())
        .arg("runs")
        .assert()
        .success()
        .stdout(row.and(contains("prf train 'runs/deep/half way/config.toml' --out 'runs/deep/half way' --resume\n")))
        .stderr(contains("runs/cut is damaged").and(contains("runs/wrong is damaged")));
}

/// The command is pasted into a shell, as a user would.
#[cfg(unix)]
#[test]
fn a_run_goes_on_by_the_command_that_is_told() {
    let folder = tempfile::tempdir().expect("a temporary folder can be made");
    let small = "environments = 4\nbatch_size = 8\nreplay_steps = 400\nlearning_starts = 100\nsteps_per_update = 50\nthreads = 1\n";
    let config = format!("{}{small}", CONFIG.replace("1000", "240"));
    make_run(&folder.path().join("runs"), "it's mine", (1, &config), &[]);
    let command = listed(folder.path())[0].1["resume"].as_str().expect("it can go on").to_owned();
    let program = assert_cmd::cargo::cargo_bin!("prf");
    let path = std::env::join_paths([
        program.parent().expect("it lies in a folder"),
        Path::new("/usr/bin"),
        Path::new("/bin"),
    ]);
    let output = Command::new("sh")
        .args(["-c", &command])
        .current_dir(folder.path())
        .env("PATH", path.expect("plain paths"))
        .output()
        .expect("there is a shell");
    assert!(output.status.success(), "{command}: {}", String::from_utf8_lossy(&output.stderr));
    let (_, record) = &listed(folder.path())[0];
    assert_eq!((&record["state"], &record["steps"]), (&"finished".into(), &240.into()));
}

#[test]
fn where_there_are_no_runs_one_is_told_so() {
    let folder = tempfile::tempdir().expect("a temporary folder can be made");
    prf(folder.path())
        .arg("runs")
        .assert()
        .code(2)
        .stdout(is_empty())
        .stderr(contains("cannot look for runs in runs").and(contains("hint: ")));
    prf(folder.path())
        .args(["runs", "."])
        .assert()
        .code(2)
        .stdout(is_empty())
        .stderr(contains("there is no run in .").and(contains("hint: ")));
}
