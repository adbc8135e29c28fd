//! The checkpoints of a run: `checkpoints/step-…/` and the replay segments they share.

use std::fs::{self, File};
use std::io::BufWriter;
use std::path::{Path, PathBuf};

use super::retention::{Retention, Segment, checkpoint_name, is_checkpoint_name};
use super::{Checkpoint, MODEL_FILE, Model};
use crate::error::{Error, Result};
use crate::files::{PARTIAL, sync_dir, write_dir_whole};
use crate::replay::Replay;

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
    ///
    /// # Errors
    /// When the directory cannot be read.
    pub fn list(run: &Path) -> Result<Vec<PathBuf>> {
        let mut found = entries(&run.join("checkpoints"))?;
        found.retain(|path| is_checkpoint_name(&file_name(path)) && path.is_dir());
        found.sort();
        Ok(found)
    }

    /// Writes the rows that are new in the replay and gives the segments that hold all of it.
    pub(crate) fn write_replay(&self, step: u64, replay: &Replay, known: &[Segment]) -> Result<Vec<Segment>> {
        let from = known.last().map_or_else(|| vec![0; replay.lanes()], |segment| segment.end.clone());
        let mut segments: Vec<Segment> =
            known.iter().filter(|segment| replay.still_holds(&segment.end)).cloned().collect();
        let file = format!("{}.lz4", checkpoint_name(step));
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

    /// Writes a checkpoint, whole or not at all, then removes what does not stay.
    pub(crate) fn write(&self, step: u64, checkpoint: &Checkpoint, retention: &Retention) -> Result<()> {
        // There may be what a user left of a damaged checkpoint; whole ones are never written twice.
        write_dir_whole(&self.checkpoints.join(checkpoint_name(step)), |dir| checkpoint.write(dir))?;
        self.forget_all_but(retention)
    }

    /// Writes the model of the best evaluation so far.
    pub(crate) fn write_best(&self, model: &Model) -> Result<()> {
        let dir = self.checkpoints.join("best");
        fs::create_dir_all(&dir).map_err(Error::io("make", &dir))?;
        model.write(&dir.join(MODEL_FILE))
    }

    /// Writes what is to be looked at after learning has diverged, whole or not at all, in place of what was there before, and gives
    /// its directory.
    pub(crate) fn write_diverged(&self, fill: impl FnOnce(&Path) -> Result<()>) -> Result<PathBuf> {
        let path = self.run().join("diverged");
        write_dir_whole(&path, fill)?;
        Ok(path)
    }

    fn run(&self) -> &Path {
        self.checkpoints.parent().unwrap_or(Path::new("."))
    }

    fn forget_all_but(&self, retention: &Retention) -> Result<()> {
        let found = Self::list(self.run())?;
        for path in retention.superfluous(&found) {
            fs::remove_dir_all(path).map_err(Error::io("remove", path))?;
        }
        for path in entries(&self.replay)? {
            if !retention.needs(&file_name(&path)) {
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
