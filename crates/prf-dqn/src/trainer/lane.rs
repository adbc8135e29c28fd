//! One environment of a run and the episode it is in.

use prf_envs::Task;
use prf_envs::rng::ChaCha8Rng;
use rand_core::Rng;
use serde::{Deserialize, Serialize};

use crate::evaluate::Episode;

pub(super) struct Lane {
    pub(super) task: Task,
    pub(super) episode: Episode,
    /// Where the seeds of its episodes come from.
    pub(super) seeds: ChaCha8Rng,
}

impl Lane {
    pub(super) fn new(task: Task, seeds: ChaCha8Rng) -> Self {
        let mut lane = Self { task, episode: Episode::default(), seeds };
        lane.begin_episode();
        lane
    }

    pub(super) fn begin_episode(&mut self) {
        self.episode = Episode::default();
        self.task.reset(self.seeds.next_u64());
    }
}

/// Sums over training episodes and updates since the last record.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub(super) struct Window {
    pub(super) steps: u64,
    episodes: u64,
    score: f64,
    reward: f64,
    losses: u64,
    loss: f64,
}

impl Window {
    pub(super) fn add_episode(&mut self, episode: Episode) {
        self.steps += u64::from(episode.steps);
        self.episodes += 1;
        self.score += f64::from(episode.score);
        self.reward += episode.reward;
    }

    pub(super) fn add_loss(&mut self, loss: f32) {
        self.losses += 1;
        self.loss += f64::from(loss);
    }

    pub(super) fn mean_score(&self) -> Option<f64> {
        self.mean(self.score)
    }

    pub(super) fn mean_reward(&self) -> Option<f64> {
        self.mean(self.reward)
    }

    pub(super) fn mean_steps(&self) -> Option<f64> {
        self.mean(self.steps as f64)
    }

    fn mean(&self, sum: f64) -> Option<f64> {
        (self.episodes > 0).then(|| sum / self.episodes as f64)
    }

    pub(super) fn mean_loss(&self) -> Option<f64> {
        (self.losses > 0).then(|| self.loss / self.losses as f64)
    }
}
