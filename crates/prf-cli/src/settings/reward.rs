//! The reward's parameters, from a config, from options, or from both.

use std::path::{Path, PathBuf};

use prf_core::{CellSize, DeltaSchedule, DescriptorKind, DescriptorParams, MotionParams, RewardParams};
use prf_envs::{RewardConfig, RewardSource};
use serde::Deserialize;

use super::{Source, load, misfit};
use crate::args::{MotionOptions, RewardArgs};
use crate::error::{CliError, Result};

/// How frames are scored.
#[derive(Debug)]
pub(crate) struct RewardSettings {
    pub(crate) descriptor: DescriptorParams,
    pub(crate) params: RewardParams,
    /// The mask's file.
    pub(crate) mask: Option<PathBuf>,
}

/// What `args` ask for: the config's `[reward]` or the defaults, changed by single options.
///
/// # Errors
///
/// Misuse, pointing at the option or at the config's line, whichever set the wrong value.
pub(crate) fn reward_settings(args: &RewardArgs) -> Result<RewardSettings> {
    let config = reward_config(args)?;
    Ok(RewardSettings {
        descriptor: config.descriptor_params().unwrap_or_default(),
        params: config.params(),
        mask: config.window.and_then(|window| window.mask),
    })
}

/// The same as a perceptual `[reward]`, complete but for its goal. A mask's path is relative to the current folder.
///
/// # Errors
///
/// As [`reward_settings`].
pub(crate) fn reward_config(args: &RewardArgs) -> Result<RewardConfig> {
    let (mut config, source) = match &args.config {
        Some(path) => read(path)?,
        None => (RewardConfig::perceptual(""), None),
    };
    if let Some(kind) = args.descriptor.map(DescriptorKind::from).filter(|&kind| config.descriptor != Some(kind)) {
        config = config.with_descriptor(kind);
    }
    apply(args, &mut config)?;
    config.validate().map_err(|error| blame(error, args, source.as_ref()))?;
    Ok(config)
}

/// The part of a config that is of interest here.
#[derive(Deserialize)]
struct RewardTable {
    reward: RewardConfig,
}

fn read(path: &Path) -> Result<(RewardConfig, Option<Source>)> {
    let (RewardTable { mut reward }, source) = load(path, &[])?;
    if reward.source == RewardSource::Variable {
        // Such a config says how its agent is rewarded, not how pictures are compared.
        reward = RewardConfig { scale: reward.scale, hog: reward.hog, ..RewardConfig::perceptual("") };
    }
    if let Some(mask) = reward.window.as_mut().and_then(|window| window.mask.as_mut()) {
        *mask = source.resolve("reward.window.mask", mask);
    }
    Ok((reward, Some(source)))
}

fn apply(args: &RewardArgs, config: &mut RewardConfig) -> Result<()> {
    let hog = &mut config.hog;
    if let Some(fraction) = args.cell {
        hog.cell = CellSize::Fraction(fraction);
    }
    if let Some(px) = args.cell_px {
        hog.cell = CellSize::Px(px);
    }
    hog.orientations = args.orientations.unwrap_or(hog.orientations);
    hog.signed = args.signed.unwrap_or(hog.signed);
    hog.block_cells = args.block_cells.unwrap_or(hog.block_cells);
    hog.norm = args.norm.map_or(hog.norm, Into::into);
    config.scale = args.scale.map_or(config.scale, Into::into);
    apply_window(args, config)?;
    apply_motion(&args.motion, config)
}

fn apply_window(args: &RewardArgs, config: &mut RewardConfig) -> Result<()> {
    let Some(window) = &mut config.window else {
        return refuse("window", &[("--method", args.method.is_some()), ("--mask", args.mask.is_some())]);
    };
    window.method = args.method.map_or(window.method, Into::into);
    if args.mask.is_some() {
        window.mask.clone_from(&args.mask);
    }
    Ok(())
}

fn apply_motion(args: &MotionOptions, config: &mut RewardConfig) -> Result<()> {
    let Some(motion) = &mut config.motion else {
        let given = [
            ("--threshold", args.threshold.is_some()),
            ("--tau-start", args.tau_start.is_some()),
            ("--tau-step", args.tau_step.is_some()),
            ("--delta-divisor", args.delta_divisor.is_some()),
            ("--duration", args.duration.is_some()),
            ("--skip-still", args.skip_still.is_some()),
        ];
        return refuse("motion", &given);
    };
    change_motion(args, motion);
    Ok(())
}

fn change_motion(args: &MotionOptions, motion: &mut MotionParams) {
    motion.threshold = args.threshold.unwrap_or(motion.threshold);
    motion.tau_start = args.tau_start.unwrap_or(motion.tau_start);
    motion.tau_step = args.tau_step.unwrap_or(motion.tau_step);
    motion.skip_still = args.skip_still.unwrap_or(motion.skip_still);
    if let Some(divisor) = args.delta_divisor {
        motion.delta = DeltaSchedule::Divisor(divisor);
    }
    if let Some(duration) = args.duration {
        motion.delta = DeltaSchedule::Duration(duration);
    }
}

/// The motion template's parameters: `usual` ones, changed by options.
///
/// # Errors
///
/// Misuse, pointing at the option that is out of range.
pub(crate) fn motion_params(usual: MotionParams, args: &MotionOptions) -> Result<MotionParams> {
    let mut motion = usual;
    change_motion(args, &mut motion);
    match motion.validate() {
        Ok(()) => Ok(motion),
        Err(prf_core::Error::InvalidParam { key, got, expected }) => {
            let option = motion_option_for(&key, args).unwrap_or("the schedule");
            Err(CliError::misuse(format!("{option}: got {got}, expected {expected}")).into())
        }
        Err(other) => Err(other.into()),
    }
}

/// An option that would change nothing was meant for another descriptor.
fn refuse(descriptor: &str, options: &[(&str, bool)]) -> Result<()> {
    match options.iter().find(|(_, given)| *given) {
        None => Ok(()),
        Some((option, _)) => {
            Err(CliError::misuse(format!("{option} is for --descriptor {descriptor}, which was not asked for"))
                .hint(format!("add --descriptor {descriptor}, or leave {option} out"))
                .into())
        }
    }
}

fn blame(error: prf_core::Error, args: &RewardArgs, source: Option<&Source>) -> anyhow::Error {
    if let prf_core::Error::InvalidParam { key, got, expected } = &error
        && let Some(option) = option_for(key, args)
    {
        return CliError::misuse(format!("{option}: got {got}, expected {expected}")).into();
    }
    match source {
        Some(source) => misfit(source, error),
        None => error.into(),
    }
}

/// The option that was used to set `key`, if one was.
fn option_for(key: &str, args: &RewardArgs) -> Option<&'static str> {
    let (option, used) = match key {
        "reward.hog.cell.fraction" => ("--cell", args.cell.is_some()),
        "reward.hog.cell.px" => ("--cell-px", args.cell_px.is_some()),
        "reward.hog.orientations" => ("--orientations", args.orientations.is_some()),
        "reward.hog.block_cells" => ("--block-cells", args.block_cells.is_some()),
        key => return motion_option_for(key.strip_prefix("reward.motion.")?, &args.motion),
    };
    used.then_some(option)
}

fn motion_option_for(key: &str, args: &MotionOptions) -> Option<&'static str> {
    let (option, used) = match key {
        "threshold" => ("--threshold", args.threshold.is_some()),
        "tau_start" => ("--tau-start", args.tau_start.is_some()),
        "tau_step" => ("--tau-step", args.tau_step.is_some()),
        "delta.divisor" => ("--delta-divisor", args.delta_divisor.is_some()),
        "delta.duration" => ("--duration", args.duration.is_some()),
        _ => return None,
    };
    used.then_some(option)
}
