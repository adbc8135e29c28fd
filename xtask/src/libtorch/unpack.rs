//! Unpacking what is needed of a wheel, by Python's own zip reader.

use std::path::Path;

use anyhow::{Context, Result, bail};

use super::pins::Wheel;
use super::space;
use crate::python::Python;

const SCRIPT: &str = include_str!("unpack.py");

/// Exit status of the script when the disk is full: `ENOSPC`, alike on Linux and macOS.
const DISK_FULL: i32 = 28;

/// Unpacks what the rules of `wheel` name from `wheels` into `folder`.
pub(super) fn unpack(python: &Python, wheel: &Wheel<'_>, wheels: &Path, folder: &Path) -> Result<()> {
    let output = python
        .command()
        .args(["-c", SCRIPT])
        .arg(wheels.join(wheel.file))
        .arg(folder)
        .args(wheel.rules)
        .output()
        .context("can't run python3")?;
    if output.status.success() {
        return Ok(());
    }
    if output.status.code() == Some(DISK_FULL) {
        bail!(space::full(folder));
    }
    let stderr = String::from_utf8_lossy(&output.stderr);
    let reason = stderr.lines().last().unwrap_or("python3 gave no reason");
    bail!("could not unpack {}: {reason}", wheel.file)
}
