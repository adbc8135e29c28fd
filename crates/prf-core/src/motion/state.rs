//! What a motion template remembers.

use crate::Error;
use crate::frame::check_shape;

/// Everything that a [`MotionTemplate`](crate::MotionTemplate) remembers of its sequence, for a checkpoint. The
/// default is that of one which has seen nothing.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MotionState {
    /// `[h, w]` of the frames; `[0, 0]` before the first one.
    pub shape: [usize; 2],
    /// The frame that the next one is compared with, row by row from the top; empty before the first one.
    pub reference: Vec<u8>,
    /// `μ`, row by row from the top: 0 where nothing moved, else when it did. Empty before the first frame.
    pub history: Vec<f32>,
    /// How many silhouettes have been taken in.
    pub iterations: u64,
    /// `τ` of the last one, 0 before the first one.
    pub tau: f32,
}

impl MotionState {
    /// Keeps the memory, not what it holds.
    pub(super) fn clear(&mut self) {
        self.reference.clear();
        self.history.clear();
        (self.shape, self.iterations, self.tau) = ([0, 0], 0, 0.0);
    }

    /// Checks that a motion template can have come to this state.
    pub(super) fn validate(&self) -> Result<(), Error> {
        self.validate_lengths()?;
        let (tau, latest) = (self.tau, if self.iterations == 0 { 0.0 } else { f32::MAX });
        if !(0.0..=latest).contains(&tau) {
            return Err(refused(format!("the time {tau}"), format!("0 to {latest:e}")));
        }
        match self.history.iter().find(|mu| !(0.0..=tau).contains(*mu)) {
            Some(mu) => Err(refused(format!("a movement at {mu}"), format!("0 to {tau}, the last time"))),
            None => Ok(()),
        }
    }

    fn validate_lengths(&self) -> Result<(), Error> {
        let ([height, width], reference, history) = (self.shape, self.reference.len(), self.history.len());
        let got = || format!("{width}x{height} px, {history} times and {reference} pixels");
        if self.shape == [0, 0] {
            let empty = (history, reference, self.iterations) == (0, 0, 0);
            return if empty { Ok(()) } else { Err(refused(got(), "nothing, as no frame was seen")) };
        }
        if check_shape(width, height, history).is_err() || ![0, history].contains(&reference) {
            return Err(refused(got(), "a time for each pixel and one frame or none"));
        }
        Ok(())
    }
}

fn refused(got: String, expected: impl Into<String>) -> Error {
    Error::Restore { got, expected: expected.into() }
}
