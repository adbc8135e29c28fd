//! The goal is a movement.

use super::comparison::Comparison;
use super::{Explanation, TaskDescriptor};
use crate::{Error, Frame, FrameView, MotionParams, MotionTemplate, RewardParams, Score};

/// Motion template task descriptor: what has moved in the episode so far is compared with what moves in the goal.
///
/// The agent's template is the motion template `Ψ(S)` of all frames since [`reset`](TaskDescriptor::reset), the goal's
/// is `Ψ(G)` of a sequence that shows the task. Only where and in which order something moves counts, so the two
/// may show different bodies. Templates are compared as by the [`DirectDescriptor`](crate::DirectDescriptor). All frames of
/// an episode have one size, which need not be the goal's. (Paper, section "Motion template task descriptor".)
///
/// ```
/// use prf_core::{Frame, MotionDescriptor, MotionParams, MotionTemplate, RewardParams, TaskDescriptor};
/// // A bar that grows downwards.
/// let frame = |rows: usize| {
///     let mut frame = Frame::new(30, 30);
///     (5..5 + rows).for_each(|y| frame.row_mut(y)[10..20].fill(255));
///     frame
/// };
/// let mut goal = MotionTemplate::new(MotionParams::default())?;
/// for rows in [2, 8, 14, 20] {
///     goal.observe(frame(rows).view())?;
/// }
/// let mut picture = Frame::new(1, 1);
/// goal.history_into(&mut picture);
/// let mut descriptor = MotionDescriptor::new(&picture, MotionParams::default(), RewardParams::default())?;
///
/// descriptor.reset();
/// let mut rewards = Vec::new();
/// for rows in [2, 8, 14, 20] {
///     rewards.push(descriptor.observe(frame(rows).view())?.reward);
/// }
/// assert_eq!(rewards[3], 1.0);
/// assert!(rewards[3] > rewards[1]);
/// # Ok::<(), prf_core::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct MotionDescriptor {
    motion: MotionTemplate,
    /// What it was prepared for, if it was.
    shape: Option<[usize; 2]>,
    template: Frame,
    comparison: Comparison,
}

impl MotionDescriptor {
    /// Prepares a goal: a motion template, as [`MotionTemplate::history_into`] draws it.
    ///
    /// # Errors
    ///
    /// As [`DirectDescriptor::new`](crate::DirectDescriptor::new) and [`MotionTemplate::new`], whose keys get `motion.` before
    /// them.
    pub fn new(goal: &Frame, motion: MotionParams, params: RewardParams) -> Result<MotionDescriptor, Error> {
        Ok(MotionDescriptor {
            motion: MotionTemplate::new(motion).map_err(|error| error.within("motion"))?,
            shape: None,
            template: Frame::new(1, 1),
            comparison: Comparison::new(goal, params)?,
        })
    }
}

impl TaskDescriptor for MotionDescriptor {
    fn prepare(&mut self, shape: [usize; 2]) -> Result<(), Error> {
        self.shape = Some(shape);
        Ok(())
    }

    fn reset(&mut self) {
        self.motion.reset();
    }

    fn pass(&mut self, mirror: FrameView<'_>) -> Result<(), Error> {
        self.motion.observe(mirror)
    }

    fn observe(&mut self, mirror: FrameView<'_>) -> Result<Score, Error> {
        self.motion.observe(mirror)?;
        self.motion.history_into(&mut self.template);
        Ok(self.comparison.score(self.template.view().region()))
    }

    fn explain<'a>(&'a self, _: FrameView<'a>) -> Explanation<'a> {
        self.comparison.explain(self.template.view(), None)
    }

    fn save_state(&self) -> Vec<u8> {
        self.motion.save_state()
    }

    fn load_state(&mut self, bytes: &[u8]) -> Result<(), Error> {
        let mut motion = self.motion.clone();
        motion.load_state(bytes)?;
        match (motion.shape(), self.shape) {
            (got, Some(shape)) if got != shape && got != [0, 0] => {
                Err(Error::Restore { got: format!("frames of {got:?}"), expected: format!("{shape:?}") })
            }
            _ => {
                self.motion = motion;
                Ok(())
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::DeltaSchedule;

    fn frame(step: usize) -> Frame {
        let mut frame = Frame::new(24, 20);
        (2..8).for_each(|y| frame.row_mut(y + step)[3 * step..3 * step + 6].fill(200));
        frame
    }

    fn descriptor() -> MotionDescriptor {
        let mut motion = MotionTemplate::new(MotionParams::default()).expect("valid");
        (0..5).for_each(|step| motion.observe(frame(step).view()).expect("one size"));
        let mut goal = Frame::new(1, 1);
        motion.history_into(&mut goal);
        MotionDescriptor::new(&goal, MotionParams::default(), RewardParams::default()).expect("valid")
    }

    fn score(descriptor: &mut MotionDescriptor, step: usize) -> Score {
        descriptor.observe(frame(step).view()).expect("one size")
    }

    #[test]
    fn the_same_movement_is_the_goal_and_the_reverse_is_not() {
        let mut descriptor = descriptor();
        let forwards: Vec<f32> = (0..5).map(|step| score(&mut descriptor, step).reward).collect();
        assert_eq!(forwards[4], 1.0);
        descriptor.reset();
        let backwards: Vec<f32> = (0..5).rev().map(|step| score(&mut descriptor, step).reward).collect();
        assert!(backwards[4] < 0.9, "{backwards:?}");
    }

    #[test]
    fn an_episode_goes_on_where_it_was_saved() {
        let (mut whole, mut resumed) = (descriptor(), descriptor());
        for step in 0..3 {
            score(&mut whole, step);
        }
        resumed.load_state(&whole.save_state()).expect("its own bytes");
        for step in 3..6 {
            assert_eq!(score(&mut whole, step), score(&mut resumed, step));
        }
        resumed.load_state(&descriptor().save_state()).expect("of an episode's beginning");
        assert_eq!(score(&mut resumed, 0), score(&mut descriptor(), 0));
    }

    #[test]
    fn a_frame_that_is_passed_is_seen_and_not_scored() {
        let (mut scored, mut passed) = (descriptor(), descriptor());
        for step in 0..3 {
            score(&mut scored, step);
            passed.pass(frame(step).view()).expect("one size");
        }
        assert_eq!(score(&mut scored, 3), score(&mut passed, 3));
    }

    #[test]
    fn damaged_states_are_refused_and_change_nothing() {
        let mut descriptor = descriptor();
        for step in 0..3 {
            score(&mut descriptor, step);
        }
        let state = descriptor.save_state();
        for len in 0..state.len() {
            assert!(matches!(descriptor.load_state(&state[..len]), Err(Error::Restore { .. })), "{len} bytes");
        }
        let longer = [&state[..], &[0]].concat();
        assert!(matches!(descriptor.load_state(&longer), Err(Error::Restore { .. })));
        // The time, behind the tag and four numbers: 0.5 after two iterations.
        let at = 7 + 4 * 8;
        assert_eq!(state[at..at + 4], 0.5f32.to_le_bytes());
        let later = [&state[..at], &3e8f32.to_le_bytes(), &state[at + 4..]].concat();
        assert!(matches!(descriptor.load_state(&later), Err(Error::Restore { .. })));
        let mut prepared = self::descriptor();
        prepared.prepare([20, 23]).expect("motion takes any size");
        assert!(matches!(prepared.load_state(&state), Err(Error::Restore { .. })), "frames were 24 x 20");
        prepared.prepare([20, 24]).expect("motion takes any size");
        assert!(prepared.load_state(&state).is_ok());
        assert_eq!(descriptor.save_state(), state);
    }

    #[test]
    fn its_own_parameters_are_checked() {
        let motion = MotionParams { delta: DeltaSchedule::Divisor(0.0), ..MotionParams::default() };
        let error = MotionDescriptor::new(&frame(0), motion, RewardParams::default()).expect_err("by zero");
        assert!(error.to_string().starts_with("motion.delta.divisor: got 0"), "{error}");
    }
}
