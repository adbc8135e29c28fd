//! A task as a config file describes it: the tables `[env]`, `[reward]` (with `[reward.hog]`) and `[state]`.

use std::path::PathBuf;

use prf_core::{
    CellSize, DescriptorKind, DescriptorParams, DistanceScale, Error as ParamError, HogParams, MatchMethod,
    MotionParams, Norm, RewardParams, WindowParams,
};
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
    /// If given, an episode terminates, as a success, once no more than this many actions are missing to the finished task.
    /// Only the worlds of the face have it; from 0 to what is missing at the beginning, less 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub solved_within: Option<u32>,
}

impl EnvConfig {
    /// The world called `name` with its own step limit.
    pub fn new(name: &str) -> EnvConfig {
        EnvTable { name: name.to_owned(), limit_steps: None, solved_within: None }.into()
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
    solved_within: Option<u32>,
}

impl From<EnvTable> for EnvConfig {
    fn from(EnvTable { name, limit_steps, solved_within }: EnvTable) -> EnvConfig {
        // An unknown world has no limit either; its name is what `validate` complains about.
        let limit_steps = limit_steps.or_else(|| registry::default_limit_steps(&name)).unwrap_or(0);
        EnvConfig { name, limit_steps, solved_within }
    }
}

/// `[reward]`: where the agent's reward comes from.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(from = "RewardTable")]
pub struct RewardConfig {
    /// The source.
    pub source: RewardSource,
    /// How a goal becomes a template; for perceptual rewards only.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub descriptor: Option<DescriptorKind>,
    /// The goal's file, relative to the config's; for perceptual rewards only.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub goal: Option<PathBuf>,
    /// What of the source rewards a step; anything but [`RewardForm::State`] is for perceptual rewards only.
    pub form: RewardForm,
    /// Discount γ in [0, 1) of [`RewardForm::Potential`]. It is the learner's, so the table has no key for it, and whoever joins
    /// the table with a learner fills it in.
    #[serde(skip)]
    pub gamma: Option<f32>,
    /// How the distance is scaled; only perceptual rewards look at it.
    pub scale: DistanceScale,
    /// `[reward.window]`; for the window descriptor only.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub window: Option<WindowConfig>,
    /// `[reward.motion]`; for the motion descriptor only.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub motion: Option<MotionParams>,
    /// `[reward.hog]`; only perceptual rewards look at it.
    pub hog: HogParams,
}

/// `[reward.window]`: how the window is found.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct WindowConfig {
    /// What makes a window the best one.
    pub method: MatchMethod,
    /// A picture of the goal's size that is black where the goal doesn't count; its file is relative to the config's.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mask: Option<PathBuf>,
}

impl RewardConfig {
    /// The world's own reward (VRF).
    pub fn variable() -> RewardConfig {
        RewardTable { source: RewardSource::Variable, ..RewardTable::default() }.into()
    }

    /// The perceptual reward of a goal in a file, with the direct descriptor and default parameters.
    pub fn perceptual(goal: impl Into<PathBuf>) -> RewardConfig {
        let goal = Some(goal.into());
        RewardTable { descriptor: Some(DescriptorKind::Direct), goal, ..RewardTable::default() }.into()
    }

    /// The same reward by another descriptor, with that one's own defaults and cell size.
    #[must_use]
    pub fn with_descriptor(self, kind: DescriptorKind) -> RewardConfig {
        let hog = HogParams { cell: kind.paper_cell(), ..self.hog };
        RewardConfig {
            descriptor: Some(kind),
            window: (kind == DescriptorKind::Window).then(WindowConfig::default),
            motion: (kind == DescriptorKind::Motion).then(MotionParams::default),
            hog,
            ..self
        }
    }

    /// The parameters of the reward's formula.
    pub fn params(&self) -> RewardParams {
        RewardParams { hog: self.hog, scale: self.scale }
    }

    /// The descriptor with its own parameters; none for a variable reward.
    pub fn descriptor_params(&self) -> Option<DescriptorParams> {
        let method = self.window.as_ref().map(|window| window.method).unwrap_or_default();
        Some(match self.descriptor? {
            DescriptorKind::Direct => DescriptorParams::Direct,
            DescriptorKind::Window => DescriptorParams::Window(WindowParams { method }),
            DescriptorKind::Motion => DescriptorParams::Motion(self.motion.unwrap_or_default()),
        })
    }

    /// Checks every value.
    ///
    /// # Errors
    /// [`InvalidParam`](ParamError::InvalidParam) with the full key, such as `reward.hog.orientations`.
    pub fn validate(&self) -> Result<(), ParamError> {
        match self.source {
            RewardSource::Perceptual => {
                required("reward.descriptor", self.descriptor.is_some(), "\"direct\", \"window\" or \"motion\"")?;
                required("reward.goal", self.goal.is_some(), "the path of a picture of the finished task")?;
            }
            RewardSource::Variable => {
                useless("reward.descriptor", self.descriptor.is_some(), PERCEPTUAL)?;
                useless("reward.goal", self.goal.is_some(), PERCEPTUAL)?;
            }
        }
        if self.form == RewardForm::Potential {
            useless("reward.form", self.source == RewardSource::Variable, PERCEPTUAL)?;
            let fits = self.gamma.is_some_and(|gamma| (0.0..1.0).contains(&gamma));
            let got = self.gamma.map_or("no discount".to_owned(), |gamma| format!("the discount {gamma}"));
            let expected = "a learner's discount from 0 up to, but not including, 1, for \"potential\"";
            if !fits {
                return Err(invalid("reward.form", got, expected));
            }
        }
        let is = |kind| self.descriptor == Some(kind);
        useless("reward.window", self.window.is_some() && !is(DescriptorKind::Window), WINDOW)?;
        useless("reward.motion", self.motion.is_some() && !is(DescriptorKind::Motion), MOTION)?;
        self.motion.unwrap_or_default().validate().map_err(|error| error.within("reward.motion"))?;
        self.hog.validate().map_err(|error| error.within("reward.hog"))
    }
}

const PERCEPTUAL: &str = "nothing, because reward.source is \"variable\": remove it, or ask for \"perceptual\"";
const WINDOW: &str = "nothing, because reward.descriptor is not \"window\": remove it, or ask for \"window\"";
const MOTION: &str = "nothing, because reward.descriptor is not \"motion\": remove it, or ask for \"motion\"";

/// What stands in the file, before the descriptor's own cell size and tables are filled in.
#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields)]
struct RewardTable {
    source: RewardSource,
    descriptor: Option<DescriptorKind>,
    goal: Option<PathBuf>,
    #[serde(default)]
    form: RewardForm,
    #[serde(default)]
    scale: DistanceScale,
    window: Option<WindowConfig>,
    motion: Option<MotionParams>,
    #[serde(default)]
    hog: HogTable,
}

/// `[reward.hog]` as it stands in the file.
#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields)]
struct HogTable {
    orientations: Option<usize>,
    signed: Option<bool>,
    cell: Option<CellSize>,
    block_cells: Option<usize>,
    norm: Option<Norm>,
}

impl From<RewardTable> for RewardConfig {
    fn from(table: RewardTable) -> RewardConfig {
        let RewardTable { source, descriptor, goal, form, scale, window, motion, hog } = table;
        let default = HogParams { cell: descriptor.unwrap_or_default().paper_cell(), ..HogParams::default() };
        RewardConfig {
            source,
            descriptor,
            goal,
            form,
            gamma: None,
            scale,
            window: window.or((descriptor == Some(DescriptorKind::Window)).then(WindowConfig::default)),
            motion: motion.or((descriptor == Some(DescriptorKind::Motion)).then(MotionParams::default)),
            hog: HogParams {
                orientations: hog.orientations.unwrap_or(default.orientations),
                signed: hog.signed.unwrap_or(default.signed),
                cell: hog.cell.unwrap_or(default.cell),
                block_cells: hog.block_cells.unwrap_or(default.block_cells),
                norm: hog.norm.unwrap_or(default.norm),
            },
        }
    }
}

/// Where the reward comes from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum RewardSource {
    /// F of the mirror frame after each action: how much it looks like the goal.
    #[default]
    Perceptual,
    /// What the world itself gives (VRF).
    Variable,
}

/// What of a perceptual reward an agent gets for the step from `s` to `s′`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum RewardForm {
    /// `F(s′)`, as in the paper: every step near the goal is rewarded, so an agent may prefer never to finish.
    #[default]
    State,
    /// `γF(s′) − F(s)`, also where `s′` is terminal: a whole episode of T steps then comes to `γᵀF(s_T) − F(s₀)`, so what counts
    /// is how it ends. `docs/reward.md` says where that helps and where it harms.
    Potential,
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
    /// The motion template of the episode so far, with the parameters in `[reward.motion]` if there are any: the paper's `T_A`.
    Motion,
}

fn required(key: &str, given: bool, expected: &str) -> Result<(), ParamError> {
    if given { Ok(()) } else { Err(invalid(key, "nothing", expected)) }
}

fn useless(key: &str, given: bool, expected: &str) -> Result<(), ParamError> {
    if given { Err(invalid(key, "a value", expected)) } else { Ok(()) }
}

fn invalid(key: &str, got: impl Into<String>, expected: &str) -> ParamError {
    ParamError::InvalidParam { key: key.to_owned(), got: got.into(), expected: expected.to_owned() }
}
