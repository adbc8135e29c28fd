//! `prf inspect`: is this reward any good?

use std::path::Path;

use prf_core::{Evidence, Judgement, Ranked, draw_ranking, io};

use crate::ExitStatus;
use crate::args::InspectArgs;
use crate::error::{CliError, Result};
use crate::evidence::{Known, Subject, words};
use crate::files::write_whole;
use crate::plot::write_svg;
use crate::printer::{Format, Printer};

mod diagram;

pub(crate) fn run(args: &InspectArgs, printer: &mut Printer) -> Result<ExitStatus> {
    let subject = Subject::read(&args.evidence, &args.reward, printer)?;
    let known = Known::gather(&args.evidence, &subject, printer)?;
    let evidence = known.evidence(&subject, &subject.goal)?;
    let params = subject.params();
    let misfit = |error: prf_core::Error| CliError::misuse(format!("{}: {error}", subject.goal_path.display()));
    let judgement = evidence.judge(params).map_err(misfit)?;
    report(&subject, &known, &evidence, &judgement, printer)?;
    if args.evidence.picture.is_none() && args.plot.is_none() {
        return Ok(known.status());
    }
    let headline = headline(&subject, &judgement);
    let distances = evidence.distances(params)?;
    if let Some(path) = &args.evidence.picture {
        draw_best_and_worst(path, &headline, &known, &evidence, &distances, printer)?;
    }
    if let Some(path) = &args.plot {
        write_svg(path, &diagram::svg(&headline, &known, &evidence, &judgement, &distances)?)?;
        printer.note(format_args!("drew the rewards into {}", path.display()));
    }
    Ok(known.status())
}

pub(super) fn headline(subject: &Subject, judgement: &Judgement) -> String {
    let descriptor = format!("{:?}", subject.descriptor().kind()).to_lowercase();
    let settings = words::settings(&judgement.params, judgement.cell_px);
    format!("{}: {descriptor}, {settings}", subject.goal_path.display())
}

fn report(
    subject: &Subject,
    known: &Known,
    evidence: &Evidence<'_>,
    judgement: &Judgement,
    printer: &mut Printer,
) -> Result<()> {
    if printer.format() == Format::Json {
        return printer.record(&words::Record::new(known, evidence.len(), None, judgement));
    }
    printer.line(headline(subject, judgement))?;
    printer.line(format_args!("judged by {}\n", words::evidence(known, evidence.len())))?;
    for line in words::figures(judgement) {
        printer.line(format_args!("  {line}"))?;
    }
    printer.line(format_args!("  rewards: {}\n", words::rewards(judgement.rewards)))?;
    printer.line(words::verdict(judgement))
}

/// How many frames stand side by side.
const COLUMNS: usize = 5;

/// Draws the frames of the highest and of the lowest rewards.
pub(super) fn draw_best_and_worst(
    path: &Path,
    headline: &str,
    known: &Known,
    evidence: &Evidence<'_>,
    distances: &[f32],
    printer: &mut Printer,
) -> Result<()> {
    let mut order: Vec<usize> = (0..distances.len()).collect();
    order.sort_by(|&a, &b| distances[a].total_cmp(&distances[b]));
    let frames = Frames { known, altered: evidence.alterations().collect() };
    let best = different(order.iter().copied(), &frames, distances);
    let worst = different(order.iter().rev().copied(), &frames, distances);
    let picture = draw_ranking(headline, &best, &worst);
    write_whole(path, &io::picture_png(&picture), true)?;
    printer.note(format_args!("drew the best and the worst frames into {}", path.display()));
    Ok(())
}

/// The frames that were judged.
struct Frames<'a> {
    known: &'a Known,
    /// Altered goals, if these were what was judged.
    altered: Vec<prf_core::Altered<'a>>,
}

impl<'a> Frames<'a> {
    fn get(&self, index: usize) -> (&'a prf_core::Frame, String) {
        match self.altered.get(index) {
            Some(altered) => (altered.frame, words::altered(altered)),
            None => (&self.known.footage.frames()[index], self.known.name(index)),
        }
    }
}

/// The first frames of which no two look the same.
fn different<'a>(order: impl Iterator<Item = usize>, frames: &Frames<'a>, distances: &[f32]) -> Vec<Ranked<'a>> {
    let mut shown: Vec<Ranked<'a>> = Vec::new();
    for index in order {
        let (frame, name) = frames.get(index);
        if shown.iter().all(|ranked| ranked.frame != frame.view()) {
            shown.push(Ranked { frame: frame.view(), reward: (-distances[index]).exp(), name });
        }
        if shown.len() == COLUMNS {
            break;
        }
    }
    shown
}
