//! The command line, as `python -m prf` runs it.

use std::ffi::OsString;
use std::panic::{AssertUnwindSafe, catch_unwind};

use pyo3::prelude::*;

/// The exit code of a Rust program that panics.
const PANICKED: u8 = 101;

/// Runs the command line `args`, of which the first is what the program is called in its own help, on this
/// process's standard streams and with its signals, and returns the exit code. `python -m prf` is the way
/// to call it.
#[pyfunction]
pub(crate) fn main(py: Python<'_>, args: Vec<OsString>) -> u8 {
    // What was wrong has then been said on stderr, and the program ends here as prf's own would.
    py.detach(|| catch_unwind(AssertUnwindSafe(|| prf_cli::run(args))).unwrap_or(PANICKED))
}
