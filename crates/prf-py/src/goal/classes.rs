//! `prf.DirectGoal`, `prf.WindowGoal` and `prf.MotionGoal`

use numpy::PyArray2;
use prf_core::{DeltaSchedule, DescriptorKind, DescriptorParams, MotionParams, WindowParams};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use super::parts::GoalParts;
use super::{Goal, source};
use crate::options::Options;
use crate::values::{name_of, picture};

/// The whole frame is to look like a picture.
///
/// Both are cropped to what is not black, the one with the smaller area is rescaled to the other's size,
/// and their HOGs are compared, as by :func:`distance`. Frames may have any size.
///
/// Parameters
/// ----------
/// goal : (H, W) ndarray of uint8, str or os.PathLike
///     What the finished task looks like, in grey: 0 is its background. Or the path of a PNG, JPEG, BMP, WebP
///     or GIF; colours become grey.
/// orientations, signed, cell, cell_px, block_cells, norm, scale
///     As for :func:`distance`; ``cell`` is 0.03 where neither it nor ``cell_px`` is given.
///
/// Raises
/// ------
/// TypeError
///     An argument has another type, or an array another dtype.
/// ValueError
///     An argument is out of range, an array has another number of dimensions or a side of 0 or above 16384,
///     a file holds no picture, or the cropped goal has no room for a block.
/// OSError
///     A file can't be read; FileNotFoundError where there is none.
///
/// Examples
/// --------
/// >>> import numpy as np
/// >>> import prf
/// >>> goal = prf.DirectGoal(np.zeros((84, 84), np.uint8))
/// >>> frame = np.zeros((84, 84), np.uint8)
/// >>> goal.reward(frame)
/// 1.0
/// >>> frame[20:60, 30:40] = 255
/// >>> frame[70:74, 10:70] = 128
/// >>> goal.reward(frame) < 1
/// True
#[pyclass(frozen, extends = Goal, module = "prf")]
pub(crate) struct DirectGoal;

#[pymethods]
impl DirectGoal {
    #[new]
    #[pyo3(
        signature = (goal, **options),
        text_signature = "(goal, *, orientations=9, signed=False, cell=None, cell_px=None, block_cells=1, norm='l2', \
                          scale='sqrt-blocks')"
    )]
    fn new(goal: &Bound<'_, PyAny>, options: Option<Bound<'_, PyDict>>) -> PyResult<PyClassInitializer<DirectGoal>> {
        let py = goal.py();
        let options = Options::new("DirectGoal", options);
        let params = options.reward(DescriptorKind::Direct.paper_cell())?;
        options.finish()?;
        let goal = source::picture("goal", goal)?.into();
        let parts = GoalParts { goal, descriptor: DescriptorParams::Direct, params };
        Ok(PyClassInitializer::from(Goal::new(py, parts)?).add_subclass(DirectGoal))
    }
}

/// A part of the frame is to look like a picture, wherever it is found.
///
/// The goal slides over the frame; the window of the highest correlation is compared with it as by
/// :func:`distance`. Frames have to be at least as wide and as high as the goal.
///
/// Parameters
/// ----------
/// goal : (H, W) ndarray of uint8, str or os.PathLike
///     A cut-out that shows the finished task, in grey. Or the path of a PNG, JPEG, BMP, WebP or GIF.
/// mask : (H, W) ndarray of uint8 or bool, str or os.PathLike, optional
///     Of the goal's size: only pixels that are not 0 here count.
/// method : {"ccorr-normed", "ccoeff-normed"}
///     The correlation, as for :func:`match_template`.
/// orientations, signed, cell, cell_px, block_cells, norm, scale
///     As for :func:`distance`; but ``cell`` is 0.1 where neither it nor ``cell_px`` is given.
///
/// Raises
/// ------
/// TypeError, ValueError, OSError
///     As :class:`DirectGoal`; also ValueError where the mask has another size or is 0 all over.
///
/// Examples
/// --------
/// >>> import numpy as np
/// >>> import prf
/// >>> frame = np.random.default_rng(0).integers(1, 256, (84, 84), np.uint8)
/// >>> goal = prf.WindowGoal(frame[30:39, 50:62])
/// >>> goal.score(frame)
/// Score(reward=1.0, distance=0.0, match=Match(x=50, y=30, width=12, height=9, score=1.0))
#[pyclass(frozen, extends = Goal, module = "prf")]
pub(crate) struct WindowGoal;

#[pymethods]
impl WindowGoal {
    #[new]
    #[pyo3(
        signature = (goal, **options),
        text_signature = "(goal, *, mask=None, method='ccorr-normed', orientations=9, signed=False, cell=None, \
                          cell_px=None, block_cells=1, norm='l2', scale='sqrt-blocks')"
    )]
    fn new(goal: &Bound<'_, PyAny>, options: Option<Bound<'_, PyDict>>) -> PyResult<PyClassInitializer<WindowGoal>> {
        let py = goal.py();
        let options = Options::new("WindowGoal", options);
        let mask = options.raw("mask")?.filter(|mask| !mask.is_none());
        let window = WindowParams { method: options.choice("method")?.unwrap_or_default() };
        let params = options.reward(DescriptorKind::Window.paper_cell())?;
        options.finish()?;
        let picture = source::picture("goal", goal)?;
        let mask = mask.map(|mask| source::mask(&mask)).transpose()?;
        let goal = prf_core::Goal { picture, mask };
        let parts = GoalParts { goal, descriptor: DescriptorParams::Window(window), params };
        Ok(PyClassInitializer::from(Goal::new(py, parts)?).add_subclass(WindowGoal))
    }

    /// (H, W) ndarray of uint8 or None: Which pixels of the goal count, those that are not 0 here.
    #[getter]
    fn mask<'py>(slf: &Bound<'py, WindowGoal>) -> PyResult<Option<Bound<'py, PyArray2<u8>>>> {
        let mask = &slf.as_super().get().parts.goal.mask;
        mask.as_ref().map(|mask| picture(slf.py(), mask.view())).transpose()
    }

    /// str: The correlation by which the window is found.
    #[getter]
    fn method(slf: &Bound<'_, WindowGoal>) -> Option<String> {
        match &slf.as_super().get().parts.descriptor {
            DescriptorParams::Window(window) => Some(name_of(&window.method)),
            _ => None,
        }
    }
}

/// What moves in an episode is to move as in a sequence.
///
/// The motion template of the episode's frames so far is compared with the sequence's as by :func:`distance`.
/// Only where and in which order something moves counts. All frames of an episode have one size, which need not be
/// the goal's. Call :meth:`reset` at the beginning of each episode.
///
/// Parameters
/// ----------
/// goal : (N, H, W) or (H, W) ndarray of uint8, str or os.PathLike
///     Frames that show the movement, in order; or their motion template, as :func:`motion_template` makes it.
///     Or the path of an animation (GIF, PNG, WebP), a folder of pictures, a y4m or another video, for which
///     ffmpeg has to be on the PATH; a file with one picture is a motion template.
/// threshold, tau_start, tau_step, delta_divisor, duration, skip_still
///     As for :func:`motion_template`; for the goal and for episodes.
/// orientations, signed, cell, cell_px, block_cells, norm, scale
///     As for :func:`distance`; but ``cell`` is 0.05 where neither it nor ``cell_px`` is given.
///
/// Raises
/// ------
/// TypeError, ValueError, OSError
///     As :class:`DirectGoal`; also ValueError where a sequence has fewer than two frames, or nothing moves in it,
///     or all that moved is forgotten by its end.
///
/// Warns
/// -----
/// UserWarning
///     Of at least three movements the goal's template holds only the newest, so it has no direction.
///
/// Examples
/// --------
/// >>> import numpy as np
/// >>> import prf
/// >>> frames = np.zeros((5, 40, 40), np.uint8)  # a bar that grows downwards
/// >>> for t in range(5):
/// ...     frames[t, 5 : 12 + 6 * t, 10:30] = 255
/// >>> goal = prf.MotionGoal(frames)
/// >>> goal.reset(frames[0])
/// >>> rewards = [goal.reward(frame) for frame in frames[1:]]
/// >>> rewards[0] < rewards[-1] == 1.0
/// True
#[pyclass(frozen, extends = Goal, module = "prf")]
pub(crate) struct MotionGoal;

impl MotionGoal {
    fn params(slf: &Bound<'_, MotionGoal>) -> MotionParams {
        match slf.as_super().get().parts.descriptor {
            DescriptorParams::Motion(motion) => motion,
            _ => MotionParams::default(),
        }
    }
}

#[pymethods]
impl MotionGoal {
    #[new]
    #[pyo3(
        signature = (goal, **options),
        text_signature = "(goal, *, threshold=30, tau_start=0.1, tau_step=0.4, delta_divisor=None, duration=None, \
                          skip_still=False, orientations=9, signed=False, cell=None, cell_px=None, block_cells=1, \
                          norm='l2', scale='sqrt-blocks')"
    )]
    fn new(goal: &Bound<'_, PyAny>, options: Option<Bound<'_, PyDict>>) -> PyResult<PyClassInitializer<MotionGoal>> {
        let py = goal.py();
        let options = Options::new("MotionGoal", options);
        let motion = options.motion()?;
        let params = options.reward(DescriptorKind::Motion.paper_cell())?;
        options.finish()?;
        let goal = source::motion(goal, motion)?.into();
        let parts = GoalParts { goal, descriptor: DescriptorParams::Motion(motion), params };
        Ok(PyClassInitializer::from(Goal::new(py, parts)?).add_subclass(MotionGoal))
    }

    /// int: A pixel has moved when it differs by more than this from the frame before.
    #[getter]
    fn threshold(slf: &Bound<'_, MotionGoal>) -> u8 {
        MotionGoal::params(slf).threshold
    }

    /// float: The time of the first movement.
    #[getter]
    fn tau_start(slf: &Bound<'_, MotionGoal>) -> f64 {
        MotionGoal::params(slf).tau_start
    }

    /// float: How much the time grows from one frame to the next.
    #[getter]
    fn tau_step(slf: &Bound<'_, MotionGoal>) -> f64 {
        MotionGoal::params(slf).tau_step
    }

    /// float or None: A movement of frame t is remembered for (t + 1) / delta_divisor, unless ``duration`` says it.
    #[getter]
    fn delta_divisor(slf: &Bound<'_, MotionGoal>) -> Option<f64> {
        match MotionGoal::params(slf).delta {
            DeltaSchedule::Divisor(divisor) => Some(divisor),
            DeltaSchedule::Duration(_) => None,
        }
    }

    /// float or None: How long a movement is remembered, unless ``delta_divisor`` says it.
    #[getter]
    fn duration(slf: &Bound<'_, MotionGoal>) -> Option<f64> {
        match MotionGoal::params(slf).delta {
            DeltaSchedule::Duration(duration) => Some(duration),
            DeltaSchedule::Divisor(_) => None,
        }
    }

    /// bool: Whether frames in which nothing moves are passed over.
    #[getter]
    fn skip_still(slf: &Bound<'_, MotionGoal>) -> bool {
        MotionGoal::params(slf).skip_still
    }
}
