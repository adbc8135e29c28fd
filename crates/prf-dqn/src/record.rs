//! What a run tells while it goes on. Recorders record and nothing else.

use std::time::Duration;

use serde::{Deserialize, Serialize};

use crate::error::Result;

mod jsonl;
mod kept;
mod mcap;
mod messages;
mod metrics;
mod step;
mod tensorboard;

pub use jsonl::{JsonlRecorder, is_being_recorded};
pub use kept::{KeptRecorder, Loss, Marks, Records};
pub use mcap::{McapRecorder, Preamble};
pub use messages::{Clock, Message, STEP_NS, Topic, goal_message, messages};
pub use metrics::Metrics;
pub use step::{EpisodeKind, StepRecord};
pub use tensorboard::TensorBoardRecorder;

/// Something worth telling.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum Event<'a> {
    /// How the training episodes since the last such event went.
    Train(TrainRecord),
    /// A greedy evaluation.
    Evaluation(EvaluationRecord),
    /// A step of an episode that is recorded step by step.
    #[serde(skip)]
    Step(&'a StepRecord<'a>),
    /// Where the run stands; many a second, for people who watch.
    #[serde(skip)]
    Progress(Progress),
    /// A checkpoint was written after this many steps.
    #[serde(skip)]
    Checkpoint(u64),
}

/// Training episodes, summed up.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TrainRecord {
    /// Steps so far, over all environments.
    pub step: u64,
    /// Episodes finished so far.
    pub episode: u64,
    /// Updates so far.
    pub update: u64,
    /// Mean score of the episodes since the last record; absent when none has ended.
    pub mean_score: Option<f64>,
    /// Mean sum of rewards of these episodes.
    pub mean_reward: Option<f64>,
    /// Mean length of these episodes, in steps.
    pub mean_steps: Option<f64>,
    /// Mean loss of the updates since the last record; absent before the first update.
    pub mean_loss: Option<f64>,
    /// Exploration now.
    pub epsilon: f32,
    /// Time since the run began, without the time it was interrupted, in seconds.
    pub time_s: f64,
    /// Steps a second since the last record.
    pub steps_per_s: f64,
}

/// A greedy evaluation on the run's fixed seeds.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct EvaluationRecord {
    /// Steps so far.
    pub step: u64,
    /// Training episodes finished so far.
    pub episode: u64,
    /// Episodes played.
    pub episodes: usize,
    /// Mean score.
    pub mean_score: f64,
    /// Sample standard deviation of the score.
    pub std_score: f64,
    /// Mean sum of rewards.
    pub mean_reward: f64,
    /// Mean length, in steps.
    pub mean_steps: f64,
    /// Time since the run began, without the time it was interrupted, in seconds.
    pub time_s: f64,
}

/// Where a run stands.
#[derive(Debug, Clone, Copy)]
pub struct Progress {
    /// Steps so far.
    pub steps: u64,
    /// Episodes finished so far.
    pub episodes: u64,
    /// How much of the run is done, in [0, 1].
    pub done: f64,
    /// Exploration now.
    pub epsilon: f32,
    /// Mean score of the training episodes since the last evaluation, once one has ended.
    pub recent_score: Option<f64>,
    /// Mean sum of rewards of the same episodes.
    pub recent_reward: Option<f64>,
    /// Mean score of the last evaluation.
    pub evaluation_score: Option<f64>,
}

/// Takes note of events.
pub trait Recorder {
    /// Takes note of one event.
    ///
    /// # Errors
    /// When it could not be written.
    fn record(&mut self, event: &Event<'_>) -> Result<()>;
}

/// Where the time of a run went.
#[derive(Debug, Clone, Copy, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct TimeShares {
    /// Batched forward passes that choose actions.
    pub acting_s: f64,
    /// Environments, drawing, rewards and state representation.
    pub worlds_s: f64,
    /// Writing to and drawing from the replay.
    pub replay_s: f64,
    /// Updates of the network.
    pub updates_s: f64,
    /// Greedy evaluations.
    pub evaluation_s: f64,
    /// Writing checkpoints.
    pub checkpoints_s: f64,
    /// Recording.
    pub records_s: f64,
}

impl TimeShares {
    /// The sum of all.
    pub fn total_s(&self) -> f64 {
        self.acting_s
            + self.worlds_s
            + self.replay_s
            + self.updates_s
            + self.evaluation_s
            + self.checkpoints_s
            + self.records_s
    }
}

/// Adds the time that `work` takes to `share`.
pub(crate) fn timed<T>(share: &mut f64, work: impl FnOnce() -> T) -> T {
    let start = std::time::Instant::now();
    let result = work();
    *share += Duration::as_secs_f64(&start.elapsed());
    result
}
