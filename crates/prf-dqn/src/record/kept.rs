//! Records that lie in the run directory and go on where a checkpoint left them.

use std::collections::BTreeMap;
use std::fmt;
use std::path::{Path, PathBuf};

use serde_json::Value;

use super::{Event, JsonlRecorder, McapRecorder, Preamble, Recorder, TensorBoardRecorder};
use crate::config::RunConfig;
use crate::error::Result;
use crate::run_dir::RunDir;

/// A recorder whose file a killed run may leave with more in it than its last checkpoint knows of.
pub trait KeptRecorder: Recorder {
    /// What it goes by in a checkpoint.
    fn name(&self) -> &'static str;

    /// Sees to it that all that was recorded is on the disk, and says as plain data how far that is. Whether a checkpoint is `due`
    /// by the configuration, and so in every run of it, or is there because this run was interrupted must not show in what is written
    /// after both have gone on.
    ///
    /// # Errors
    /// When it cannot be written.
    fn mark(&mut self, due: bool) -> Result<Value>;

    /// Drops what was recorded after `mark`, or everything where there is none, and goes on from there. What of it was damaged
    /// is lost, and told.
    ///
    /// # Errors
    /// When the file cannot be read or written.
    fn rewind(&mut self, mark: Option<&Value>) -> Result<Option<Loss>>;

    /// Closes the file as a whole one. Nothing is recorded after that.
    ///
    /// # Errors
    /// When it cannot be written.
    fn finish(&mut self) -> Result<()>;
}

/// How far each record was at a checkpoint, by [`KeptRecorder::name`].
pub type Marks = BTreeMap<String, Value>;

/// What of a record was lost by damage.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Loss {
    /// The file.
    pub path: PathBuf,
    /// What was found.
    pub found: String,
    /// What is lost.
    pub lost: String,
}

impl Loss {
    pub(super) fn new(path: &Path, found: impl Into<String>, lost: impl Into<String>) -> Self {
        Self { path: path.to_owned(), found: found.into(), lost: lost.into() }
    }
}

impl fmt::Display for Loss {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}; {}", self.path.display(), self.found, self.lost)
    }
}

/// The records of a run directory, as its configuration wants them.
pub struct Records {
    kept: Vec<Box<dyn KeptRecorder>>,
}

impl Records {
    /// Takes hold of the run directory; what to record has to be told by [`rewind`](Records::rewind) first.
    ///
    /// # Errors
    /// [`Error::Busy`](crate::Error::Busy) when another process records into it; [`Error::Io`](crate::Error::Io) when it cannot
    /// be written.
    pub fn open(run: &RunDir, config: &RunConfig, preamble: Preamble) -> Result<Self> {
        // The first has the lock.
        let mut kept: Vec<Box<dyn KeptRecorder>> = vec![Box::new(JsonlRecorder::open(&run.metrics_path())?)];
        if config.record.tensorboard {
            kept.push(Box::new(TensorBoardRecorder::new(&run.tensorboard_path(), preamble.goal.as_ref())));
        }
        if config.record.mcap {
            kept.push(Box::new(McapRecorder::new(&run.mcap_path(), preamble)));
        }
        Ok(Self { kept })
    }

    /// As [`KeptRecorder::mark`], of all.
    ///
    /// # Errors
    /// When something cannot be written.
    pub fn mark(&mut self, due: bool) -> Result<Marks> {
        self.kept.iter_mut().map(|kept| Ok((kept.name().to_owned(), kept.mark(due)?))).collect()
    }

    /// As [`KeptRecorder::rewind`], of all.
    ///
    /// # Errors
    /// When something cannot be read or written.
    pub fn rewind(&mut self, marks: &Marks) -> Result<Vec<Loss>> {
        let losses = self.kept.iter_mut().map(|kept| kept.rewind(marks.get(kept.name())));
        Ok(losses.collect::<Result<Vec<_>>>()?.into_iter().flatten().collect())
    }

    /// As [`KeptRecorder::finish`], of all.
    ///
    /// # Errors
    /// When something cannot be written.
    pub fn finish(&mut self) -> Result<()> {
        self.kept.iter_mut().try_for_each(|kept| kept.finish())
    }
}

impl Recorder for Records {
    fn record(&mut self, event: &Event<'_>) -> Result<()> {
        self.kept.iter_mut().try_for_each(|kept| kept.record(event))
    }
}
