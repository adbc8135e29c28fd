//! Keyword arguments as parameters.

use prf_core::{CellSize, HogParams};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use serde::de::value::Error as ChoiceError;
use serde::de::{DeserializeOwned, IntoDeserializer};

use crate::arg::Arg;
use crate::error::value_error;

/// What Python can say about a HOG.
pub(crate) struct HogOptions {
    pub(crate) orientations: Arg<usize>,
    pub(crate) signed: Arg<bool>,
    pub(crate) cell: Option<Arg<f32>>,
    pub(crate) cell_px: Option<Arg<usize>>,
    pub(crate) block_cells: Arg<usize>,
    pub(crate) norm: Arg<String>,
}

impl HogOptions {
    /// The same as valid parameters.
    pub(crate) fn params(self) -> PyResult<HogParams> {
        let cell = match (self.cell, self.cell_px) {
            (Some(_), Some(_)) => {
                let message = "got both cell and cell_px, expected one of them: a part of the height or pixels";
                return Err(PyValueError::new_err(message));
            }
            (Some(fraction), None) => CellSize::Fraction(fraction.get("cell")?),
            (None, Some(px)) => CellSize::Px(px.get("cell_px")?),
            (None, None) => HogParams::default().cell,
        };
        let params = HogParams {
            orientations: self.orientations.get("orientations")?,
            signed: self.signed.get("signed")?,
            cell,
            block_cells: self.block_cells.get("block_cells")?,
            norm: choice("norm", self.norm)?,
        };
        params.validate().map_err(|error| value_error("hog", &error))?;
        Ok(params)
    }
}

/// One of several names, which are the same as in configuration files.
pub(crate) fn choice<T: DeserializeOwned>(name: &str, value: Arg<String>) -> PyResult<T> {
    T::deserialize(value.get(name)?.into_deserializer())
        .map_err(|error: ChoiceError| PyValueError::new_err(format!("{name}: {error}")))
}
