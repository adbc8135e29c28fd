//! Keyword arguments as parameters.

use prf_core::{CellSize, DeltaSchedule, HogParams, MotionParams, RewardParams};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use serde::de::DeserializeOwned;

use crate::arg::{Expected, extract};
use crate::choice::choice;
use crate::error::value_error;

/// The keyword arguments of a call that nobody has asked for yet.
pub(crate) struct Options<'py> {
    function: &'static str,
    given: Option<Bound<'py, PyDict>>,
}

impl<'py> Options<'py> {
    pub(crate) fn new(function: &'static str, given: Option<Bound<'py, PyDict>>) -> Options<'py> {
        Options { function, given }
    }

    /// The argument `name` as it was given.
    pub(crate) fn raw(&self, name: &str) -> PyResult<Option<Bound<'py, PyAny>>> {
        let Some(given) = &self.given else { return Ok(None) };
        let value = given.get_item(name)?;
        if value.is_some() {
            given.del_item(name)?;
        }
        Ok(value)
    }

    /// The argument `name`, if it was given.
    pub(crate) fn get<T: Expected>(&self, name: &str) -> PyResult<Option<T>> {
        self.raw(name)?.map(|value| extract(name, &value)).transpose()
    }

    /// The argument `name`, which may also be `None`.
    pub(crate) fn get_optional<T: Expected>(&self, name: &str) -> PyResult<Option<T>> {
        let value = self.raw(name)?.filter(|value| !value.is_none());
        value.map(|value| extract(name, &value)).transpose()
    }

    /// The argument `name`, which is one of several names.
    pub(crate) fn choice<T: DeserializeOwned>(&self, name: &str) -> PyResult<Option<T>> {
        let Some(value) = self.raw(name)? else { return Ok(None) };
        choice(value.py(), name, &extract::<String>(name, &value)?).map(Some)
    }

    /// What HOGs are told, valid. `cell` is the side where none is given.
    pub(crate) fn hog(&self, cell: CellSize) -> PyResult<HogParams> {
        let default = HogParams::default();
        let either = self.either(["cell", "cell_px"], "a part of the height or pixels")?;
        let params = HogParams {
            orientations: self.get("orientations")?.unwrap_or(default.orientations),
            signed: self.get("signed")?.unwrap_or(default.signed),
            cell: match either {
                [Some(fraction), _] => CellSize::Fraction(extract("cell", &fraction)?),
                [_, Some(px)] => CellSize::Px(extract("cell_px", &px)?),
                _ => cell,
            },
            block_cells: self.get("block_cells")?.unwrap_or(default.block_cells),
            norm: self.choice("norm")?.unwrap_or(default.norm),
        };
        params.validate().map_err(|error| value_error("hog", &error))?;
        Ok(params)
    }

    /// What rewards are told, valid. `cell` is the side of a cell where none is given.
    pub(crate) fn reward(&self, cell: CellSize) -> PyResult<RewardParams> {
        Ok(RewardParams { hog: self.hog(cell)?, scale: self.choice("scale")?.unwrap_or_default() })
    }

    /// What motion templates are told, valid.
    pub(crate) fn motion(&self) -> PyResult<MotionParams> {
        let default = MotionParams::default();
        let either = self.either(["delta_divisor", "duration"], "two ways to say how long a movement is remembered")?;
        let params = MotionParams {
            threshold: self.get("threshold")?.unwrap_or(default.threshold),
            tau_start: self.get("tau_start")?.unwrap_or(default.tau_start),
            tau_step: self.get("tau_step")?.unwrap_or(default.tau_step),
            delta: match either {
                [Some(divisor), _] => DeltaSchedule::Divisor(extract("delta_divisor", &divisor)?),
                [_, Some(duration)] => DeltaSchedule::Duration(extract("duration", &duration)?),
                _ => default.delta,
            },
            skip_still: self.get("skip_still")?.unwrap_or(default.skip_still),
        };
        params.validate().map_err(|error| value_error("motion", &error))?;
        Ok(params)
    }

    /// At most one of two arguments.
    fn either(&self, names: [&str; 2], what: &str) -> PyResult<[Option<Bound<'py, PyAny>>; 2]> {
        let [a, b] = names;
        let values = [self.raw(a)?, self.raw(b)?].map(|value| value.filter(|value| !value.is_none()));
        if values.iter().all(Option::is_some) {
            return Err(PyValueError::new_err(format!("got both {a} and {b}, expected one of them: {what}")));
        }
        Ok(values)
    }

    /// Refuses an argument that nobody has asked for.
    pub(crate) fn finish(self) -> PyResult<()> {
        let Some((name, _)) = self.given.and_then(|given| given.iter().next()) else { return Ok(()) };
        let message = format!("{}() got an unexpected keyword argument {}", self.function, name.repr()?);
        Err(PyTypeError::new_err(message))
    }
}
