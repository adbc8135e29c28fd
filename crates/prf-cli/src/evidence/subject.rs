//! The reward that is to be judged.

use std::path::{Path, PathBuf};

use prf_core::{DescriptorParams, Goal, RewardParams};
use prf_envs::{EnvConfig, RewardConfig, RewardSource};
use serde::Deserialize;

use crate::args::{EvidenceArgs, RewardArgs};
use crate::error::{CliError, Result};
use crate::printer::Printer;
use crate::settings::{ReadGoal, goal_error, goal_misfit, load, read_goal, reward_config};

/// A reward, its goal, and the world it is for, if a config names one.
#[derive(Debug)]
pub(crate) struct Subject {
    /// Its paths are as the config has them, or as they were typed.
    pub(crate) reward: RewardConfig,
    /// Files of the goal and of its mask, relative to the current folder.
    pub(crate) goal_path: PathBuf,
    pub(crate) mask_path: Option<PathBuf>,
    pub(crate) goal: Goal,
    /// What the goal was named by, to begin an error about it with: a place in a config, or its path.
    pub(crate) place: String,
    pub(crate) env: Option<EnvConfig>,
}

/// The part of a config that is of interest here.
#[derive(Deserialize)]
struct Tables {
    env: Option<EnvConfig>,
    reward: RewardConfig,
}

/// The goal's and its mask's.
type Files = (PathBuf, Option<PathBuf>);

fn goal_of(reward: &RewardConfig, (goal, mask): &Files) -> std::result::Result<ReadGoal, prf_core::Error> {
    read_goal(goal, mask.as_deref(), &reward.descriptor_params().unwrap_or_default())
}

impl Subject {
    /// # Errors
    ///
    /// Misuse if the config or an option is wrong, or the config's reward is not perceptual; failure if the goal can't be read.
    pub(crate) fn read(args: &EvidenceArgs, reward: &RewardArgs, printer: &mut Printer) -> Result<Subject> {
        let is_config = args.subject.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("toml"));
        if is_config { Subject::of_config(args, reward, printer) } else { Subject::of_goal(args, reward, printer) }
    }

    fn of_config(args: &EvidenceArgs, reward: &RewardArgs, printer: &mut Printer) -> Result<Subject> {
        let path = &args.subject;
        if reward.config.is_some() {
            let message = format!("--config: {} is a config already", path.display());
            return Err(CliError::misuse(message).hint("name one of them").into());
        }
        let (tables, source) = load::<Tables>(path, &[])?;
        if tables.reward.source == RewardSource::Variable {
            let place = source.locate("reward.source");
            let message =
                format!("{place}: `reward.source` is \"variable\": there is no picture whose reward could be judged");
            return Err(CliError::misuse(message).hint("name a config with a perceptual reward, or a goal").into());
        }
        let mut config = reward_config(&RewardArgs { config: Some(path.clone()), ..reward.clone() })?;
        let mask_path = config.window.as_ref().and_then(|window| window.mask.clone());
        let goal_path = source.resolve("reward.goal", tables.reward.goal.as_deref().unwrap_or(Path::new("")));
        config.goal = tables.reward.goal;
        if let Some(window) = &mut config.window {
            window.mask = match &reward.mask {
                // Typed, so that it doesn't start at the config's folder.
                Some(typed) => Some(std::path::absolute(typed)?),
                None => tables.reward.window.and_then(|named| named.mask),
            };
        }
        let files = (goal_path, mask_path);
        let read = goal_of(&config, &files).map_err(|error| goal_misfit(&error, files.1.as_deref(), &source))?;
        let place = format!("{}: `reward.goal`", source.locate("reward.goal"));
        Ok(Subject { place, ..Subject::new(config, files, read, tables.env, printer) })
    }

    fn of_goal(args: &EvidenceArgs, reward: &RewardArgs, printer: &mut Printer) -> Result<Subject> {
        let mut config = reward_config(reward)?;
        config.goal = Some(args.subject.clone());
        let mask_path = config.window.as_ref().and_then(|window| window.mask.clone());
        let files = (args.subject.clone(), mask_path);
        let read = goal_of(&config, &files).map_err(goal_error)?;
        Ok(Subject::new(config, files, read, None, printer))
    }

    fn new(
        reward: RewardConfig,
        (goal_path, mask_path): Files,
        ReadGoal { goal, warning }: ReadGoal,
        env: Option<EnvConfig>,
        printer: &mut Printer,
    ) -> Subject {
        let place = goal_path.display().to_string();
        if let Some(warning) = warning {
            printer.warning(format_args!("{place}: {warning}"), Some(warning.hint()));
        }
        Subject { reward, goal_path, mask_path, goal, place, env }
    }

    pub(crate) fn descriptor(&self) -> DescriptorParams {
        self.reward.descriptor_params().unwrap_or_default()
    }

    pub(crate) fn params(&self) -> RewardParams {
        self.reward.params()
    }
}
