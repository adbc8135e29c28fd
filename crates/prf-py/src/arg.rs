//! Arguments that say by themselves what is wrong with them.

use pyo3::exceptions::{PyOverflowError, PyTypeError, PyValueError};
use pyo3::prelude::*;

/// An argument of another type than an array. It is converted before its name is known, so what is
/// wrong with it is only told by [`Arg::get`].
pub(crate) struct Arg<T>(Result<T, Wrong>);

enum Wrong {
    /// The name of the type that was got.
    Type(String),
    /// The value that was got, which doesn't fit, as Python prints it.
    Value(String),
}

/// A type that an argument may have.
pub(crate) trait Expected {
    /// What it is to somebody who writes Python.
    const TEXT: &str;
}

/// A count.
impl Expected for usize {
    const TEXT: &str = "an int of at least 1";
}

impl Expected for f32 {
    const TEXT: &str = "a float";
}

impl Expected for bool {
    const TEXT: &str = "a bool";
}

impl Expected for String {
    const TEXT: &str = "a str";
}

impl<T: Expected> Arg<T> {
    /// A default.
    pub(crate) fn of(value: T) -> Arg<T> {
        Arg(Ok(value))
    }

    /// The value of the argument `name`. That it has its type doesn't mean that it is in range.
    pub(crate) fn get(self, name: &str) -> PyResult<T> {
        self.0.map_err(|wrong| {
            let message = |got| format!("{name}: got {got}, expected {}", T::TEXT);
            match wrong {
                Wrong::Type(got) => PyTypeError::new_err(message(got)),
                Wrong::Value(got) => PyValueError::new_err(message(got)),
            }
        })
    }
}

impl<'a, 'py, T: FromPyObject<'a, 'py>> FromPyObject<'a, 'py> for Arg<T> {
    type Error = PyErr;

    fn extract(value: Borrowed<'a, 'py, PyAny>) -> PyResult<Arg<T>> {
        let error: PyErr = match value.extract::<T>() {
            Ok(value) => return Ok(Arg(Ok(value))),
            Err(error) => error.into(),
        };
        if error.is_instance_of::<PyOverflowError>(value.py()) {
            Ok(Arg(Err(Wrong::Value(value.repr()?.to_string()))))
        } else if error.is_instance_of::<PyTypeError>(value.py()) {
            Ok(Arg(Err(Wrong::Type(value.get_type().name()?.to_string()))))
        } else {
            Err(error)
        }
    }
}
