//! `metrics.jsonl`: one JSON object a line, each written to the file at once.

use std::fs::{File, OpenOptions, TryLockError};
use std::io::Write;
use std::path::{Path, PathBuf};

use super::{Event, Recorder};
use crate::error::{Error, Result};

/// Writes training and evaluation records.
#[derive(Debug)]
pub struct JsonlRecorder {
    path: PathBuf,
    file: File,
}

impl JsonlRecorder {
    /// Opens the file, to go on at its end.
    ///
    /// # Errors
    /// [`Error::Busy`] when another process records into it; [`Error::Io`] when it cannot be opened.
    pub fn open(path: &Path) -> Result<Self> {
        let file = OpenOptions::new().append(true).create(true).open(path).map_err(Error::io("open", path))?;
        // Whoever holds the lock is training in this run directory; it is given back with the file.
        match file.try_lock() {
            Ok(()) => Ok(Self { path: path.to_owned(), file }),
            Err(TryLockError::WouldBlock) => Err(Error::Busy { path: path.to_owned() }),
            Err(TryLockError::Error(source)) => Err(Error::io("lock", path)(source)),
        }
    }

    /// Length of the file, in bytes, all of which are then on the disk.
    ///
    /// # Errors
    /// When the file cannot be flushed.
    pub fn bytes(&self) -> Result<u64> {
        self.file.sync_data().map_err(Error::io("write", &self.path))?;
        Ok(self.file.metadata().map_err(Error::io("read", &self.path))?.len())
    }

    /// Drops what a killed run wrote after its last checkpoint: the resumed run writes it again.
    ///
    /// # Errors
    /// When less than `bytes` bytes are there, or the file cannot be cut.
    pub fn truncate(&mut self, bytes: u64) -> Result<()> {
        let found = self.bytes()?;
        if found < bytes {
            return Err(Error::checkpoint(&self.path, format!("{found} bytes"), format!("at least {bytes}")));
        }
        self.file.set_len(bytes).map_err(Error::io("cut", &self.path))
    }
}

/// Whether a process records into the file at `path` now. For the moment that this takes, none can begin to.
///
/// # Errors
/// When the file cannot be opened.
pub fn is_being_recorded(path: &Path) -> Result<bool> {
    let file = File::open(path).map_err(Error::io("open", path))?;
    match file.try_lock_shared() {
        Ok(()) => Ok(false),
        Err(TryLockError::WouldBlock) => Ok(true),
        Err(TryLockError::Error(source)) => Err(Error::io("lock", path)(source)),
    }
}

impl Recorder for JsonlRecorder {
    fn record(&mut self, event: &Event) -> Result<()> {
        if matches!(event, Event::Progress(_) | Event::Checkpoint(_)) {
            return Ok(());
        }
        let mut line = serde_json::to_vec(event).expect("records hold only numbers and strings");
        line.push(b'\n');
        self.file.write_all(&line).map_err(Error::io("write", &self.path))
    }
}
