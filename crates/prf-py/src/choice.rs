//! One of several names, which are the same as in configuration files.

use std::error::Error;
use std::fmt::{self, Display, Formatter};

use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyString;
use serde::de::{self, DeserializeOwned, IntoDeserializer};

/// What the argument `name` means by `got`.
pub(crate) fn choice<T: DeserializeOwned>(py: Python<'_>, name: &str, got: &str) -> PyResult<T> {
    T::deserialize(got.into_deserializer()).map_err(|error| match error {
        Refused::Unknown(names) => unknown(py, name, got, names.iter().copied()),
        Refused::Otherwise(message) => PyValueError::new_err(format!("{name}: {message}")),
    })
}

/// The exception for an argument `name` that is none of these names.
pub(crate) fn unknown<'a>(py: Python<'_>, name: &str, got: &str, names: impl Iterator<Item = &'a str>) -> PyErr {
    let names: Vec<_> = names.map(|name| format!("'{name}'")).collect();
    let got = PyString::new(py, got).repr();
    got.map_or_else(
        |error| error,
        |got| PyValueError::new_err(format!("{name}: got {got}, expected one of {}", names.join(", "))),
    )
}

/// Why a name is no choice.
#[derive(Debug)]
enum Refused {
    /// It is none of these.
    Unknown(&'static [&'static str]),
    Otherwise(String),
}

impl Display for Refused {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self {
            Refused::Unknown(names) => write!(f, "expected one of {}", names.join(", ")),
            Refused::Otherwise(message) => f.write_str(message),
        }
    }
}

impl Error for Refused {}

impl de::Error for Refused {
    fn custom<T: Display>(message: T) -> Refused {
        Refused::Otherwise(message.to_string())
    }

    fn unknown_variant(_: &str, names: &'static [&'static str]) -> Refused {
        Refused::Unknown(names)
    }
}
