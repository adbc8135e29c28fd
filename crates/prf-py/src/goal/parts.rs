//! What a goal is made of, in Rust and in Python.

use numpy::{PyArray2, PyArrayMethods, ToPyArray};
use prf_core::{
    CellSize, DeltaSchedule, DescriptorParams, FrameView, HogParams, MotionParams, RewardParams, TaskDescriptor,
    WindowParams,
};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use serde::Serialize;

use crate::error::value_error;

/// A goal, how frames are turned into something that can be compared with it, and how that is compared. These
/// fit each other: a descriptor can be made of them.
#[derive(Clone, Debug)]
pub(crate) struct GoalParts {
    pub(crate) goal: prf_core::Goal,
    pub(crate) descriptor: DescriptorParams,
    pub(crate) params: RewardParams,
}

impl GoalParts {
    pub(crate) fn describe(&self) -> PyResult<Box<dyn TaskDescriptor>> {
        self.descriptor.describe(&self.goal, self.params).map_err(|error| value_error("goal", &error))
    }

    /// The name of the Python class.
    pub(crate) fn class(&self) -> &'static str {
        match self.descriptor {
            DescriptorParams::Direct => "DirectGoal",
            DescriptorParams::Window(_) => "WindowGoal",
            DescriptorParams::Motion(_) => "MotionGoal",
        }
    }

    /// The keyword arguments of the Python class that give this goal again.
    pub(crate) fn options<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let options = PyDict::new(py);
        match &self.descriptor {
            DescriptorParams::Direct => {}
            DescriptorParams::Window(WindowParams { method }) => {
                if let Some(mask) = &self.goal.mask {
                    options.set_item("mask", array(py, mask.view())?)?;
                }
                options.set_item("method", name_of(method))?;
            }
            DescriptorParams::Motion(MotionParams { threshold, tau_start, tau_step, delta, skip_still }) => {
                options.set_item("threshold", threshold)?;
                options.set_item("tau_start", tau_start)?;
                options.set_item("tau_step", tau_step)?;
                match delta {
                    DeltaSchedule::Divisor(divisor) => options.set_item("delta_divisor", divisor)?,
                    DeltaSchedule::Duration(duration) => options.set_item("duration", duration)?,
                }
                options.set_item("skip_still", skip_still)?;
            }
        }
        let RewardParams { hog: HogParams { orientations, signed, cell, block_cells, norm }, scale } = &self.params;
        options.set_item("orientations", orientations)?;
        options.set_item("signed", signed)?;
        match *cell {
            CellSize::Fraction(fraction) => options.set_item("cell", decimal(fraction))?,
            CellSize::Px(px) => options.set_item("cell_px", px)?,
        }
        options.set_item("block_cells", block_cells)?;
        options.set_item("norm", name_of(norm))?;
        options.set_item("scale", name_of(scale))?;
        Ok(options)
    }
}

/// A copy of a picture.
pub(crate) fn array<'py>(py: Python<'py>, frame: FrameView<'_>) -> PyResult<Bound<'py, PyArray2<u8>>> {
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
