//! The native half of the Python package `prf`. It reads arrays, lets go of the GIL, calls `prf_core`
//! and `prf_envs`, and turns errors into exceptions; nothing is computed here.
//!
//! Docs of functions and classes are their docstrings. `python/prf/_native.pyi` has their types.

mod arg;
mod batch;
mod error;
mod goal;
mod hog;
mod image;
mod limits;
mod options;
mod presets;
mod results;
mod reward;
mod tasks;

use pyo3::prelude::*;

/// Nothing here needs the GIL: what is shared is frozen or behind a lock.
#[pymodule(gil_used = false)]
mod _native {
    #[pymodule_export]
    use super::goal::{DirectGoal, Goal, MotionGoal, WindowGoal};
    #[pymodule_export]
    use super::hog::hog;
    #[pymodule_export]
    use super::presets::{preset_goal, preset_limit_steps};
    #[pymodule_export]
    use super::reward::{distance, reward};
    #[pymodule_export]
    use super::tasks::Tasks;
    #[pymodule_export]
    #[expect(non_upper_case_globals, reason = "Python's name for it")]
    const __version__: &str = env!("CARGO_PKG_VERSION");
}
