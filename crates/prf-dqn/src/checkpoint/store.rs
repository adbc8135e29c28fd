//! The checkpoints of a run: `checkpoints/step-…/` and the replay segments they share.

use std::fs::{self, File};
use std::io::BufWriter;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::{Checkpoint, MODEL_FILE, Model};
use crate::error::{Error, Result};
use crate::files::{PARTIAL, sync_dir};
use crate::replay::Replay;

/// Checkpoints that are kept, the newest ones.
const KEPT: usize = 2;

/// A file of the replay: the rows that were new at one checkpoint.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct Segment {
    file: String,
    /// Rows written by each environment up to the end of this segment.
    end: Vec<u64>,
}

/// Writes and finds checkpoints in a run directory.
#[derive(Debug)]
pub struct CheckpointStore {
    checkpoints: PathBuf,
    replay: PathBuf,
}

impl CheckpointStore {
    /// The store of the run directory `run`. Leftovers of an interrupted write are removed.
    ///
    /// # Errors
    /// When the directories cannot be made.
    pub fn open(run: &Path) -> Result<Self> {
        let store = Self { checkpoints: run.join("checkpoints"), replay: run.join("replay") };
        for dir in [&store.checkpoints, &store.replay] {
            fs::create_dir_all(dir).map_err(Error::io("make", dir))?;
            for path in entries(dir)?.into_iter().filter(|path| file_name(path).starts_with(PARTIAL)) {
                let removed = if path.is_dir() { fs::remove_dir_all(&path) } else { fs::remove_file(&path) };
                removed.map_err(Error::io("remove", &path))?;
            }
        }
        Ok(store)
    }

    /// The checkpoints under `run`, oldest first.
    pub fn list(run: &Path) -> Result<Vec<PathBuf>> {
        let mut found = entries(&run.join("checkpoints"))?;
        found.retain(|path| file_name(path).starts_with("step-") && path.join(MODEL_FILE).is_file());
        found.sort();
        Ok(found)
    }

    /// Writes the rows that are new in the replay and gives the segments that hold all of it.
    pub(crate) fn write_replay(&self, step: u64, replay: &Replay, known: &[Segment]) -> Result<Vec<Segment>> {
        let from = known.last().map_or_else(|| vec![0; replay.lanes()], |segment| segment.end.clone());
        let mut segments: Vec<Segment> =
            known.iter().filter(|segment| replay.still_holds(&segment.end)).cloned().collect();
        let file = format!("step-{step:012}.lz4");
        let (partial, path) = (self.replay.join(format!("{PARTIAL}{file}")), self.replay.join(&file));
        let write = || {
            let out = File::create(&partial)?;
            replay.write_segment(&from, BufWriter::new(&out))?;
            out.sync_all()?;
            fs::rename(&partial, &path)
        };
        write().map_err(|source| {
            // The write's own error is the one to tell; what is left of the file goes with the next opening at the latest.
            drop(fs::remove_file(&partial));
            Error::io("write", &path)(source)
        })?;
        sync_dir(&self.replay)?;
        segments.push(Segment { file, end: replay.written() });
        Ok(segments)
    }

    /// Reads the segments of a checkpoint into an empty replay.
    pub(crate) fn read_replay(&self, segments: &[Segment], replay: &mut Replay) -> Result<()> {
        for segment in segments {
            let path = self.replay.join(&segment.file);
            let file = File::open(&path).map_err(Error::unreadable(&path))?;
            replay.read_segment(&path, file)?;
            if replay.written() != segment.end {
                let got = format!("{:?} rows", replay.written());
                return Err(Error::checkpoint(&path, got, format!("{:?} rows", segment.end)));
            }
        }
        Ok(())
    }

    /// Writes a checkpoint, whole or not at all, then forgets what neither it nor the one before needs. `segments` are
    /// those of the new checkpoint and of the one before.
    pub(crate) fn write(&self, step: u64, checkpoint: &Checkpoint, segments: [&[Segment]; KEPT]) -> Result<()> {
        let name = format!("step-{step:012}");
        let (partial, path) = (self.checkpoints.join(format!("{PARTIAL}{name}")), self.checkpoints.join(&name));
        let write = || {
            fs::create_dir_all(&partial).map_err(Error::io("make", &partial))?;
            checkpoint.write(&partial)?;
            sync_dir(&partial)?;
            if path.exists() {
                // What a user left of a damaged checkpoint; whole ones are never written twice.
                fs::remove_dir_all(&path).map_err(Error::io("replace", &path))?;
            }
            fs::rename(&partial, &path).map_err(Error::io("write", &path))?;
            sync_dir(&self.checkpoints)
        };
        write().inspect_err(|_| drop(fs::remove_dir_all(&partial)))?;
        self.forget_old(segments)
    }

    /// Writes the model of the best evaluation so far.
    pub(crate) fn write_best(&self, model: &Model) -> Result<()> {
        let dir = self.checkpoints.join("best");
        fs::create_dir_all(&dir).map_err(Error::io("make", &dir))?;
        model.write(&dir.join(MODEL_FILE))
    }

    fn forget_old(&self, needed: [&[Segment]; KEPT]) -> Result<()> {
        let run = self.checkpoints.parent().unwrap_or(Path::new("."));
        let found = Self::list(run)?;
        for path in &found[..found.len().saturating_sub(KEPT)] {
            fs::remove_dir_all(path).map_err(Error::io("remove", path))?;
        }
        for path in entries(&self.replay)? {
            let name = file_name(&path);
            if !needed.iter().flat_map(|segments| segments.iter()).any(|segment| segment.file == name) {
                fs::remove_file(&path).map_err(Error::io("remove", &path))?;
            }
        }
        Ok(())
    }
}

fn entries(dir: &Path) -> Result<Vec<PathBuf>> {
    let read = || fs::read_dir(dir)?.map(|entry| Ok(entry?.path())).collect::<std::io::Result<Vec<_>>>();
    match read() {
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => Ok(Vec::new()),
        other => other.map_err(Error::io("read", dir)),
    }
}

fn file_name(path: &Path) -> String {
    path.file_name().unwrap_or_default().to_string_lossy().into_owned()
}
