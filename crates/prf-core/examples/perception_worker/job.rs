//! What is timed: each case's work with all prepared that can be.

use std::path::Path;

use prf_core::{
    DescriptorKind, DescriptorParams, Error, FrameView, Goal, Hog, Match, MotionTemplate, Plane, RewardParams,
    TaskDescriptor, TemplateMatcher, WindowParams,
};

use crate::Result;
use crate::case::{Case, Work};

/// Something to do with one picture after the other.
pub(crate) trait Job {
    fn call(&mut self, frame: FrameView<'_>) -> std::result::Result<(), Error>;

    /// Adds what the last call gave; `frame` is its picture.
    fn output(&self, frame: FrameView<'_>, out: &mut Vec<f32>);
}

pub(crate) fn make(case: &Case, folder: &Path) -> Result<Box<dyn Job>> {
    Ok(match &case.work {
        Work::Hog { hog } => Box::new(HogJob { hog: Hog::new(*hog)?, features: Vec::new() }),
        Work::Scores { template, method } => {
            let matcher = TemplateMatcher::new(&template.first(folder)?, None, *method)?;
            Box::new(ScoresJob { matcher, map: Plane::from_vec(1, 1, vec![0.0])? })
        }
        Work::Best { template, method } => {
            let matcher = TemplateMatcher::new(&template.first(folder)?, None, *method)?;
            Box::new(BestJob { matcher, found: None })
        }
        Work::Motion { motion } => Box::new(MotionJob { template: MotionTemplate::new(*motion)? }),
        Work::Reward { descriptor, goal, hog, motion } => {
            let params = match descriptor {
                DescriptorKind::Direct => DescriptorParams::Direct,
                DescriptorKind::Window => DescriptorParams::Window(WindowParams::default()),
                DescriptorKind::Motion => DescriptorParams::Motion(*motion),
            };
            let reward = RewardParams { hog: *hog, ..RewardParams::default() };
            let descriptor = params.describe(&Goal::from(goal.first(folder)?), reward)?;
            Box::new(RewardJob { descriptor, episode: case.frames.count, step: 0 })
        }
    })
}

struct HogJob {
    hog: Hog,
    features: Vec<f32>,
}

impl Job for HogJob {
    fn call(&mut self, frame: FrameView<'_>) -> std::result::Result<(), Error> {
        self.hog.compute_bytes_into(frame, &mut self.features).map(|_| ())
    }

    fn output(&self, _: FrameView<'_>, out: &mut Vec<f32>) {
        out.extend(&self.features);
    }
}

struct ScoresJob {
    matcher: TemplateMatcher,
    map: Plane,
}

impl Job for ScoresJob {
    fn call(&mut self, frame: FrameView<'_>) -> std::result::Result<(), Error> {
        self.matcher.scores_into(frame, &mut self.map)
    }

    fn output(&self, _: FrameView<'_>, out: &mut Vec<f32>) {
        out.extend(self.map.as_slice());
    }
}

struct BestJob {
    matcher: TemplateMatcher,
    found: Option<Match>,
}

impl Job for BestJob {
    fn call(&mut self, frame: FrameView<'_>) -> std::result::Result<(), Error> {
        self.found = Some(self.matcher.best(frame)?);
        Ok(())
    }

    fn output(&self, _: FrameView<'_>, out: &mut Vec<f32>) {
        out.extend(self.found.iter().flat_map(|found| [found.rect.x as f32, found.rect.y as f32, found.score]));
    }
}

struct MotionJob {
    template: MotionTemplate,
}

impl Job for MotionJob {
    fn call(&mut self, frame: FrameView<'_>) -> std::result::Result<(), Error> {
        self.template.observe(frame)
    }

    fn output(&self, _: FrameView<'_>, out: &mut Vec<f32>) {
        out.extend(self.template.history());
    }
}

struct RewardJob {
    descriptor: Box<dyn TaskDescriptor>,
    /// Steps after which a new one begins.
    episode: usize,
    step: usize,
}

impl Job for RewardJob {
    fn call(&mut self, frame: FrameView<'_>) -> std::result::Result<(), Error> {
        if self.step.is_multiple_of(self.episode) {
            self.descriptor.reset();
        }
        self.step += 1;
        self.descriptor.observe(frame).map(|_| ())
    }

    /// What was compared: the box of the agent's template, and how many features.
    fn output(&self, frame: FrameView<'_>, out: &mut Vec<f32>) {
        let explanation = self.descriptor.explain(frame);
        let rect = explanation.agent_box;
        out.extend([rect.x, rect.y, rect.width, rect.height, explanation.layout.len()].map(|value| value as f32));
    }
}
