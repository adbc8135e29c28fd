//! Parameters and pictures as Python has them.

use numpy::{PyArray2, PyArrayMethods, ToPyArray};
use prf_core::{CellSize, DeltaSchedule, FrameView, HogParams, MotionParams, RewardParams};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use serde::Serialize;

/// A copy of a picture.
pub(crate) fn picture<'py>(py: Python<'py>, frame: FrameView<'_>) -> PyResult<Bound<'py, PyArray2<u8>>> {
    frame.as_slice().to_pyarray(py).reshape([frame.height(), frame.width()])
}

/// What one of several choices is called, in Python as in configuration files.
pub(crate) fn name_of(choice: &impl Serialize) -> String {
    match serde_json::to_value(choice) {
        Ok(serde_json::Value::String(name)) => name,
        other => unreachable!("a choice without a name: {other:?}"),
    }
}

/// The shortest number that is this one in 32 bits: what was given, not 0.029999999329447746.
pub(crate) fn decimal(value: f32) -> f64 {
    value.to_string().parse().unwrap_or(f64::from(value))
}

/// Adds the keyword arguments that are these parameters.
pub(crate) fn add_motion(options: &Bound<'_, PyDict>, params: &MotionParams) -> PyResult<()> {
    let MotionParams { threshold, tau_start, tau_step, delta, skip_still } = params;
    options.set_item("threshold", threshold)?;
    options.set_item("tau_start", tau_start)?;
    options.set_item("tau_step", tau_step)?;
    match delta {
        DeltaSchedule::Divisor(divisor) => options.set_item("delta_divisor", divisor)?,
        DeltaSchedule::Duration(duration) => options.set_item("duration", duration)?,
    }
    options.set_item("skip_still", skip_still)
}

/// Adds the keyword arguments that are these parameters.
pub(crate) fn add_reward(options: &Bound<'_, PyDict>, params: &RewardParams) -> PyResult<()> {
    let RewardParams { hog: HogParams { orientations, signed, cell, block_cells, norm }, scale } = params;
    options.set_item("orientations", orientations)?;
    options.set_item("signed", signed)?;
    match *cell {
        CellSize::Fraction(fraction) => options.set_item("cell", decimal(fraction))?,
        CellSize::Px(px) => options.set_item("cell_px", px)?,
    }
    options.set_item("block_cells", block_cells)?;
    options.set_item("norm", name_of(norm))?;
    options.set_item("scale", name_of(scale))
}

/// How an object is printed: its class, what is given without a name, and its keyword arguments.
pub(crate) fn repr(class: &str, first: Option<String>, options: &Bound<'_, PyDict>) -> PyResult<String> {
    let mut words: Vec<String> = first.into_iter().collect();
    for (name, value) in options {
        let value = match value.cast::<PyArray2<u8>>() {
            Ok(array) => format!("<{}x{} px>", array.dims()[1], array.dims()[0]),
            Err(_) => value.repr()?.to_string(),
        };
        words.push(format!("{name}={value}"));
    }
    Ok(format!("{class}({})", words.join(", ")))
}
