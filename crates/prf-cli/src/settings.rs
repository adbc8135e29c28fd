//! Config files: read, changed by `--set`, and blamed by line and column when they are wrong.

use std::fs;
use std::path::Path;

use serde::de::DeserializeOwned;

use crate::error::{CliError, Result};

pub(crate) use self::goal::{ReadGoal, goal_error, goal_misfit, is_picture, read_goal};
pub(crate) use self::reward::{RewardSettings, motion_params, reward_config, reward_settings};
#[cfg(feature = "train")]
pub(crate) use self::run::{LoadedRun, load_run};
pub(crate) use self::source::Source;

mod explain;
mod goal;
mod overrides;
mod reward;
#[cfg(feature = "train")]
mod run;
mod source;
#[cfg(test)]
mod tests;

/// Reads the config at `path`, changes it by the `key.path=value` of `sets`, and returns it with
/// its source, which knows where each key stands.
///
/// # Errors
///
/// Misuse if the file cannot be read, is not TOML, or does not fit `T`.
pub(crate) fn load<T: DeserializeOwned>(path: &Path, sets: &[String]) -> Result<(T, Source)> {
    let source = Source::new(path.to_owned(), read(path)?, sets)?;
    let value = source.deserialize()?;
    Ok((value, source))
}

/// Points at the key that a library found wrong; passes any other error on.
pub(crate) fn misfit(source: &Source, error: prf_core::Error) -> anyhow::Error {
    match error {
        prf_core::Error::InvalidParam { key, got, expected } => source.explain(&key, &got, &expected).into(),
        other => other.into(),
    }
}

fn read(path: &Path) -> Result<String> {
    let bytes = fs::read(path).map_err(|error| {
        CliError::misuse(format!("cannot read the config {}: {error}", path.display()))
            .hint("`prf init breakout` writes a config to start from")
    })?;
    String::from_utf8(bytes).map_err(|error| {
        let valid = error.utf8_error().valid_up_to();
        let (line, column) = source::line_column(error.as_bytes(), valid);
        CliError::misuse(format!(
            "{}:{line}:{column}: this is not UTF-8 text, which a config has to be",
            path.display()
        ))
        .into()
    })
}
