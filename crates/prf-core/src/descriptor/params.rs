//! Which descriptor shows the task.

use serde::{Deserialize, Serialize};

use super::{DirectDescriptor, MotionDescriptor, TaskDescriptor, WindowDescriptor, WindowParams};
use crate::{CellSize, Error, Frame, MotionParams, RewardParams};

/// How a goal becomes a template.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum DescriptorKind {
    /// The whole picture.
    #[default]
    Direct,
    /// A part of the picture, wherever it is found.
    Window,
    /// What has moved.
    Motion,
}

impl DescriptorKind {
    /// The side of a HOG cell that the paper uses with this descriptor: 0.03 (direct), 0.1 (window) or 0.05 (motion) of the
    /// cropped template's height (section "Experiments and results").
    #[must_use]
    pub fn paper_cell(self) -> CellSize {
        CellSize::Fraction(match self {
            DescriptorKind::Direct => 0.03,
            DescriptorKind::Window => 0.1,
            DescriptorKind::Motion => 0.05,
        })
    }
}

/// A descriptor with the parameters that only it has.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum DescriptorParams {
    /// Makes a [`DirectDescriptor`].
    #[default]
    Direct,
    /// Makes a [`WindowDescriptor`].
    Window(WindowParams),
    /// Makes a [`MotionDescriptor`].
    Motion(MotionParams),
}

/// What the finished task looks like.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Goal {
    /// The picture of the whole screen, of a part of it, or the motion template.
    pub picture: Frame,
    /// Which pixels of a part count: those that are not black here. Of the picture's size.
    pub mask: Option<Frame>,
}

impl Goal {
    /// The picture as it counts: black where the mask is.
    pub(crate) fn seen(&self) -> Frame {
        let mut seen = self.picture.clone();
        if let Some(mask) = &self.mask {
            seen.blacken_outside(mask.view());
        }
        seen
    }
}

impl From<Frame> for Goal {
    fn from(picture: Frame) -> Goal {
        Goal { picture, mask: None }
    }
}

impl DescriptorParams {
    /// The kind of descriptor.
    #[must_use]
    pub fn kind(&self) -> DescriptorKind {
        match self {
            DescriptorParams::Direct => DescriptorKind::Direct,
            DescriptorParams::Window(_) => DescriptorKind::Window,
            DescriptorParams::Motion(_) => DescriptorKind::Motion,
        }
    }

    /// The descriptor for a goal.
    ///
    /// ```
    /// use prf_core::{DescriptorParams, Frame, Goal, RewardParams, WindowParams};
    /// let goal = Goal::from(Frame::from_vec(20, 10, vec![90; 200])?);
    /// let window = DescriptorParams::Window(WindowParams::default());
    /// let mut descriptor = window.describe(&goal, RewardParams::default())?;
    /// assert!(descriptor.prepare([84, 84]).is_ok());
    /// # Ok::<(), prf_core::Error>(())
    /// ```
    ///
    /// # Errors
    ///
    /// As the descriptor's own `new`; [`Error::InvalidParam`] for a mask that this descriptor has no use for.
    pub fn describe(&self, goal: &Goal, params: RewardParams) -> Result<Box<dyn TaskDescriptor>, Error> {
        let Goal { picture, mask } = goal;
        if mask.is_some() && self.kind() != DescriptorKind::Window {
            return Err(Error::invalid("mask", &"a picture", "none: only a window has a mask"));
        }
        Ok(match self {
            DescriptorParams::Direct => Box::new(DirectDescriptor::new(picture, params)?),
            DescriptorParams::Window(window) => {
                Box::new(WindowDescriptor::new(picture, mask.as_ref(), *window, params)?)
            }
            DescriptorParams::Motion(motion) => Box::new(MotionDescriptor::new(picture, *motion, params)?),
        })
    }
}
