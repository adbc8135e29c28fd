//! What every world is.

use prf_core::{Frame, FrameMut, Label};

use crate::Error;

/// The fixed facts about a world.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Spec {
    /// The name that a config uses.
    pub name: &'static str,
    /// Width of the mirror frame, in pixels.
    pub width: usize,
    /// Height of the mirror frame, in pixels.
    pub height: usize,
    /// The actions' names; an action is an index into them.
    pub actions: &'static [&'static str],
    /// Steps after which an episode is truncated; at least 1.
    pub limit_steps: u32,
    /// Whether chance plays a part, so that seeds give different episodes.
    pub chance: bool,
}

/// Where an episode stands after a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Status {
    /// It goes on.
    Running,
    /// It has come to its own end. There is no future to expect: the only status that stops bootstrapping.
    Terminated,
    /// It was cut off by the step limit. The world would have gone on.
    Truncated,
}

impl Status {
    /// Whether the next call has to be a reset.
    pub fn is_over(self) -> bool {
        self != Status::Running
    }
}

/// What one step brought.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Step {
    /// The world's own reward for this step: the paper's variable reward function (VRF).
    pub reward: f32,
    /// The score so far in this episode.
    pub score: f32,
    /// Where the episode stands.
    pub status: Status,
}

/// A world with rules, a picture and a score.
///
/// The same seed and the same actions give the same episode, bit by bit, on every machine.
/// [`check::conformance`](crate::check::conformance) tests all that is promised here.
pub trait Environment: Send {
    /// The world's fixed facts.
    fn spec(&self) -> &Spec;

    /// Begins the episode that belongs to `seed`.
    fn reset(&mut self, seed: u64);

    /// Plays one step with `action`, an index into [`Spec::actions`].
    ///
    /// # Errors
    /// [`Error::UnknownAction`]; [`Error::NotReset`] before the first reset; [`Error::EpisodeOver`] after the
    /// episode's end. The world is as it was before.
    fn step(&mut self, action: usize) -> Result<Step, Error>;

    /// Draws the world over the whole `frame`, scaled to the frame's own size. Before the first reset it is black.
    fn draw(&self, frame: &mut FrameMut<'_>);

    /// [`draw`](Environment::draw)s over a frame that owns its pixels.
    fn draw_into(&self, frame: &mut Frame) {
        self.draw(&mut frame.view_mut());
    }

    /// Everything that decides how the episode goes on, as bytes for [`load_state`](Environment::load_state).
    fn save_state(&self) -> Vec<u8>;

    /// Continues where [`save_state`](Environment::save_state) was called, on this world or one made alike.
    ///
    /// # Errors
    /// [`Error::BadState`] if the bytes are damaged or no state of this world; the world is as it was before.
    fn load_state(&mut self, bytes: &[u8]) -> Result<(), Error>;

    /// What the best known player would do now.
    fn oracle_action(&self) -> usize;

    /// How near the task is to being done in this very state, to judge rewards of its picture by. Where the score says that, as by
    /// default, that is all; where the score counts what was done before, a world says more.
    fn label(&self, score: f32) -> Label {
        Label { score: Some(f64::from(score)), success: None }
    }
}
