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
    /// The one in `folder`, for this Python and what the file of requirements says now.
    pub(crate) fn new(folder: PathBuf, python: &Python, requirements: &Path) -> Result<Venv> {
        let wanted =
            fs::read_to_string(requirements).with_context(|| format!("can't read {}", requirements.display()))?;
        let (major, minor) = python.version();
        let stamp = format!("Python {major}.{minor}\n{wanted}");
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

    pub(crate) fn pip_install(&self) -> Command {
        let mut command = self.python();
        command.args(["-m", "pip", "install", "--disable-pip-version-check"]);
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
