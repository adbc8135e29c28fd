//! The workers: ours is built, the peers' gets a virtual environment.

use std::env;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use anyhow::{Context, Result, ensure};
use serde_json::Value;

use crate::cargo;
use crate::python::Python;
use crate::venv::{Venv, target, with_first};

/// Builds our worker.
///
/// # Errors
/// If cargo can't.
pub(super) fn prf(root: &Path) -> Result<Command> {
    let mut build = cargo();
    build.current_dir(root).args(["build", "--release", "--package", "prf-core", "--example", "perception_worker"]);
    build.arg("--message-format=json-render-diagnostics").stdout(Stdio::piped());
    let output = build.spawn().and_then(std::process::Child::wait_with_output).context("can't start cargo")?;
    ensure!(output.status.success(), "the worker of prf-core can't be built");
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
    let mut pip = venv.pip("install");
    pip.args(["--no-build-isolation", "--no-deps", "--force-reinstall"]).arg(root.join("crates/prf-py"));
    // maturin is found there.
    pip.env("PATH", with_first(&venv.folder().join("bin"))?);
    succeed(pip, "the Python package can't be built")?;
    Ok(script(root, &venv, "python_package.py"))
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
