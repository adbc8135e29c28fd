//! The reward's parameters, from a config, from options, or from both.

use std::path::Path;

use prf_core::{CellSize, RewardParams};
use prf_envs::RewardConfig;
use serde::Deserialize;

use super::{Source, load, misfit};
use crate::args::RewardArgs;
use crate::error::{CliError, Result};

/// What `args` ask for: the config's `[reward]` or the defaults, changed by single options.
///
/// # Errors
///
/// Misuse, pointing at the option or at the config's line, whichever set the wrong value.
pub(crate) fn reward_params(args: &RewardArgs) -> Result<RewardParams> {
    let (mut params, source) = match &args.config {
        Some(path) => read(path)?,
        None => (RewardParams::default(), None),
    };
    apply(args, &mut params);
    match params.hog.validate() {
        Ok(()) => Ok(params),
        Err(error) => Err(blame(error, args, source.as_ref())),
    }
}

/// The part of a config that is of interest here.
#[derive(Deserialize)]
struct RewardTable {
    reward: RewardConfig,
}

fn read(path: &Path) -> Result<(RewardParams, Option<Source>)> {
    let (RewardTable { reward }, source) = load(path, &[])?;
    Ok((reward.params(), Some(source)))
}

fn apply(args: &RewardArgs, params: &mut RewardParams) {
    let hog = &mut params.hog;
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
    params.scale = args.scale.map_or(params.scale, Into::into);
}

fn blame(error: prf_core::Error, args: &RewardArgs, source: Option<&Source>) -> anyhow::Error {
    if let prf_core::Error::InvalidParam { key, got, expected } = &error
        && let Some(option) = option_for(key, args)
    {
        return CliError::misuse(format!("{option}: got {got}, expected {expected}")).into();
    }
    match source {
        Some(source) => misfit(source, error.within("reward.hog")),
        None => error.into(),
    }
}

/// The option that was used to set `key`, if one was.
fn option_for(key: &str, args: &RewardArgs) -> Option<&'static str> {
    let (option, used) = match key {
        "cell.fraction" => ("--cell", args.cell.is_some()),
        "cell.px" => ("--cell-px", args.cell_px.is_some()),
        "orientations" => ("--orientations", args.orientations.is_some()),
        "block_cells" => ("--block-cells", args.block_cells.is_some()),
        _ => return None,
    };
    used.then_some(option)
}
