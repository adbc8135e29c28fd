//! What of a run goes into a checkpoint, and how it comes back.

use std::collections::BTreeMap;
use std::path::Path;

use prf_envs::rng;
use serde::{Deserialize, Serialize};

use super::Trainer;
use super::lane::Window;
use super::recording::Recording;
use crate::checkpoint::{Checkpoint, CheckpointStore, Model, Retention};
use crate::error::{Error, Result};
use crate::evaluate::Episode;
use crate::optimizer::Adam;
use crate::record::{Event, Marks, Recorder, TimeShares, timed};
use crate::run_dir::RunDir;

/// Names of vectors in a checkpoint.
const PRIORITIES: &str = "replay.priorities";
const LARGEST_PRIORITY: &str = "replay.largest_priority";

/// Everything that is counted.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub(super) struct Counters {
    pub(super) steps: u64,
    pub(super) episodes: u64,
    /// Evaluations and checkpoints that were due so far by the configuration's intervals.
    pub(super) evaluations_due: u64,
    pub(super) checkpoints_due: u64,
    /// Steps at the last evaluation.
    pub(super) evaluated_at: Option<u64>,
    pub(super) last_score: Option<f64>,
    pub(super) best_score: Option<f64>,
    pub(super) window: Window,
    /// Training time before this process, in seconds, and where it went.
    pub(super) elapsed_s: f64,
    pub(super) time: TimeShares,
}

/// The JSON part of a checkpoint.
#[derive(Debug, Serialize, Deserialize)]
struct State {
    config: String,
    counters: Counters,
    updates: u64,
    adam_steps: u64,
    episodes: Vec<Episode>,
    recording: Recording,
    records: Marks,
    /// This checkpoint and those that stay beside it.
    retention: Retention,
}

impl Counters {
    pub(super) fn finish(&mut self, episode: Episode) {
        self.episodes += 1;
        self.window.add_episode(episode);
    }
}

impl Trainer {
    /// Writes a checkpoint, unless there is one of this very step.
    pub(super) fn save(&mut self, recorder: &mut dyn Recorder) -> Result<()> {
        if self.saved_at == Some(self.counters.steps) {
            return Ok(());
        }
        let mut time = 0.0;
        timed(&mut time, || self.write_checkpoint())?;
        self.time.checkpoints_s += time;
        recorder.record(&Event::Checkpoint(self.counters.steps))
    }

    fn write_checkpoint(&mut self) -> Result<()> {
        let step = self.counters.steps;
        let due = self.is_finished() || step / self.config.train.checkpoint_every_steps > self.counters.checkpoints_due;
        self.counters.checkpoints_due = step / self.config.train.checkpoint_every_steps;
        let segments = self.checkpoints.write_replay(step, &self.replay, self.retention.newest())?;
        let retention = self.retention.with(step, segments, self.config.train.keep_checkpoints);
        let records = timed(&mut self.time.records_s, || self.records.mark(due))?;
        self.checkpoints.write(step, &self.checkpoint(&retention, records)?, &retention)?;
        self.retention = retention;
        self.saved_at = Some(step);
        Ok(())
    }

    /// The run as it is now, but for the frames of the replay, which are in the segments that `retention` names, and for its
    /// records, which are at `records`.
    pub(super) fn checkpoint(&self, retention: &Retention, records: Marks) -> Result<Checkpoint> {
        let (first, second, adam_steps) = self.learner.optimizer.to_parts()?;
        let mut blobs = BTreeMap::new();
        blobs.insert("rng.exploration".to_owned(), rng::save(&self.exploration));
        blobs.insert("rng.replay".to_owned(), rng::save(&self.sampling));
        for (index, lane) in self.lanes.iter().enumerate() {
            blobs.insert(format!("task.{index}"), lane.task.save_state());
            blobs.insert(format!("rng.episodes.{index}"), rng::save(&lane.seeds));
        }
        let mut vectors = BTreeMap::from([
            ("target".to_owned(), self.learner.target.to_vec()?),
            ("adam.first".to_owned(), first),
            ("adam.second".to_owned(), second),
        ]);
        if let Some((priorities, largest)) = self.replay.priorities() {
            vectors.insert(PRIORITIES.to_owned(), priorities);
            vectors.insert(LARGEST_PRIORITY.to_owned(), vec![largest]);
        }
        let state = State {
            config: self.config_text(),
            counters: Counters { elapsed_s: self.elapsed_s(), time: self.time, ..self.counters.clone() },
            updates: self.learner.updates,
            adam_steps,
            episodes: self.lanes.iter().map(|lane| lane.episode).collect(),
            recording: self.recording.clone(),
            records,
            retention: retention.clone(),
        };
        Ok(Checkpoint {
            state: serde_json::to_string(&state).expect("a state holds only numbers and strings"),
            blobs,
            vectors,
            model: Model::of(&self.learner.online)?,
        })
    }

    /// Goes on from the newest checkpoint; without any, from the beginning.
    pub(super) fn resume(&mut self, run: &RunDir) -> Result<()> {
        let Some(dir) = CheckpointStore::list(run.path())?.pop() else {
            self.losses = self.records.rewind(&Marks::new())?;
            return Ok(());
        };
        let mut checkpoint = Checkpoint::read(&dir, self.learner.online.architecture())?;
        let state: State = serde_json::from_str(&checkpoint.state)
            .map_err(|error| Error::checkpoint(&dir, error, "the state of a run of this version"))?;
        if state.config != self.config_text() {
            return Err(Error::mismatch(&dir, "another configuration", "the run's own config.toml, unchanged"));
        }
        self.restore_learner(&mut checkpoint, &state, &dir)?;
        self.restore_lanes(&mut checkpoint, &state, &dir)?;
        let damaged = |error| Error::checkpoint(&dir, error, "a whole checkpoint");
        self.exploration = rng::restore(&checkpoint.blob("rng.exploration", &dir)?).map_err(damaged)?;
        self.sampling = rng::restore(&checkpoint.blob("rng.replay", &dir)?).map_err(damaged)?;
        self.checkpoints.read_replay(state.retention.newest(), &mut self.replay)?;
        self.restore_priorities(&mut checkpoint, &dir)?;
        self.losses = self.records.rewind(&state.records)?;
        self.recording = state.recording;
        self.saved_at = Some(state.counters.steps);
        self.time = state.counters.time;
        self.counters = state.counters;
        self.retention = state.retention;
        Ok(())
    }

    fn restore_learner(&mut self, checkpoint: &mut Checkpoint, state: &State, dir: &Path) -> Result<()> {
        let compute = self.learner.compute().clone();
        let count = checkpoint.model.values.len();
        let [target, first, second] = ["target", "adam.first", "adam.second"];
        let target = Model { values: checkpoint.vector(target, count, dir)?, ..checkpoint.model.clone() };
        self.learner.online = checkpoint.model.network(&compute)?;
        self.learner.target = target.network(&compute)?;
        let (first, second) = (checkpoint.vector(first, count, dir)?, checkpoint.vector(second, count, dir)?);
        self.learner.optimizer = Adam::restore(&first, &second, state.adam_steps, compute.device())?;
        self.learner.updates = state.updates;
        Ok(())
    }

    fn restore_lanes(&mut self, checkpoint: &mut Checkpoint, state: &State, dir: &Path) -> Result<()> {
        if state.episodes.len() != self.lanes.len() {
            let got = format!("{} environments", state.episodes.len());
            return Err(Error::mismatch(dir, got, format!("{}", self.lanes.len())));
        }
        for (index, lane) in self.lanes.iter_mut().enumerate() {
            let damaged = |error| Error::checkpoint(dir, error, "a whole checkpoint");
            lane.task.load_state(&checkpoint.blob(&format!("task.{index}"), dir)?).map_err(damaged)?;
            lane.seeds = rng::restore(&checkpoint.blob(&format!("rng.episodes.{index}"), dir)?).map_err(damaged)?;
            lane.episode = state.episodes[index];
        }
        Ok(())
    }

    /// To be called when the replay holds its rows again.
    fn restore_priorities(&mut self, checkpoint: &mut Checkpoint, dir: &Path) -> Result<()> {
        let Some((priorities, _)) = self.replay.priorities() else { return Ok(()) };
        let priorities = checkpoint.vector(PRIORITIES, priorities.len(), dir)?;
        let largest = checkpoint.vector(LARGEST_PRIORITY, 1, dir)?[0];
        let damaged = |got| Error::checkpoint(dir, got, "a priority for each transition of the replay");
        self.replay.set_priorities(&priorities, largest).map_err(damaged)
    }

    /// The configuration as a checkpoint remembers it; where the goal's file lies does not matter.
    fn config_text(&self) -> String {
        toml::to_string(&self.config.without_paths()).expect("a configuration is plain tables")
    }
}
