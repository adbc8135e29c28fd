//! How far a run has come, and how it goes on.

use std::path::{Path, PathBuf};
use std::time::SystemTime;

use prf_dqn::checkpoint::{Checkpoint, CheckpointStore};
use prf_dqn::config::RunConfig;
use prf_dqn::record::{Metrics, is_being_recorded};
use prf_dqn::run_dir::{Manifest, RunDir};

use super::read_config;
use crate::shell::shown;

/// The state of a run.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum State {
    Finished,
    /// A process trains in it now.
    Running,
    /// Saved after so many steps, and to be gone on with.
    Interrupted(u64),
    /// Begun and never saved: it begins anew.
    NeverSaved,
    /// Something that is needed is missing or broken.
    Damaged(String),
}

/// A run as `prf runs` tells of it.
#[derive(Debug)]
pub(crate) struct Standing {
    pub(crate) path: PathBuf,
    pub(crate) state: State,
    /// Absent if it can't be read.
    pub(crate) config: Option<RunConfig>,
    pub(crate) manifest: Option<Manifest>,
    /// Steps and training episodes that are done, as far as they are recorded or saved.
    pub(crate) steps: u64,
    pub(crate) episodes: u64,
    pub(crate) best_score: Option<f64>,
    pub(crate) last_score: Option<f64>,
    /// When something was recorded last.
    pub(crate) changed: Option<SystemTime>,
}

impl Standing {
    /// The run in the folder `path`. Of checkpoints, only the lengths of the newest one's files are looked at.
    pub(crate) fn of(path: &Path) -> Standing {
        let dir = RunDir::at(path);
        let metrics_path = dir.metrics_path();
        let mut damage = None;
        let mut note = |error: &dyn ToString| {
            damage.get_or_insert_with(|| error.to_string());
        };
        let config = read_config(&dir).inspect_err(|error| note(error)).ok();
        let manifest = dir.manifest().inspect_err(|error| note(error)).ok().flatten();
        let metrics = match metrics_path.exists() {
            true => Metrics::read(&metrics_path).inspect_err(|error| note(error)).unwrap_or_default(),
            false => Metrics::default(),
        };
        let saved = newest_checkpoint(path).inspect_err(|error| note(error)).ok().flatten();
        let is_finished = manifest.as_ref().is_some_and(|manifest| manifest.finished);
        let state = match damage {
            // While a run goes on, files come and go.
            _ if is_being_recorded(&metrics_path).unwrap_or(false) => State::Running,
            Some(damage) => State::Damaged(damage),
            None => match saved {
                Some(_) if is_finished => State::Finished,
                Some(step) => State::Interrupted(step),
                None => State::NeverSaved,
            },
        };
        let recorded = metrics.evaluations.last();
        let recorded_step = recorded.map_or(0, |record| record.step);
        Standing {
            steps: match state {
                State::Interrupted(step) => step,
                State::NeverSaved => 0,
                _ => recorded_step.max(saved.unwrap_or(0)),
            },
            episodes: recorded.map_or(0, |record| record.episode),
            best_score: metrics.evaluations.iter().map(|record| record.mean_score).max_by(f64::total_cmp),
            last_score: recorded.map(|record| record.mean_score),
            changed: [metrics_path, dir.config_path()].iter().find_map(|path| path.metadata().ok()?.modified().ok()),
            path: path.to_owned(),
            state,
            config,
            manifest,
        }
    }

    /// The command that goes on with an unfinished run, from the current folder.
    pub(crate) fn resume(&self) -> Option<String> {
        if !matches!(self.state, State::Interrupted(_) | State::NeverSaved) {
            return None;
        }
        let mut command =
            format!("prf train {} --out {} --resume", shown(&self.path.join("config.toml")), shown(&self.path));
        match self.manifest.as_ref().map(|manifest| manifest.device.as_str()) {
            Some(device) if device.starts_with("cuda") => command.push_str(" --device cuda"),
            Some("mps") => command.push_str(" --device mps"),
            _ => {}
        }
        Some(command)
    }
}

/// The steps of the newest checkpoint, whose files are all there.
fn newest_checkpoint(run: &Path) -> prf_dqn::Result<Option<u64>> {
    let Some(newest) = CheckpointStore::list(run)?.pop() else { return Ok(None) };
    Checkpoint::check_lengths(&newest)?;
    let name = newest.file_name().unwrap_or_default().to_string_lossy().into_owned();
    Ok(name.strip_prefix("step-").and_then(|step| step.parse().ok()))
}
