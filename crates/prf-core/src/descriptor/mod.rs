//! How a task is shown (paper, section "Visual task descriptors").

mod comparison;
mod direct;
mod explanation;
mod motion;
mod params;
mod window;

pub(crate) use comparison::Comparison;
pub use direct::DirectDescriptor;
pub use explanation::Explanation;
pub use motion::MotionDescriptor;
pub use params::{DescriptorKind, DescriptorParams, Goal};
pub(crate) use window::WindowFinder;
pub use window::{WindowDescriptor, WindowParams};

use crate::{Error, FrameView, Score};

/// A goal `T_G`, and a way to make a template `T_A` of the agent's frames that can be compared with it (paper, section
/// "Visual task descriptors").
pub trait TaskDescriptor: Send {
    /// Gets ready for frames of this shape, `[height, width]` in pixels. [`observe`](TaskDescriptor::observe) does so by
    /// itself; asking before tells early whether it can.
    ///
    /// # Errors
    ///
    /// [`Error::TemplateTooLarge`] when the goal is a window that doesn't fit into frames of this shape. The other
    /// descriptors take any.
    fn prepare(&mut self, shape: [usize; 2]) -> Result<(), Error>;

    /// Begins an episode: what was seen before no longer counts.
    fn reset(&mut self);

    /// Takes in what the agent's world looks like now without scoring it, so that a motion descriptor sees what the first step
    /// moves. A descriptor that remembers frames has to override it; the others need not.
    ///
    /// # Errors
    ///
    /// [`Error::FrameSize`] as [`observe`](TaskDescriptor::observe).
    fn pass(&mut self, mirror: FrameView<'_>) -> Result<(), Error> {
        let _ = mirror;
        Ok(())
    }

    /// Takes in what the agent's world looks like now and scores it.
    ///
    /// # Errors
    ///
    /// As [`prepare`](TaskDescriptor::prepare), and [`Error::FrameSize`] when motion began the episode with another size;
    /// nothing has been taken in then.
    fn observe(&mut self, mirror: FrameView<'_>) -> Result<Score, Error>;

    /// Where the last score came from; `mirror` is the frame that was observed.
    fn explain<'a>(&'a self, mirror: FrameView<'a>) -> Explanation<'a>;

    /// What it remembers of the episode so far, for a checkpoint; most remember nothing.
    fn save_state(&self) -> Vec<u8> {
        Vec::new()
    }

    /// Takes up what [`save_state`](TaskDescriptor::save_state) gave and goes on to the same bits.
    ///
    /// # Errors
    ///
    /// [`Error::Restore`] when the bytes are those of another descriptor; it is then left as it was.
    fn load_state(&mut self, bytes: &[u8]) -> Result<(), Error> {
        if bytes.is_empty() {
            return Ok(());
        }
        let got = format!("{} bytes of a descriptor with memory", bytes.len());
        Err(Error::Restore { got, expected: "none".to_owned() })
    }
}
