//! `cargo prf ARGS…`.

use std::env;
use std::ffi::OsString;
use std::path::Path;
use std::process::{Command, ExitCode};

use anyhow::{Context, Result};

use crate::compiler::Compiler;
use crate::{cargo, libtorch};

/// Sets libtorch up, builds `prf` and becomes it.
///
/// # Errors
/// If libtorch or the C++ compiler is missing and can't be had, or cargo does not start.
pub fn run(root: &Path, args: &[OsString]) -> Result<ExitCode> {
    let source = libtorch::ensure(root)?;
    let compiler = Compiler::find(&env::var_os("PATH").unwrap_or_default(), env::var_os("CXX").as_deref())?;
    let mut command = cargo();
    command
        .args(["run", "--release", "--package", "prf-cli", "--manifest-path"])
        .arg(root.join("Cargo.toml"))
        .arg("--")
        .args(args);
    source.configure(&mut command);
    compiler.configure(&mut command);
    become_it(command).context("could not start cargo")
}

/// Replaces this process, so that signals and the exit status are `prf`'s own; cargo does likewise.
#[cfg(unix)]
fn become_it(mut command: Command) -> Result<ExitCode> {
    use std::os::unix::process::CommandExt;
    Err(command.exec().into())
}

#[cfg(not(unix))]
fn become_it(mut command: Command) -> Result<ExitCode> {
    let code = command.status()?.code();
    Ok(code.and_then(|code| u8::try_from(code).ok()).map_or(ExitCode::FAILURE, ExitCode::from))
}
