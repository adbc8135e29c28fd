//! `prf.reward` and `prf.distance`

use prf_core::{DescriptorKind, DirectDescriptor, FrameView, RewardParams, Score, TaskDescriptor, crop_box};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::error::value_error;
use crate::image::Picture;
use crate::limits::check_features;
use crate::options::Options;

/// How much a frame looks like the goal: ``exp(-distance(goal, frame, ...))``.
///
/// Takes the arguments of :func:`distance` and raises the same errors.
///
/// Returns
/// -------
/// float
///     Above 0 and at most 1; exactly 1 for the goal itself.
///
/// Examples
/// --------
/// >>> import numpy as np
/// >>> import prf
/// >>> goal = np.zeros((84, 84), np.uint8)
/// >>> frame = goal.copy()
/// >>> frame[20:60, 30:40] = 255
/// >>> frame[70:74, 10:70] = 128
/// >>> prf.reward(goal, goal)
/// 1.0
/// >>> 0 < prf.reward(goal, frame) < 1
/// True
#[pyfunction]
#[pyo3(
    signature = (goal, frame, **options),
    text_signature = "(goal, frame, *, orientations=9, signed=False, cell=None, cell_px=None, block_cells=1, \
                      norm='l2', scale='sqrt-blocks')"
)]
pub(crate) fn reward(
    goal: &Bound<'_, PyAny>,
    frame: &Bound<'_, PyAny>,
    options: Option<Bound<'_, PyDict>>,
) -> PyResult<f32> {
    Ok(score(goal, frame, Options::new("reward", options))?.reward)
}

/// Distance between the HOGs of a goal and a frame.
///
/// Both pictures are cropped to what is not black, the one with the smaller area is rescaled to the
/// other's size, and the Euclidean distance of their HOGs is divided as ``scale`` says. Where a crop is
/// too small for a block of cells, cells and then blocks shrink until one fits.
///
/// Parameters
/// ----------
/// goal : (H, W) ndarray of uint8
///     What the finished task looks like, in grey.
/// frame : (H, W) ndarray of uint8
///     What is compared with it; may have another size. A C-contiguous array is read without a copy.
/// orientations, signed, cell, cell_px, block_cells, norm
///     As for :func:`hog`; ``cell`` is a part of the height of the crops at their common size.
/// scale : {"none", "sqrt-blocks", "sqrt-features"}
///     What the distance is divided by: 1, the square root of the number of blocks, or that of the
///     number of features. With "sqrt-blocks" and an L1 or L2 norm it is at most the square root of 2.
///
/// Returns
/// -------
/// float
///     At least 0; 0 for the goal itself.
///
/// Raises
/// ------
/// TypeError
///     An argument has another type, or an array another dtype.
/// ValueError
///     An argument is out of range, an array has another number of dimensions or a side of 0 or above
///     16384, or the cropped goal has no room for a block.
///
/// Examples
/// --------
/// >>> import numpy as np
/// >>> import prf
/// >>> goal = np.zeros((84, 84), np.uint8)
/// >>> goal[10:30, 10:20] = 255
/// >>> prf.distance(goal, np.roll(goal, 5, axis=1))  # cropping takes the shift away
/// 0.0
#[pyfunction]
#[pyo3(
    signature = (goal, frame, **options),
    text_signature = "(goal, frame, *, orientations=9, signed=False, cell=None, cell_px=None, block_cells=1, \
                      norm='l2', scale='sqrt-blocks')"
)]
pub(crate) fn distance(
    goal: &Bound<'_, PyAny>,
    frame: &Bound<'_, PyAny>,
    options: Option<Bound<'_, PyDict>>,
) -> PyResult<f32> {
    Ok(score(goal, frame, Options::new("distance", options))?.distance)
}

fn score(goal: &Bound<'_, PyAny>, frame: &Bound<'_, PyAny>, options: Options<'_>) -> PyResult<Score> {
    let params = options.reward(DescriptorKind::Direct.paper_cell())?;
    options.finish()?;
    let py = goal.py();
    let (goal, frame) = (Picture::read("goal", goal)?, Picture::read("frame", frame)?);
    let (goal, frame) = (goal.view()?, frame.view()?);
    py.detach(|| compare(goal, frame, params))
}

fn compare(goal: FrameView<'_>, frame: FrameView<'_>, params: RewardParams) -> PyResult<Score> {
    let goal = goal.to_frame();
    // The common size is one of the two crops', so checking both is checking it.
    for picture in [goal.view(), frame] {
        let crop = crop_box(picture);
        check_features(&params.hog, [crop.height, crop.width])?;
    }
    let mut descriptor = DirectDescriptor::new(&goal, params).map_err(|error| value_error("goal", &error))?;
    descriptor.observe(frame).map_err(|error| value_error("frame", &error))
}
