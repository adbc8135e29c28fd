//! What `prf` says about itself.

use std::io::Write as _;
use std::process::{Command, Stdio};

use predicates::prelude::*;
use predicates::str::{contains, is_empty, is_match};

mod common;

use common::prf;

#[test]
fn help_lists_every_command_and_the_exit_codes() {
    let mut help = prf(".".as_ref());
    help.arg("--help");
    let assert = help.assert().success().stderr(is_empty());
    for command in ["train", "eval", "runs", "plot", "report", "score", "init", "worlds", "play", "completions"] {
        let line = is_match(format!("(?m)^  {command}  +[A-Z]")).expect("it is a pattern");
        assert!(line.eval(&String::from_utf8_lossy(&assert.get_output().stdout)), "{command}");
    }
    assert.stdout(contains("Exit codes: 0 done, 1 failed, 2 "));
}

#[test]
fn every_command_has_help() {
    for command in ["train", "eval", "runs", "plot", "report", "score", "init", "worlds", "play", "completions"] {
        prf(".".as_ref())
            .args([command, "--help"])
            .assert()
            .success()
            .stdout(contains(format!("Usage: prf {command}")));
    }
}

#[test]
fn misuse_ends_with_2_and_says_how_it_is_used() {
    let cases: [&[&str]; 5] = [&[], &["scor"], &["score"], &["score", "goal.png"], &["init", "--bogus"]];
    for args in cases {
        prf(".".as_ref()).args(args).assert().code(2).stdout(is_empty()).stderr(contains("Usage: prf"));
    }
}

#[test]
fn every_shell_gets_completions() {
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        prf(".".as_ref())
            .args(["completions", shell])
            .assert()
            .success()
            .stdout(contains("score").and(contains("completions")))
            .stderr(is_empty());
    }
    prf(".".as_ref()).args(["completions", "csh"]).assert().code(2);
}

#[cfg(unix)]
#[test]
fn bash_accepts_its_completions() {
    let script = prf(".".as_ref()).args(["completions", "bash"]).assert().get_output().stdout.clone();
    let mut bash = Command::new("bash").arg("-n").stdin(Stdio::piped()).spawn().expect("the tests need bash");
    let mut stdin = bash.stdin.take().expect("it is piped");
    stdin.write_all(&script).expect("bash reads its script");
    drop(stdin);
    assert!(bash.wait().expect("bash ends").success());
}

/// A help or a script that is too long for the reader is no error.
#[cfg(unix)]
#[test]
fn a_closed_pipe_ends_quietly() {
    for args in [&["--help"][..], &["completions", "zsh"]] {
        let (reader, writer) = std::io::pipe().expect("there are pipes");
        drop(reader);
        let output = Command::new(assert_cmd::cargo::cargo_bin!("prf"))
            .args(args)
            .stdout(writer)
            .stderr(Stdio::piped())
            .output()
            .expect("prf starts");
        assert_eq!(String::from_utf8_lossy(&output.stderr), "", "{args:?}");
        assert_eq!(output.status.code(), Some(0), "{args:?}");
    }
}

#[cfg(not(feature = "train"))]
#[test]
fn without_training_one_is_told_how_to_get_it() {
    for command in ["train", "eval", "runs", "plot", "report"] {
        prf(".".as_ref())
            .args([command, "some.toml"])
            .assert()
            .code(1)
            .stdout(is_empty())
            .stderr(contains("built without training").and(contains("cargo install")));
    }
}
