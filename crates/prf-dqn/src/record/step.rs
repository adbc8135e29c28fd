//! One step of a recorded episode.

use prf_core::{Explanation, FrameView};
use serde::Serialize;

/// Whose episode it is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum EpisodeKind {
    /// Of a greedy evaluation.
    Evaluation,
    /// Of the ε-greedy policy that gathers what is learned from.
    Training,
}

/// One step of a recorded episode, after its action.
#[derive(Debug, Clone, Copy)]
pub struct StepRecord<'a> {
    /// Whose episode it is.
    pub kind: EpisodeKind,
    /// Training steps taken so far.
    pub trained_steps: u64,
    /// Of an evaluation: its place among the evaluation's episodes. Of training: how many began before it. From 0.
    pub episode: u64,
    /// Its place in the episode, from 1.
    pub step: u32,
    /// The world's picture.
    pub mirror: FrameView<'a>,
    /// What the reward was made of; none for a variable reward.
    pub explanation: Option<Explanation<'a>>,
    /// The action, an index into the world's actions.
    pub action: usize,
    /// The action's name.
    pub action_name: &'static str,
    /// The reward of the configured source.
    pub reward: f32,
    /// The world's own score so far.
    pub score: f32,
    /// Exploration, in [0, 1]; 0 in an evaluation.
    pub epsilon: f32,
    /// Whether the episode ends with it.
    pub last: bool,
}
