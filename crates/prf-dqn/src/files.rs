//! Files that are there whole or not at all.

use std::fs::{self, File};
use std::io::{self, Write};
use std::path::Path;

use crate::error::{Error, Result};

/// Begins the name of a file or directory that is not yet whole.
pub(crate) const PARTIAL: &str = ".partial-";

/// Writes a file whole or, on an error, not at all; an older file of this name stays until then.
///
/// # Errors
/// [`Error::Io`] when it cannot be written.
pub fn write_whole(path: &Path, bytes: &[u8]) -> Result<()> {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let partial = path.with_file_name(format!("{PARTIAL}{name}"));
    let write = || {
        write_synced(&partial, bytes)?;
        fs::rename(&partial, path)
    };
    write().map_err(|source| {
        // The write's own error is the one to tell.
        drop(fs::remove_file(&partial));
        Error::io("write", path)(source)
    })
}

/// Writes a directory whole or, on an error, not at all, and waits until it is on the disk. `fill` is given the empty directory
/// that becomes it, and flushes what it writes there. An older directory of this name is replaced.
///
/// # Errors
/// Those of `fill`, and [`Error::Io`] when the directory cannot be made.
pub(crate) fn write_dir_whole(path: &Path, fill: impl FnOnce(&Path) -> Result<()>) -> Result<()> {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let partial = path.with_file_name(format!("{PARTIAL}{name}"));
    let write = || {
        if partial.exists() {
            fs::remove_dir_all(&partial).map_err(Error::io("remove", &partial))?;
        }
        fs::create_dir_all(&partial).map_err(Error::io("make", &partial))?;
        fill(&partial)?;
        sync_dir(&partial)?;
        if path.exists() {
            fs::remove_dir_all(path).map_err(Error::io("replace", path))?;
        }
        fs::rename(&partial, path).map_err(Error::io("write", path))?;
        sync_dir(path.parent().unwrap_or(Path::new(".")))
    };
    // The error of the write is the one to tell.
    write().inspect_err(|_| drop(fs::remove_dir_all(&partial)))
}

/// Writes a new file and waits until it is on the disk.
pub(crate) fn write_synced(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let mut file = File::create(path)?;
    file.write_all(bytes)?;
    file.sync_all()
}

/// Waits until the names in a directory are on the disk.
pub(crate) fn sync_dir(dir: &Path) -> Result<()> {
    File::open(dir).and_then(|dir| dir.sync_all()).map_err(Error::io("write", dir))
}
