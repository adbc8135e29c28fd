//! `prf.preset_goal`, and the settings that belong to it

use numpy::{PyArrayMethods, ToPyArray};
use prf_core::Frame;
use prf_envs::TaskConfig;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyString;

use crate::choice;
use crate::error::value_error;
use crate::goal::GoalParts;

/// A file in `configs/`, as the build script read it.
pub(crate) struct Preset {
    name: &'static str,
    /// The tables `[env]`, `[reward]` and `[state]`.
    task: &'static str,
    goal: Option<Picture>,
}

struct Picture {
    width: usize,
    height: usize,
    pixels: &'static [u8],
}

impl Picture {
    fn frame(&self, name: &str) -> PyResult<Frame> {
        let frame = Frame::from_vec(self.width, self.height, self.pixels.to_vec());
        frame.map_err(|error| value_error(name, &error))
    }
}

const PRESETS: &[Preset] = include!(concat!(env!("OUT_DIR"), "/presets.rs"));

impl Preset {
    pub(crate) fn find(py: Python<'_>, name: &str) -> PyResult<&'static Preset> {
        PRESETS.iter().find(|preset| preset.name == name).ok_or_else(|| unknown(py, name, |_| true))
    }

    pub(crate) fn config(&self) -> PyResult<TaskConfig> {
        toml::from_str(self.task).map_err(|error| PyValueError::new_err(format!("{}: {error}", self.name)))
    }
}

fn unknown(py: Python<'_>, name: &str, fits: fn(&Preset) -> bool) -> PyErr {
    choice::unknown(py, "name", name, PRESETS.iter().filter(|preset| fits(preset)).map(|preset| preset.name))
}

/// The goal of one of the worlds, with the settings that its agents were trained with.
///
/// Parameters
/// ----------
/// name : str
///     A file in ``configs/`` of PRF without its ending: "breakout", "flappy", "kobian-happy-kprf",
///     "kobian-surprise-kprf" (the robot's own movement), "kobian-happy-hprf" or "kobian-surprise-hprf" (a person's).
/// goal : ndarray, str or os.PathLike, optional
///     Another picture or movement in the place of the preset's, as the goal's class takes it.
///
/// Returns
/// -------
/// DirectGoal, WindowGoal or MotionGoal
///
/// Raises
/// ------
/// TypeError
///     An argument has another type.
/// ValueError
///     There is no such preset; or ``goal`` is refused, as by the goal's class.
/// OSError
///     The file of ``goal`` can't be read.
///
/// Examples
/// --------
/// >>> import prf
/// >>> goal = prf.preset_goal("flappy")
/// >>> type(goal).__name__, goal.norm
/// ('WindowGoal', 'none')
#[pyfunction]
#[pyo3(signature = (name, goal=None))]
pub(crate) fn preset_goal<'py>(
    name: &Bound<'py, PyString>,
    goal: Option<Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyAny>> {
    let (py, name) = (name.py(), name.to_str()?);
    let preset = PRESETS.iter().find(|preset| preset.name == name);
    let Some((preset, picture)) = preset.and_then(|preset| Some((preset, preset.goal.as_ref()?))) else {
        return Err(unknown(py, name, |preset| preset.goal.is_some()));
    };
    let reward = preset.config()?.reward;
    let descriptor = reward.descriptor_params().unwrap_or_default();
    let own = picture.frame(name)?;
    let goal = match goal {
        Some(goal) => goal,
        None => own.as_slice().to_pyarray(py).reshape([own.height(), own.width()])?.into_any(),
    };
    let parts = GoalParts { goal: own.into(), descriptor, params: reward.params() };
    py.import("prf")?.getattr(parts.class())?.call((goal,), Some(&parts.options(py)?))
}

/// The steps after which a preset's episodes are truncated.
#[pyfunction]
pub(crate) fn preset_limit_steps(py: Python<'_>, name: &str) -> PyResult<u32> {
    Ok(Preset::find(py, name)?.config()?.env.limit_steps)
}
