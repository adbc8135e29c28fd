//! `prf tune`: which window, cells and norm make a reward good?

use std::num::NonZero;
use std::path::Path;
use std::thread;

use prf_core::{Judgement, Verdict, recommend, settings};

use self::candidates::{Candidate, candidates};
use self::snippet::{Recommendation, write_files};
use super::inspect::draw_best_and_worst;
use crate::ExitStatus;
use crate::args::TuneArgs;
use crate::error::{CliError, Result};
use crate::evidence::{Known, Subject, words};
use crate::plot::{heat, write_svg};
use crate::printer::{Format, Printer};

mod candidates;
mod snippet;
mod tables;

/// Every setting of one window, judged.
struct Judged {
    candidate: Candidate,
    judgements: Vec<Judgement>,
    /// Frames that were judged by.
    frames: usize,
}

pub(crate) fn run(args: &TuneArgs, printer: &mut Printer) -> Result<ExitStatus> {
    let subject = Subject::read(&args.evidence, &args.reward)?;
    let candidates = candidates(&subject, args.screen.as_deref())?;
    let known = Known::gather(&args.evidence, &subject, printer)?;
    let judged = judge(&subject, &known, candidates)?;
    let all = || judged.iter().flat_map(|window| window.judgements.iter().map(move |judgement| (window, judgement)));
    let Some(best) = recommend(all().map(|(_, judgement)| judgement)) else {
        return Err(nothing_good(&judged).into());
    };
    let Some((window, _)) = all().find(|(_, judgement)| std::ptr::eq(*judgement, best)) else {
        return Err(nothing_good(&judged).into());
    };
    let given =
        judged.first().and_then(|window| window.judgements.first()).filter(|first| first.params == subject.params());
    let recommendation = Recommendation { subject: &subject, known: &known, judged: &judged, window, best, given };
    if printer.format() == Format::Json {
        for (window, judgement) in all() {
            let mut record = words::Record::new(&known, window.frames, window.candidate.rect, judgement);
            record.recommended = Some(std::ptr::eq(judgement, best));
            printer.record(&record)?;
        }
    } else {
        printer.bytes(recommendation.toml(None)?.as_bytes())?;
    }
    if best.verdict != Verdict::Good {
        printer.warning(format_args!("even the best of these settings is {}", words::verdict(best)), Some(BETTER));
    }
    if let Some(out) = &args.out {
        write_files(&recommendation, out, args.force, printer)?;
    }
    draw(args, &recommendation, printer)?;
    Ok(known.status())
}

const BETTER: &str = "show another part of the picture (--descriptor window, --screen), or judge by other frames";

/// Judges all settings of all windows. A window in which nothing can be judged is left out, unless it is the given one.
fn judge(subject: &Subject, known: &Known, candidates: Vec<Candidate>) -> Result<Vec<Judged>> {
    let threads = thread::available_parallelism().unwrap_or(NonZero::<usize>::MIN);
    let mut judged = Vec::new();
    for (index, candidate) in candidates.into_iter().enumerate() {
        let evidence = match known.evidence(&subject.descriptor(), &candidate.goal) {
            Ok(evidence) => evidence,
            Err(error) if index == 0 => return Err(error),
            Err(_) => continue,
        };
        let settings = settings(&candidate.goal, subject.params());
        let judgements = evidence.sweep(&settings, threads)?;
        let frames = evidence.len();
        drop(evidence);
        judged.push(Judged { candidate, judgements, frames });
    }
    Ok(judged)
}

fn nothing_good(judged: &[Judged]) -> CliError {
    let judgements = || judged.iter().flat_map(|window| &window.judgements);
    let best = judgements().max_by(|a, b| a.quality.total_cmp(&b.quality));
    let best = best.map_or(String::new(), |best| format!("; the best is {}", words::verdict(best)));
    CliError::failed(format!("none of {} settings makes a reward to learn from{best}", judgements().count()))
        .hint(BETTER)
}

fn draw(args: &TuneArgs, recommendation: &Recommendation<'_>, printer: &mut Printer) -> Result<()> {
    let Recommendation { subject, known, window, best, .. } = recommendation;
    let headline = recommendation.headline();
    if let Some(path) = &args.evidence.picture {
        let evidence = known.evidence(&subject.descriptor(), &window.candidate.goal)?;
        let distances = evidence.distances(best.params)?;
        draw_best_and_worst(path, &headline, known, &evidence, &distances, printer)?;
    }
    if let Some(path) = &args.plot {
        draw_tables(path, recommendation, &headline, printer)?;
    }
    Ok(())
}

fn draw_tables(path: &Path, recommendation: &Recommendation<'_>, headline: &str, printer: &mut Printer) -> Result<()> {
    let subtitle = format!("judged by {}", words::evidence(recommendation.known, recommendation.window.frames));
    write_svg(path, &heat::tables(headline, &subtitle, &recommendation.tables())?)?;
    printer.note(format_args!("drew the tables of all settings into {}", path.display()));
    Ok(())
}
