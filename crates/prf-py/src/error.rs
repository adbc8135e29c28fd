//! Errors become exceptions.

use std::path::Path;

use prf_core::{Error, PictureProblem};
use pyo3::PyErr;
use pyo3::exceptions::{PyOSError, PyValueError};

/// What Linux, macOS and Windows call a file that is not there.
const ENOENT: i32 = 2;
/// What Linux, macOS and Windows call a folder where a file should be.
const EISDIR: i32 = 21;

/// The exception for an error of `prf_core` about the argument `name`.
pub(crate) fn value_error(name: &str, error: &Error) -> PyErr {
    let message = match error {
        Error::InvalidParam { key, got, expected } => format!("{}: got {got}, expected {expected}", argument(key)),
        other => format!("{name}: {other}"),
    };
    PyValueError::new_err(message)
}

/// The exception for an error of `prf_core` about a file or a folder, whose path it names.
pub(crate) fn file_error(error: &Error) -> PyErr {
    match error {
        Error::Picture { path, problem: problem @ PictureProblem::Missing } => os_error(ENOENT, problem, path),
        Error::Picture { path, problem: problem @ PictureProblem::NotAFile } if path.is_dir() => {
            os_error(EISDIR, problem, path)
        }
        Error::Picture { path, problem: PictureProblem::Io(error) } => match error.raw_os_error() {
            Some(number) => system_error(number, error, path),
            None => PyOSError::new_err(format!("{}: {error}", path.display())),
        },
        Error::InvalidParam { .. } => value_error("goal", error),
        other => PyValueError::new_err(in_python(&other.to_string())),
    }
}

/// A message with the arguments' names in Python for keys of a configuration.
pub(crate) fn in_python(message: &str) -> String {
    ["delta.divisor", "delta.duration"].iter().fold(message.to_owned(), |text, key| text.replace(key, argument(key)))
}

/// The same for a number that the system gave. On Windows Python takes the last argument for it and ignores the first; elsewhere
/// it ignores the last.
fn system_error(number: i32, problem: &impl ToString, path: &Path) -> PyErr {
    PyOSError::new_err((number, problem.to_string(), path.as_os_str().to_owned(), number))
}

/// Python itself makes a `FileNotFoundError` and so on of it.
fn os_error(number: i32, problem: &impl ToString, path: &Path) -> PyErr {
    PyOSError::new_err((number, problem.to_string(), path.as_os_str().to_owned()))
}

/// What the parameter with this key of a configuration is called in Python.
fn argument(key: &str) -> &str {
    match key.trim_start_matches("hog.").trim_start_matches("motion.") {
        "cell.fraction" => "cell",
        "cell.px" => "cell_px",
        "delta.divisor" => "delta_divisor",
        "delta.duration" => "duration",
        "lambda" => "decay",
        other => other,
    }
}
