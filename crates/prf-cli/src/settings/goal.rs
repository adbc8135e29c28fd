//! Goals in files: a picture, a cut-out with its mask, or a sequence that shows a movement.

use std::path::Path;

use prf_core::io::{self, FrameSource, MotionSequence, SequenceWarning};
use prf_core::{DescriptorParams, Error, Frame, Goal, MotionParams, PictureProblem, SequenceProblem};

use super::Source;
use crate::error::CliError;

pub(super) const GOAL: &str = "reward.goal";
pub(super) const MASK: &str = "reward.window.mask";

/// A goal that was read.
#[derive(Debug)]
pub(crate) struct ReadGoal {
    pub(crate) goal: Goal,
    /// What is suspicious about the sequence that it was made of.
    pub(crate) warning: Option<SequenceWarning>,
}

/// The goal that the files show to this descriptor. For the motion descriptor a sequence of frames (a folder, an
/// animation, a video) becomes its motion template; a file with a single picture is taken for one that was made before.
///
/// # Errors
///
/// As [`FrameSource::open`] and [`MotionSequence::of`].
pub(crate) fn read_goal(path: &Path, mask: Option<&Path>, descriptor: &DescriptorParams) -> Result<ReadGoal, Error> {
    let (picture, warning) = match descriptor {
        DescriptorParams::Motion(motion) => read_motion(path, *motion)?,
        DescriptorParams::Direct | DescriptorParams::Window(_) => (io::read_frame(path)?, None),
    };
    Ok(ReadGoal { goal: Goal { picture, mask: mask.map(io::read_frame).transpose()? }, warning })
}

fn read_motion(path: &Path, params: MotionParams) -> Result<(Frame, Option<SequenceWarning>), Error> {
    let source = FrameSource::open(path)?;
    if is_picture(&source) {
        return Ok((io::read_frame(path)?, None));
    }
    let MotionSequence { template, warning, .. } = MotionSequence::of(source, params, false)?;
    Ok((template, warning))
}

/// Whether it is a file with one picture; a folder with one is a sequence that is too short.
pub(crate) fn is_picture(source: &FrameSource) -> bool {
    source.len_hint() == Some(1) && !source.path().is_dir()
}

/// The error for a goal that was named on the command line: with the options that help.
pub(crate) fn goal_error(error: Error) -> anyhow::Error {
    let Error::Sequence { problem, .. } = &error else { return error.into() };
    match problem {
        SequenceProblem::Forgotten { key, needed, .. } => {
            let option = if *key == "delta.divisor" { "--delta-divisor" } else { "--duration" };
            CliError::misuse(error.to_string()).hint(format!("try {option} {needed}")).into()
        }
        SequenceProblem::Still { largest: largest @ 1.., .. } => {
            CliError::failed(error.to_string()).hint(format!("try --threshold {}", largest - 1)).into()
        }
        _ => error.into(),
    }
}

/// The error for a goal that a config names: with the place in the config.
pub(crate) fn goal_misfit(error: &Error, mask: Option<&Path>, source: &Source) -> CliError {
    let at = |key: &str| format!("{}: `{key}`: {error}", source.locate(key));
    match error {
        Error::Sequence { problem: SequenceProblem::Forgotten { key, .. }, .. } => {
            CliError::misuse(at(&format!("reward.motion.{key}")))
        }
        Error::TemplateTooLarge { .. } => {
            CliError::misuse(at(GOAL)).hint("`prf goal crop` cuts a smaller part out of a picture")
        }
        Error::Picture { path, problem } if !matches!(problem, PictureProblem::NoPictures) => {
            let key = if Some(&**path) == mask { MASK } else { GOAL };
            CliError::failed(at(key)).hint("name a picture of the finished task, such as a PNG")
        }
        _ => CliError::failed(at(GOAL)),
    }
}
