//! Putting the pinned libtorch in its place: whole or not at all.

use std::fs::{self, File, TryLockError};
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};

use super::fetch::fetch;
use super::pins::{Pin, VERSION};
use super::progress::bytes_under;
use super::space;
use super::unpack::unpack;
use crate::python::Python;

/// In an unpacked libtorch: what it was made of.
const STAMP: &str = "prf-stamp";

/// A libtorch to be had in one folder.
pub struct Install<'a> {
    folder: &'a Path,
    pin: &'a Pin<'a>,
}

impl<'a> Install<'a> {
    /// To unpack what `pin` names into `folder`; beside it lie the lock and what is half done.
    pub fn new(folder: &'a Path, pin: &'a Pin<'a>) -> Install<'a> {
        Install { folder, pin }
    }

    /// Whether the folder holds just what the pin names.
    pub fn is_ready(&self) -> bool {
        fs::read_to_string(self.folder.join(STAMP)).is_ok_and(|stamp| stamp == self.pin.stamp())
    }

    /// Fetches, checks, unpacks, and puts the folder in its place, unless it is ready. What an
    /// interrupted call left behind is used if it is sound, and cleared away if not. A second
    /// process waits for the first.
    ///
    /// # Errors
    /// One sentence with what to do: no Python, no pip, no space, no network, a wrong hash.
    pub fn run(&self, python: impl FnOnce() -> Result<Python>) -> Result<()> {
        if self.is_ready() {
            return Ok(());
        }
        let _lock = self.lock()?;
        if self.is_ready() {
            return Ok(());
        }
        if self.folder.exists() {
            eprintln!("{} is not the pinned libtorch {VERSION}: it will be replaced", self.folder.display());
        }
        self.build(&python()?).map_err(|error| space::explain(error, self.folder))
    }

    fn build(&self, python: &Python) -> Result<()> {
        python.require_pip()?;
        let partial = self.beside("partial");
        let (wheels, scratch, unpacked) = (partial.join("wheels"), partial.join("scratch"), partial.join("unpacked"));
        remove(&scratch)?;
        remove(&unpacked)?;
        fs::create_dir_all(&wheels).with_context(|| format!("can't make {}", wheels.display()))?;
        let needed = (self.pin.space_mb * 1_000_000).saturating_sub(bytes_under(&wheels));
        space::check(&partial, python.free_bytes(&partial)?, needed)?;

        for wheel in self.pin.wheels {
            fetch(python, wheel, &wheels, &scratch)?;
        }
        eprintln!("unpacking libtorch {VERSION}");
        for wheel in self.pin.wheels {
            unpack(python, wheel, &wheels, &unpacked)?;
        }
        // torch-sys compares this with the version it wants.
        fs::write(unpacked.join("build-version"), VERSION)?;
        fs::write(unpacked.join(STAMP), self.pin.stamp())?;
        self.replace_by(&unpacked)?;
        remove(&partial)
    }

    fn replace_by(&self, unpacked: &Path) -> Result<()> {
        let old = self.beside("old");
        remove(&old)?;
        if self.folder.symlink_metadata().is_ok() {
            fs::rename(self.folder, &old)?;
        }
        fs::rename(unpacked, self.folder)?;
        remove(&old)
    }

    /// Held until dropped, or until the process ends however it ends.
    fn lock(&self) -> Result<File> {
        let path = self.beside("lock");
        let file = File::create(&path).with_context(|| format!("can't make {}", path.display()))?;
        match file.try_lock() {
            Err(TryLockError::WouldBlock) => {
                eprintln!("another process is setting libtorch up: waiting for it");
                file.lock()?;
            }
            result => result?,
        }
        Ok(file)
    }

    fn beside(&self, what: &str) -> PathBuf {
        let mut name = self.folder.as_os_str().to_owned();
        name.push(".");
        name.push(what);
        PathBuf::from(name)
    }
}

/// Removes a folder, or a link to one, if it is there.
fn remove(folder: &Path) -> Result<()> {
    let removed = match folder.symlink_metadata() {
        Ok(metadata) if metadata.is_dir() => fs::remove_dir_all(folder),
        Ok(_) => fs::remove_file(folder),
        Err(error) if error.kind() == ErrorKind::NotFound => Ok(()),
        Err(error) => Err(error),
    };
    removed.with_context(|| format!("can't remove {}", folder.display()))
}
