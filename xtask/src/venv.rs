//! Virtual environments under `target/`, each made once and kept.

use std::env;
use std::ffi::OsString;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, Result};

use crate::python::Python;

/// A virtual environment that knows what it was made for.
pub(crate) struct Venv {
    folder: PathBuf,
    stamp: String,
}

impl Venv {
    /// The one in `folder`, for this Python and what the files of requirements say now.
    pub(crate) fn new(folder: PathBuf, python: &Python, requirements: &[PathBuf]) -> Result<Venv> {
        let (major, minor) = python.version();
        let mut stamp = format!("Python {major}.{minor}\n");
        for file in requirements {
            let wanted = fs::read_to_string(file).with_context(|| format!("can't read {}", file.display()))?;
            stamp.push_str(&wanted);
        }
        Ok(Venv { folder, stamp })
    }

    pub(crate) fn folder(&self) -> &Path {
        &self.folder
    }

    pub(crate) fn is_ready(&self) -> bool {
        fs::read_to_string(self.stamp_file()).is_ok_and(|stamp| stamp == self.stamp)
    }

    pub(crate) fn mark_ready(&self) -> Result<()> {
        Ok(fs::write(self.stamp_file(), &self.stamp)?)
    }

    /// A command that makes it anew, without packages.
    pub(crate) fn make(&self, python: &Python) -> Command {
        let mut command = python.command();
        command.args(["-m", "venv", "--clear"]).arg(&self.folder);
        command
    }

    pub(crate) fn python(&self) -> Command {
        Command::new(self.folder.join("bin/python"))
    }

    /// A command of its pip, such as `install`.
    pub(crate) fn pip(&self, name: &str) -> Command {
        let mut command = self.python();
        command.args(["-m", "pip", name, "--disable-pip-version-check"]);
        command
    }

    /// A command that installs what the files of requirements name.
    pub(crate) fn install_requirements(&self, files: &[PathBuf]) -> Command {
        let mut command = self.pip("install");
        for file in files {
            command.arg("--requirement").arg(file);
        }
        command
    }

    fn stamp_file(&self) -> PathBuf {
        self.folder.join("prf-stamp")
    }
}

/// Where cargo builds.
pub(crate) fn target(root: &Path) -> PathBuf {
    env::var_os("CARGO_TARGET_DIR").map_or_else(|| root.join("target"), |dir| root.join(dir))
}

/// `PATH` with this folder before all others.
pub(crate) fn with_first(folder: &Path) -> Result<OsString> {
    let path = env::var_os("PATH").unwrap_or_default();
    let folders = std::iter::once(folder.to_path_buf()).chain(env::split_paths(&path));
    Ok(env::join_paths(folders)?)
}
