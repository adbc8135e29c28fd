//! The Python package: installed into a virtual environment of its own and tested there.

use std::env;
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, Result, ensure};

use super::Runner;
use crate::python::Python;
use crate::venv::{Venv, target, with_first};

/// Installs the package as a user would and runs its tests. The environment is kept for the next
/// time, when nothing need be fetched.
pub(super) fn test(root: &Path, runner: &mut Runner<'_>) -> Result<()> {
    let package = root.join("crates/prf-py");
    let requirements = package.join("requirements-test.txt");
    let python = Python::find(&env::var_os("PATH").unwrap_or_default())?;
    let venv = Venv::new(target(root).join("venv"), &python, &requirements)?;
    if venv.is_ready() {
        let mut pip = pip_install(&venv)?;
        pip.args(["--no-build-isolation", "--no-deps", "--force-reinstall"]);
        pip.arg(&package);
        runner.run(pip)?;
    } else {
        python.require_venv()?;
        runner.run(venv.make(&python))?;
        let mut pip = pip_install(&venv)?;
        pip.arg("--requirement").arg(&requirements);
        runner.run(pip)?;
        let mut pip = pip_install(&venv)?;
        pip.arg(format!("{}[test]", package.display()));
        runner.run(pip)?;
        venv.mark_ready()?;
    }
    let mut pytest = venv.python();
    pytest.args(["-m", "pytest", "--color=no"]).arg(package.join("tests"));
    pytest.current_dir(&package);
    runner.run(pytest)
}

/// A folder with the `ffmpeg` that the tests' requirements bring along.
pub(super) fn ffmpeg(root: &Path) -> Result<PathBuf> {
    let venv = target(root).join("venv");
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

/// pip, for what has to be built.
fn pip_install(venv: &Venv) -> Result<Command> {
    let mut command = venv.pip_install();
    command
        // maturin is found there when pip does not fetch one of its own.
        .env("PATH", with_first(&venv.folder().join("bin"))?)
        // With checks on, like the other tests, and sharing what is built already.
        .env("MATURIN_PEP517_ARGS", "--profile=dev");
    Ok(command)
}
