//! Errors become exceptions.

use prf_core::Error;
use pyo3::PyErr;
use pyo3::exceptions::PyValueError;

/// The exception for an error of `prf_core` about the argument `name`.
pub(crate) fn value_error(name: &str, error: &Error) -> PyErr {
    let message = match error {
        Error::InvalidParam { key, got, expected } => format!("{}: got {got}, expected {expected}", argument(key)),
        other => format!("{name}: {other}"),
    };
    PyValueError::new_err(message)
}

/// What the parameter with this key of a configuration is called in Python.
fn argument(key: &str) -> &str {
    match key.strip_prefix("hog.").unwrap_or(key) {
        "cell.fraction" => "cell",
        "cell.px" => "cell_px",
        other => other,
    }
}
