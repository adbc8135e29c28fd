//! Which libtorch is to be used.

use std::ffi::OsString;
use std::fmt::{self, Display, Formatter};
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Result, ensure};

use super::pins::VERSION;

/// Where libtorch comes from.
#[derive(Debug, PartialEq, Eq)]
pub enum Source {
    /// The pinned one, in this folder.
    Pinned(PathBuf),
    /// The user's own, in this folder.
    Own(PathBuf),
    /// The one in the user's Python (`LIBTORCH_USE_PYTORCH`).
    PyTorch,
}

impl Source {
    /// Follows the same rules as `torch-sys` does, given the variables of the environment.
    ///
    /// # Errors
    /// If the user's own libtorch is none.
    pub fn choose(root: &Path, variable: impl Fn(&str) -> Option<OsString>) -> Result<Source> {
        if variable("LIBTORCH_USE_PYTORCH").is_some() {
            return Ok(Source::PyTorch);
        }
        let pinned = root.join(".libtorch");
        // Cargo sets LIBTORCH to the pinned one where the user has not.
        let Some(own) = variable("LIBTORCH").map(PathBuf::from).filter(|own| *own != pinned) else {
            return Ok(Source::Pinned(pinned));
        };
        let part = |name: &str| variable(name).map_or_else(|| own.clone(), PathBuf::from);
        let complete = part("LIBTORCH_LIB").join("lib").is_dir() && part("LIBTORCH_INCLUDE").join("include").is_dir();
        ensure!(
            complete,
            "LIBTORCH is {}, which has no lib/ and include/: set it to a folder with a libtorch \
             {VERSION}, or unset it and one is fetched",
            own.display()
        );
        Ok(Source::Own(std::path::absolute(own)?))
    }

    /// Tells `command`, a cargo that builds, where libtorch is.
    pub fn configure(&self, command: &mut Command) {
        if let Source::Pinned(folder) | Source::Own(folder) = self {
            command.env("LIBTORCH", folder);
        }
    }
}

impl Display for Source {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self {
            Source::Pinned(folder) => write!(f, "libtorch {VERSION} is ready in {}", folder.display()),
            Source::Own(folder) => write!(f, "using your own libtorch in {} (LIBTORCH)", folder.display()),
            Source::PyTorch => write!(f, "using the libtorch of your Python (LIBTORCH_USE_PYTORCH)"),
        }
    }
}
