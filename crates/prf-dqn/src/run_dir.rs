//! The directory of a run and what lies where in it.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use prf_core::Goal;
use serde::{Deserialize, Serialize};

use crate::config::RunConfig;
use crate::error::{Error, Result};
use crate::files::{PARTIAL, write_whole};
use crate::record::{JsonlRecorder, TimeShares};

/// The goal's picture, and the mask of one that has it.
const GOAL: &str = "goal.png";
const MASK: &str = "mask.png";
/// The records, whose lock is that of the run.
const METRICS: &str = "metrics.jsonl";

/// A run's directory: `config.toml`, `goal.png`, `mask.png`, `manifest.json`, `metrics.jsonl`, `run.mcap`, `tensorboard/`,
/// `checkpoints/`, `replay/`; after a divergence `diverged/`.
#[derive(Debug, Clone)]
pub struct RunDir {
    path: PathBuf,
    revision: Option<&'static str>,
}

/// Where a run came from and where its time went: `manifest.json`.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Manifest {
    /// Version of PRF.
    pub prf_version: String,
    /// Revision of the sources, when prf was built in a git checkout.
    pub git_revision: Option<String>,
    /// Version of libtorch.
    pub libtorch_version: String,
    /// The machine, as [`machine::describe`](crate::machine::describe) has it; absent from older runs.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub machine: Option<String>,
    /// Seed of the run.
    pub seed: u64,
    /// Device of the network.
    pub device: String,
    /// Threads of the network.
    pub threads: usize,
    /// Steps taken so far.
    pub steps: u64,
    /// Whether the run came to its end.
    pub finished: bool,
    /// Where the time went, in seconds.
    pub time: TimeShares,
}

impl RunDir {
    /// Begins a run directory: makes it, unless something is there already, and writes the resolved configuration and
    /// the goal's pictures into it, so that the run depends on no other file.
    ///
    /// # Errors
    /// [`Error::Io`] when the directory is there and not empty, or cannot be written; [`Error::Busy`] when another process
    /// begins it at this moment.
    pub fn create(path: &Path, config: &RunConfig, goal: Option<&Goal>) -> Result<Self> {
        let run = Self::at(path);
        run.expect_nothing()?;
        fs::create_dir_all(path).map_err(Error::io("make", path))?;
        // Of two processes that came so far, the one with this lock goes on. Once it is given back there is a run.
        let _lock = JsonlRecorder::open(&run.metrics_path())?;
        run.expect_nothing()?;
        let mut config = config.clone();
        if let Some(goal) = goal {
            prf_core::io::write_frame(goal.picture.view(), run.path.join(GOAL))?;
            config.reward.goal = Some(GOAL.into());
            if let (Some(mask), Some(window)) = (&goal.mask, &mut config.reward.window) {
                prf_core::io::write_frame(mask.view(), run.path.join(MASK))?;
                window.mask = Some(MASK.into());
            }
        }
        let text = toml::to_string(&config).expect("a configuration is plain tables");
        // The configuration makes the directory a run, so it comes last.
        write_whole(&run.config_path(), text.as_bytes())?;
        Ok(run)
    }

    /// Whether nothing is there but what an interrupted beginning leaves.
    fn expect_nothing(&self) -> Result<()> {
        let leftover = |entry: &fs::DirEntry| {
            let name = entry.file_name();
            let is_empty = || entry.metadata().is_ok_and(|metadata| metadata.len() == 0);
            name == GOAL
                || name == MASK
                || name.to_string_lossy().starts_with(PARTIAL)
                || (name == METRICS && is_empty())
        };
        let begun = |entry: std::io::Result<fs::DirEntry>| entry.is_ok_and(|entry| !leftover(&entry));
        if fs::read_dir(&self.path).is_ok_and(|mut entries| entries.any(begun)) || self.path.is_file() {
            let source = std::io::Error::from(std::io::ErrorKind::AlreadyExists);
            return Err(Error::Io { action: "make", path: self.path.clone(), source });
        }
        Ok(())
    }

    /// The run directory at `path`, made earlier.
    pub fn at(path: &Path) -> Self {
        Self { path: path.to_owned(), revision: None }
    }

    /// The same, with the revision of the sources that prf was built from, which the run's records name.
    #[must_use]
    pub fn built_from(self, revision: Option<&'static str>) -> Self {
        Self { revision, ..self }
    }

    /// The directory itself.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The resolved configuration.
    pub fn config_path(&self) -> PathBuf {
        self.path.join("config.toml")
    }

    /// The records of the run, one JSON object a line.
    pub fn metrics_path(&self) -> PathBuf {
        self.path.join(METRICS)
    }

    /// The recorded episodes, for Foxglove.
    pub fn mcap_path(&self) -> PathBuf {
        self.path.join("run.mcap")
    }

    /// The folder of the event file, for TensorBoard.
    pub fn tensorboard_path(&self) -> PathBuf {
        self.path.join("tensorboard")
    }

    /// Where a run of `seed` on `device` comes from, as its records name it.
    pub(crate) fn provenance(&self, seed: u64, device: tch::Device) -> BTreeMap<String, String> {
        let known = [
            ("seed", seed.to_string()),
            ("device", format!("{device:?}").to_lowercase()),
            ("prf_version", env!("CARGO_PKG_VERSION").to_owned()),
            ("libtorch_version", crate::LIBTORCH_VERSION.to_owned()),
        ];
        let revision = self.revision.map(|revision| ("git_revision", revision.to_owned()));
        known.into_iter().chain(revision).map(|(key, value)| (key.to_owned(), value)).collect()
    }

    /// Writes `manifest.json`.
    ///
    /// # Errors
    /// [`Error::Io`] when it cannot be written.
    pub fn write_manifest(&self, manifest: &Manifest) -> Result<()> {
        let text = serde_json::to_vec_pretty(manifest).expect("a manifest holds only numbers and strings");
        write_whole(&self.manifest_path(), &text)
    }

    /// Reads `manifest.json`; nothing if the run has none yet.
    ///
    /// # Errors
    /// [`Error::Io`] when it cannot be read, [`Error::Mismatch`] when it is no manifest.
    pub fn manifest(&self) -> Result<Option<Manifest>> {
        let path = self.manifest_path();
        let bytes = match fs::read(&path) {
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => return Ok(None),
            read => read.map_err(Error::io("read", &path))?,
        };
        let manifest = serde_json::from_slice(&bytes);
        Ok(Some(manifest.map_err(|error| Error::mismatch(&path, error.to_string(), "what prf train writes there"))?))
    }

    fn manifest_path(&self) -> PathBuf {
        self.path.join("manifest.json")
    }

    /// The files of the goal's picture and of its mask that are there.
    pub fn goal_paths(&self) -> impl Iterator<Item = PathBuf> {
        [GOAL, MASK].map(|name| self.path.join(name)).into_iter().filter(|path| path.is_file())
    }
}
