//! The config of a training run, with its goal picture.

use std::path::Path;

use prf_core::Goal;
use prf_core::io::SequenceWarning;
use prf_dqn::config::RunConfig;
use prf_envs::RewardConfig;

use super::goal::{GOAL, MASK};
use super::{ReadGoal, Source, goal_misfit, load, misfit, read_goal};
use crate::error::{CliError, Result};

/// Builds the task once, so that what does not fit together is known before anything is written.
fn check_task(config: &RunConfig, goal: Option<&Goal>, source: &Source) -> Result<()> {
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
            // A window that is larger than the world's screen.
            prf_core::Error::TemplateTooLarge { .. } => Err(goal_misfit(&error, None, source).into()),
            error => Err(CliError::misuse(format!("{}: `{HOG}`: {error}", source.locate(HOG))).into()),
        },
        other => Err(other.into()),
    }
}

const HOG: &str = "reward.hog";

/// A config that has been checked, and the goal it names.
#[derive(Debug)]
pub(crate) struct LoadedRun {
    /// The paths in it are relative to the current folder.
    pub(crate) config: RunConfig,
    /// The goal, if the config names one.
    pub(crate) goal: Option<Goal>,
    /// What is suspicious about the sequence that the goal was made of.
    pub(crate) warning: Option<SequenceWarning>,
}

impl LoadedRun {
    /// Settles `auto` by what this machine is good at.
    pub(crate) fn resolve_precision(&mut self, device: tch::Device) {
        self.config.train.precision = self.config.train.precision.resolved(device);
    }
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
    resolve(&mut config.reward, &source)?;
    let (goal, warning) = load_goal(&config.reward, &source)?;
    check_task(&config, goal.as_ref(), &source)?;
    Ok(LoadedRun { config, goal, warning })
}

/// Makes the paths of the reward relative to the current folder.
fn resolve(reward: &mut RewardConfig, source: &Source) -> Result<()> {
    let mask = reward.window.as_mut().and_then(|window| window.mask.as_mut());
    for (key, path) in [(GOAL, reward.goal.as_mut()), (MASK, mask)] {
        let Some(path) = path else { continue };
        *path = source.resolve(key, path);
        if !path.exists() {
            let missing = format!("{}: `{key}`: there is no file {}", source.locate(key), path.display());
            return Err(CliError::misuse(missing)
                .hint("a goal's path is taken from the config's folder; one given with --set, from the current folder")
                .into());
        }
    }
    Ok(())
}

fn load_goal(reward: &RewardConfig, source: &Source) -> Result<(Option<Goal>, Option<SequenceWarning>)> {
    let (Some(path), Some(descriptor)) = (&reward.goal, reward.descriptor_params()) else { return Ok((None, None)) };
    let mask = reward.window.as_ref().and_then(|window| window.mask.as_deref());
    let ReadGoal { goal, warning } =
        read_goal(path, mask, &descriptor).map_err(|error| goal_misfit(&error, mask, source))?;
    Ok((Some(goal), warning))
}
