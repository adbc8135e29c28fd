//! `prf goal motion`: the goal is the motion template of a sequence.

use prf_core::io::{FrameSource, MotionSequence};
use prf_core::{DescriptorKind, Error, MotionParams, SequenceProblem};

use super::{warn_of, write};
use crate::ExitStatus;
use crate::args::{GoalOut, MotionArgs};
use crate::error::{CliError, Result};
use crate::printer::Printer;
use crate::settings::{goal_error, is_picture, motion_params};

pub(super) fn run(args: &MotionArgs, printer: &mut Printer) -> Result<ExitStatus> {
    let params = motion_params(MotionParams::default(), &args.motion)?;
    let source = FrameSource::open(&args.sequence)?;
    if is_picture(&source) {
        let message = format!("{} is a single picture, in which nothing can move", args.sequence.display());
        return Err(CliError::misuse(message).hint("give a folder of pictures, an animation or a video").into());
    }
    let sequence = read(source, params, args.skip_damaged, printer)?;
    let status = status(&sequence);
    make(sequence, &args.out, printer, |printer| printer.line(args.out.out.display()))?;
    Ok(status)
}

/// Makes the template, and names what was left out of it.
pub(super) fn read(
    source: FrameSource,
    params: MotionParams,
    skip_damaged: bool,
    printer: &mut Printer,
) -> Result<MotionSequence> {
    match MotionSequence::of(source, params, skip_damaged) {
        Ok(sequence) => {
            sequence.damaged.iter().for_each(|error| printer.problem(error));
            if !sequence.damaged.is_empty() {
                printer.note(format_args!("made of the {} frames that can be read", sequence.frames));
            }
            Ok(sequence)
        }
        Err(error @ Error::Picture { .. }) => {
            Err(CliError::failed(error.to_string()).hint("--skip-damaged leaves frames out that cannot be read").into())
        }
        Err(error) => {
            if let Error::Sequence { problem: SequenceProblem::TooFewFrames { damaged, .. }, .. } = &error {
                damaged.iter().for_each(|error| printer.problem(error));
            }
            Err(goal_error(error))
        }
    }
}

/// Writes the template, names it by `said`, and says what is suspicious about it.
pub(super) fn make(
    sequence: MotionSequence,
    out: &GoalOut,
    printer: &mut Printer,
    said: impl FnOnce(&mut Printer) -> Result<()>,
) -> Result<()> {
    write(&sequence.template, out)?;
    said(printer)?;
    if let Some(warning) = sequence.warning {
        printer.warning(warning, Some(warning.hint()));
    }
    warn_of(sequence.template, DescriptorKind::Motion, printer);
    Ok(())
}

pub(super) fn status(sequence: &MotionSequence) -> ExitStatus {
    if sequence.damaged.is_empty() { ExitStatus::Done } else { ExitStatus::FinishedWithLoss }
}
