//! The workers: ours is built, the peers' gets a virtual environment.

use std::env;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use anyhow::{Context, Result, ensure};
use serde_json::Value;

use crate::python::Python;
use crate::venv::{Venv, target, with_first};
use crate::{cargo, libtorch};

/// Builds our worker.
///
/// # Errors
/// If cargo can't.
pub(super) fn prf(root: &Path) -> Result<Command> {
    example(root, "prf-core", "perception_worker")
}

/// Holds every library that a worker may load to one thread.
pub(super) fn hold_to_one_thread(command: &mut Command) {
    for library in ["OMP", "OPENBLAS", "MKL"] {
        command.env(format!("{library}_NUM_THREADS"), "1");
    }
}

/// Builds both workers that train what `config` says, each with as many threads as there are cores.
///
/// # Errors
/// If libtorch can't be had, cargo or pip can't do their work, or there is no Python that serves.
pub(super) fn training(root: &Path, config: &Path) -> Result<(Command, Command)> {
    let venv = fetched(root, "training", &["requirements-training.txt"])?;
    install_package(root, &venv)?;
    libtorch::ensure(root)?;
    let mut prf = example(root, "prf-dqn", "training_worker")?;
    let mut peers = script(root, &venv, "training_worker.py");
    prf.arg(config).arg(target(root).join("compare").join("runs"));
    peers.arg(config);
    Ok((prf, peers))
}

/// Builds an example, as fast as it can be.
fn example(root: &Path, package: &str, name: &str) -> Result<Command> {
    let mut build = cargo();
    build.current_dir(root).args(["build", "--release", "--package", package, "--example", name]);
    build.arg("--message-format=json-render-diagnostics").stdout(Stdio::piped());
    let output = build.spawn().and_then(std::process::Child::wait_with_output).context("can't start cargo")?;
    ensure!(output.status.success(), "the worker of {package} can't be built");
    let program = executable(&String::from_utf8_lossy(&output.stdout)).context("cargo did not say what it built")?;
    Ok(Command::new(program))
}

/// The last program that cargo names in its messages.
fn executable(messages: &str) -> Option<PathBuf> {
    let parsed = messages.lines().filter_map(|line| serde_json::from_str::<Value>(line).ok());
    parsed.filter_map(|message| message["executable"].as_str().map(PathBuf::from)).next_back()
}

/// Fetches the peers, unless they are there.
///
/// # Errors
/// If there is no Python that serves, or pip can't fetch them.
pub(super) fn peers(root: &Path) -> Result<Command> {
    let venv = fetched(root, "venv", &["requirements.txt"])?;
    Ok(script(root, &venv, "perception_worker.py"))
}

/// Fetches what the package is measured against, unless it is there, and builds and installs the package as it is released.
///
/// # Errors
/// As [`peers`]; if the package can't be built.
pub(super) fn package(root: &Path) -> Result<Command> {
    let venv = fetched(root, "python", &["requirements.txt", "requirements-python.txt"])?;
    install_package(root, &venv)?;
    Ok(script(root, &venv, "python_package.py"))
}

fn install_package(root: &Path, venv: &Venv) -> Result<()> {
    let mut pip = venv.pip("install");
    pip.args(["--no-build-isolation", "--no-deps", "--force-reinstall"]).arg(root.join("crates/prf-py"));
    // maturin is found there.
    pip.env("PATH", with_first(&venv.folder().join("bin"))?);
    succeed(pip, "the Python package can't be built")
}

/// A virtual environment with what files in `tests/compare` name.
fn fetched(root: &Path, name: &str, files: &[&str]) -> Result<Venv> {
    let requirements: Vec<PathBuf> = files.iter().map(|file| root.join("tests/compare").join(file)).collect();
    let python = Python::find(&env::var_os("PATH").unwrap_or_default())?;
    let venv = Venv::new(target(root).join("compare").join(name), &python, &requirements)?;
    if !venv.is_ready() {
        python.require_venv()?;
        succeed(venv.make(&python), "the virtual environment can't be made")?;
        let mut pip = venv.install_requirements(&requirements);
        pip.arg("--only-binary=:all:");
        let complaint = format!(
            "pip can't fetch what tests/compare/{} names: check the network and pip's settings",
            files.join(", ")
        );
        succeed(pip, &complaint)?;
        venv.mark_ready()?;
    }
    Ok(venv)
}

fn script(root: &Path, venv: &Venv, name: &str) -> Command {
    let mut command = venv.python();
    command.arg(root.join("tests/compare").join(name));
    command
}

/// Runs a command whose output is for the user's eyes; ours is kept for results.
fn succeed(mut command: Command, complaint: &str) -> Result<()> {
    command.stdout(std::io::stderr());
    let status = command.status().with_context(|| complaint.to_owned())?;
    ensure!(status.success(), "{complaint} ({status})");
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_program_is_what_cargo_names_last() {
        let messages = "{\"reason\":\"compiler-artifact\",\"executable\":null}\n\
                        {\"reason\":\"compiler-artifact\",\"executable\":\"a/worker\"}\n\
                        {\"reason\":\"build-finished\",\"success\":true}\n";
        assert_eq!(executable(messages), Some(PathBuf::from("a/worker")));
        assert_eq!(executable("not a message\n"), None);
    }
}
