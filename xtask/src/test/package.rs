//! The Python package: built into a wheel once, which is installed into virtual environments and tested there.

use std::env;
use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};

use super::Runner;
use crate::python::Python;
use crate::venv::{Venv, target, with_first};

/// A virtual environment to test the package in. It is kept for the next time, when nothing need be fetched.
pub(super) struct Environment {
    venv: Venv,
    package: PathBuf,
    /// Where the wheel lies once it is built.
    wheels: PathBuf,
}

impl Environment {
    /// The one in `folder` of cargo's target folder, with what these files of the package require.
    pub(super) fn prepare(root: &Path, folder: &str, files: &[&str], runner: &mut Runner<'_>) -> Result<Environment> {
        let package = root.join("crates/prf-py");
        let requirements: Vec<PathBuf> = files.iter().map(|file| package.join(file)).collect();
        let python = Python::find(&env::var_os("PATH").unwrap_or_default())?;
        let venv = Venv::new(target(root).join(folder), &python, &requirements)?;
        if !venv.is_ready() {
            python.require_venv()?;
            runner.run(venv.make(&python))?;
            runner.run(venv.install_requirements(&requirements))?;
            venv.mark_ready()?;
        }
        Ok(Environment { venv, package, wheels: target(root).join("wheel") })
    }

    /// Builds the wheel as pip does for a user, but with checks on, like the other tests.
    pub(super) fn build_wheel(&self, runner: &mut Runner<'_>) -> Result<()> {
        if self.wheels.exists() {
            fs::remove_dir_all(&self.wheels).with_context(|| format!("can't empty {}", self.wheels.display()))?;
        }
        let mut pip = self.venv.pip("wheel");
        pip.args(["--no-build-isolation", "--no-deps", "--wheel-dir"]).arg(&self.wheels).arg(&self.package);
        // What could not be uploaded to the package index, such as for a library that it links to, is an error.
        pip.env("MATURIN_PEP517_ARGS", "--profile dev --compatibility pypi");
        // maturin is there.
        pip.env("PATH", with_first(&self.venv.folder().join("bin"))?);
        runner.run(pip)
    }

    /// Installs the wheel that was built last, with what its tests need.
    pub(super) fn install_wheel(&self, runner: &mut Runner<'_>) -> Result<()> {
        let wheel = the_wheel(&self.wheels)?;
        let mut pip = self.venv.pip("install");
        pip.args(["--no-deps", "--force-reinstall"]).arg(&wheel);
        runner.run(pip)?;
        let mut pip = self.venv.pip("install");
        pip.arg(format!("{}[test]", wheel.display()));
        runner.run(pip)
    }

    /// Runs the tests in `folder` of the package.
    pub(super) fn pytest(&self, folder: &str, runner: &mut Runner<'_>) -> Result<()> {
        let mut pytest = self.venv.python();
        pytest.args(["-m", "pytest", "--color=no", folder]).current_dir(&self.package);
        runner.run(pytest)
    }
}

/// The only wheel in `folder`.
fn the_wheel(folder: &Path) -> Result<PathBuf> {
    let entries = fs::read_dir(folder).with_context(|| format!("no wheel was built into {}", folder.display()))?;
    let paths = entries.map(|entry| Ok(entry?.path())).collect::<Result<Vec<_>>>()?;
    match &paths[..] {
        [wheel] if wheel.extension().is_some_and(|ending| ending == "whl") => Ok(wheel.clone()),
        _ => bail!("{} has not one wheel in it: got {paths:?}", folder.display()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn there_must_be_one_wheel() -> Result<()> {
        let folder = tempfile::tempdir()?;
        let wheels = folder.path().join("wheel");
        let said = |wheels: &Path| the_wheel(wheels).map_err(|error| error.to_string());
        assert!(said(&wheels).is_err_and(|said| said.starts_with("no wheel was built into ")));
        fs::create_dir(&wheels)?;
        assert!(said(&wheels).is_err_and(|said| said.ends_with("got []")));
        let wheel = wheels.join("prf_py-0.1.0-cp310-abi3-linux_x86_64.whl");
        fs::write(&wheel, "")?;
        assert_eq!(said(&wheels), Ok(wheel));
        fs::write(wheels.join("prf_py-0.2.0-cp310-abi3-linux_x86_64.whl"), "")?;
        assert!(said(&wheels).is_err());
        Ok(())
    }
}
