//! The whole frame is the template.

use super::comparison::Comparison;
use super::{Explanation, TaskDescriptor};
use crate::{Error, Frame, FrameView, RewardParams, Score};

/// Direct task descriptor: the agent's frame itself is compared with a picture of the goal.
///
/// Both are cropped to what is not black, the one with the smaller area is rescaled to the other's
/// size, and their HOGs are compared. Frames may have any size, also another than the goal's. (Paper, section "Mirror
/// task descriptors".)
///
/// ```
/// use prf_core::{DirectDescriptor, Frame, RewardParams, TaskDescriptor};
/// let mut goal = Frame::new(40, 30);
/// goal.row_mut(10)[5..25].fill(200);
/// goal.row_mut(20)[5..25].fill(200);
/// let mut descriptor = DirectDescriptor::new(&goal, RewardParams::default())?;
///
/// // The same picture elsewhere: cropping takes the shift away.
/// let mut frame = Frame::new(64, 64);
/// frame.row_mut(31)[40..60].fill(200);
/// frame.row_mut(41)[40..60].fill(200);
/// assert_eq!(descriptor.observe(frame.view())?.reward, 1.0);
/// # Ok::<(), prf_core::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct DirectDescriptor {
    comparison: Comparison,
}

impl DirectDescriptor {
    /// Prepares a goal, a picture of any size with 0 as its background.
    ///
    /// Frames are never refused later: where a crop is too small for the cells or blocks asked for,
    /// the cells shrink until one block fits, and then the block. A goal that is too small by itself
    /// is an error, as then the parameters can't be meant.
    ///
    /// # Errors
    ///
    /// [`Error::InvalidParam`] as [`RewardParams::validate`], [`Error::TooSmall`] when the cropped
    /// goal doesn't hold a block.
    pub fn new(goal: &Frame, params: RewardParams) -> Result<DirectDescriptor, Error> {
        Ok(DirectDescriptor { comparison: Comparison::new(goal, params)? })
    }
}

impl TaskDescriptor for DirectDescriptor {
    fn prepare(&mut self, _: [usize; 2]) -> Result<(), Error> {
        Ok(())
    }

    fn reset(&mut self) {}

    fn observe(&mut self, mirror: FrameView<'_>) -> Result<Score, Error> {
        Ok(self.comparison.score(mirror.region()))
    }

    fn explain<'a>(&'a self, mirror: FrameView<'a>) -> Explanation<'a> {
        self.comparison.explain(mirror, None)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{CellSize, HogParams, Norm, Rect};

    /// A black frame with these boxes, each of its own brightness.
    fn boxes(width: usize, height: usize, boxes: &[(Rect, u8)]) -> Frame {
        let mut frame = Frame::new(width, height);
        for &(rect, value) in boxes {
            for y in rect.y..rect.y + rect.height {
                frame.row_mut(y)[rect.x..rect.x + rect.width].fill(value);
            }
        }
        frame
    }

    fn rect(x: usize, y: usize, width: usize, height: usize) -> Rect {
        Rect { x, y, width, height }
    }

    #[test]
    fn a_picture_twice_as_large_is_nearly_the_same() {
        let hog = HogParams { cell: CellSize::Fraction(0.25), norm: Norm::L2, ..HogParams::default() };
        let goal = boxes(40, 40, &[(rect(4, 4, 16, 16), 255), (rect(10, 20, 10, 8), 128)]);
        let twice = boxes(80, 80, &[(rect(8, 8, 32, 32), 255), (rect(20, 40, 20, 16), 128)]);
        let other = boxes(80, 80, &[(rect(8, 8, 32, 8), 255), (rect(8, 40, 4, 16), 128)]);
        let mut descriptor =
            DirectDescriptor::new(&goal, RewardParams { hog, ..RewardParams::default() }).expect("valid");
        let mut score = |frame: &Frame| descriptor.observe(frame.view()).expect("any frame will do");
        let (same, different) = (score(&twice), score(&other));
        assert!(same.reward > different.reward + 0.2, "{same:?} and {different:?}");
    }

    #[test]
    fn a_black_frame_is_compared_whole() {
        let goal = Frame::new(30, 30);
        let mut descriptor = DirectDescriptor::new(&goal, RewardParams::default()).expect("valid");
        for frame in [Frame::new(30, 30), Frame::new(7, 50)] {
            assert_eq!(descriptor.observe(frame.view()).expect("any frame will do").reward, 1.0);
            assert_eq!(descriptor.explain(frame.view()).goal_box, rect(0, 0, 30, 30));
        }
    }

    #[test]
    fn a_goal_too_small_for_a_block_is_refused() {
        let goal = boxes(84, 84, &[(rect(10, 10, 6, 20), 255)]);
        let hog = HogParams { cell: CellSize::Px(8), ..HogParams::default() };
        let error = DirectDescriptor::new(&goal, RewardParams { hog, ..RewardParams::default() });
        assert!(matches!(error, Err(Error::TooSmall { width: 6, height: 20, min: 8, .. })), "{error:?}");
    }

    /// docs/reward.md goes through this by hand.
    #[test]
    fn the_example_of_the_documentation() {
        let frame = boxes(4, 4, &[(rect(2, 0, 1, 4), 51), (rect(3, 0, 1, 4), 255)]);
        let hog = HogParams { orientations: 2, cell: CellSize::Px(2), ..HogParams::default() };
        let params = RewardParams { hog, ..RewardParams::default() };
        let mut descriptor = DirectDescriptor::new(&Frame::new(4, 4), params).expect("valid");
        let score = descriptor.observe(frame.view()).expect("any frame will do");
        assert!((score.distance - 1.0).abs() < 1e-6 && (score.reward - 0.367_879_4).abs() < 1e-6, "{score:?}");
    }

    #[test]
    fn one_flat_box_has_no_edges_left_once_cropped() {
        let frame = boxes(30, 30, &[(rect(4, 7, 9, 5), 200)]);
        let mut descriptor = DirectDescriptor::new(&Frame::new(30, 30), RewardParams::default()).expect("valid");
        assert_eq!(descriptor.observe(frame.view()).expect("any frame will do").reward, 1.0);
    }
}
