//! `cargo xtask test`: every suite, each run to its end, and one sum.

use std::env;
use std::io::{Write, stdout};
use std::path::Path;
use std::process::{Command, ExitCode};

use anyhow::Result;

mod clients;
mod package;
mod readers;
mod suite;
mod tally;
mod video;
mod wheel;

pub use suite::{Outcome, Runner, run_suite};
pub use tally::Tally;

use crate::compiler::Compiler;
use crate::{cargo, libtorch};

/// Sets everything up, runs every test and prints the sum as the last line.
///
/// # Errors
/// If standard output can't be written.
pub fn run(root: &Path) -> Result<ExitCode> {
    let mut sink = stdout();
    let outcomes = [
        run_suite(&mut sink, "workspace", |runner| workspace(root, runner)),
        run_suite(&mut sink, "prf-cli without libtorch", |runner| without_libtorch(root, runner)),
        run_suite(&mut sink, "wheel", |runner| wheel::test(root, runner)),
        run_suite(&mut sink, "wheel with its clients", |runner| clients::test(root, runner)),
        run_suite(&mut sink, "runs in other programs", |runner| readers::test(root, runner)),
        run_suite(&mut sink, "videos by ffmpeg", |runner| video::test(root, runner)),
    ];
    let sum = report(&mut sink, &outcomes)?;
    Ok(if sum.failed == 0 { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

/// Prints a line a suite and the sum, and returns the sum.
///
/// # Errors
/// If `sink` can't be written.
pub fn report(sink: &mut impl Write, outcomes: &[Outcome]) -> Result<Tally> {
    let sum = outcomes.iter().map(Outcome::tally).sum();
    writeln!(sink)?;
    for outcome in outcomes {
        writeln!(sink, "{outcome}")?;
    }
    writeln!(sink, "{sum}")?;
    sink.flush()?;
    Ok(sum)
}

fn workspace(root: &Path, runner: &mut Runner<'_>) -> Result<()> {
    let mut tests = workspace_tests(root)?;
    tests.arg("--no-fail-fast");
    runner.run(tests)
}

/// `cargo test --workspace`, with what it needs to link.
fn workspace_tests(root: &Path) -> Result<Command> {
    let mut tests = with_libtorch(root)?;
    tests.args(["test", "--workspace"]);
    Ok(tests)
}

/// A cargo with what it needs to link to libtorch.
fn with_libtorch(root: &Path) -> Result<Command> {
    let source = libtorch::ensure(root)?;
    let path = env::var_os("PATH").unwrap_or_default();
    let compiler = Compiler::find(&path, env::var_os("CXX").as_deref())?;
    let mut command = cargo_at(root);
    source.configure(&mut command);
    compiler.configure(&mut command);
    Ok(command)
}

fn without_libtorch(root: &Path, runner: &mut Runner<'_>) -> Result<()> {
    let mut tests = cargo_at(root);
    tests.args(["test", "--package", "prf-cli", "--no-default-features", "--no-fail-fast"]);
    runner.run(tests)
}

fn cargo_at(root: &Path) -> Command {
    let mut command = cargo();
    // Its lines are read, and colours would be in the way.
    command.current_dir(root).env("CARGO_TERM_COLOR", "never");
    command
}
