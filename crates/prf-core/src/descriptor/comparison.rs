//! What all descriptors share once they have their template: crop, rescale, HOG, distance.

use crate::crop::crop_box_of;
use crate::region::Region;
use crate::{
    Error, Explanation, Frame, FrameView, Hog, HogLayout, Match, Rect, Resizer, RewardParams, Score, crop_box,
};

/// How many sizes the goal's HOG is kept for.
const KEPT_SIZES: usize = 8;

/// A goal's template `T_G`, prepared to be compared with any number of agent templates `T_A`.
#[derive(Clone, Debug)]
pub(crate) struct Comparison {
    params: RewardParams,
    goal: Frame,
    goal_box: Rect,
    hog: Hog,
    resizer: Resizer,
    /// The part of the last `T_A` that was compared.
    agent_box: Rect,
    /// Cells and blocks of the last comparison.
    layout: HogLayout,
    score: Score,
    agent_features: Vec<f32>,
    /// The one of the last comparison comes first.
    goal_features: Vec<Kept>,
}

/// The goal's HOG at one size.
#[derive(Clone, Debug)]
struct Kept {
    shape: [usize; 2],
    features: Vec<f32>,
}

impl Comparison {
    /// As [`DirectDescriptor::new`](crate::DirectDescriptor::new), which has the errors.
    pub(crate) fn new(goal: &Frame, params: RewardParams) -> Result<Comparison, Error> {
        params.validate()?;
        let goal_box = crop_box(goal.view());
        let layout = HogLayout::new(&params.hog, goal_box.width, goal_box.height)?;
        Ok(Comparison {
            params,
            goal: goal.clone(),
            goal_box,
            hog: Hog::new(params.hog)?,
            resizer: Resizer::default(),
            agent_box: goal_box,
            layout,
            score: Score { reward: 1.0, distance: 0.0 },
            agent_features: Vec::new(),
            goal_features: Vec::with_capacity(KEPT_SIZES),
        })
    }

    /// Where the last score came from: `agent` holds the `T_A` that was compared, at `matched` if it is a part.
    pub(super) fn explain<'a>(&'a self, agent: FrameView<'a>, matched: Option<Match>) -> Explanation<'a> {
        let [x, y] = matched.map_or([0, 0], |matched| [matched.rect.x, matched.rect.y]);
        Explanation {
            score: self.score,
            goal: self.goal.view(),
            goal_box: self.goal_box,
            agent,
            matched,
            agent_box: Rect { x: self.agent_box.x + x, y: self.agent_box.y + y, ..self.agent_box },
            mask: None,
            params: self.params,
            layout: self.layout,
            agent_features: &self.agent_features,
            goal_features: self.goal_features.first().map_or(&[], |kept| &kept.features),
        }
    }

    /// Crops `T_A`, brings both to one size and compares their HOGs.
    pub(crate) fn score(&mut self, agent: Region<'_, u8>) -> Score {
        self.agent_box = crop_box_of(agent);
        let agent = agent.within(self.agent_box);
        let goal_shape = [self.goal_box.height, self.goal_box.width];
        self.layout = HogLayout::fitted(&self.params.hog, common(agent.shape(), goal_shape));
        hog_at(&mut self.hog, &mut self.resizer, &self.layout, agent, &mut self.agent_features);
        self.prepare_goal();
        let divisor = self.params.scale.divisor(&self.layout);
        self.score = Score::of(&self.agent_features, &self.goal_features[0].features, divisor);
        self.score
    }

    /// The goal's HOG for the layout, from memory or made now, is at the front of the list.
    fn prepare_goal(&mut self) {
        let shape = self.layout.shape();
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
        hog_at(&mut self.hog, &mut self.resizer, &self.layout, goal, &mut kept.features);
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
        hog.compute(layout, resizer.rows(template, layout.shape()), out);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_larger_of_two_templates_sets_the_size() {
        assert_eq!(common([10, 20], [9, 20]), [10, 20]);
        assert_eq!(common([10, 20], [30, 30]), [30, 30]);
        // One area: the taller, whichever comes first.
        assert_eq!(common([10, 20], [20, 10]), [20, 10]);
        assert_eq!(common([20, 10], [10, 20]), [20, 10]);
    }

    #[test]
    fn comparing_allocates_nothing_once_warm() {
        let goal = Frame::from_vec(84, 84, vec![9; 84 * 84]).expect("84 x 84");
        let mut comparison = Comparison::new(&goal, RewardParams::default()).expect("valid");
        let mut frame = Frame::new(84, 84);
        let pointers = |comparison: &Comparison| {
            (comparison.agent_features.as_ptr(), comparison.goal_features[0].features.as_ptr())
        };
        frame.row_mut(40)[20..60].fill(200);
        frame.row_mut(41)[20..60].fill(100);
        comparison.score(frame.view().region());
        let before = pointers(&comparison);
        for y in 0..20 {
            frame.row_mut(y)[y..y + 30].fill(200);
            comparison.score(frame.view().region());
        }
        assert_eq!(before, pointers(&comparison));
        assert_eq!(comparison.goal_features.len(), 1);
    }
}
