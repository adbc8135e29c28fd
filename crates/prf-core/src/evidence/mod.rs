//! Is a reward any good for a task, and which settings make it good?
//!
//! A reward teaches a task when it orders states as the task does. What is known of that order is one of three things:
//! scores of frames, demonstrations that end at the goal, or nothing but the goal itself, which is then altered.

mod figures;
mod footage;
mod objects;
mod probes;
mod settings;
mod sweep;
mod verdict;
mod windows;

use std::borrow::Cow;

pub use figures::{Figure, FigureKind};
pub use footage::{Footage, Label};
pub use settings::settings;
pub use verdict::{Judgement, Rewards, Verdict, recommend};
pub use windows::windows_around;

use crate::descriptor::{Comparison, WindowFinder};
use crate::{DescriptorParams, Error, Frame, Goal, RewardParams};
pub use probes::Alteration;
use probes::Probe;

/// The agent's templates `T_A` of many frames, found once, and what is known of them. Any number of reward settings can be
/// judged by it.
///
/// ```
/// use prf_core::{CellSize, DescriptorParams, Evidence, Frame, Goal, HogParams, Norm, RewardParams, Verdict};
/// // A ball on the floor, and nothing else is known.
/// let mut picture = Frame::new(40, 40);
/// (12..22).for_each(|y| picture.row_mut(y)[14..22].fill(255));
/// picture.row_mut(36).fill(90);
/// let evidence = Evidence::of_goal(&DescriptorParams::Direct, &Goal::from(picture))?;
///
/// let cell = |px| RewardParams { hog: HogParams { cell: CellSize::Px(px), ..HogParams::default() }, ..Default::default() };
/// let (fine, coarse) = (evidence.judge(cell(1))?, evidence.judge(cell(10))?);
/// assert!(coarse.quality > fine.quality);
/// # Ok::<(), prf_core::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Evidence<'a> {
    /// `T_G` as it is compared.
    goal: Frame,
    templates: Cow<'a, [Frame]>,
    knowledge: Knowledge<'a>,
}

/// A goal that was altered to judge a reward by.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Altered<'a> {
    /// What was done.
    pub alteration: Alteration,
    /// To which of the things in it, from 0, the largest first.
    pub thing: usize,
    /// How much, from 1: see [`Alteration`].
    pub level: usize,
    /// What it looks like now; a window's goal has a border around it.
    pub frame: &'a Frame,
}

/// What is known of the templates, in their order.
#[derive(Clone, Debug)]
enum Knowledge<'a> {
    Scores(&'a [Label]),
    /// The places at which demonstrations begin.
    Demonstrations(&'a [usize]),
    Alterations(Vec<Probe>),
}

impl Evidence<'static> {
    /// What the goal alone can tell: the things in it are displaced, taken away, scaled and covered, and noise is laid over it.
    /// A good reward falls steadily with displacement, and gives less where a thing is absent than where it is displaced.
    ///
    /// Things are what hangs together and differs from the most frequent grey. For a window the altered goals lie on a larger
    /// picture, over which the window is looked for.
    ///
    /// # Errors
    ///
    /// [`Error::NothingToAlter`] when the goal is even; errors of the descriptor's own `new`.
    pub fn of_goal(descriptor: &DescriptorParams, goal: &Goal) -> Result<Evidence<'static>, Error> {
        let is_window = matches!(descriptor, DescriptorParams::Window(_));
        let probes = probes::probes(goal, is_window)?;
        let templates = match descriptor {
            DescriptorParams::Window(window) => {
                let mut finder = WindowFinder::new(&goal.picture, goal.mask.as_ref(), *window)?;
                let found = probes.iter().map(|probe| template(&mut finder, &probe.frame));
                found.collect::<Result<Vec<_>, _>>()?
            }
            // A motion template is altered as it is.
            DescriptorParams::Direct | DescriptorParams::Motion(_) => {
                probes.iter().map(|probe| probe.frame.clone()).collect()
            }
        };
        Ok(Evidence { goal: goal.seen(), templates: templates.into(), knowledge: Knowledge::Alterations(probes) })
    }
}

impl Evidence<'_> {
    /// How many templates there are.
    #[must_use]
    pub fn len(&self) -> usize {
        self.templates.len()
    }

    /// Whether there is no template.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.templates.is_empty()
    }

    /// The altered goals, in the order of their distances; none where the evidence is another.
    pub fn alterations(&self) -> impl Iterator<Item = Altered<'_>> {
        let probes = match &self.knowledge {
            Knowledge::Alterations(probes) => &probes[..],
            Knowledge::Scores(_) | Knowledge::Demonstrations(_) => &[],
        };
        probes.iter().map(|probe| Altered {
            alteration: probe.alteration,
            thing: probe.object,
            level: probe.level,
            frame: &probe.frame,
        })
    }

    /// `D` of each template under these settings.
    ///
    /// # Errors
    ///
    /// As [`DirectDescriptor::new`](crate::DirectDescriptor::new).
    pub fn distances(&self, params: RewardParams) -> Result<Vec<f32>, Error> {
        let mut comparison = Comparison::new(&self.goal, params)?;
        Ok(self.templates.iter().map(|template| comparison.score(template.view().region()).distance).collect())
    }

    /// Whether these settings make a good reward.
    ///
    /// # Errors
    ///
    /// As [`Evidence::distances`].
    pub fn judge(&self, params: RewardParams) -> Result<Judgement, Error> {
        let distances = self.distances(params)?;
        // The order of D is the order of F turned round, and does not drown where F underflows.
        let closeness: Vec<f64> = distances.iter().map(|&distance| -f64::from(distance)).collect();
        let figures = match &self.knowledge {
            Knowledge::Scores(labels) => figures::of_scores(&closeness, labels),
            Knowledge::Demonstrations(starts) => figures::of_demonstrations(&closeness, starts),
            Knowledge::Alterations(probes) => figures::of_alterations(&closeness, probes),
        };
        Ok(Judgement::new(params, self.goal.view(), figures, &distances))
    }
}

/// The window of the frame that was found.
fn template(finder: &mut WindowFinder, frame: &Frame) -> Result<Frame, Error> {
    let found = finder.find(frame.view())?;
    let pixels = (0..found.height()).flat_map(|y| found.row(y)).copied().collect();
    Frame::from_vec(found.width(), found.height(), pixels)
}
