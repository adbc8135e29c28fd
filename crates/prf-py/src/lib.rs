//! The native half of the Python package `prf`. It reads arrays, lets go of the GIL, calls `prf_core`
//! and `prf_envs`, and turns errors into exceptions; nothing is computed here. The command line is `prf_cli`'s.
//!
//! Docs of functions and classes are their docstrings. `python/prf/_native.pyi` has their types.

mod arg;
mod batch;
mod choice;
mod command;
mod crop;
mod ema;
mod error;
mod exclusive;
mod goal;
mod grey;
mod hog;
mod image;
mod limits;
mod matching;
mod motion;
mod options;
mod presets;
mod results;
mod reward;
mod tasks;
mod values;

use pyo3::prelude::*;

/// Nothing here needs the GIL: what is shared is frozen or behind a lock.
#[pymodule(gil_used = false)]
mod _native {
    #[pymodule_export]
    use super::command::main;
    #[pymodule_export]
    use super::crop::{crop, crop_box, crop_box_batch};
    #[pymodule_export]
    use super::ema::EmaState;
    #[pymodule_export]
    use super::goal::{DirectGoal, Goal, MotionGoal, WindowGoal};
    #[pymodule_export]
    use super::grey::to_grey;
    #[pymodule_export]
    use super::hog::{hog, hog_batch};
    #[pymodule_export]
    use super::matching::{match_template, match_template_batch};
    #[pymodule_export]
    use super::motion::{MotionTemplate, motion_template};
    #[pymodule_export]
    use super::presets::{preset_goal, preset_limit_steps};
    #[pymodule_export]
    use super::reward::{distance, distance_batch, reward, reward_batch};
    #[pymodule_export]
    use super::tasks::Tasks;
    #[pymodule_export]
    #[expect(non_upper_case_globals, reason = "Python's name for it")]
    const __version__: &str = env!("CARGO_PKG_VERSION");
}
