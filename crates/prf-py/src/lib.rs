//! The native half of the Python package `prf`. It reads arrays, lets go of the GIL, calls `prf_core`
//! and turns errors into exceptions; nothing is computed here. The command line is `prf_cli`'s.
//!
//! Docs of functions are their docstrings. `python/prf/_native.pyi` has their types.

mod arg;
mod command;
mod error;
mod hog;
mod image;
mod limits;
mod options;
mod reward;

use pyo3::prelude::*;

#[pymodule]
mod _native {
    #[pymodule_export]
    use super::command::main;
    #[pymodule_export]
    use super::hog::hog;
    #[pymodule_export]
    use super::reward::{distance, reward};
    #[pymodule_export]
    #[expect(non_upper_case_globals, reason = "Python's name for it")]
    const __version__: &str = env!("CARGO_PKG_VERSION");
}
