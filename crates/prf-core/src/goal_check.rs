//! Goals that can't teach anything, found before anybody trains on them.

use crate::crop::crop_box_of;
use crate::{DescriptorKind, DirectDescriptor, Error, Frame, Goal, HogLayout, RewardParams, TaskDescriptor};

/// Rewards below this are next to nothing.
pub(crate) const NEXT_TO_NOTHING: f32 = 1e-6;
/// Rewards above this are next to that of the goal itself.
pub(crate) const NEXT_TO_ONE: f32 = 0.99;

/// Why a goal is probably not what its maker meant.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum GoalWarning {
    /// All black, and the whole screen is to look like that: right for a task that clears the screen, and for no other.
    Black,
    /// A window that is all black matches nothing.
    BlackWindow,
    /// A motion template without motion.
    NoMotion,
    /// One even grey: there are no edges that a frame could share.
    Flat {
        /// The grey, 1 to 255.
        value: u8,
    },
    /// All of it lies in one HOG cell, so that where something lies in it doesn't count.
    OneCell {
        /// Side of the cell, in pixels.
        cell_px: usize,
    },
    /// What differs from the goal gets next to no reward, so no frame can be told from another.
    Underflow {
        /// The largest reward of the goal mirrored, upside down or blackened.
        reward: f32,
    },
    /// What differs from the goal gets nearly the goal's own reward.
    Saturated {
        /// The least reward of the goal mirrored, upside down or blackened.
        reward: f32,
    },
}

impl GoalWarning {
    /// What to do about it.
    #[must_use]
    pub fn hint(&self) -> &'static str {
        match self {
            GoalWarning::Black => "the emptier a frame, the higher its reward; show something if that is not the task",
            GoalWarning::BlackWindow => "cut out a part in which something can be seen",
            GoalWarning::NoMotion => "take a sequence in which something moves, or a lower threshold",
            GoalWarning::Flat { .. } => "show the finished task itself, or an all black picture to reward emptiness",
            GoalWarning::OneCell { .. } => "take smaller cells",
            GoalWarning::Underflow { .. } => "divide the distance (scale \"sqrt-blocks\"), or take larger cells",
            GoalWarning::Saturated { .. } => "take smaller cells, another norm, or a smaller part of the picture",
        }
    }
}

impl std::fmt::Display for GoalWarning {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            GoalWarning::Black => write!(f, "the goal is all black"),
            GoalWarning::BlackWindow => write!(f, "the goal's window is all black, which matches nothing"),
            GoalWarning::NoMotion => write!(f, "nothing moves in the goal"),
            GoalWarning::Flat { value } => {
                write!(f, "what is compared of the goal is one even grey ({value}), without any edge")
            }
            GoalWarning::OneCell { cell_px } => write!(f, "all of the goal lies in one cell of {cell_px} px"),
            GoalWarning::Underflow { reward } => {
                write!(f, "what differs from the goal gets a reward of at most {reward:.1e}, too little to learn from")
            }
            GoalWarning::Saturated { reward } => {
                write!(f, "even the goal mirrored, upside down or blackened gets a reward of {reward:.3}")
            }
        }
    }
}

/// What is suspicious about a goal for this kind of descriptor and these parameters; nothing for most goals. The goal of
/// motion is its template in a picture.
///
/// ```
/// use prf_core::{DescriptorKind, Frame, Goal, GoalWarning, RewardParams, check_goal};
/// let goal = Goal::from(Frame::from_vec(20, 10, vec![90; 200])?);
/// let warnings = check_goal(&goal, DescriptorKind::Window, RewardParams::default())?;
/// assert_eq!(warnings, [GoalWarning::Flat { value: 90 }]);
/// # Ok::<(), prf_core::Error>(())
/// ```
///
/// # Errors
///
/// As [`DirectDescriptor::new`]: the goal can't be used at all.
pub fn check_goal(goal: &Goal, kind: DescriptorKind, params: RewardParams) -> Result<Vec<GoalWarning>, Error> {
    let picture = goal.seen();
    let whole = picture.view().region();
    let crop = crop_box_of(whole);
    let part = whole.within(crop);
    let layout = HogLayout::new(&params.hog, crop.width, crop.height)?;
    let first = part.row(0)[0];
    if (0..crop.height).all(|y| part.row(y).iter().all(|&pixel| pixel == first)) {
        return Ok(vec![match (first, kind) {
            (0, DescriptorKind::Direct) => GoalWarning::Black,
            (0, DescriptorKind::Window) => GoalWarning::BlackWindow,
            (0, DescriptorKind::Motion) => GoalWarning::NoMotion,
            (value, _) => GoalWarning::Flat { value },
        }]);
    }
    if layout.cells() == [1, 1] {
        return Ok(vec![GoalWarning::OneCell { cell_px: layout.cell_px() }]);
    }
    probe(&picture, params)
}

/// Compares the goal with pictures that a good reward tells from it.
fn probe(goal: &Frame, params: RewardParams) -> Result<Vec<GoalWarning>, Error> {
    let (width, height) = (goal.width(), goal.height());
    let altered = |pixel: &dyn Fn(usize, usize) -> u8| {
        let mut frame = Frame::new(width, height);
        (0..height).for_each(|y| (0..width).for_each(|x| frame.row_mut(y)[x] = pixel(x, y)));
        frame
    };
    let probes = [
        altered(&|x, y| goal.view().row(y)[width - 1 - x]),
        altered(&|x, y| goal.view().row(height - 1 - y)[x]),
        Frame::new(width, height),
    ];
    let mut descriptor = DirectDescriptor::new(goal, params)?;
    let mut rewards = Vec::with_capacity(probes.len());
    for probe in &probes {
        rewards.push(descriptor.observe(probe.view())?.reward);
    }
    let largest = rewards.iter().copied().filter(|&reward| reward < 1.0).fold(0.0, f32::max);
    let least = rewards.iter().copied().fold(1.0, f32::min);
    Ok(match (largest, least) {
        // First, since a goal without a gradient gets 1 for everything, and `largest` then is that of nothing.
        (_, reward) if reward > NEXT_TO_ONE => vec![GoalWarning::Saturated { reward }],
        (reward, _) if reward < NEXT_TO_NOTHING => vec![GoalWarning::Underflow { reward }],
        _ => Vec::new(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{CellSize, DistanceScale, HogParams};

    fn texture() -> Frame {
        let pixels = (0..40 * 30).map(|i: usize| 1 + ((i * 2_654_435_761) >> 13) as u8 % 255).collect();
        Frame::from_vec(40, 30, pixels).expect("40 x 30")
    }

    fn params(cell: usize, scale: DistanceScale) -> RewardParams {
        RewardParams { hog: HogParams { cell: CellSize::Px(cell), ..HogParams::default() }, scale }
    }

    fn warnings(goal: Frame, kind: DescriptorKind, params: RewardParams) -> Vec<GoalWarning> {
        check_goal(&goal.into(), kind, params).expect("the goal holds a cell")
    }

    #[test]
    fn a_good_goal_gets_no_warning() {
        for kind in [DescriptorKind::Direct, DescriptorKind::Window, DescriptorKind::Motion] {
            assert_eq!(warnings(texture(), kind, params(4, DistanceScale::SqrtBlocks)), []);
        }
    }

    #[test]
    fn black_means_something_else_to_each_descriptor() {
        let black = |kind| warnings(Frame::new(20, 20), kind, RewardParams::default());
        assert_eq!(black(DescriptorKind::Direct), [GoalWarning::Black]);
        assert_eq!(black(DescriptorKind::Window), [GoalWarning::BlackWindow]);
        assert_eq!(black(DescriptorKind::Motion), [GoalWarning::NoMotion]);
    }

    #[test]
    fn what_the_mask_leaves_decides() {
        let (mut picture, mut mask) = (texture(), Frame::new(40, 30));
        (5..9).for_each(|y| {
            picture.row_mut(y)[5..9].fill(77);
            mask.row_mut(y)[5..9].fill(255);
        });
        let goal = Goal { picture, mask: Some(mask) };
        let found = check_goal(&goal, DescriptorKind::Window, RewardParams::default()).expect("a cell fits");
        assert_eq!(found, [GoalWarning::Flat { value: 77 }]);
    }

    #[test]
    fn one_cell_underflow_and_saturation_are_found() {
        let one = warnings(texture(), DescriptorKind::Direct, params(30, DistanceScale::None));
        assert_eq!(one, [GoalWarning::OneCell { cell_px: 30 }]);
        let under = warnings(texture(), DescriptorKind::Direct, params(1, DistanceScale::None));
        assert!(matches!(under[..], [GoalWarning::Underflow { reward }] if reward < 1e-6), "{under:?}");
        let mut faint = Frame::from_vec(40, 30, vec![100; 1200]).expect("40 x 30");
        faint.row_mut(3)[4] = 101;
        let hog = HogParams { norm: crate::Norm::None, cell: CellSize::Px(10), ..HogParams::default() };
        let saturated = warnings(faint, DescriptorKind::Direct, RewardParams { hog, ..RewardParams::default() });
        assert!(matches!(saturated[..], [GoalWarning::Saturated { reward }] if reward > 0.99), "{saturated:?}");
        assert!(saturated[0].to_string().contains("upside down"), "{}", saturated[0]);
    }

    #[test]
    fn a_goal_too_small_for_a_gradient_is_saturated() {
        let tiny = Frame::from_vec(2, 2, vec![10, 20, 30, 40]).expect("2 x 2");
        let found = warnings(tiny, DescriptorKind::Direct, params(1, DistanceScale::SqrtBlocks));
        assert_eq!(found, [GoalWarning::Saturated { reward: 1.0 }]);
    }
}
