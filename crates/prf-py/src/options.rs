//! Keyword arguments as parameters.

use prf_core::{CellSize, HogParams};
use pyo3::exceptions::{PyOverflowError, PyValueError};
use pyo3::prelude::*;
use serde::Deserialize;
use serde::de::IntoDeserializer;
use serde::de::value::Error as ChoiceError;

use crate::error::value_error;

/// An `int` argument that counts something.
pub(crate) enum Count {
    Is(usize),
    /// It is negative or beyond all that can be counted; this is how Python prints it.
    OutOfRange(String),
}

impl<'py> FromPyObject<'_, 'py> for Count {
    type Error = PyErr;

    fn extract(value: Borrowed<'_, 'py, PyAny>) -> PyResult<Count> {
        match value.extract() {
            Ok(count) => Ok(Count::Is(count)),
            Err(error) if error.is_instance_of::<PyOverflowError>(value.py()) => {
                Ok(Count::OutOfRange(value.repr()?.to_string()))
            }
            Err(error) => Err(error),
        }
    }
}

impl Count {
    /// The value of the argument `name`; whether 0 is allowed is checked by `prf_core`.
    fn get(self, name: &str) -> PyResult<usize> {
        match self {
            Count::Is(count) => Ok(count),
            Count::OutOfRange(got) => {
                let message = format!("{name}: got {got}, expected 1 to {}", usize::MAX);
                Err(PyValueError::new_err(message))
            }
        }
    }
}

/// What Python can say about a HOG.
pub(crate) struct HogOptions<'a> {
    pub(crate) orientations: Count,
    pub(crate) signed: bool,
    pub(crate) cell: Option<f32>,
    pub(crate) cell_px: Option<Count>,
    pub(crate) block_cells: Count,
    pub(crate) norm: &'a str,
}

impl HogOptions<'_> {
    /// The same as valid parameters.
    pub(crate) fn params(self) -> PyResult<HogParams> {
        let cell = match (self.cell, self.cell_px) {
            (Some(_), Some(_)) => {
                let message = "got both cell and cell_px, expected one of them: a part of the height or pixels";
                return Err(PyValueError::new_err(message));
            }
            (Some(fraction), None) => CellSize::Fraction(fraction),
            (None, Some(px)) => CellSize::Px(px.get("cell_px")?),
            (None, None) => HogParams::default().cell,
        };
        let params = HogParams {
            orientations: self.orientations.get("orientations")?,
            signed: self.signed,
            cell,
            block_cells: self.block_cells.get("block_cells")?,
            norm: choice("norm", self.norm)?,
        };
        params.validate().map_err(|error| value_error("hog", &error))?;
        Ok(params)
    }
}

/// One of several names, which are the same as in configuration files.
pub(crate) fn choice<'a, T: Deserialize<'a>>(name: &str, value: &'a str) -> PyResult<T> {
    T::deserialize(value.into_deserializer())
        .map_err(|error: ChoiceError| PyValueError::new_err(format!("{name}: {error}")))
}
