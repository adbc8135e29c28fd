//! Values of arguments, and what is wrong with them.

use pyo3::exceptions::{PyOverflowError, PyTypeError, PyValueError};
use pyo3::prelude::*;

/// A type that an argument may have.
pub(crate) trait Expected: for<'a, 'py> FromPyObject<'a, 'py> {
    /// What it is to somebody who writes Python.
    const TEXT: &str;
}

/// A count.
impl Expected for usize {
    const TEXT: &str = "an int of at least 1";
}

/// A difference of bytes.
impl Expected for u8 {
    const TEXT: &str = "an int of 0 to 254";
}

impl Expected for f32 {
    const TEXT: &str = "a float";
}

impl Expected for f64 {
    const TEXT: &str = "a float";
}

impl Expected for bool {
    const TEXT: &str = "a bool";
}

impl Expected for String {
    const TEXT: &str = "a str";
}

/// The value of the argument `name`. That it has its type doesn't mean that it is in range.
pub(crate) fn extract<T: Expected>(name: &str, value: &Bound<'_, PyAny>) -> PyResult<T> {
    let error: PyErr = match value.extract::<T>() {
        Ok(value) => return Ok(value),
        Err(error) => error.into(),
    };
    let py = value.py();
    if error.is_instance_of::<PyOverflowError>(py) {
        Err(PyValueError::new_err(format!("{name}: got {}, expected {}", value.repr()?, T::TEXT)))
    } else if error.is_instance_of::<PyTypeError>(py) {
        Err(PyTypeError::new_err(format!("{name}: got {}, expected {}", value.get_type().name()?, T::TEXT)))
    } else {
        Err(error)
    }
}
