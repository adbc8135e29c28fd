//! Frames that a reward is to be judged by, with what is known of them.

use std::borrow::Cow;

use super::figures::LEAST_FRAMES;
use super::{Evidence, Knowledge, template};
use crate::descriptor::WindowFinder;
use crate::{DescriptorParams, Error, Frame, FrameView, Goal, MotionParams, MotionTemplate};

/// What is known of a frame.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Label {
    /// How far the task has come; the higher the better. Frames without one have no place in the order.
    pub score: Option<f64>,
    /// Whether the task is done here.
    pub success: Option<bool>,
}

/// Frames with labels, spread evenly over all that were shown. Memory stays within twice the limit's frames, however many are shown.
///
/// ```
/// use prf_core::{DescriptorParams, Footage, Frame, Goal, Label, RewardParams};
/// let mut footage = Footage::new(None, 1000)?;
/// let mut frame = Frame::new(30, 30);
/// frame.row_mut(0).fill(200);
/// frame.row_mut(29).fill(200);
/// for bars in 1..10 {
///     frame.row_mut(3 * bars)[2..28].fill(200); // one more
///     footage.observe(frame.view(), Label { score: Some(bars as f64), success: None })?;
/// }
/// let evidence = footage.scored(&DescriptorParams::Direct, &Goal::from(frame.clone()))?;
/// let judgement = evidence.judge(RewardParams::default())?;
/// assert_eq!(judgement.figures[0].value, Some(1.0));
/// # Ok::<(), prf_core::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Footage {
    limit: usize,
    /// Every so many frames one is kept.
    stride: usize,
    /// Frames that were shown.
    shown: usize,
    motion: Option<MotionTemplate>,
    kept: Kept,
}

#[derive(Clone, Debug, Default)]
struct Kept {
    /// Which of the frames shown they are.
    indices: Vec<usize>,
    frames: Vec<Frame>,
    /// Motion templates up to each of the frames.
    templates: Vec<Frame>,
    labels: Vec<Label>,
    /// Places among the frames at which episodes begin.
    starts: Vec<usize>,
}

impl Footage {
    /// Nothing yet; `limit` frames are kept at most. With the parameters of a motion descriptor, motion templates are made of the frames.
    ///
    /// # Errors
    ///
    /// [`Error::InvalidParam`] as [`MotionTemplate::new`], or when the limit is 0.
    pub fn new(motion: Option<MotionParams>, limit: usize) -> Result<Footage, Error> {
        if limit == 0 {
            return Err(Error::invalid("limit", &0, "at least 1 frame"));
        }
        let motion = motion.map(MotionTemplate::new).transpose().map_err(|error| error.within("motion"))?;
        Ok(Footage { limit, stride: 1, shown: 0, motion, kept: Kept::default() })
    }

    /// Begins an episode or a demonstration: the next frame follows on none before it.
    pub fn begin(&mut self) {
        self.kept.starts.push(self.kept.frames.len());
        if let Some(motion) = &mut self.motion {
            motion.reset();
        }
    }

    /// Takes in a frame for the movement that it shows, and not to be judged by.
    ///
    /// # Errors
    ///
    /// As [`Footage::observe`].
    pub fn pass(&mut self, frame: FrameView<'_>) -> Result<(), Error> {
        match &mut self.motion {
            Some(motion) => motion.observe(frame),
            None => Ok(()),
        }
    }

    /// Takes in a frame.
    ///
    /// # Errors
    ///
    /// As [`MotionTemplate::observe`], for motion descriptors.
    pub fn observe(&mut self, frame: FrameView<'_>, label: Label) -> Result<(), Error> {
        self.pass(frame)?;
        let index = self.shown;
        self.shown += 1;
        if !index.is_multiple_of(self.stride) {
            return Ok(());
        }
        if self.kept.frames.len() == self.limit {
            self.kept.thin();
            self.stride *= 2;
            if !index.is_multiple_of(self.stride) {
                return Ok(());
            }
        }
        self.kept.indices.push(index);
        self.kept.frames.push(frame.to_frame());
        self.kept.labels.push(label);
        if let Some(motion) = &self.motion {
            let mut template = Frame::new(1, 1);
            motion.history_into(&mut template);
            self.kept.templates.push(template);
        }
        Ok(())
    }

    /// Frames that were taken in to be judged by, kept or not.
    #[must_use]
    pub fn shown(&self) -> usize {
        self.shown
    }

    /// The frames that were kept.
    #[must_use]
    pub fn frames(&self) -> &[Frame] {
        &self.kept.frames
    }

    /// Which of those taken in each of the kept frames is, from 0.
    #[must_use]
    pub fn indices(&self) -> &[usize] {
        &self.kept.indices
    }

    /// Places among the kept frames at which episodes or demonstrations begin.
    #[must_use]
    pub fn starts(&self) -> &[usize] {
        &self.kept.starts
    }

    /// What is known of each of the kept frames.
    #[must_use]
    pub fn labels(&self) -> &[Label] {
        &self.kept.labels
    }

    /// Evidence by scores and success: templates of this goal in all frames.
    ///
    /// # Errors
    ///
    /// [`Error::NoEvidence`] when there are neither two different scores nor both successes and failures; errors of the
    /// descriptor's own `new` and `observe`.
    pub fn scored(&self, descriptor: &DescriptorParams, goal: &Goal) -> Result<Evidence<'_>, Error> {
        let scores = || self.kept.labels.iter().filter_map(|label| label.score);
        let (least, most) = scores().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), s| (a.min(s), b.max(s)));
        let has = |success| self.kept.labels.iter().any(|label| label.success == Some(success));
        if least >= most && !(has(true) && has(false)) {
            let got = match scores().next() {
                Some(score) => format!("all {} frames have the score {score}", scores().count()),
                None => format!("none of the {} frames to judge by has a score", self.kept.labels.len()),
            };
            return Err(Error::NoEvidence { got, expected: "frames of different scores, or of success and failure" });
        }
        self.evidence(descriptor, goal, Knowledge::Scores(&self.kept.labels))
    }

    /// Evidence by demonstrations: templates of this goal in all frames; every [`begin`](Footage::begin) begins one
    /// demonstration, whose last frame shows the goal.
    ///
    /// # Errors
    ///
    /// [`Error::NoEvidence`] when no demonstration has three frames; errors of the descriptor's own `new` and `observe`.
    pub fn demonstrated(&self, descriptor: &DescriptorParams, goal: &Goal) -> Result<Evidence<'_>, Error> {
        let ends = self.kept.starts.iter().skip(1).copied().chain([self.kept.frames.len()]);
        let longest = self.kept.starts.iter().zip(ends).map(|(start, end)| end - start).max().unwrap_or(0);
        if longest < LEAST_FRAMES {
            let got = format!("the longest demonstration has {longest} frames");
            return Err(Error::NoEvidence { got, expected: "at least 3 frames that end at the goal" });
        }
        self.evidence(descriptor, goal, Knowledge::Demonstrations(&self.kept.starts))
    }

    fn evidence<'a>(
        &'a self,
        descriptor: &DescriptorParams,
        goal: &Goal,
        knowledge: Knowledge<'a>,
    ) -> Result<Evidence<'a>, Error> {
        let templates = match descriptor {
            DescriptorParams::Motion(_) => Cow::Borrowed(&self.kept.templates[..]),
            DescriptorParams::Direct => Cow::Borrowed(&self.kept.frames[..]),
            DescriptorParams::Window(window) => {
                let mut finder = WindowFinder::new(&goal.picture, goal.mask.as_ref(), *window)?;
                let found = self.kept.frames.iter().map(|frame| template(&mut finder, frame));
                Cow::Owned(found.collect::<Result<Vec<_>, _>>()?)
            }
        };
        Ok(Evidence { goal: goal.seen(), templates, knowledge })
    }
}

impl Kept {
    /// Drops every other frame.
    fn thin(&mut self) {
        fn every_other<T>(values: &mut Vec<T>) {
            let mut index = 0;
            values.retain(|_| {
                index += 1;
                index % 2 == 1
            });
        }
        every_other(&mut self.indices);
        every_other(&mut self.frames);
        every_other(&mut self.templates);
        every_other(&mut self.labels);
        self.starts.iter_mut().for_each(|start| *start = start.div_ceil(2));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::RewardParams;

    fn show(footage: &mut Footage, frames: usize) {
        for value in 0..frames {
            let mut frame = Frame::new(6, 6);
            frame.row_mut(3)[..3].fill(value as u8 + 1);
            let label = Label { score: Some(value as f64), success: None };
            footage.observe(frame.view(), label).expect("one size");
        }
    }

    #[test]
    fn what_is_kept_is_spread_evenly_and_stays_within_the_limit() {
        let mut footage = Footage::new(None, 8).expect("above 0");
        footage.begin();
        show(&mut footage, 21);
        footage.begin();
        show(&mut footage, 6);
        assert_eq!(footage.shown(), 27);
        assert_eq!(footage.indices(), [0, 4, 8, 12, 16, 20, 24]);
        let scores: Vec<f64> = footage.labels().iter().filter_map(|label| label.score).collect();
        assert_eq!(scores, [0.0, 4.0, 8.0, 12.0, 16.0, 20.0, 3.0]);
        assert_eq!(footage.kept.starts, [0, 6]);
        assert_eq!(footage.frames()[6].row(3)[0], 4);
    }

    #[test]
    fn motion_templates_are_made_of_all_frames_of_their_episode() {
        let mut few = Footage::new(Some(MotionParams::default()), 4).expect("valid");
        let mut all = Footage::new(Some(MotionParams::default()), 100).expect("valid");
        for footage in [&mut few, &mut all] {
            for _ in 0..2 {
                footage.begin();
                for step in 0..8 {
                    let mut frame = Frame::new(20, 20);
                    (4..9).for_each(|y| frame.row_mut(y)[2 * step..2 * step + 3].fill(200));
                    footage.observe(frame.view(), Label::default()).expect("one size");
                }
            }
        }
        for (index, template) in few.indices().iter().zip(&few.kept.templates) {
            assert_eq!(template, &all.kept.templates[*index]);
        }
        assert!(few.kept.templates[1].as_slice().iter().any(|&v| v > 0));
    }

    #[test]
    fn frames_that_nothing_is_known_of_are_no_evidence() {
        let goal = Goal::from(Frame::new(6, 6));
        let scored = |footage: &Footage| footage.scored(&DescriptorParams::Direct, &goal).map(|_| ());
        let mut footage = Footage::new(None, 8).expect("above 0");
        let error = scored(&footage).expect_err("nothing shown").to_string();
        assert!(
            error.starts_with("none of the 0 frames to judge by has a score, expected frames of different scores"),
            "{error}"
        );
        show(&mut footage, 1);
        show(&mut footage, 1);
        let error = scored(&footage).expect_err("one score").to_string();
        assert!(error.starts_with("all 2 frames have the score 0"), "{error}");
        for success in [true, false] {
            let label = Label { score: None, success: Some(success) };
            footage.observe(Frame::new(6, 6).view(), label).expect("one size");
        }
        scored(&footage).expect("success and failure");
        let mut demonstration = Footage::new(None, 8).expect("above 0");
        demonstration.begin();
        show(&mut demonstration, 2);
        let error = demonstration.demonstrated(&DescriptorParams::Direct, &goal).expect_err("too short").to_string();
        assert!(error.starts_with("the longest demonstration has 2 frames"), "{error}");
        assert!(Footage::new(None, 0).is_err());
    }

    #[test]
    fn templates_are_the_windows_that_were_found() {
        let mut goal = Frame::new(5, 4);
        goal.row_mut(1)[1..4].fill(90);
        let mut frame = Frame::new(30, 20);
        frame.row_mut(11)[21..24].fill(90);
        let mut footage = Footage::new(None, 8).expect("above 0");
        for score in [0.0, 1.0] {
            footage.observe(frame.view(), Label { score: Some(score), success: None }).expect("one size");
        }
        let window = DescriptorParams::Window(crate::WindowParams::default());
        let evidence = footage.scored(&window, &Goal::from(goal.clone())).expect("it fits");
        assert_eq!(evidence.templates[0], goal);
        assert_eq!(evidence.distances(RewardParams::default()).expect("a cell fits"), [0.0, 0.0]);
        let large = Goal::from(Frame::new(40, 4));
        assert!(matches!(footage.scored(&window, &large), Err(Error::TemplateTooLarge { .. })));
    }
}
