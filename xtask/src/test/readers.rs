//! What a run leaves behind, read by other programs: recordings, event files, and reports in a browser.

use std::env;
use std::path::Path;
use std::process::{Command, Stdio};

use anyhow::Result;

use super::{Runner, with_libtorch};
use crate::find_in;
use crate::python::Python;
use crate::venv::{Venv, target};

/// Names of Chromium, as tests/readers/check_page.py has them.
const BROWSERS: [&str; 5] = ["chromium", "chromium-browser", "google-chrome", "google-chrome-stable", "chrome"];

/// Builds `prf` and lets the tests in `tests/readers` look at what it writes.
pub(super) fn test(root: &Path, runner: &mut Runner<'_>) -> Result<()> {
    // An earlier suite may have left one that can't train.
    let mut build = with_libtorch(root)?;
    build.args(["build", "--package", "prf-cli"]);
    runner.run(build)?;
    let folder = root.join("tests/readers");
    let requirements = [folder.join("requirements.txt")];
    let python = Python::find(&env::var_os("PATH").unwrap_or_default())?;
    let venv = Venv::new(target(root).join("readers"), &python, &requirements)?;
    if !venv.is_ready() {
        python.require_venv()?;
        runner.run(venv.make(&python))?;
        runner.run(venv.install_requirements(&requirements))?;
        venv.mark_ready()?;
    }
    install_browser(runner)?;
    let mut pytest = venv.python();
    pytest.args(["-m", "pytest", "--color=no", "-p", "no:cacheprovider", "."]).current_dir(&folder);
    pytest.env("PRF", target(root).join("debug/prf"));
    runner.run(pytest)
}

/// Installs Debian's Chromium where there is none and this user may. Where there is still none, its test says so.
fn install_browser(runner: &mut Runner<'_>) -> Result<()> {
    let path = env::var_os("PATH").unwrap_or_default();
    if BROWSERS.iter().any(|name| find_in(&path, name).is_some()) || !may_install() {
        return Ok(());
    }
    for words in [&["update"][..], &["install", "--yes", "chromium"]] {
        let mut apt = Command::new("apt-get");
        apt.args(words).env("DEBIAN_FRONTEND", "noninteractive").stdin(Stdio::null());
        runner.run(apt)?;
    }
    Ok(())
}

/// Whether this is Debian, or alike, and the user its administrator.
fn may_install() -> bool {
    let user = Command::new("id").arg("-u").output();
    user.is_ok_and(|user| user.stdout.trim_ascii() == b"0")
        && find_in(&env::var_os("PATH").unwrap_or_default(), "apt-get").is_some()
}
