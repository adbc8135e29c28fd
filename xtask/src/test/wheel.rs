//! The Python package alone with what it depends on.

use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, Result, ensure};

use super::Runner;
use super::package::Environment;
use crate::venv::target;

/// Of cargo's target folder.
const VENV: &str = "venv";

/// Builds the wheel, for later suites too, and runs the package's tests.
pub(super) fn test(root: &Path, runner: &mut Runner<'_>) -> Result<()> {
    let environment = Environment::prepare(root, VENV, &["requirements-test.txt"], runner)?;
    environment.build_wheel(runner)?;
    environment.install_wheel(runner)?;
    environment.pytest("tests", runner)
}

/// A folder with the `ffmpeg` that the tests' requirements bring along.
pub(super) fn ffmpeg(root: &Path) -> Result<PathBuf> {
    let venv = target(root).join(VENV);
    let code = "import os, sys, imageio_ffmpeg\n\
                os.makedirs(sys.argv[1], exist_ok=True)\n\
                link = os.path.join(sys.argv[1], 'ffmpeg')\n\
                os.path.lexists(link) and os.remove(link)\n\
                os.symlink(imageio_ffmpeg.get_ffmpeg_exe(), link)";
    let folder = venv.join("ffmpeg");
    let status = Command::new(venv.join("bin/python")).args(["-c", code]).arg(&folder).status();
    let made = status.with_context(|| format!("can't run the Python of {}", venv.display()))?.success();
    ensure!(
        made,
        "imageio-ffmpeg, which brings ffmpeg, is not in {}: remove that folder and try again",
        venv.display()
    );
    Ok(folder)
}
