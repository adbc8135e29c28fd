//! The config of a training run, with its goal picture.

use std::path::{Path, PathBuf};

use prf_core::Frame;
use prf_dqn::config::RunConfig;

use super::{Source, load, misfit};
use crate::error::{CliError, Result};

/// Builds the task once, so that what does not fit together is known before anything is written.
fn check_task(config: &RunConfig, goal: Option<&Frame>, source: &Source) -> Result<()> {
    let error = match prf_envs::Task::new(&config.task(), goal).map_err(prf_dqn::Error::from) {
        Ok(task) => match prf_dqn::trainer::check(config, &task) {
            Ok(()) => return Ok(()),
            Err(error) => error,
        },
        Err(error) => error,
    };
    match error {
        prf_dqn::Error::Config(error) | prf_dqn::Error::Task(prf_envs::Error::Core(error)) => match error {
            prf_core::Error::InvalidParam { .. } => Err(misfit(source, error)),
            error => Err(CliError::misuse(format!("{}: `{HOG}`: {error}", source.locate(HOG))).into()),
        },
        other => Err(other.into()),
    }
}

const HOG: &str = "reward.hog";
const GOAL: &str = "reward.goal";

/// A config that has been checked, and the goal it names.
#[derive(Debug)]
pub(crate) struct LoadedRun {
    pub(crate) config: RunConfig,
    /// The goal picture, if the config names one.
    pub(crate) goal: Option<Frame>,
    /// The file the goal was read from.
    pub(crate) goal_path: Option<PathBuf>,
}

/// Reads the config at `path`, changed by `sets` and then by `seed`, and the goal it names.
///
/// # Errors
///
/// Misuse if the config is wrong or names a goal that is not there; failure if the goal is there
/// and cannot be read as a picture.
pub(crate) fn load_run(path: &Path, sets: &[String], seed: Option<u64>) -> Result<LoadedRun> {
    let (mut config, source) = load::<RunConfig>(path, sets)?;
    config.seed = seed.unwrap_or(config.seed);
    config.validate().map_err(|error| misfit(&source, error))?;
    let goal_path = config.reward.goal.as_deref().map(|goal| source.resolve(GOAL, goal));
    let goal = goal_path.as_deref().map(|path| read_goal(path, &source)).transpose()?;
    check_task(&config, goal.as_ref(), &source)?;
    Ok(LoadedRun { config, goal, goal_path })
}

fn read_goal(path: &Path, source: &Source) -> Result<Frame> {
    if !path.exists() {
        let missing = format!("{}: `{GOAL}`: there is no file {}", source.locate(GOAL), path.display());
        return Err(CliError::misuse(missing)
            .hint("a goal's path is taken from the config's folder; one given with --set, from the current folder")
            .into());
    }
    prf_core::io::read_frame(path).map_err(|error| {
        CliError::failed(format!("{}: `{GOAL}`: {error}", source.locate(GOAL)))
            .hint("name a picture of the finished task, such as a PNG")
            .into()
    })
}
