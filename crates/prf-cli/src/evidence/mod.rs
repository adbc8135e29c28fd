//! What a reward is judged by: frames with scores, demonstrations, a world, or the goal alone.

mod scores;
mod subject;
pub(crate) mod words;

use std::collections::{BTreeMap, HashSet};

use prf_core::io::{FrameInfo, FrameSource, Limits};
use prf_core::{DescriptorParams, Evidence, Footage, Frame, Goal, Label};
use prf_envs::EnvConfig;
use prf_envs::survey::survey;

use self::scores::{Scores, reached};
pub(crate) use self::subject::Subject;
use crate::ExitStatus;
use crate::args::EvidenceArgs;
use crate::error::{CliError, Result};
use crate::printer::Printer;

/// What is known, ready to judge any goal of the subject's descriptor by.
pub(crate) struct Known {
    pub(crate) kind: Kind,
    pub(crate) footage: Footage,
    /// What to call frames, by their place among all that were taken in.
    names: BTreeMap<usize, String>,
    /// Frames or sources that could not be read.
    lost: usize,
}

/// Where the knowledge comes from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    World(String),
    Scores,
    Demonstrations(usize),
    Goal,
}

impl Known {
    /// Reads the frames, or plays the world.
    ///
    /// # Errors
    ///
    /// Misuse when frames come without anything that is known of them; failure when none can be read.
    pub(crate) fn gather(args: &EvidenceArgs, subject: &Subject, printer: &mut Printer) -> Result<Known> {
        let motion = match subject.descriptor() {
            DescriptorParams::Motion(motion) => Some(motion),
            DescriptorParams::Direct | DescriptorParams::Window(_) => None,
        };
        let world = subject.env.as_ref().filter(|_| args.frames.is_empty() && !args.goal_only);
        // A world shows about as many as it is asked for, and none of them is to be dropped.
        let limit = if world.is_some() { 2 * args.sample } else { args.sample };
        let footage = Footage::new(motion, limit as usize)?;
        let mut known = Known { kind: Kind::Goal, footage, names: BTreeMap::new(), lost: 0 };
        if let Some(path) = &args.scores {
            known.read_scores(Scores::read(path, args.success_at)?, args, printer)?;
        } else if args.demo {
            known.read_demonstrations(args, printer)?;
        } else if let Some(env) = world {
            known.play(env, args)?;
        } else if !args.frames.is_empty() {
            return Err(nothing_known().into());
        }
        if known.kind != Kind::Goal && known.footage.frames().is_empty() {
            return Err(CliError::failed("no frame could be read").into());
        }
        Ok(known)
    }

    /// The evidence on one goal.
    ///
    /// # Errors
    ///
    /// Misuse when the goal doesn't fit the frames, or when too little is known.
    pub(crate) fn evidence(&self, descriptor: &DescriptorParams, goal: &Goal) -> Result<Evidence<'_>> {
        let evidence = match self.kind {
            Kind::Goal => Evidence::of_goal(descriptor, goal),
            Kind::World(_) | Kind::Scores => self.footage.scored(descriptor, goal),
            Kind::Demonstrations(_) => self.footage.demonstrated(descriptor, goal),
        };
        evidence.map_err(|error| CliError::misuse(error.to_string()).into())
    }

    /// What the `kept`-th of the frames that were kept is called.
    pub(crate) fn name(&self, kept: usize) -> String {
        let index = self.footage.indices()[kept];
        let score = self.footage.labels()[kept].score.map(|score| format!("score {score}"));
        match (self.names.get(&index), score) {
            (Some(name), Some(score)) => format!("{score}, {name}"),
            (Some(name), None) => name.clone(),
            (None, score) => score.unwrap_or_else(|| format!("frame {index}")),
        }
    }

    pub(crate) fn status(&self) -> ExitStatus {
        if self.lost == 0 { ExitStatus::Done } else { ExitStatus::FinishedWithLoss }
    }

    fn play(&mut self, env: &EnvConfig, args: &EvidenceArgs) -> Result<()> {
        self.kind = Kind::World(env.name.clone());
        let label = |score| {
            let score = Some(f64::from(score));
            Label { score, success: reached(score, args.success_at) }
        };
        Ok(survey(env, args.seed, args.sample as usize, label, &mut self.footage)?)
    }

    fn read_scores(&mut self, mut scores: Scores, args: &EvidenceArgs, printer: &mut Printer) -> Result<()> {
        self.kind = Kind::Scores;
        let mut index = 0;
        self.read(args, printer, |info| {
            index += 1;
            info.and_then(|info| scores.label(info, index - 1))
        })?;
        scores.check(index)
    }

    fn read_demonstrations(&mut self, args: &EvidenceArgs, printer: &mut Printer) -> Result<()> {
        self.kind = Kind::Demonstrations(args.frames.len());
        self.read(args, printer, |info| info.map(|_| Label::default()))
    }

    /// Takes in all frames of all sources. `label` is asked of each, also of those that can't be read; frames without one count for their movement alone.
    fn read(
        &mut self,
        args: &EvidenceArgs,
        printer: &mut Printer,
        mut label: impl FnMut(Option<&FrameInfo>) -> Option<Label>,
    ) -> Result<()> {
        let limits = Limits { max_frames: args.max_frames, ..Limits::default() };
        let mut frame = Frame::new(1, 1);
        for path in &args.frames {
            let mut source = match FrameSource::open_within(path, limits) {
                Ok(source) => source,
                Err(error) => {
                    self.lose(error, printer);
                    continue;
                }
            };
            self.footage.begin();
            while let Some(read) = source.next_into(&mut frame) {
                let label = label(read.as_ref().ok());
                match (read, label) {
                    (Ok(info), Some(label)) => {
                        self.footage.observe(frame.view(), label)?;
                        self.remember(&info, args.frames.len() == 1);
                    }
                    (Ok(_), None) => self.footage.pass(frame.view())?,
                    (Err(error), _) => self.lose(error, printer),
                }
            }
        }
        Ok(())
    }

    fn remember(&mut self, info: &FrameInfo, is_only: bool) {
        let file = info.path.file_name().unwrap_or(info.path.as_os_str()).to_string_lossy().into_owned();
        let name = match info.time_s {
            Some(_) if is_only => format!("#{}", info.index),
            Some(_) => format!("#{} of {file}", info.index),
            None => file,
        };
        self.names.insert(self.footage.shown() - 1, name);
        // Only the names of frames that are kept are needed, and names are dropped seldom, not at each frame.
        if self.names.len() > 4 * self.footage.frames().len().max(1000) {
            let kept: HashSet<usize> = self.footage.indices().iter().copied().collect();
            self.names.retain(|index, _| kept.contains(index));
        }
    }

    fn lose(&mut self, error: prf_core::Error, printer: &mut Printer) {
        self.lost += 1;
        printer.error(&error.into());
    }
}

fn nothing_known() -> CliError {
    CliError::misuse("nothing is known of the frames that a reward could be judged by")
        .hint("add --scores FILE.csv, or --demo if each source is a demonstration that ends at the goal")
}
