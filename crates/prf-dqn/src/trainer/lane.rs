//! One environment of a run and the episode it is in.

use prf_envs::Task;
use prf_envs::rng::ChaCha8Rng;
use rand_core::Rng;
use serde::{Deserialize, Serialize};

use crate::error::{Error, Result};
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

/// The reward of `environment` in `step`, if it is one that can be learned from.
pub(super) fn finite(reward: f32, environment: usize, step: u64) -> Result<f32> {
    if reward.is_finite() { Ok(reward) } else { Err(Error::Reward { environment, step, reward }) }
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_reward_that_is_no_number_is_named_with_its_place() {
        assert_eq!(finite(0.5, 3, 120).expect("a number"), 0.5);
        for reward in [f32::NAN, f32::INFINITY] {
            let error = finite(reward, 3, 120).expect_err("no number").to_string();
            assert!(
                error.starts_with("the reward of environment 3 in step 120 is ") && error.contains("expected"),
                "{error}"
            );
        }
    }
}
