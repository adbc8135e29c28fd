//! What a reward is judged by: frames with scores, demonstrations, a world, or the goal alone.

mod scores;
mod subject;
pub(crate) mod words;

use std::collections::{BTreeMap, HashSet};
use std::path::Path;

use prf_core::io::{FrameInfo, FrameSource, Limits};
use prf_core::{DescriptorParams, Error as CoreError, Evidence, Footage, Frame, Goal, Label};
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
        let limit = if world.is_some() { 2 * args.sample + 200 } else { args.sample };
        let footage = Footage::new(motion, limit as usize)?;
        let window = matches!(subject.descriptor(), DescriptorParams::Window(_)).then_some(&subject.goal.picture);
        let mut known = Known { kind: Kind::Goal, footage, names: BTreeMap::new(), lost: 0 };
        if let Some(path) = &args.scores {
            known.read_scores(Scores::read(path, args.success_at)?, (args, window), printer)?;
        } else if args.demo {
            known.read_demonstrations((args, window), printer)?;
        } else if let Some(env) = world {
            known.play(env, args)?;
        } else if !args.frames.is_empty() {
            return Err(nothing_known().into());
        }
        if known.kind != Kind::Goal && known.footage.frames().is_empty() {
            return Err(CliError::failed("no frame could be read").into());
        }
        known.note_success(args, printer);
        Ok(known)
    }

    /// Says why there is no figure of success where one was asked for.
    fn note_success(&self, args: &EvidenceArgs, printer: &mut Printer) {
        let labels = self.footage.labels();
        let has = |success| labels.iter().any(|label| label.success == Some(success));
        let highest = labels.iter().filter_map(|label| label.score).max_by(f64::total_cmp);
        if let Some(border) = args.success_at
            && !(has(true) && has(false))
        {
            let highest =
                highest.map_or("there are no scores".to_owned(), |score| format!("the highest score is {score}"));
            printer.note(format_args!("--success-at {border} tells no frames apart: {highest}"));
        }
    }

    /// The evidence on one goal of the subject.
    ///
    /// # Errors
    ///
    /// Misuse when the goal doesn't fit the frames, or when too little is known.
    pub(crate) fn evidence(&self, subject: &Subject, goal: &Goal) -> Result<Evidence<'_>> {
        let descriptor = &subject.descriptor();
        let evidence = match self.kind {
            Kind::Goal => Evidence::of_goal(descriptor, goal),
            Kind::World(_) | Kind::Scores => self.footage.scored(descriptor, goal),
            Kind::Demonstrations(_) => self.footage.demonstrated(descriptor, goal),
        };
        evidence.map_err(|error| match error {
            CoreError::TemplateTooLarge { .. } => CliError::misuse(format!("{}: {error}", subject.place)).into(),
            error => CliError::misuse(error.to_string()).into(),
        })
    }

    /// What the `kept`-th of the frames that were kept is called.
    pub(crate) fn name(&self, kept: usize) -> String {
        let index = self.footage.indices()[kept];
        let score = self.footage.labels()[kept].score.map(|score| format!("score {}", short(score)));
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
        let label = |label: Label| Label { success: reached(label.score, args.success_at).or(label.success), ..label };
        Ok(survey(env, args.seed, args.sample as usize, label, &mut self.footage)?)
    }

    fn read_scores(&mut self, mut scores: Scores, frames: Frames<'_>, printer: &mut Printer) -> Result<()> {
        self.kind = Kind::Scores;
        let mut index = 0;
        self.read(frames, printer, |seen| {
            let label = match seen {
                Seen::Frame { info, is_picture } => scores.label(info, is_picture, index)?,
                Seen::Lost => None,
                Seen::LostRest => {
                    scores.lose_count();
                    None
                }
            };
            index += 1;
            Ok(label)
        })?;
        // With frames lost, the table may well have been made for all of them.
        if self.lost == 0 { scores.check(index) } else { Ok(()) }
    }

    fn read_demonstrations(&mut self, frames: Frames<'_>, printer: &mut Printer) -> Result<()> {
        self.read(frames, printer, |_| Ok(Some(Label::default())))?;
        let (starts, kept) = (self.footage.starts(), self.footage.frames().len());
        let ends = starts.iter().skip(1).copied().chain([kept]);
        self.kind = Kind::Demonstrations(starts.iter().zip(ends).filter(|&(&start, end)| end > start).count());
        Ok(())
    }

    /// Takes in all frames of all sources. `label` is asked of each; frames without one count for their movement alone.
    fn read(
        &mut self,
        (args, window): Frames<'_>,
        printer: &mut Printer,
        mut label: impl FnMut(Seen<'_>) -> Result<Option<Label>>,
    ) -> Result<()> {
        let limits = Limits { max_frames: args.max_frames, ..Limits::default() };
        let mut frame = Frame::new(1, 1);
        let mut follows_picture = false;
        for path in &args.frames {
            let mut source = match FrameSource::open_within(path, limits) {
                Ok(source) => source,
                Err(error) => {
                    label(if is_named_like_picture(path) { Seen::Lost } else { Seen::LostRest })?;
                    self.lose(&error.into(), printer);
                    continue;
                }
            };
            // Single pictures, such as a shell's `*.png`, are one sequence.
            let (is_single, is_picture) = (source.len_hint() == Some(1), source.len_hint().is_some());
            if !(is_single && follows_picture) {
                self.footage.begin();
            }
            follows_picture = is_single;
            while let Some(read) = source.next_into(&mut frame) {
                match read {
                    Ok(info) => {
                        let label = label(Seen::Frame { info: &info, is_picture })?;
                        let name = frame_name(&info, args.frames.len() == 1);
                        if let Err(error) = self.take(&frame, label, window, name) {
                            self.lose(&anyhow::anyhow!("{}: {error}", info.path.display()), printer);
                        }
                    }
                    Err(error) => {
                        label(if path.is_dir() { Seen::Lost } else { Seen::LostRest })?;
                        self.lose(&error.into(), printer);
                    }
                }
            }
        }
        Ok(())
    }

    fn take(
        &mut self,
        frame: &Frame,
        label: Option<Label>,
        window: Option<&Frame>,
        name: String,
    ) -> std::result::Result<(), CoreError> {
        let shape = |frame: &Frame| [frame.height(), frame.width()];
        if let Some(goal) = window
            && (0..2).any(|side| shape(goal)[side] > shape(frame)[side])
        {
            return Err(CoreError::TemplateTooLarge { template: shape(goal), frame: shape(frame) });
        }
        let Some(label) = label else { return self.footage.pass(frame.view()) };
        self.footage.observe(frame.view(), label)?;
        self.remember(name);
        Ok(())
    }

    fn remember(&mut self, name: String) {
        self.names.insert(self.footage.shown() - 1, name);
        // Only the names of frames that are kept are needed, and names are dropped seldom, not at each frame.
        if self.names.len() > 4 * self.footage.frames().len().max(1000) {
            let kept: HashSet<usize> = self.footage.indices().iter().copied().collect();
            self.names.retain(|index, _| kept.contains(index));
        }
    }

    fn lose(&mut self, error: &anyhow::Error, printer: &mut Printer) {
        self.lost += 1;
        printer.error(error);
    }
}

/// What to read, and the goal that has to fit into each frame, if it is a window.
type Frames<'a> = (&'a EvidenceArgs, Option<&'a Frame>);

/// What comes next in the frames' order.
#[derive(Clone, Copy)]
enum Seen<'a> {
    Frame {
        info: &'a FrameInfo,
        /// In a file of its own.
        is_picture: bool,
    },
    /// One that can't be read.
    Lost,
    /// Nobody knows how many that can't be read.
    LostRest,
}

/// A score in a few digits.
fn short(score: f64) -> String {
    let score = score + 0.0; // a zero without a sign
    if score.fract() == 0.0 { format!("{score:.0}") } else { format!("{score:.2}") }
}

/// Whether a path that can't be opened was meant to be one frame.
fn is_named_like_picture(path: &Path) -> bool {
    let ending = path.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
    ["png", "jpg", "jpeg", "bmp", "webp"].contains(&ending.as_str())
}

fn frame_name(info: &FrameInfo, is_only: bool) -> String {
    let file = info.path.file_name().unwrap_or(info.path.as_os_str()).to_string_lossy().into_owned();
    match info.time_s {
        Some(_) if is_only => format!("#{}", info.index),
        Some(_) => format!("#{} of {file}", info.index),
        None => file,
    }
}

fn nothing_known() -> CliError {
    CliError::misuse("nothing is known of the frames that a reward could be judged by")
        .hint("add --scores FILE.csv, or --demo if each source is a demonstration that ends at the goal")
}
