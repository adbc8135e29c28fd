//! Lets `prf` find libtorch from wherever it is started, and know the revision it was built from.

use std::env;
use std::process::Command;

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    // Both are for training alone; without it, no change elsewhere is a reason to build anew.
    if env::var_os("CARGO_FEATURE_TRAIN").is_some() {
        set_rpath();
        set_revision();
    }
}

fn set_rpath() {
    // Set by torch-sys.
    if let Ok(folder) = env::var("DEP_TCH_LIBTORCH_LIB") {
        println!("cargo::rustc-link-arg=-Wl,-rpath,{folder}");
    }
}

/// A run's manifest names the revision; outside of a checkout, or without git, there is none.
fn set_revision() {
    if let Some(revision) = git(&["describe", "--always", "--dirty", "--abbrev=12"]) {
        println!("cargo::rustc-env=PRF_GIT_REVISION={revision}");
    }
    // Edited sources make a revision "dirty".
    println!("cargo::rerun-if-changed=..");
    if let Some(log) = git(&["rev-parse", "--git-path", "logs/HEAD"]) {
        println!("cargo::rerun-if-changed={log}");
    }
}

fn git(args: &[&str]) -> Option<String> {
    let output = Command::new("git").args(args).output().ok().filter(|output| output.status.success())?;
    Some(String::from_utf8(output.stdout).ok()?.trim().to_owned())
}
