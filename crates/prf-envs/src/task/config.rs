//! A task as a config file describes it: the tables `[env]`, `[reward]` (with `[reward.hog]`) and `[state]`.

use std::path::PathBuf;

use prf_core::{DistanceScale, Error as ParamError, HogParams, RewardParams};
use serde::{Deserialize, Serialize};

use crate::{Error, registry};

/// What is to be learned: the world, the reward, and what the agent sees.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TaskConfig {
    /// `[env]`
    pub env: EnvConfig,
    /// `[reward]`
    pub reward: RewardConfig,
    /// `[state]`
    #[serde(default)]
    pub state: StateConfig,
}

impl TaskConfig {
    /// Checks every value, except that the goal is there and can be read.
    ///
    /// # Errors
    /// [`InvalidParam`](ParamError::InvalidParam) with the full key, such as `reward.hog.orientations`.
    pub fn validate(&self) -> Result<(), ParamError> {
        self.env.validate()?;
        self.reward.validate()?;
        self.state.validate()
    }
}

/// `[env]`: the world.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(from = "EnvTable")]
pub struct EnvConfig {
    /// The world's name, one of [`registry::names`].
    pub name: String,
    /// Steps after which an episode is truncated, at least 1. The world's own limit if the file says nothing.
    pub limit_steps: u32,
}

impl EnvConfig {
    /// The world called `name` with its own step limit.
    pub fn new(name: &str) -> EnvConfig {
        EnvTable { name: name.to_owned(), limit_steps: None }.into()
    }

    fn validate(&self) -> Result<(), ParamError> {
        match registry::make(self) {
            Err(Error::Core(error)) => Err(error),
            _ => Ok(()),
        }
    }
}

/// What stands in the file, before the world's own limit is filled in.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct EnvTable {
    name: String,
    limit_steps: Option<u32>,
}

impl From<EnvTable> for EnvConfig {
    fn from(EnvTable { name, limit_steps }: EnvTable) -> EnvConfig {
        // An unknown world has no limit either; its name is what `validate` complains about.
        let limit_steps = limit_steps.or_else(|| registry::default_limit_steps(&name)).unwrap_or(0);
        EnvConfig { name, limit_steps }
    }
}

/// `[reward]`: where the agent's reward comes from.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RewardConfig {
    /// The source.
    pub source: RewardSource,
    /// How a goal becomes a template; for perceptual rewards only.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub descriptor: Option<DescriptorKind>,
    /// The goal's file, relative to the config's; for perceptual rewards only.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub goal: Option<PathBuf>,
    /// How the distance is scaled; only perceptual rewards look at it.
    #[serde(default = "default_scale")]
    pub scale: DistanceScale,
    /// `[reward.hog]`; only perceptual rewards look at it.
    #[serde(default)]
    pub hog: HogParams,
}

impl RewardConfig {
    /// The world's own reward (VRF).
    pub fn variable() -> RewardConfig {
        let RewardParams { hog, scale } = RewardParams::default();
        RewardConfig { source: RewardSource::Variable, descriptor: None, goal: None, scale, hog }
    }

    /// The perceptual reward of a goal in a file, with the direct descriptor and default parameters.
    pub fn perceptual(goal: impl Into<PathBuf>) -> RewardConfig {
        RewardConfig {
            source: RewardSource::Perceptual,
            descriptor: Some(DescriptorKind::Direct),
            goal: Some(goal.into()),
            ..RewardConfig::variable()
        }
    }

    /// The parameters of the reward's formula.
    pub fn params(&self) -> RewardParams {
        RewardParams { hog: self.hog, scale: self.scale }
    }

    fn validate(&self) -> Result<(), ParamError> {
        match self.source {
            RewardSource::Perceptual => {
                required("reward.descriptor", self.descriptor.is_some(), "\"direct\"")?;
                required("reward.goal", self.goal.is_some(), "the path of a picture of the finished task")?;
            }
            RewardSource::Variable => {
                useless("reward.descriptor", self.descriptor.is_some())?;
                useless("reward.goal", self.goal.is_some())?;
            }
        }
        self.hog.validate().map_err(|error| error.within("reward.hog"))
    }
}

/// Where the reward comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum RewardSource {
    /// F of the mirror frame after each action: how much it looks like the goal.
    Perceptual,
    /// What the world itself gives (VRF).
    Variable,
}

/// How a goal becomes a template.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum DescriptorKind {
    /// The whole picture (section III-A of the paper).
    Direct,
}

/// `[state]`: what the agent sees.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct StateConfig {
    /// The representation.
    pub kind: StateKind,
    /// How much of the past an average keeps, λ in [0, 1); only [`StateKind::Ema`] looks at it.
    pub lambda: f32,
}

impl Default for StateConfig {
    /// The paper's: an average with λ = 0.7.
    fn default() -> Self {
        StateConfig { kind: StateKind::Ema, lambda: 0.7 }
    }
}

impl StateConfig {
    fn validate(&self) -> Result<(), ParamError> {
        if (0.0..1.0).contains(&self.lambda) {
            return Ok(());
        }
        Err(invalid("state.lambda", self.lambda.to_string(), "0 or more, and below 1"))
    }
}

/// How the mirror frames become what the agent sees.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum StateKind {
    /// An exponential moving average of the mirror frames, so that one picture shows movement.
    Ema,
    /// The mirror frame as it is.
    Mirror,
}

fn default_scale() -> DistanceScale {
    RewardParams::default().scale
}

fn required(key: &str, given: bool, expected: &str) -> Result<(), ParamError> {
    if given { Ok(()) } else { Err(invalid(key, "nothing", expected)) }
}

fn useless(key: &str, given: bool) -> Result<(), ParamError> {
    if !given {
        return Ok(());
    }
    let expected = "nothing, because reward.source is \"variable\": remove it, or ask for \"perceptual\"";
    Err(invalid(key, "a value", expected))
}

fn invalid(key: &str, got: impl Into<String>, expected: &str) -> ParamError {
    ParamError::InvalidParam { key: key.to_owned(), got: got.into(), expected: expected.to_owned() }
}
