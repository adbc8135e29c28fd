//! `prf score`: pictures against a picture of the goal.

use std::path::{Path, PathBuf};

use prf_core::{DirectDescriptor, Frame, Score, TaskDescriptor, io};
use serde::Serialize;

use crate::ExitStatus;
use crate::args::{Descriptor, ScoreArgs};
use crate::error::{CliError, Result};
use crate::printer::{Format, Printer};
use crate::settings::reward_params;

pub(crate) fn run(args: &ScoreArgs, printer: &mut Printer) -> Result<ExitStatus> {
    let params = reward_params(&args.reward)?;
    let goal = io::read_frame(&args.goal)?;
    warn_of_flat_goal(&args.goal, &goal, printer);
    let mut descriptor = match args.descriptor {
        Descriptor::Direct => DirectDescriptor::new(&goal, params),
    }
    .map_err(|error| CliError::misuse(format!("{}: {error}", args.goal.display())))?;
    let output = Output::new(&args.frames, printer.format());
    output.begin(printer)?;
    let mut rewards = Vec::with_capacity(args.frames.len());
    for (index, path) in args.frames.iter().enumerate() {
        match io::read_frame(path) {
            Ok(frame) => {
                let score = descriptor.observe(frame.view());
                output.score(path, index, score, printer)?;
                rewards.push(score.reward);
            }
            Err(error) => printer.error(&error.into()),
        }
    }
    warn_of_saturation(&rewards, printer);
    status(rewards.len(), args.frames.len())
}

fn status(scored: usize, asked: usize) -> Result<ExitStatus> {
    match scored {
        0 => Err(CliError::failed("no frame could be scored").into()),
        _ if scored < asked => Ok(ExitStatus::FinishedWithLoss),
        _ => Ok(ExitStatus::Done),
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
struct Record<'a> {
    source: &'a str,
    /// Place among the frames of the command line, from 0.
    index: usize,
    reward: f32,
    distance: f32,
}

impl Output {
    fn new(frames: &[PathBuf], format: Format) -> Self {
        match format {
            Format::Json => Self::Json,
            Format::Text if frames.len() == 1 => Self::Sentence,
            Format::Text => {
                let width = |path: &PathBuf| path.to_string_lossy().chars().count();
                let widest = frames.iter().map(width).max().unwrap_or(0);
                Self::Table { width: widest.max("source".len()) }
            }
        }
    }

    fn begin(&self, printer: &mut Printer) -> Result<()> {
        match self {
            Self::Table { width } => {
                printer.line(format_args!("{:width$}  {:>9}  {:>9}", "source", "reward", "distance"))
            }
            Self::Sentence | Self::Json => Ok(()),
        }
    }

    fn score(&self, path: &Path, index: usize, score: Score, printer: &mut Printer) -> Result<()> {
        let source = path.to_string_lossy();
        let Score { reward, distance } = score;
        match self {
            Self::Json => printer.record(&Record { source: &source, index, reward, distance }),
            Self::Sentence => {
                printer.line(format_args!("{source}: reward {}, distance {}", short(reward), short(distance)))
            }
            Self::Table { width } => {
                printer.line(format_args!("{source:width$}  {:>9}  {:>9}", short(reward), short(distance)))
            }
        }
    }
}

/// At most nine characters, with the first digits of even a very small number.
fn short(value: f32) -> String {
    if value != 0.0 && value < 1e-4 { format!("{value:.3e}") } else { format!("{value:.6}") }
}

/// A goal without edges looks to HOG like a black picture, which few people mean by it.
fn warn_of_flat_goal(path: &Path, goal: &Frame, printer: &mut Printer) {
    let pixels = goal.as_slice();
    let first = pixels[0];
    if pixels.iter().any(|&pixel| pixel != first) {
        return;
    }
    let path = path.display();
    if first == 0 {
        printer.note(format_args!("{path} is all black: the emptier a frame, the higher its reward"));
    } else {
        printer.warning(
            format_args!("{path} is one even grey: it has no edges that a frame could share"),
            Some("show the finished task itself, or an all black picture to reward emptiness"),
        );
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
