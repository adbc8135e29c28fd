//! `prf plot`: the learning curves of runs.

use std::path::{Path, PathBuf};

use serde::Serialize;

use crate::ExitStatus;
use crate::args::PlotArgs;
use crate::error::{CliError, Result};
use crate::files::write_whole;
use crate::plot::curve::Shape;
use crate::plot::{png, write_svg};
use crate::printer::{Format, Printer};
use crate::runs::curves::{LearningCurve, Question};
use crate::runs::diagram::{Picture, players};
use crate::runs::group::groups;
use crate::runs::players::Players;
use crate::runs::read_all;

/// Where the picture goes unless it is said.
const OUT: &str = "curves.svg";

/// A line of JSON output; other tools rely on these names.
#[derive(Debug, Serialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
enum Record<'a> {
    /// A point of a curve; `low` and `high` bound its 95 % interval, which a single seed has not.
    Point { curve: &'a str, seeds: usize, x: f64, y: f64, low: Option<f64>, high: Option<f64> },
    /// A player to compare with.
    Player { player: &'static str, score: f64, episodes: usize },
}

pub(crate) fn run(args: &PlotArgs, printer: &mut Printer) -> Result<ExitStatus> {
    let (runs, is_damaged) = read_all(&args.runs, printer)?;
    let groups = groups(runs, printer);
    let question = Question { y: args.y, x: args.x, aggregate: args.aggregate };
    let curves = question.curves(&groups, printer);
    if curves.is_empty() {
        let message = format!("there is no {} to draw", args.y.name());
        return Err(CliError::failed(message).hint("`prf runs` says how far runs have come").into());
    }
    let players = players(&groups, args.y)?;
    if args.y.is_score() && players.is_none() {
        printer.note("the runs' worlds differ in their settings, so no player is drawn to compare with");
    }
    let world = &groups[0].runs[0].config.env.name;
    let picture = Picture { question, world, curves: &curves, players };
    match printer.format() {
        Format::Json => records(&curves, players).try_for_each(|record| printer.record(&record))?,
        Format::Text => print(&question, &curves, players, printer)?,
    }
    if let Some(path) = out(args) {
        write(&path, &picture.svg(Shape::Titled)?)?;
        printer.note(format_args!("drew {} into {}", curves_in_words(curves.len()), path.display()));
    }
    Ok(if is_damaged { ExitStatus::FinishedWithLoss } else { ExitStatus::Done })
}

/// Where the picture is to go, if there is to be one.
fn out(args: &PlotArgs) -> Option<PathBuf> {
    let default = (args.format == Format::Text).then(|| PathBuf::from(OUT));
    args.out.clone().or(default)
}

fn write(path: &Path, svg: &str) -> Result<()> {
    if path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("png")) {
        write_whole(path, &png(svg)?, true)
    } else {
        write_svg(path, svg)
    }
}

fn records(curves: &[LearningCurve], players: Option<Players>) -> impl Iterator<Item = Record<'_>> {
    let points = curves.iter().flat_map(|curve| {
        curve.points.iter().map(|point| Record::Point {
            curve: &curve.name,
            seeds: curve.seeds,
            x: point.x,
            y: point.y,
            low: point.interval.map(|[low, _]| low),
            high: point.interval.map(|[_, high]| high),
        })
    });
    let players =
        players.map(|found| [("oracle", found.oracle, found.episodes[0]), ("random", found.random, found.episodes[1])]);
    let player = |(player, score, episodes)| Record::Player { player, score, episodes };
    points.chain(players.into_iter().flatten().map(player))
}

/// Where each curve ends.
fn print(question: &Question, curves: &[LearningCurve], players: Option<Players>, printer: &mut Printer) -> Result<()> {
    printer.line(format_args!(
        "{} at the end, {} over seeds [95% interval]",
        question.y.name(),
        question.aggregate.name()
    ))?;
    let width = curves.iter().map(|curve| curve.name.chars().count()).max().unwrap_or(0).max("oracle".len());
    for curve in curves {
        let Some(last) = curve.points.last() else { continue };
        let interval = last.interval.map_or(String::new(), |[low, high]| format!(" [{low:.3}, {high:.3}]"));
        let (name, seeds, end) = (&curve.name, curve.seeds_in_words(), question.x.shown(last.x));
        printer.line(format_args!("  {name:width$}  {:.3}{interval}  {seeds}, {end}", last.y))?;
    }
    if let Some(Players { oracle, random, episodes: [_, episodes] }) = players {
        printer.line(format_args!("  {:width$}  {oracle:.3}  in the same episodes", "oracle"))?;
        printer.line(format_args!("  {:width$}  {random:.3}  in {episodes} episodes", "random"))?;
    }
    Ok(())
}

fn curves_in_words(count: usize) -> String {
    if count == 1 { "1 curve".to_owned() } else { format!("{count} curves") }
}
