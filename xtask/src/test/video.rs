//! Videos through a real ffmpeg, which comes with a Python package, so that no machine need have one.

use std::path::Path;

use anyhow::{Context, Result};

use super::{Runner, wheel, workspace_tests};

/// Runs the tests that need `ffmpeg` on PATH. The virtual environment of the wheel's tests must be there.
pub(super) fn test(root: &Path, runner: &mut Runner<'_>) -> Result<()> {
    let folder = wheel::ffmpeg(root)?;
    // The whole workspace, though only prf-core has such tests: it is built already.
    let mut tests = workspace_tests(root)?;
    tests.args(["--lib", "--", "--ignored", "io::ffmpeg"]);
    tests.env("PATH", wheel::with_first(&folder).context("can't put ffmpeg on PATH")?);
    runner.run(tests)
}
