//! What must hold for every descriptor, whatever the goal's shape.
#![expect(clippy::unwrap_used, reason = "a test may stop at the first surprise")]

use prf_core::{
    CellSize, DescriptorParams, DistanceScale, Frame, Goal, HogParams, MatchMethod, MotionParams, Norm, Rect,
    RewardParams, WindowParams,
};
use proptest::prelude::*;

mod shapes;

use shapes::any_shape;

/// Side of the largest goals; frames are no smaller, so that every window fits.
const MOST: usize = 12;

/// A descriptor whose goal is a picture of what it looks at.
fn of_a_picture() -> impl Strategy<Value = DescriptorParams> {
    let window = |method| DescriptorParams::Window(WindowParams { method });
    prop::sample::select(vec![
        DescriptorParams::Direct,
        window(MatchMethod::CcorrNormed),
        window(MatchMethod::CcoeffNormed),
    ])
}

fn descriptor() -> impl Strategy<Value = DescriptorParams> {
    prop_oneof![
        3 => of_a_picture(),
        1 => (0u8..=254).prop_map(|threshold| DescriptorParams::Motion(MotionParams { threshold, ..Default::default() })),
    ]
}

prop_compose! {
    /// Cells small enough for a goal of any shape.
    fn reward_params()(
        cell in prop_oneof![Just(CellSize::Px(1)), (0.01f32..0.1).prop_map(CellSize::Fraction)],
        orientations in 1usize..12,
        signed: bool,
        norm in prop::sample::select(vec![Norm::None, Norm::L1, Norm::L1Sqrt, Norm::L2, Norm::L2Hys]),
        scale in prop::sample::select(vec![
            DistanceScale::None, DistanceScale::SqrtBlocks, DistanceScale::SqrtFeatures,
        ]),
    ) -> RewardParams {
        RewardParams { hog: HogParams { cell, orientations, signed, norm, block_cells: 1 }, scale }
    }
}

/// Frames of one size, at least that of the largest goals.
fn episode() -> impl Strategy<Value = Vec<Frame>> {
    let pixel = || prop_oneof![3 => Just(0u8), 1 => Just(200), 2 => any::<u8>()];
    (MOST..30, MOST..30).prop_flat_map(move |(width, height)| {
        let frame = prop::collection::vec(pixel(), width * height)
            .prop_map(move |pixels| Frame::from_vec(width, height, pixels).unwrap());
        prop::collection::vec(frame, 1..5)
    })
}

/// The goal alone on black, its top left corner at (`x`, `y`).
fn placed(goal: &Frame, x: usize, y: usize) -> Frame {
    let mut frame = Frame::new(4 * MOST, 4 * MOST);
    for row in 0..goal.height() {
        frame.row_mut(y + row)[x..x + goal.width()].copy_from_slice(goal.row(row));
    }
    frame
}

proptest! {
    #[test]
    fn rewards_and_matches_keep_to_their_bounds(
        picture in any_shape(MOST), masked: bool, frames in episode(),
        params in reward_params(), descriptor in descriptor(),
    ) {
        let is_window = matches!(descriptor, DescriptorParams::Window(_));
        let lit = picture.as_slice().iter().any(|&pixel| pixel != 0);
        // What is not black of the goal is as good a mask as any.
        let mask = (masked && is_window && lit).then(|| picture.clone());
        let goal = Goal { picture, mask };
        let mut descriptor = descriptor.describe(&goal, params).unwrap();
        for frame in frames {
            let score = descriptor.observe(frame.view()).unwrap();
            prop_assert!(score.reward > 0.0 && score.reward <= 1.0, "{score:?}");
            prop_assert!(score.distance >= 0.0 && score.distance.is_finite(), "{score:?}");
            prop_assert_eq!(score.reward, (-score.distance).exp().max(f32::MIN_POSITIVE));
            let matched = descriptor.explain(frame.view()).matched;
            prop_assert_eq!(matched.is_some(), is_window);
            if let Some(found) = matched {
                prop_assert!((-1.0..=1.0).contains(&found.score), "{found:?}");
                let Rect { x, y, width, height } = found.rect;
                prop_assert_eq!((width, height), (goal.picture.width(), goal.picture.height()));
                prop_assert!(x + width <= frame.width() && y + height <= frame.height(), "{found:?}");
            }
        }
    }

    #[test]
    fn a_goal_of_any_shape_is_its_own_best_reward(
        picture in any_shape(MOST), params in reward_params(), descriptor in of_a_picture(),
    ) {
        let goal = Goal::from(picture);
        let mut descriptor = descriptor.describe(&goal, params).unwrap();
        let score = descriptor.observe(goal.picture.view()).unwrap();
        prop_assert_eq!((score.reward, score.distance), (1.0, 0.0));
    }

    #[test]
    fn a_goal_alone_on_black_is_found_where_it_lies(
        picture in any_shape(MOST), params in reward_params(), x in 0..=3 * MOST, y in 0..=3 * MOST,
    ) {
        let frame = placed(&picture, x, y);
        let goal = Goal::from(picture);
        let window = DescriptorParams::Window(WindowParams { method: MatchMethod::CcorrNormed });
        let mut descriptor = window.describe(&goal, params).unwrap();
        prop_assert_eq!(descriptor.observe(frame.view()).unwrap().reward, 1.0);
        let found = descriptor.explain(frame.view()).matched.unwrap();
        let black = goal.picture.as_slice().iter().all(|&pixel| pixel == 0);
        prop_assert_eq!((found.rect.x, found.rect.y), if black { (0, 0) } else { (x, y) });
        prop_assert_eq!(found.score, if black { 0.0 } else { 1.0 });
    }

    #[test]
    fn the_motion_of_a_picture_of_any_shape_scores_as_its_own_goal(
        pictures in prop::collection::vec(any_shape(MOST), 2..4), params in reward_params(),
    ) {
        // The first sets the size; the others are cut or filled up with black to it.
        let (width, height) = (pictures[0].width(), pictures[0].height());
        let fitted = |picture: &Frame| {
            let mut frame = Frame::new(width, height);
            for row in 0..height.min(picture.height()) {
                let shared = width.min(picture.width());
                frame.row_mut(row)[..shared].copy_from_slice(&picture.row(row)[..shared]);
            }
            frame
        };
        let frames: Vec<Frame> = pictures.iter().map(fitted).collect();
        let motion = MotionParams::default();
        let mut template = Frame::new(1, 1);
        prf_core::MotionTemplate::of(motion, frames.iter().map(Frame::view)).unwrap().history_into(&mut template);
        let mut descriptor = DescriptorParams::Motion(motion).describe(&Goal::from(template), params).unwrap();
        let rewards: Vec<f32> =
            frames.iter().map(|frame| descriptor.observe(frame.view()).unwrap().reward).collect();
        prop_assert!(rewards.iter().all(|reward| *reward > 0.0 && *reward <= 1.0), "{rewards:?}");
        prop_assert_eq!(rewards[frames.len() - 1], 1.0);
    }
}
