//! What a run is made of: the tables of a run's TOML file, with defaults and ranges.

use prf_core::Error as ParamError;
use prf_envs::{EnvConfig, RewardConfig, StateConfig, TaskConfig};
use serde::{Deserialize, Serialize};

use crate::compute::{Compute, Precision};
use crate::error::Result;
use crate::learner::LearnerSettings;
use crate::replay::{Reach, Replay};

/// Everything that decides a training run. The same `RunConfig` on the same machine with the same
/// number of threads gives the same run, bit by bit.
#[derive(Debug, Clone, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct RunConfig {
    /// Seed of every random stream of the run.
    #[serde(default)]
    pub seed: u64,
    /// `[env]`: the world.
    pub env: EnvConfig,
    /// `[reward]`: where the learner's reward comes from.
    pub reward: RewardConfig,
    /// `[state]`: what the network sees.
    #[serde(default)]
    pub state: StateConfig,
    /// `[train]`: the learner.
    pub train: TrainConfig,
    /// `[evaluation]`: the greedy evaluations during the run.
    #[serde(default)]
    pub evaluation: EvaluationConfig,
    /// `[record]`: what the run writes besides `metrics.jsonl`.
    #[serde(default)]
    pub record: RecordConfig,
}

/// `[train]`: the deep Q-network and its schedule. A *step* is one action in one environment.
#[derive(Debug, Clone, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct TrainConfig {
    /// Length of the run in steps, over all environments. Exactly one of `steps` and `episodes` is given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub steps: Option<u64>,
    /// Length of the run in finished episodes.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub episodes: Option<u64>,
    /// Environments stepped together, with one batched forward pass, 1..=1024.
    #[serde(default = "default_environments")]
    pub environments: usize,
    /// Transitions in one update, 1..=4096.
    #[serde(default = "default_batch_size")]
    pub batch_size: usize,
    /// Steps that the replay remembers; each costs one byte a pixel.
    #[serde(default = "default_replay_steps")]
    pub replay_steps: usize,
    /// Steps taken before those that updates are counted from.
    #[serde(default = "default_learning_starts")]
    pub learning_starts: u64,
    /// Steps taken for each update.
    #[serde(default = "default_steps_per_update")]
    pub steps_per_update: u64,
    /// Updates after which the target network becomes a copy of the online network.
    #[serde(default = "default_target_every_updates")]
    pub target_every_updates: u64,
    /// Adam's learning rate at the start, in (0, 1].
    #[serde(default = "default_learning_rate")]
    pub learning_rate: f64,
    /// Adam's learning rate at the end of the run, reached linearly; the same as `learning_rate` when absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub final_learning_rate: Option<f64>,
    /// Discount γ, in [0, 1).
    #[serde(default = "default_gamma")]
    pub gamma: f32,
    /// What rewards are multiplied by before they are learned from, above 0; 1 in the paper. Of an error above 1 the
    /// loss sees little more than the sign, so values many times larger than 1 are learned less exactly.
    #[serde(default = "default_reward_scale")]
    pub reward_scale: f64,
    /// Steps whose rewards are summed before the target network's value takes over, 1..=100; 1 in the paper.
    #[serde(default = "default_n_step")]
    pub n_step: u32,
    /// Let the online network choose the action whose target value is bootstrapped (double DQN).
    #[serde(default = "default_double")]
    pub double: bool,
    /// What the network computes in: `f32`, `bf16`, or `auto`, which becomes one of them, by what the machine is good at, when a
    /// run begins. Parameters are learned in f32 with each.
    #[serde(default)]
    pub precision: Precision,
    /// Give the network a value and an advantage stream (dueling, Wang et al. 2016). That paper also divides the gradient that enters
    /// the last convolution by √2 and clips gradients to a norm of 10; neither is done here.
    #[serde(default)]
    pub dueling: bool,
    /// CPU threads of the network; 0 takes every core. Part of what makes a run repeatable.
    #[serde(default)]
    pub threads: usize,
    /// Steps between checkpoints.
    #[serde(default = "default_checkpoint_every_steps")]
    pub checkpoint_every_steps: u64,
    /// Newest checkpoints that stay, 1..=1000; the model of the best evaluation stays besides. Each takes 16 bytes a
    /// parameter, 27 MB for Breakout, and keeps the part of the replay that it needs.
    #[serde(default = "default_keep_checkpoints")]
    pub keep_checkpoints: usize,
    /// `[train.epsilon]`: the exploration schedule.
    #[serde(default)]
    pub epsilon: EpsilonConfig,
    /// `[train.prioritized]`: what is drawn from the replay; uniformly when absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub prioritized: Option<PrioritizedConfig>,
}

/// `[train.epsilon]`: ε falls linearly from `start` to `end` within `decay_steps` steps.
#[derive(Debug, Clone, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields, default)]
pub struct EpsilonConfig {
    /// ε of the first step, in [0, 1]; 1 in the paper.
    pub start: f32,
    /// ε after `decay_steps`, in [0, 1].
    pub end: f32,
    /// Steps, over all environments, from `start` to `end`.
    pub decay_steps: u64,
}

/// `[train.prioritized]`: transitions are drawn in proportion to `(|δ| + 1e-6)^α`, δ being the error of their value when they were
/// last learned from (Schaul et al. 2016, the proportional variant, with its values as defaults).
#[derive(Debug, Clone, Copy, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields, default)]
pub struct PrioritizedConfig {
    /// How much priorities count, α in [0, 1]; 0 draws uniformly.
    pub alpha: f32,
    /// How far weights in the loss make up for it at first, β in [0, 1]; it rises linearly to 1 at the end of the run.
    pub beta_start: f32,
}

/// `[evaluation]`: the greedy policy, played on fixed seeds while the run goes on.
#[derive(Debug, Clone, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields, default)]
pub struct EvaluationConfig {
    /// Training episodes between evaluations; 100 in the paper.
    pub every_episodes: u64,
    /// Episodes of one evaluation, 1..=10000.
    pub episodes: usize,
}

/// `[record]`: what the run writes besides `metrics.jsonl`, and which episodes it writes step by step.
#[derive(Debug, Clone, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields, default)]
pub struct RecordConfig {
    /// Write `run.mcap`.
    pub mcap: bool,
    /// Write the event file in `tensorboard/`.
    pub tensorboard: bool,
    /// Episodes of each evaluation that are recorded step by step, the first ones; at most `evaluation.episodes`.
    pub evaluation_episodes: usize,
    /// A training episode is recorded step by step whenever this many have begun; 0 records none.
    pub training_every_episodes: u64,
}

impl Default for EpsilonConfig {
    fn default() -> Self {
        Self { start: 1.0, end: 0.05, decay_steps: 60_000 }
    }
}

impl Default for PrioritizedConfig {
    fn default() -> Self {
        Self { alpha: 0.6, beta_start: 0.4 }
    }
}

impl Default for EvaluationConfig {
    fn default() -> Self {
        Self { every_episodes: 100, episodes: 20 }
    }
}

impl Default for RecordConfig {
    fn default() -> Self {
        Self { mcap: true, tensorboard: true, evaluation_episodes: 1, training_every_episodes: 100 }
    }
}

fn default_environments() -> usize {
    16
}
fn default_batch_size() -> usize {
    32
}
fn default_replay_steps() -> usize {
    100_000
}
fn default_learning_starts() -> u64 {
    2_000
}
fn default_steps_per_update() -> u64 {
    4
}
fn default_target_every_updates() -> u64 {
    1_000
}
fn default_learning_rate() -> f64 {
    1e-4
}
fn default_gamma() -> f32 {
    0.99
}
fn default_reward_scale() -> f64 {
    1.0
}
fn default_n_step() -> u32 {
    1
}
fn default_double() -> bool {
    true
}
fn default_checkpoint_every_steps() -> u64 {
    20_000
}
fn default_keep_checkpoints() -> usize {
    2
}

impl RunConfig {
    /// The configuration without the paths of pictures, for comparing runs: where the files lie does not matter.
    #[must_use]
    pub fn without_paths(&self) -> Self {
        let mut config = self.clone();
        config.reward.goal = None;
        if let Some(window) = &mut config.reward.window {
            window.mask = None;
        }
        config
    }

    /// The part that describes the task, whose rewards know the learner's discount.
    pub fn task(&self) -> TaskConfig {
        let reward = RewardConfig { gamma: Some(self.train.gamma), ..self.reward.clone() };
        TaskConfig { env: self.env.clone(), reward, state: self.state }
    }

    /// Checks every range.
    ///
    /// # Errors
    /// [`ParamError::InvalidParam`] with the dotted key of the first value that cannot be used.
    pub fn validate(&self) -> Result<(), ParamError> {
        self.task().validate()?;
        self.train.validate()?;
        self.evaluation.validate()?;
        within("record.evaluation_episodes", self.record.evaluation_episodes as u64, 0, self.evaluation.episodes as u64)
    }
}

impl TrainConfig {
    /// What of it concerns an update.
    pub fn learner(&self) -> LearnerSettings {
        let Self { double, reward_scale, target_every_updates, .. } = *self;
        LearnerSettings { double, reward_scale, target_every_updates }
    }

    /// Where and how its network computes.
    ///
    /// # Errors
    /// [`Error::Threads`](crate::Error::Threads) when the system gives no more threads.
    pub fn compute(&self, device: tch::Device) -> Result<Compute> {
        Compute::new(device, self.precision, self.threads)
    }

    /// How far a transition reaches.
    pub(crate) fn reach(&self) -> Reach {
        Reach { steps: self.n_step, gamma: self.gamma }
    }

    /// The empty replay for frames of `frame_len` pixels.
    pub(crate) fn replay(&self, frame_len: usize) -> Replay {
        let replay = Replay::new(self.replay_steps, self.environments, frame_len);
        match self.prioritized {
            None => replay,
            Some(PrioritizedConfig { alpha, .. }) => replay.with_priorities(alpha, self.reach()),
        }
    }

    /// Memory that this replay takes once it is full, in bytes.
    pub(crate) fn replay_bytes(&self, frame_len: usize) -> u64 {
        let priorities = self.prioritized.map(|_| Replay::priorities_bytes(self.replay_steps, self.environments));
        Replay::memory_bytes(self.replay_steps, self.environments, frame_len) + priorities.unwrap_or(0)
    }

    fn validate(&self) -> Result<(), ParamError> {
        match (self.steps, self.episodes) {
            (None, None) => {
                return Err(invalid("train.steps", &"nothing", "the run's length as `steps` or as `episodes`"));
            }
            (Some(_), Some(_)) => {
                return Err(invalid("train.episodes", &"`steps` and `episodes`", "only one of the two"));
            }
            (Some(steps), None) => within("train.steps", steps, 1, u64::MAX)?,
            (None, Some(episodes)) => within("train.episodes", episodes, 1, u64::MAX)?,
        }
        within("train.environments", self.environments as u64, 1, 1024)?;
        within("train.batch_size", self.batch_size as u64, 1, 4096)?;
        let smallest = (self.environments * 4).max(self.batch_size) as u64;
        within("train.replay_steps", self.replay_steps as u64, smallest, 100_000_000)?;
        within("train.n_step", self.n_step.into(), 1, 100)?;
        let rows = self.replay_steps / self.environments;
        if rows <= self.n_step as usize + 1 {
            let expected = format!("more than {} steps for each environment", self.n_step + 1);
            return Err(invalid("train.replay_steps", &format!("{rows} steps for each environment"), &expected));
        }
        let complete = (self.environments * (self.n_step as usize + 1)) as u64;
        within("train.learning_starts", self.learning_starts, complete, u64::MAX)?;
        within("train.steps_per_update", self.steps_per_update, 1, 1_000_000)?;
        within("train.target_every_updates", self.target_every_updates, 1, u64::MAX)?;
        within("train.threads", self.threads as u64, 0, 1024)?;
        within("train.checkpoint_every_steps", self.checkpoint_every_steps, 1, u64::MAX)?;
        within("train.keep_checkpoints", self.keep_checkpoints as u64, 1, 1000)?;
        learning_rate("train.learning_rate", self.learning_rate)?;
        if let Some(rate) = self.final_learning_rate {
            learning_rate("train.final_learning_rate", rate)?;
        }
        if !(0.0..1.0).contains(&self.gamma) {
            return Err(invalid("train.gamma", &self.gamma, "a discount from 0 up to, but not including, 1"));
        }
        if !(self.reward_scale > 0.0 && self.reward_scale.is_finite()) {
            return Err(invalid("train.reward_scale", &self.reward_scale, "a finite number above 0"));
        }
        self.prioritized.map_or(Ok(()), |prioritized| prioritized.validate())?;
        self.epsilon.validate()
    }
}

impl PrioritizedConfig {
    fn validate(&self) -> Result<(), ParamError> {
        unit("train.prioritized.alpha", self.alpha, "a number from 0 to 1")?;
        unit("train.prioritized.beta_start", self.beta_start, "a number from 0 to 1")
    }
}

impl EpsilonConfig {
    fn validate(&self) -> Result<(), ParamError> {
        unit("train.epsilon.start", self.start, "a probability from 0 to 1")?;
        unit("train.epsilon.end", self.end, "a probability from 0 to 1")?;
        within("train.epsilon.decay_steps", self.decay_steps, 1, u64::MAX)
    }
}

impl EvaluationConfig {
    fn validate(&self) -> Result<(), ParamError> {
        within("evaluation.every_episodes", self.every_episodes, 1, u64::MAX)?;
        within("evaluation.episodes", self.episodes as u64, 1, 10_000)
    }
}

fn learning_rate(key: &str, rate: f64) -> Result<(), ParamError> {
    if rate > 0.0 && rate <= 1.0 { Ok(()) } else { Err(invalid(key, &rate, "a number above 0 and at most 1")) }
}

fn unit(key: &str, value: f32, expected: &str) -> Result<(), ParamError> {
    if (0.0..=1.0).contains(&value) { Ok(()) } else { Err(invalid(key, &value, expected)) }
}

fn within(key: &str, value: u64, least: u64, most: u64) -> Result<(), ParamError> {
    if (least..=most).contains(&value) {
        return Ok(());
    }
    let expected = if most == u64::MAX { format!("at least {least}") } else { format!("from {least} to {most}") };
    Err(invalid(key, &value, &expected))
}

fn invalid(key: &str, got: &dyn ToString, expected: &str) -> ParamError {
    ParamError::InvalidParam { key: key.to_owned(), got: got.to_string(), expected: expected.to_owned() }
}
