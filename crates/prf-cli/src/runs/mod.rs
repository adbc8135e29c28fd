//! Runs that were trained before: read back, found under folders, put into groups, and drawn as curves.

use std::path::Path;

use prf_dqn::config::RunConfig;
use prf_dqn::record::Metrics;
use prf_dqn::run_dir::RunDir;

use crate::error::{CliError, Result};
use crate::printer::Printer;
use crate::settings::{load, misfit};

pub(crate) mod curves;
pub(crate) mod diagram;
pub(crate) mod find;
pub(crate) mod group;
pub(crate) mod players;
pub(crate) mod standing;
pub(crate) mod statistics;

/// A run's config and records.
#[derive(Clone, Debug)]
pub(crate) struct Run {
    pub(crate) dir: RunDir,
    /// As its file has it: paths start at the run's folder.
    pub(crate) config: RunConfig,
    pub(crate) metrics: Metrics,
}

impl Run {
    /// Reads the run in the folder `path`.
    ///
    /// # Errors
    ///
    /// Misuse if there is no run, or if its config is damaged; failure if its records can't be read.
    pub(crate) fn read(path: &Path) -> Result<Run> {
        let dir = RunDir::at(path);
        if !dir.config_path().is_file() {
            return Err(no_run(path).into());
        }
        let config = read_config(&dir)?;
        let metrics =
            if dir.metrics_path().exists() { Metrics::read(&dir.metrics_path())? } else { Metrics::default() };
        Ok(Run { dir, config, metrics })
    }

    /// The folder's own name.
    pub(crate) fn name(&self) -> String {
        name_of(self.dir.path())
    }

    pub(crate) fn shown(&self) -> String {
        self.dir.path().display().to_string()
    }
}

/// A folder's own name, also of `.`.
pub(crate) fn name_of(path: &Path) -> String {
    let absolute = std::path::absolute(path).unwrap_or_default();
    let name = path.file_name().or_else(|| absolute.file_name());
    name.map_or_else(|| path.display().to_string(), |name| name.to_string_lossy().into_owned())
}

/// The config of a run, checked.
pub(crate) fn read_config(dir: &RunDir) -> Result<RunConfig> {
    let (config, source) = load::<RunConfig>(&dir.config_path(), &[])?;
    config.validate().map_err(|error| misfit(&source, error))?;
    Ok(config)
}

fn no_run(path: &Path) -> CliError {
    let shown = path.display();
    if !path.exists() {
        return CliError::misuse(format!("there is no folder {shown}")).hint("`prf runs` lists the runs in a folder");
    }
    let below = find::run_folders(path).unwrap_or_default();
    match below.folders.as_slice() {
        [] => CliError::misuse(format!("{shown} is no run: it has no config.toml"))
            .hint("name the folder that `prf train` printed; `prf runs` lists the runs in a folder"),
        [first, ..] => CliError::misuse(format!("{shown} is no run, but has {} in it", below.folders.len()))
            .hint(format!("name the runs themselves, such as {}", first.display())),
    }
}

/// Reads several runs, each once, and tells of records that are damaged. Also says whether there were any.
///
/// # Errors
///
/// As [`Run::read`], of the first that can't be read; misuse if their worlds differ.
pub(crate) fn read_all(paths: &[std::path::PathBuf], printer: &mut Printer) -> Result<(Vec<Run>, bool)> {
    let mut places = Vec::new();
    let (mut runs, mut is_damaged) = (Vec::<Run>::new(), false);
    for path in paths {
        let place = std::fs::canonicalize(path).unwrap_or_else(|_| path.clone());
        if places.contains(&place) {
            continue;
        }
        places.push(place);
        let run = Run::read(path)?;
        is_damaged |= warn_of_damage(&run, printer);
        runs.push(run);
    }
    if let [first, rest @ ..] = runs.as_slice()
        && let Some(other) = rest.iter().find(|run| run.config.env.name != first.config.env.name)
    {
        let of = |run: &Run| format!("{} of {}", run.config.env.name, run.shown());
        let message = format!("runs of one world were expected, got {} and {}", of(first), of(other));
        return Err(CliError::misuse(message)
            .hint("scores of different worlds don't compare: take each world by itself")
            .into());
    }
    Ok((runs, is_damaged))
}

/// Tells of records that can't be read, and whether there are any.
pub(crate) fn warn_of_damage(run: &Run, printer: &mut Printer) -> bool {
    let lines = &run.metrics.damaged_lines;
    let Some(first) = lines.first() else { return false };
    let path = run.dir.metrics_path();
    let words = match lines.len() {
        1 => format!("line {first} of {} is no record and is left out", path.display()),
        count => {
            format!("{count} lines of {}, the first of them {first}, are no records and are left out", path.display())
        }
    };
    printer.warning(words, None);
    true
}

#[cfg(test)]
pub(crate) mod fixture {
    //! Runs made of numbers, for the tests of this module.

    use prf_dqn::record::EvaluationRecord;

    use super::*;

    pub(crate) const CONFIG: &str =
        "seed = 1\n[env]\nname = \"breakout\"\n[reward]\nsource = \"variable\"\n[train]\nsteps = 1000\n";

    /// A run in a folder of this name, with greedy scores at steps.
    pub(crate) fn run(folder: &str, config: &str, scores: &[(u64, f64)]) -> Run {
        let evaluation = |&(step, score): &(u64, f64)| EvaluationRecord {
            step,
            episode: step / 10,
            episodes: 4,
            mean_score: score,
            std_score: 1.0,
            mean_reward: 2.0 * score,
            mean_steps: 10.0,
            time_s: step as f64 / 100.0,
        };
        let evaluations = scores.iter().map(evaluation).collect();
        Run {
            dir: RunDir::at(Path::new(folder)),
            config: toml::from_str(config).expect("it is a config"),
            metrics: Metrics { evaluations, ..Metrics::default() },
        }
    }
}
