//! `prf tune`: which window, cells and norm make a reward good?

use std::num::NonZero;
use std::path::Path;
use std::thread;

use indicatif::{ProgressBar, ProgressStyle};
use prf_core::{Judgement, Verdict, recommend, settings};

use self::candidates::{Candidate, candidates};
use self::snippet::{Recommendation, write_files};
use super::inspect::draw_best_and_worst;
use crate::ExitStatus;
use crate::args::TuneArgs;
use crate::error::{CliError, Result};
use crate::evidence::{Known, Subject, words};
use crate::files::refuse_existing;
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
    let subject = Subject::read(&args.evidence, &args.reward, printer)?;
    check_out(args)?;
    let candidates = candidates(&subject, args.screen.as_deref())?;
    let known = Known::gather(&args.evidence, &subject, printer)?;
    let judged = judge(&subject, &known, candidates)?;
    let all: Vec<(&Judged, &Judgement)> =
        judged.iter().flat_map(|window| window.judgements.iter().map(move |judgement| (window, judgement))).collect();
    let Some(best_at) = recommend(all.iter().map(|(_, judgement)| *judgement)) else {
        return Err(nothing_good(&all).into());
    };
    let (window, best) = all[best_at];
    let given = all.first().map(|(_, first)| *first).filter(|first| first.params == subject.params());
    let picture = args.screen.as_ref().unwrap_or(&subject.goal_path);
    let out = args.out.as_deref();
    let recommendation =
        Recommendation { subject: &subject, known: &known, judged: &judged, window, best, given, picture, out };
    if printer.format() == Format::Json {
        for (index, (window, judgement)) in all.iter().enumerate() {
            let mut record = words::Record::new(&known, window.frames, window.candidate.rect, judgement);
            record.recommended = Some(index == best_at);
            printer.record(&record)?;
        }
    } else {
        printer.bytes(recommendation.toml()?.as_bytes())?;
    }
    if best.verdict != Verdict::Good {
        printer.warning(format_args!("even the best of these settings is {}", words::verdict(best)), Some(BETTER));
    }
    if let Some(out) = out {
        write_files(&recommendation, out, args.force, printer)?;
    }
    draw(args, &recommendation, printer)?;
    Ok(known.status())
}

/// Refuses to write over anything before any work is done, and over the config itself in any case.
fn check_out(args: &TuneArgs) -> Result<()> {
    let Some(out) = &args.out else { return Ok(()) };
    let same = |a: &Path, b: &Path| matches!((a.canonicalize(), b.canonicalize()), (Ok(a), Ok(b)) if a == b);
    if same(out, &args.evidence.subject) {
        let message = format!("--out: {} would lose all but its [reward]", out.display());
        return Err(CliError::misuse(message).hint("write elsewhere, and put the [reward] into the config").into());
    }
    if args.force { Ok(()) } else { refuse_existing(out) }
}

const BETTER: &str = "show another part of the picture (--descriptor window, --screen), or judge by other frames";

/// Judges all settings of all windows. A window in which nothing can be judged is left out, unless it is the given one.
fn judge(subject: &Subject, known: &Known, candidates: Vec<Candidate>) -> Result<Vec<Judged>> {
    let threads = thread::available_parallelism().unwrap_or(NonZero::<usize>::MIN);
    let style =
        ProgressStyle::with_template("{bar:24} {pos} of {len} windows  {eta} left").expect("the template is a literal");
    // On a terminal only, and gone when it is done.
    let bar = ProgressBar::new(candidates.len() as u64).with_style(style.progress_chars("█▉▊▋▌▍▎▏ "));
    let mut judged = Vec::new();
    for (index, candidate) in candidates.into_iter().enumerate() {
        bar.set_position(index as u64);
        let evidence = match known.evidence(subject, &candidate.goal) {
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
    bar.finish_and_clear();
    Ok(judged)
}

fn nothing_good(all: &[(&Judged, &Judgement)]) -> CliError {
    let best = all.iter().map(|(_, judgement)| judgement).max_by(|a, b| a.quality.total_cmp(&b.quality));
    let best = best.map_or(String::new(), |best| format!("; the best is {}", words::verdict(best)));
    CliError::failed(format!("none of {} settings makes a reward to learn from{best}", all.len())).hint(BETTER)
}

fn draw(args: &TuneArgs, recommendation: &Recommendation<'_>, printer: &mut Printer) -> Result<()> {
    let Recommendation { subject, known, window, best, .. } = recommendation;
    let headline = recommendation.headline();
    if let Some(path) = &args.evidence.picture {
        let evidence = known.evidence(subject, &window.candidate.goal)?;
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
