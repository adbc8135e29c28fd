//! `prf runs`: the runs in a folder, how far each has come, and how to go on with it.

use std::path::Path;
use std::time::{SystemTime, UNIX_EPOCH};

use serde::Serialize;

use super::learning::duration;
use crate::ExitStatus;
use crate::args::RunsArgs;
use crate::error::{CliError, Result};
use crate::printer::{Format, Printer};
use crate::runs::find::{Found, run_folders};
use crate::runs::standing::{Standing, State};

/// A line of JSON output; other tools rely on these names.
#[derive(Debug, Serialize)]
struct Record<'a> {
    run: String,
    world: Option<&'a str>,
    seed: Option<u64>,
    state: &'static str,
    steps: u64,
    total_steps: Option<u64>,
    episodes: u64,
    total_episodes: Option<u64>,
    best_score: Option<f64>,
    last_score: Option<f64>,
    /// Seconds since 1970.
    changed_s: Option<u64>,
    /// The command that goes on with it.
    resume: Option<String>,
    /// What is damaged.
    problem: Option<&'a str>,
}

pub(crate) fn run(args: &RunsArgs, printer: &mut Printer) -> Result<ExitStatus> {
    let found = find(&args.folder)?;
    for closed in &found.closed {
        printer.warning(format_args!("cannot look into {}", closed.display()), None);
    }
    let standings: Vec<Standing> = found.folders.iter().map(|path| Standing::of(path)).collect();
    match printer.format() {
        Format::Json => standings.iter().try_for_each(|standing| printer.record(&record(standing)))?,
        Format::Text => print(&standings, &args.folder, printer)?,
    }
    Ok(ExitStatus::Done)
}

fn find(folder: &Path) -> Result<Found> {
    let shown = folder.display();
    let found = run_folders(folder).map_err(|error| {
        CliError::misuse(format!("cannot look for runs in {shown}: {error}")).hint(
            "name the folder that `prf train` was given by --out, or one above it; it is runs/ where it was given none",
        )
    })?;
    if found.folders.is_empty() {
        let message = format!("there is no run in {shown}");
        return Err(CliError::misuse(message)
            .hint("`prf train` begins one, in runs/ unless --out names another folder")
            .into());
    }
    Ok(found)
}

fn record(standing: &Standing) -> Record<'_> {
    let Standing { path, state, config, steps, episodes, best_score, last_score, changed, .. } = standing;
    Record {
        run: path.display().to_string(),
        world: config.as_ref().map(|config| config.env.name.as_str()),
        seed: config.as_ref().map(|config| config.seed),
        state: state_name(state),
        steps: *steps,
        total_steps: config.as_ref().and_then(|config| config.train.steps),
        episodes: *episodes,
        total_episodes: config.as_ref().and_then(|config| config.train.episodes),
        best_score: *best_score,
        last_score: *last_score,
        changed_s: changed.and_then(|time| Some(time.duration_since(UNIX_EPOCH).ok()?.as_secs())),
        resume: standing.resume(),
        problem: match state {
            State::Damaged(problem) => Some(problem),
            _ => None,
        },
    }
}

fn state_name(state: &State) -> &'static str {
    match state {
        State::Finished => "finished",
        State::Running => "running",
        State::Interrupted(_) => "interrupted",
        State::NeverSaved => "never saved",
        State::Damaged(_) => "damaged",
    }
}

/// A table, and below it what can be done about unfinished and damaged runs.
fn print(standings: &[Standing], folder: &Path, printer: &mut Printer) -> Result<()> {
    let heads = ["run", "world", "state", "done", "best", "last", "changed"].map(str::to_owned);
    let rows: Vec<[String; 7]> = [heads].into_iter().chain(standings.iter().map(|run| row(run, folder))).collect();
    let width = |column: usize| rows.iter().map(|row| row[column].chars().count()).max().unwrap_or(0);
    let widths: [usize; 7] = std::array::from_fn(width);
    for row in &rows {
        let [name, world, state, done, best, last, changed] = row;
        let [w0, w1, w2, w3, w4, w5, _] = widths;
        printer.line(format_args!(
            "{name:w0$}  {world:w1$}  {state:w2$}  {done:>w3$}  {best:>w4$}  {last:>w5$}  {changed}"
        ))?;
    }
    for (index, command) in standings.iter().filter_map(Standing::resume).enumerate() {
        if index == 0 {
            printer.line("\nto go on with those that are not finished:")?;
        }
        printer.line(format_args!("  {command}"))?;
    }
    for standing in standings {
        if let State::Damaged(problem) = &standing.state {
            printer.warning(format_args!("{} is damaged: {problem}", standing.path.display()), None);
        }
    }
    Ok(())
}

fn row(standing: &Standing, folder: &Path) -> [String; 7] {
    let Standing { path, state, config, changed, .. } = standing;
    let name = match path.strip_prefix(folder) {
        Ok(name) if !name.as_os_str().is_empty() => name,
        _ => path,
    };
    let score = |score: Option<f64>| score.map_or("–".to_owned(), |score| format!("{score:.2}"));
    [
        name.display().to_string(),
        config.as_ref().map_or("–".to_owned(), |config| config.env.name.clone()),
        state_name(state).to_owned(),
        done(standing),
        score(standing.best_score),
        score(standing.last_score),
        changed.map_or("–".to_owned(), ago),
    ]
}

fn done(standing: &Standing) -> String {
    let length = standing.config.as_ref().map(|config| (config.train.steps, config.train.episodes));
    match length {
        Some((Some(total), _)) => format!("{} of {total} steps", standing.steps),
        Some((None, Some(total))) => format!("{} of {total} episodes", standing.episodes),
        _ => format!("{} steps", standing.steps),
    }
}

fn ago(time: SystemTime) -> String {
    const DAY: u64 = 86_400;
    match time.elapsed().unwrap_or_default().as_secs() {
        seconds if seconds >= 2 * DAY => format!("{} days ago", seconds / DAY),
        seconds => format!("{} ago", duration(seconds as f64)),
    }
}
