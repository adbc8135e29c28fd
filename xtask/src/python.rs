//! The `python3` that fetches libtorch, tests the wheel and runs what we are compared with.

use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

use anyhow::{Context, Result, bail};

use crate::find_in;

/// Oldest Python that serves: torch 2.11.0 asks for it, and so does the wheel of this project.
const OLDEST: (u32, u32) = (3, 10);

/// A Python interpreter that runs.
#[derive(Debug)]
pub struct Python {
    program: PathBuf,
    version: (u32, u32),
}

impl Python {
    /// The `python3` of `path` (in the form of `PATH`).
    ///
    /// # Errors
    /// If there is none, or it does not run, or it is too old.
    pub fn find(path: &OsStr) -> Result<Python> {
        let Some(program) = find_in(path, "python3") else {
            bail!(
                "there is no python3 on PATH, and it is needed to fetch libtorch, to test the Python \
                 package and to compare with OpenCV: install Python 3.10 or newer with pip and venv"
            );
        };
        let shown = program.display().to_string();
        let code = "import sys; print(*sys.version_info[:2])";
        let output = Command::new(&program).args(["-c", code]).output();
        let version = output
            .ok()
            .filter(|output| output.status.success())
            .and_then(|output| parse_version(&output.stdout))
            .with_context(|| format!("{shown} does not run: repair it, or put another python3 first on PATH"))?;
        if version < OLDEST {
            let (major, minor) = version;
            bail!(
                "{shown} is Python {major}.{minor}, and 3.10 or newer is needed: install a newer \
                 one and put it first on PATH"
            );
        }
        Ok(Python { program, version })
    }

    /// Its version, major and minor.
    pub fn version(&self) -> (u32, u32) {
        self.version
    }

    /// A command that starts it, without anything to read.
    pub fn command(&self) -> Command {
        let mut command = Command::new(&self.program);
        command.stdin(Stdio::null());
        command
    }

    /// # Errors
    /// If it has no pip.
    pub fn require_pip(&self) -> Result<()> {
        let code = "import sys, importlib.util; sys.exit(not importlib.util.find_spec('pip'))";
        if self.output(&["-c", code])?.status.success() {
            return Ok(());
        }
        bail!(
            "{} has no pip, which fetches libtorch: install it (Debian, Ubuntu: `apt install \
             python3-pip`; elsewhere: `python3 -m ensurepip`)",
            self.program.display()
        )
    }

    /// # Errors
    /// If it can't make virtual environments.
    pub fn require_venv(&self) -> Result<()> {
        if self.output(&["-c", "import venv, ensurepip"])?.status.success() {
            return Ok(());
        }
        bail!(
            "{} can't make virtual environments: install its venv module (Debian, Ubuntu: `apt \
             install python3-venv`)",
            self.program.display()
        )
    }

    /// Free space of the file system that holds `folder`, in bytes.
    ///
    /// # Errors
    /// If it can't be found out.
    pub fn free_bytes(&self, folder: &Path) -> Result<u64> {
        let code = "import shutil, sys; print(shutil.disk_usage(sys.argv[1]).free)";
        let output = self.command().args(["-c", code]).arg(folder).output()?;
        String::from_utf8_lossy(&output.stdout)
            .trim()
            .parse()
            .with_context(|| format!("can't find out how much space is free in {}", folder.display()))
    }

    fn output(&self, args: &[&str]) -> Result<Output> {
        self.command().args(args).output().with_context(|| format!("can't run {}", self.program.display()))
    }
}

fn parse_version(line: &[u8]) -> Option<(u32, u32)> {
    let line = str::from_utf8(line).ok()?;
    let (major, minor) = line.trim().split_once(' ')?;
    Some((major.parse().ok()?, minor.parse().ok()?))
}
