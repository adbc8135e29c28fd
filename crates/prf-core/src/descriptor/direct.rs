//! The whole frame is the template.

use super::TaskDescriptor;
use crate::region::Region;
use crate::{Error, Frame, FrameView, Hog, HogLayout, Rect, Resizer, RewardParams, Score, crop_box};

/// How many sizes the goal's HOG is kept for.
const KEPT_SIZES: usize = 8;

/// Direct task descriptor: the agent's frame itself is compared with a picture of the goal.
///
/// Both are cropped to what is not black, the one with the smaller area is rescaled to the other's
/// size, and their HOGs are compared. Frames may have any size, also another than the goal's.
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
/// assert_eq!(descriptor.observe(frame.view()).reward, 1.0);
/// # Ok::<(), prf_core::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct DirectDescriptor {
    params: RewardParams,
    goal: Frame,
    goal_box: Rect,
    hog: Hog,
    resizer: Resizer,
    agent_features: Vec<f32>,
    goal_features: Vec<Kept>,
}

/// The goal's HOG at one size.
#[derive(Clone, Debug)]
struct Kept {
    shape: [usize; 2],
    features: Vec<f32>,
}

impl DirectDescriptor {
    /// Prepares a goal.
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
        params.validate()?;
        let goal_box = crop_box(goal.view());
        HogLayout::new(&params.hog, goal_box.width, goal_box.height)?;
        Ok(DirectDescriptor {
            params,
            goal: goal.clone(),
            goal_box,
            hog: Hog::new(params.hog)?,
            resizer: Resizer::default(),
            agent_features: Vec::new(),
            goal_features: Vec::with_capacity(KEPT_SIZES),
        })
    }

    /// The part of the goal that is compared, in the goal's own pixels.
    #[must_use]
    pub fn goal_box(&self) -> Rect {
        self.goal_box
    }

    /// The goal's HOG for this layout, from memory or made now, is at the front of the list.
    fn prepare_goal(&mut self, layout: &HogLayout) {
        let shape = layout.shape();
        let found = self.goal_features.iter().position(|kept| kept.shape == shape);
        if let Some(at) = found {
            self.goal_features[..=at].rotate_right(1);
            return;
        }
        if self.goal_features.len() < KEPT_SIZES {
            let features = Vec::new();
            self.goal_features.push(Kept { shape, features });
        }
        // The one that was not asked for the longest makes room.
        self.goal_features.rotate_right(1);
        let Some(kept) = self.goal_features.first_mut() else {
            return;
        };
        kept.shape = shape;
        let goal = self.goal.view().region().within(self.goal_box);
        hog_at(&mut self.hog, &mut self.resizer, layout, goal, &mut kept.features);
    }
}

impl TaskDescriptor for DirectDescriptor {
    fn reset(&mut self) {}

    fn observe(&mut self, mirror: FrameView<'_>) -> Score {
        let agent = mirror.region().within(crop_box(mirror));
        let goal_shape = [self.goal_box.height, self.goal_box.width];
        let layout = HogLayout::fitted(&self.params.hog, common(agent.shape(), goal_shape));
        hog_at(&mut self.hog, &mut self.resizer, &layout, agent, &mut self.agent_features);
        self.prepare_goal(&layout);
        let divisor = self.params.scale.divisor(&layout);
        let goal = &self.goal_features[0].features;
        Score::of(&self.agent_features, goal, divisor)
    }
}

/// The size both templates get: that with the larger area. Of two shapes with one area it is the
/// taller, so that the order of the two doesn't matter.
fn common(a: [usize; 2], b: [usize; 2]) -> [usize; 2] {
    let rank = |[height, width]: [usize; 2]| (height * width, height);
    if rank(a) >= rank(b) { a } else { b }
}

/// HOG of a template at the layout's size.
fn hog_at(hog: &mut Hog, resizer: &mut Resizer, layout: &HogLayout, template: Region<'_, u8>, out: &mut Vec<f32>) {
    if template.shape() == layout.shape() {
        hog.compute(layout, template, out);
    } else {
        hog.compute(layout, resizer.rescale(template, layout.shape()), out);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{CellSize, HogParams, Norm};

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
    fn the_larger_of_two_templates_sets_the_size() {
        assert_eq!(common([10, 20], [9, 20]), [10, 20]);
        assert_eq!(common([10, 20], [30, 30]), [30, 30]);
        // One area: the taller, whichever comes first.
        assert_eq!(common([10, 20], [20, 10]), [20, 10]);
        assert_eq!(common([20, 10], [10, 20]), [20, 10]);
    }

    #[test]
    fn a_picture_twice_as_large_is_nearly_the_same() {
        let hog = HogParams { cell: CellSize::Fraction(0.25), norm: Norm::L2, ..HogParams::default() };
        let goal = boxes(40, 40, &[(rect(4, 4, 16, 16), 255), (rect(10, 20, 10, 8), 128)]);
        let twice = boxes(80, 80, &[(rect(8, 8, 32, 32), 255), (rect(20, 40, 20, 16), 128)]);
        let other = boxes(80, 80, &[(rect(8, 8, 32, 8), 255), (rect(8, 40, 4, 16), 128)]);
        let mut descriptor =
            DirectDescriptor::new(&goal, RewardParams { hog, ..RewardParams::default() }).expect("valid");
        let (same, different) = (descriptor.observe(twice.view()), descriptor.observe(other.view()));
        assert!(same.reward > different.reward + 0.2, "{same:?} and {different:?}");
    }

    #[test]
    fn a_black_frame_is_compared_whole() {
        let goal = Frame::new(30, 30);
        let mut descriptor = DirectDescriptor::new(&goal, RewardParams::default()).expect("valid");
        assert_eq!(descriptor.goal_box(), rect(0, 0, 30, 30));
        assert_eq!(descriptor.observe(Frame::new(30, 30).view()).reward, 1.0);
        assert_eq!(descriptor.observe(Frame::new(7, 50).view()).reward, 1.0);
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
        let score = DirectDescriptor::new(&Frame::new(4, 4), params).expect("valid").observe(frame.view());
        assert!((score.distance - 1.0).abs() < 1e-6 && (score.reward - 0.367_879_4).abs() < 1e-6, "{score:?}");
    }

    #[test]
    fn one_flat_box_has_no_edges_left_once_cropped() {
        let frame = boxes(30, 30, &[(rect(4, 7, 9, 5), 200)]);
        let mut descriptor = DirectDescriptor::new(&Frame::new(30, 30), RewardParams::default()).expect("valid");
        assert_eq!(descriptor.observe(frame.view()).reward, 1.0);
    }

    #[test]
    fn steps_allocate_nothing_once_warm() {
        let goal = boxes(84, 84, &[(rect(0, 0, 84, 84), 9)]);
        let mut descriptor = DirectDescriptor::new(&goal, RewardParams::default()).expect("valid");
        let frame = |i: usize| boxes(84, 84, &[(rect(i, 2 * i, 30 + i, 20), 200)]);
        descriptor.observe(frame(20).view());
        let before = (descriptor.agent_features.as_ptr(), descriptor.goal_features[0].features.as_ptr());
        for i in 0..20 {
            descriptor.observe(frame(i).view());
        }
        let after = (descriptor.agent_features.as_ptr(), descriptor.goal_features[0].features.as_ptr());
        assert_eq!(before, after);
        assert_eq!(descriptor.goal_features.len(), 1);
    }
}
