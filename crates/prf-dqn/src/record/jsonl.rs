//! `metrics.jsonl`: one JSON object a line, each written to the file at once.

use std::fs::{File, OpenOptions, TryLockError};
use std::io::Write;
use std::path::{Path, PathBuf};

use serde_json::Value;

use super::{Event, KeptRecorder, Loss, Recorder};
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
    fn bytes(&self) -> Result<u64> {
        self.file.sync_data().map_err(Error::io("write", &self.path))?;
        Ok(self.file.metadata().map_err(Error::io("read", &self.path))?.len())
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
    fn record(&mut self, event: &Event<'_>) -> Result<()> {
        if !matches!(event, Event::Train(_) | Event::Evaluation(_)) {
            return Ok(());
        }
        let mut line = serde_json::to_vec(event).expect("records hold only numbers and strings");
        line.push(b'\n');
        self.file.write_all(&line).map_err(Error::io("write", &self.path))
    }
}

impl KeptRecorder for JsonlRecorder {
    fn name(&self) -> &'static str {
        "metrics.jsonl"
    }

    fn mark(&mut self, _due: bool) -> Result<Value> {
        Ok(self.bytes()?.into())
    }

    /// The numbers of a run are never given up: a file that is too short is an error.
    fn rewind(&mut self, mark: Option<&Value>) -> Result<Option<Loss>> {
        let mark = mark.map_or(Some(0), Value::as_u64);
        let mark = mark.ok_or_else(|| Error::checkpoint(&self.path, "another mark in it", "a length"))?;
        let found = self.bytes()?;
        if found < mark {
            return Err(Error::checkpoint(&self.path, format!("{found} bytes"), format!("at least {mark}")));
        }
        self.file.set_len(mark).map_err(Error::io("cut", &self.path))?;
        Ok(None)
    }

    fn finish(&mut self) -> Result<()> {
        self.file.sync_all().map_err(Error::io("write", &self.path))
    }
}
