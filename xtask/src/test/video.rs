//! Videos through a real ffmpeg, which comes with a Python package, so that no machine need have one.

use std::path::Path;

use anyhow::{Context, Result};

use super::{Runner, wheel, with_first, workspace_tests};

/// Runs the test that needs `ffmpeg` on PATH. The virtual environment of the wheel's tests must be there.
pub(super) fn test(root: &Path, runner: &mut Runner<'_>) -> Result<()> {
    let folder = wheel::ffmpeg(root)?;
    // With the whole workspace, though it is prf-core's: so what is built already serves.
    let mut tests = workspace_tests(root)?;
    tests.args(["--test", "real_ffmpeg"]);
    tests.env("PATH", with_first(&folder).context("can't put ffmpeg on PATH")?);
    runner.run(tests)
}
