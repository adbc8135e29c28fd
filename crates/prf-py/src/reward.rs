//! `prf.reward` and `prf.distance`

use numpy::PyArray1;
use prf_core::{DescriptorKind, DirectDescriptor, FrameView, RewardParams, Score, TaskDescriptor};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::batch::{self, Threads};
use crate::error::value_error;
use crate::image::{Picture, Pictures};
use crate::limits::check_picture;
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

/// :func:`reward` of many frames and one goal, on several threads.
///
/// :meth:`DirectGoal.rewards` is the same for a goal that is used more than once.
///
/// Parameters
/// ----------
/// goal : (H, W) ndarray of uint8
///     What the finished task looks like, in grey.
/// frames : (N, h, w) ndarray of uint8
///     What is compared with it. N may be 0.
/// orientations, signed, cell, cell_px, block_cells, norm, scale
///     As for :func:`distance`.
/// threads : int, 1 to 1024, optional
///     The most threads; as many as there are cores where it isn't given. The result is the same.
///
/// Returns
/// -------
/// (N,) ndarray of float32
///     What :func:`reward` gives for each.
///
/// Raises
/// ------
/// TypeError, ValueError
///     As :func:`distance`.
///
/// Examples
/// --------
/// >>> import numpy as np
/// >>> import prf
/// >>> goal = np.zeros((84, 84), np.uint8)
/// >>> goal[10:30, 10:20] = 255
/// >>> prf.reward_batch(goal, np.stack([goal, np.roll(goal, 5, axis=1)]))
/// array([1., 1.], dtype=float32)
#[pyfunction]
#[pyo3(
    signature = (goal, frames, **options),
    text_signature = "(goal, frames, *, orientations=9, signed=False, cell=None, cell_px=None, block_cells=1, \
                      norm='l2', scale='sqrt-blocks', threads=None)"
)]
pub(crate) fn reward_batch<'py>(
    goal: &Bound<'py, PyAny>,
    frames: &Bound<'py, PyAny>,
    options: Option<Bound<'py, PyDict>>,
) -> PyResult<Bound<'py, PyArray1<f32>>> {
    scores(goal, frames, Options::new("reward_batch", options), |score| score.reward)
}

/// :func:`distance` of many frames and one goal, on several threads.
///
/// Parameters
/// ----------
/// goal : (H, W) ndarray of uint8
///     What the finished task looks like, in grey.
/// frames : (N, h, w) ndarray of uint8
///     What is compared with it. N may be 0.
/// orientations, signed, cell, cell_px, block_cells, norm, scale
///     As for :func:`distance`.
/// threads : int, 1 to 1024, optional
///     The most threads; as many as there are cores where it isn't given. The result is the same.
///
/// Returns
/// -------
/// (N,) ndarray of float32
///     What :func:`distance` gives for each.
///
/// Raises
/// ------
/// TypeError, ValueError
///     As :func:`distance`.
///
/// Examples
/// --------
/// >>> import numpy as np
/// >>> import prf
/// >>> goal = np.zeros((84, 84), np.uint8)
/// >>> goal[10:30, 10:20] = 255
/// >>> prf.distance_batch(goal, np.stack([goal, np.roll(goal, 5, axis=1)]))
/// array([0., 0.], dtype=float32)
#[pyfunction]
#[pyo3(
    signature = (goal, frames, **options),
    text_signature = "(goal, frames, *, orientations=9, signed=False, cell=None, cell_px=None, block_cells=1, \
                      norm='l2', scale='sqrt-blocks', threads=None)"
)]
pub(crate) fn distance_batch<'py>(
    goal: &Bound<'py, PyAny>,
    frames: &Bound<'py, PyAny>,
    options: Option<Bound<'py, PyDict>>,
) -> PyResult<Bound<'py, PyArray1<f32>>> {
    scores(goal, frames, Options::new("distance_batch", options), |score| score.distance)
}

fn score(goal: &Bound<'_, PyAny>, frame: &Bound<'_, PyAny>, options: Options<'_>) -> PyResult<Score> {
    let params = options.reward(DescriptorKind::Direct.paper_cell())?;
    options.finish()?;
    let py = frame.py();
    let (goal, frame) = (Picture::read("goal", goal)?, Picture::read("frame", frame)?);
    let (goal, frame) = (goal.view()?, frame.view()?);
    py.detach(|| {
        check_picture(&params.hog, frame)?;
        let mut descriptor = descriptor(goal, params)?;
        descriptor.observe(frame).map_err(|error| value_error("frame", &error))
    })
}

fn scores<'py>(
    goal: &Bound<'py, PyAny>,
    frames: &Bound<'py, PyAny>,
    options: Options<'py>,
    value: impl Fn(Score) -> f32 + Sync,
) -> PyResult<Bound<'py, PyArray1<f32>>> {
    let params = options.reward(DescriptorKind::Direct.paper_cell())?;
    let threads = Threads::read(&options)?;
    options.finish()?;
    let (goal, frames) = (Picture::read("goal", goal)?, Pictures::read("frames", frames)?);
    let (goal, mut views, [height, width]) = (goal.view()?, frames.views()?, frames.shape());
    let descriptor = frames.py().detach(|| {
        views.try_for_each(|frame| check_picture(&params.hog, frame))?;
        descriptor(goal, params)
    })?;
    batch::each("frames", &frames, threads, descriptor, &[], |descriptor, pixels, values| {
        values[0] = value(descriptor.observe(FrameView::new(width, height, pixels)?)?);
        Ok(())
    })
}

fn descriptor(goal: FrameView<'_>, params: RewardParams) -> PyResult<DirectDescriptor> {
    check_picture(&params.hog, goal)?;
    DirectDescriptor::new(&goal.to_frame(), params).map_err(|error| value_error("goal", &error))
}
