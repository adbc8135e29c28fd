//! How a task is shown (paper, section "Visual task descriptors").

mod direct;

pub use direct::DirectDescriptor;

use crate::{FrameView, Score};

/// A goal, and a way to make a template of the agent's frames that can be compared with it.
pub trait TaskDescriptor: Send {
    /// Begins an episode: what was seen before no longer counts.
    fn reset(&mut self);

    /// Takes in what the agent's world looks like now and scores it.
    fn observe(&mut self, mirror: FrameView<'_>) -> Score;
}
