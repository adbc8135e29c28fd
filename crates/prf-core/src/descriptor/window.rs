//! The goal is a part of the picture, wherever it may be found.

use serde::{Deserialize, Serialize};

use super::comparison::Comparison;
use super::{Explanation, TaskDescriptor};
use crate::region::Region;
use crate::{Error, Frame, FrameView, Match, MatchMethod, RewardParams, Score, TemplateMatcher};

/// Parameters of a window task descriptor. In a file, every key may be left out.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct WindowParams {
    /// What makes a window of the frame the best one.
    pub method: MatchMethod,
}

/// Window task descriptor: the part of the agent's frame that matches the goal best is compared with it.
///
/// The goal slides over the frame; the window of the highest normalised correlation is the agent's template. Both are
/// then compared as by the [`DirectDescriptor`](crate::DirectDescriptor). (Paper, section "Mirror task descriptors".)
///
/// ```
/// use prf_core::{Frame, Rect, RewardParams, TaskDescriptor, WindowDescriptor, WindowParams};
/// let mut goal = Frame::new(12, 9);
/// goal.row_mut(2)[1..6].fill(200);
/// goal.row_mut(7)[5..11].fill(120);
/// let mut descriptor = WindowDescriptor::new(&goal, None, WindowParams::default(), RewardParams::default())?;
///
/// let mut frame = Frame::new(84, 84);
/// frame.row_mut(32)[51..56].fill(200);
/// frame.row_mut(37)[55..61].fill(120);
/// frame.row_mut(70).fill(90);
/// assert_eq!(descriptor.observe(frame.view())?.reward, 1.0);
/// let found = descriptor.explain(frame.view()).matched.unwrap();
/// assert_eq!(found.rect, Rect { x: 50, y: 30, width: 12, height: 9 });
/// # Ok::<(), prf_core::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct WindowDescriptor {
    finder: WindowFinder,
    comparison: Comparison,
}

/// Finds the agent's template `T_A`: the window that matches the goal best.
#[derive(Clone, Debug)]
pub(crate) struct WindowFinder {
    matcher: TemplateMatcher,
    cut_out: Option<CutOut>,
    matched: Option<Match>,
}

/// A goal that is no rectangle: what lies outside of the mask is black in both templates.
#[derive(Clone, Debug)]
struct CutOut {
    mask: Frame,
    template: Frame,
}

impl WindowFinder {
    /// # Errors
    ///
    /// As [`TemplateMatcher::new`].
    pub(crate) fn new(goal: &Frame, mask: Option<&Frame>, window: WindowParams) -> Result<WindowFinder, Error> {
        let matcher = TemplateMatcher::new(goal, mask, window.method)?;
        let cut_out = mask.map(|mask| CutOut { mask: mask.clone(), template: goal.clone() });
        Ok(WindowFinder { matcher, cut_out, matched: None })
    }

    /// # Errors
    ///
    /// As [`TemplateMatcher::prepare`].
    pub(crate) fn find<'a>(&'a mut self, mirror: FrameView<'a>) -> Result<Region<'a, u8>, Error> {
        let matched = self.matcher.best(mirror)?;
        self.matched = Some(matched);
        let window = mirror.region().within(matched.rect);
        let Some(CutOut { mask, template }) = &mut self.cut_out else {
            return Ok(window);
        };
        for y in 0..mask.height() {
            template.row_mut(y).copy_from_slice(window.row(y));
        }
        template.blacken_outside(mask.view());
        Ok(template.view().region())
    }
}

impl WindowDescriptor {
    /// Prepares a goal of any size; frames have to be at least as wide and as high. Where `mask`, a picture of the goal's size, is black the goal doesn't count.
    ///
    /// # Errors
    ///
    /// As [`DirectDescriptor::new`](crate::DirectDescriptor::new) and [`TemplateMatcher::new`].
    pub fn new(
        goal: &Frame,
        mask: Option<&Frame>,
        window: WindowParams,
        params: RewardParams,
    ) -> Result<WindowDescriptor, Error> {
        let finder = WindowFinder::new(goal, mask, window)?;
        let mut template = goal.clone();
        if let Some(mask) = mask {
            template.blacken_outside(mask.view());
        }
        Ok(WindowDescriptor { finder, comparison: Comparison::new(&template, params)? })
    }
}

impl TaskDescriptor for WindowDescriptor {
    fn prepare(&mut self, shape: [usize; 2]) -> Result<(), Error> {
        self.finder.matcher.prepare(shape)
    }

    fn reset(&mut self) {}

    fn observe(&mut self, mirror: FrameView<'_>) -> Result<Score, Error> {
        Ok(self.comparison.score(self.finder.find(mirror)?))
    }

    fn explain<'a>(&'a self, mirror: FrameView<'a>) -> Explanation<'a> {
        let mask = self.finder.cut_out.as_ref().map(|cut_out| cut_out.mask.view());
        Explanation { mask, ..self.comparison.explain(mirror, self.finder.matched) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{CellSize, HogParams, Rect};

    fn params() -> RewardParams {
        let hog = HogParams { cell: CellSize::Px(2), ..HogParams::default() };
        RewardParams { hog, ..RewardParams::default() }
    }

    fn texture(width: usize, height: usize, seed: usize) -> Frame {
        let pixels = (0..width * height).map(|i| 1 + ((i * (seed + 5) * 2_654_435_761) >> 13) as u8 % 255).collect();
        Frame::from_vec(width, height, pixels).expect("sides above 0")
    }

    fn paste(frame: &mut Frame, picture: &Frame, [left, top]: [usize; 2]) {
        for y in 0..picture.height() {
            frame.row_mut(top + y)[left..left + picture.width()].copy_from_slice(picture.view().row(y));
        }
    }

    #[test]
    fn the_goal_is_found_wherever_it_lies() {
        let goal = texture(9, 12, 1);
        for method in [MatchMethod::CcorrNormed, MatchMethod::CcoeffNormed] {
            let window = WindowParams { method };
            let mut descriptor = WindowDescriptor::new(&goal, None, window, params()).expect("valid");
            for at in [[0, 0], [31, 20], [11, 28]] {
                let mut frame = texture(40, 40, 2);
                paste(&mut frame, &goal, at);
                assert_eq!(descriptor.observe(frame.view()).expect("it fits").reward, 1.0);
                let explanation = descriptor.explain(frame.view());
                let rect = Rect { x: at[0], y: at[1], width: 9, height: 12 };
                assert_eq!(explanation.matched.expect("observed").rect, rect);
                assert_eq!(explanation.agent_box, rect);
            }
        }
    }

    #[test]
    fn what_the_mask_leaves_out_does_not_count() {
        let goal = texture(10, 10, 1);
        let mut mask = Frame::new(10, 10);
        (2..8).for_each(|y| mask.row_mut(y)[2..8].fill(255));
        let mut frame = texture(40, 40, 3);
        let (mut masked, mut plain) = (goal.clone(), params());
        plain.scale = crate::DistanceScale::None;
        masked.row_mut(0).fill(7);
        paste(&mut frame, &masked, [13, 21]);
        let score = |mask| {
            let window = WindowParams::default();
            let mut descriptor = WindowDescriptor::new(&goal, mask, window, plain).expect("valid");
            descriptor.observe(frame.view()).expect("it fits")
        };
        assert_eq!(score(Some(&mask)).reward, 1.0);
        assert!(score(None).reward < 0.9);
    }

    #[test]
    fn the_template_is_what_was_compared() {
        let goal = texture(6, 6, 1);
        let mut mask = Frame::new(6, 6);
        (1..5).for_each(|y| mask.row_mut(y)[1..4].fill(255));
        mask.row_mut(3)[2] = 0;
        let mut frame = texture(20, 20, 3);
        paste(&mut frame, &goal, [9, 5]);
        let window = WindowParams::default();
        let mut descriptor = WindowDescriptor::new(&goal, Some(&mask), window, params()).expect("valid");
        descriptor.observe(frame.view()).expect("it fits");
        let template = descriptor.explain(frame.view()).agent_template();
        assert_eq!((template.width(), template.height()), (3, 4));
        for (x, y) in (0..3).flat_map(|x| (0..4).map(move |y| (x, y))) {
            let expected = if (x, y) == (1, 2) { 0 } else { goal.view().row(y + 1)[x + 1] };
            assert_eq!(template.view().row(y)[x], expected, "({x}, {y})");
        }
    }

    /// docs/reward.md goes through this by hand.
    #[test]
    fn the_example_of_the_documentation() {
        let picture = |width, pixels: &[u8]| Frame::from_vec(width, 2, pixels.to_vec()).expect("two rows");
        let goal = picture(3, &[10, 20, 30, 30, 20, 10]);
        let frame = picture(4, &[50, 80, 90, 100, 140, 100, 90, 80]);
        let cell = CellSize::Px(2);
        let hog = HogParams { orientations: 2, signed: true, cell, ..HogParams::default() };
        let params = RewardParams { hog, ..RewardParams::default() };
        for (method, scores, x, reward) in [
            (MatchMethod::CcorrNormed, [0.9616, 0.9562], 0, 0.8953),
            (MatchMethod::CcoeffNormed, [0.6876, 1.0], 1, 1.0),
        ] {
            let mut map = crate::Plane::from_vec(1, 1, vec![0.0]).expect("one value");
            let mut matcher = TemplateMatcher::new(&goal, None, method).expect("no mask");
            matcher.scores_into(frame.view(), &mut map).expect("it fits");
            let close = |a: f32, b: f32| (a - b).abs() < 1e-4;
            assert!(map.as_slice().iter().zip(scores).all(|(&got, by_hand)| close(got, by_hand)), "{map:?}");

            let mut descriptor = WindowDescriptor::new(&goal, None, WindowParams { method }, params).expect("valid");
            let score = descriptor.observe(frame.view()).expect("it fits");
            let explanation = descriptor.explain(frame.view());
            assert_eq!(explanation.matched.expect("observed").rect, Rect { x, y: 0, width: 3, height: 2 });
            assert_eq!(explanation.layout.cells(), [1, 1]);
            assert!(close(score.reward, reward), "{score:?}");
        }
    }

    #[test]
    fn a_goal_larger_than_the_frame_is_refused() {
        let mut descriptor =
            WindowDescriptor::new(&texture(9, 12, 1), None, WindowParams::default(), params()).expect("valid");
        for shape in [[11, 40], [40, 8]] {
            let error = descriptor.prepare(shape).expect_err("too small").to_string();
            assert!(error.contains("9x12"), "{error}");
            assert!(error.contains(&format!("{}x{}", shape[1], shape[0])), "{error}");
            assert!(descriptor.observe(Frame::new(shape[1], shape[0]).view()).is_err());
        }
        descriptor.prepare([12, 9]).expect("just large enough");
    }
}
