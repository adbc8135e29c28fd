//! `prf goal ck-plus`: the goal is the motion template of a face out of CK+.

use std::path::Path;

use prf_core::io::FrameSource;
use prf_core::io::ck_plus::{Emotion, Selection, Sequence, list};
use prf_core::{DeltaSchedule, MotionParams};
use serde::Serialize;

use super::sequence;
use crate::ExitStatus;
use crate::args::CkPlusArgs;
use crate::error::{CliError, Result};
use crate::printer::{Format, Printer};
use crate::settings::motion_params;

/// More than so many sequences are not all named in an error.
const SHOWN: usize = 20;

pub(super) fn run(args: &CkPlusArgs, printer: &mut Printer) -> Result<ExitStatus> {
    let params = motion_params(human(), &args.motion)?;
    let CkPlusArgs { emotion, subject, session, .. } = args;
    let selection = Selection { subject: subject.clone(), session: session.clone(), emotion: *emotion };
    let sequences = list(&args.root, &selection)?;
    if sequences.is_empty() {
        return Err(none_fits(&args.root, &selection)?.into());
    }
    if args.list {
        print(&sequences, printer)?;
        return Ok(ExitStatus::Done);
    }
    let [one] = &sequences[..] else { return Err(many_fit(&args.root, &sequences).into()) };
    let motion = sequence::read(FrameSource::open(&one.folder)?, params, args.skip_damaged, printer)?;
    let (status, goal) = (sequence::status(&motion), args.out.out.to_string_lossy());
    let made = Made {
        goal: &goal,
        sequence: Record::from(one),
        movements: motion.movements,
        remembered: motion.remembered,
        damaged: motion.damaged.len(),
    };
    sequence::make(motion, &args.out, printer, |printer| match printer.format() {
        Format::Json => printer.record(&made),
        Format::Text => printer.line(&goal),
    })?;
    Ok(status)
}

/// The paper's schedule for a human's goal.
fn human() -> MotionParams {
    MotionParams { tau_step: 0.3, delta: DeltaSchedule::Divisor(4.0), ..MotionParams::default() }
}

/// A line of JSON output; other tools rely on these names.
#[derive(Serialize)]
struct Record<'a> {
    subject: &'a str,
    session: &'a str,
    /// Null without a label.
    emotion: Option<&'static str>,
    /// Pictures in the folder, whether they can be read or not.
    frames: u64,
    folder: String,
}

impl<'a> From<&'a Sequence> for Record<'a> {
    fn from(sequence: &'a Sequence) -> Self {
        let Sequence { subject, session, folder, frames, emotion } = sequence;
        let (emotion, folder) = (emotion.map(Emotion::name), folder.to_string_lossy().into_owned());
        Self { subject, session, emotion, frames: *frames, folder }
    }
}

/// The JSON output of a goal that was made.
#[derive(Serialize)]
struct Made<'a> {
    goal: &'a str,
    #[serde(flatten)]
    sequence: Record<'a>,
    /// In how many frames something moved, and how many of these movements the template shows.
    movements: u64,
    remembered: u64,
    /// Pictures that were left out.
    damaged: usize,
}

fn print(sequences: &[Sequence], printer: &mut Printer) -> Result<()> {
    if printer.format() == Format::Json {
        return sequences.iter().try_for_each(|sequence| printer.record(&Record::from(sequence)));
    }
    printer.line("subject  session  emotion   frames  folder")?;
    sequences.iter().try_for_each(|sequence| {
        let emotion = sequence.emotion.map_or("-", Emotion::name);
        let Sequence { subject, session, frames, folder, .. } = sequence;
        printer.line(format_args!("{subject:7}  {session:7}  {emotion:8}  {frames:>6}  {}", folder.display()))
    })
}

fn many_fit(root: &Path, sequences: &[Sequence]) -> CliError {
    let mut message = format!("{} sequences of {} fit, expected one", sequences.len(), root.display());
    for Sequence { subject, session, frames, emotion, .. } in sequences.iter().take(SHOWN) {
        let emotion = emotion.map_or("no label", Emotion::name);
        message.push_str(&format!("\n  {subject} {session}  {emotion}, {frames} frames"));
    }
    if sequences.len() > SHOWN {
        message.push_str(&format!("\n  and {} more, which --list prints", sequences.len() - SHOWN));
    }
    CliError::misuse(message).hint("narrow them with --emotion, --subject and --session to a single one")
}

fn none_fits(root: &Path, selection: &Selection) -> Result<CliError> {
    let Selection { subject, session, emotion } = selection;
    let given = [
        emotion.map(|emotion| format!("--emotion {emotion}")),
        subject.as_ref().map(|subject| format!("--subject {subject}")),
        session.as_ref().map(|session| format!("--session {session}")),
    ];
    let given: Vec<String> = given.into_iter().flatten().collect();
    let error = CliError::misuse(format!("no sequence of {} fits {}", root.display(), given.join(" ")));
    let others = list(root, &Selection { emotion: None, ..selection.clone() })?;
    let unlabelled = !others.is_empty() && others.iter().all(|sequence| sequence.emotion.is_none());
    Ok(error.hint(if unlabelled {
        "what would fit has no label; does the folder Emotion lie beside cohn-kanade-images?"
    } else {
        "--list without them prints what there is"
    }))
}
