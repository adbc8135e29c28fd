//! What a goal is made of, in Rust and in Python.

use prf_core::{DescriptorParams, RewardParams, TaskDescriptor, WindowParams};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::error::value_error;
use crate::values::{add_motion, add_reward, name_of, picture};

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
                    options.set_item("mask", picture(py, mask.view())?)?;
                }
                options.set_item("method", name_of(method))?;
            }
            DescriptorParams::Motion(motion) => add_motion(&options, motion)?,
        }
        add_reward(&options, &self.params)?;
        Ok(options)
    }
}
