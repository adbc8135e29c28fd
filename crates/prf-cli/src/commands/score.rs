//! `prf score`: frames against a goal.

use std::path::{Path, PathBuf};

use prf_core::io::{self, FrameInfo, FrameSource, Limits};
use prf_core::{DescriptorKind, Frame, Goal, GoalWarning, Match, Score, TaskDescriptor, check_goal, draw_explanation};
use serde::Serialize;

use self::curves::Curves;
use crate::ExitStatus;
use crate::args::ScoreArgs;
use crate::error::{CliError, Result};
use crate::files::write_whole;
use crate::plot::write_svg;
use crate::printer::{Format, Printer};
use crate::settings::{ReadGoal, RewardSettings, goal_error, read_goal, reward_settings};

mod curves;

pub(crate) fn run(args: &ScoreArgs, printer: &mut Printer) -> Result<ExitStatus> {
    let settings = reward_settings(&args.reward)?;
    let ReadGoal { goal, warning } =
        read_goal(&args.goal, settings.mask.as_deref(), &settings.descriptor).map_err(goal_error)?;
    if let Some(warning) = warning {
        printer.warning(format_args!("{}: {warning}", args.goal.display()), Some(warning.hint()));
    }
    warn_of_goal(&args.goal, &goal, &settings, printer);
    let descriptor = settings
        .descriptor
        .describe(&goal, settings.params)
        .map_err(|error| CliError::misuse(format!("{}: {error}", args.goal.display())))?;
    let mut scoring = Scoring {
        descriptor,
        frame: Frame::new(1, 1),
        scored: None,
        rewards: Vec::new(),
        lost: 0,
        follows_picture: false,
        curves: args.plot.as_ref().map(|_| Curves::default()),
        output: Output::new(&args.frames, printer.format()),
    };
    let limits = Limits { max_frames: args.max_frames, ..Limits::default() };
    for path in &args.frames {
        match FrameSource::open_within(path, limits) {
            Ok(source) => scoring.score(path, source, printer)?,
            Err(error) => scoring.lose(error, printer),
        }
    }
    warn_of_saturation(&scoring.rewards, printer);
    if let Some(path) = &args.explain {
        scoring.explain(path, printer)?;
    }
    if let Some(path) = &args.plot {
        scoring.plot(path, &args.goal, settings.descriptor.kind(), printer)?;
    }
    scoring.status()
}

/// Room for where in a source a frame lies: " #1234 (123.45 s)".
const PLACE: usize = 17;

/// What one call has scored so far.
struct Scoring {
    descriptor: Box<dyn TaskDescriptor>,
    frame: Frame,
    /// What the frame that was scored last is called.
    scored: Option<String>,
    rewards: Vec<f32>,
    /// How many frames or sources could not be scored.
    lost: usize,
    /// Whether the last source was a single picture: such, as of a shell's `*.png`, are one sequence.
    follows_picture: bool,
    /// For a diagram, if one was asked for.
    curves: Option<Curves>,
    output: Output,
}

impl Scoring {
    /// All frames of a source.
    fn score(&mut self, path: &Path, mut source: FrameSource, printer: &mut Printer) -> Result<()> {
        let many = source.len_hint() != Some(1);
        if many || !self.follows_picture {
            self.descriptor.reset();
        }
        self.follows_picture = !many;
        if many && matches!(self.output, Output::Sentence) {
            self.output = Output::Table { width: path.to_string_lossy().chars().count() + PLACE };
        }
        if let Some(curves) = &mut self.curves
            && many
        {
            curves.begin(path);
        }
        let mut next = Frame::new(1, 1);
        while let Some(read) = source.next_into(&mut next) {
            let scored = read.and_then(|info| Ok((info, self.descriptor.observe(next.view())?)));
            match scored {
                Ok((info, score)) => {
                    std::mem::swap(&mut self.frame, &mut next);
                    self.take(&info, many, score, printer)?;
                }
                Err(error) => self.lose(error, printer),
            }
        }
        if let Some(curves) = &mut self.curves {
            curves.end();
        }
        Ok(())
    }

    fn take(&mut self, info: &FrameInfo, many: bool, score: Score, printer: &mut Printer) -> Result<()> {
        let matched = self.descriptor.explain(self.frame.view()).matched;
        let record = Record::new(info, self.rewards.len() + self.lost, score, matched);
        if self.rewards.is_empty() {
            self.output.begin(printer)?;
        }
        self.output.score(&record, many, printer)?;
        self.scored = Some(record.name(many));
        self.rewards.push(score.reward);
        if let Some(curves) = &mut self.curves {
            curves.take(info, score.reward);
        }
        Ok(())
    }

    fn lose(&mut self, error: prf_core::Error, printer: &mut Printer) {
        self.lost += 1;
        if let Some(curves) = &mut self.curves {
            curves.lose();
        }
        printer.error(&error.into());
    }

    fn explain(&self, path: &Path, printer: &mut Printer) -> Result<()> {
        let Some(name) = &self.scored else { return Ok(()) };
        let picture = draw_explanation(&self.descriptor.explain(self.frame.view()), name);
        write_whole(path, &io::picture_png(&picture), true)?;
        printer.note(format_args!("drew what was compared in {name} into {}", path.display()));
        Ok(())
    }

    fn plot(&self, path: &Path, goal: &Path, kind: DescriptorKind, printer: &mut Printer) -> Result<()> {
        let Some(curves) = self.curves.as_ref().filter(|_| !self.rewards.is_empty()) else { return Ok(()) };
        write_svg(path, &curves.svg(goal, kind, self.lost)?)?;
        printer.note(format_args!("drew the rewards of {} into {}", frames(self.rewards.len()), path.display()));
        Ok(())
    }

    fn status(&self) -> Result<ExitStatus> {
        match (self.rewards.len(), self.lost) {
            (0, _) => Err(CliError::failed("no frame could be scored").into()),
            (_, 0) => Ok(ExitStatus::Done),
            _ => Ok(ExitStatus::FinishedWithLoss),
        }
    }
}

/// How scores are written.
enum Output {
    /// One sentence, for a single frame.
    Sentence,
    /// A table whose first column has this many characters.
    Table {
        width: usize,
    },
    Json,
}

/// A line of JSON output; other tools rely on these names.
#[derive(Serialize)]
struct Record {
    source: String,
    /// Place among all frames, from 0; those that could not be read count, too.
    index: usize,
    /// When the frame is shown, for what has times.
    #[serde(skip_serializing_if = "Option::is_none")]
    time_s: Option<f64>,
    reward: f32,
    distance: f32,
    #[serde(skip_serializing_if = "Option::is_none")]
    r#match: Option<Window>,
    #[serde(skip)]
    frame: u64,
}

/// Where the window was found, in pixels of the frame.
#[derive(Serialize)]
struct Window {
    x: usize,
    y: usize,
    width: usize,
    height: usize,
    score: f32,
}

impl From<Match> for Window {
    fn from(Match { rect, score }: Match) -> Self {
        Self { x: rect.x, y: rect.y, width: rect.width, height: rect.height, score }
    }
}

impl Record {
    fn new(info: &FrameInfo, index: usize, Score { reward, distance }: Score, matched: Option<Match>) -> Self {
        Self {
            source: info.path.to_string_lossy().into_owned(),
            index,
            time_s: info.time_s,
            reward,
            distance,
            r#match: matched.map(Into::into),
            frame: info.index,
        }
    }

    /// What people call the frame: its file, and where in it.
    fn name(&self, many: bool) -> String {
        match self.time_s {
            Some(time_s) if many => format!("{} #{} ({time_s:.2} s)", self.source, self.frame),
            _ => self.source.clone(),
        }
    }
}

impl Output {
    fn new(frames: &[PathBuf], format: Format) -> Self {
        match format {
            Format::Json => Self::Json,
            Format::Text if frames.len() == 1 => Self::Sentence,
            Format::Text => Self::table(frames),
        }
    }

    fn table(frames: &[PathBuf]) -> Self {
        let width = |path: &PathBuf| path.to_string_lossy().chars().count();
        let widest = frames.iter().map(width).max().unwrap_or(0);
        Self::Table { width: widest.max("source".len()) }
    }

    fn begin(&self, printer: &mut Printer) -> Result<()> {
        match self {
            Self::Table { width } => {
                printer.line(format_args!("{:width$}  {:>9}  {:>9}", "source", "reward", "distance"))
            }
            Self::Sentence | Self::Json => Ok(()),
        }
    }

    fn score(&self, record: &Record, many: bool, printer: &mut Printer) -> Result<()> {
        let (name, reward, distance) = (record.name(many), short(record.reward), short(record.distance));
        match self {
            Self::Json => printer.record(record),
            Self::Sentence => {
                let window = record.r#match.as_ref().map_or(String::new(), |window| {
                    format!(", best match {:.3} at ({}, {})", window.score, window.x, window.y)
                });
                printer.line(format_args!("{name}: reward {reward}, distance {distance}{window}"))
            }
            Self::Table { width } => printer.line(format_args!("{name:width$}  {reward:>9}  {distance:>9}")),
        }
    }
}

fn frames(count: usize) -> String {
    if count == 1 { "1 frame".to_owned() } else { format!("{count} frames") }
}

/// At most nine characters, with the first digits of even a very small number.
fn short(value: f32) -> String {
    if value != 0.0 && value < 1e-4 { format!("{value:.3e}") } else { format!("{value:.6}") }
}

fn warn_of_goal(path: &Path, goal: &Goal, settings: &RewardSettings, printer: &mut Printer) {
    // A goal that cannot be used at all is an error in a moment.
    for warning in check_goal(goal, settings.descriptor.kind(), settings.params).unwrap_or_default() {
        let words = format!("{}: {warning}", path.display());
        match warning {
            GoalWarning::Black => printer.note(format_args!("{words}: {}", warning.hint())),
            _ => printer.warning(words, Some(warning.hint())),
        }
    }
}

/// Rewards that are all the same, or all next to nothing, teach an agent nothing.
fn warn_of_saturation(rewards: &[f32], printer: &mut Printer) {
    const NEXT_TO_NOTHING: f32 = 1e-6;
    const DIFFERENT: f32 = 1e-6;
    let largest = rewards.iter().copied().fold(f32::NEG_INFINITY, f32::max);
    let least = rewards.iter().copied().fold(f32::INFINITY, f32::min);
    if (0.0..NEXT_TO_NOTHING).contains(&largest) {
        printer.warning(
            format_args!("no reward is above {}: too small to learn from", short(largest)),
            Some("divide the distance, as with --scale sqrt-blocks, or take larger cells"),
        );
    } else if rewards.len() > 1 && largest - least < DIFFERENT {
        printer.warning(
            format_args!("all {} rewards are {}: they tell no frame from another", rewards.len(), short(largest)),
            Some("try other cells or another norm, unless the pictures are the same"),
        );
    }
}
