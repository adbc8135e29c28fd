//! `prf.motion_template` and `prf.MotionTemplate`

use numpy::{PyArray2, PyArrayMethods, ToPyArray};
use prf_core::{Frame, MotionParams, MotionTemplate as Motion};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict, PyTuple};

use crate::error::value_error;
use crate::exclusive::Exclusive;
use crate::image::{Picture, Pictures};
use crate::options::Options;
use crate::values::{add_motion, decimal, picture, repr};

/// One picture of where and when something moved in a sequence of frames: the motion template.
///
/// A pixel that differs by more than the threshold from the frame before becomes ``tau``, which grows from frame to
/// frame; one that hasn't moved for longer than ``delta`` becomes 0 again. The result is that times ``255 / tau``,
/// so what moved last is white. It is the goal that :class:`MotionGoal` takes.
///
/// Parameters
/// ----------
/// frames : (N, H, W) ndarray of uint8
///     In order. Of fewer than two the template is black.
/// threshold : int, 0 to 254
///     A pixel has moved when it differs by more than this.
/// tau_start : float, 0.001 to 1000
///     ``tau`` of the first movement, between frames 0 and 1.
/// tau_step : float, 0.001 to 1000
///     How much ``tau`` grows from one frame to the next.
/// delta_divisor : float, above 0
///     ``delta`` is ``(t + 1) / delta_divisor`` at movement ``t``, counted from 0. 3 where neither this nor
///     ``duration`` is given.
/// duration : float, at least 0
///     ``delta`` itself, the same at any time, instead of ``delta_divisor``.
/// skip_still : bool
///     Whether frames in which nothing has moved are passed over, so that nothing grows older by them.
///
/// Returns
/// -------
/// (H, W) ndarray of uint8
///     0 where no movement is remembered.
///
/// Raises
/// ------
/// TypeError
///     An argument has another type, or the array another dtype.
/// ValueError
///     An argument is out of range, or the array has another number of dimensions or a side of 0 or above 16384.
///
/// Examples
/// --------
/// >>> import numpy as np
/// >>> import prf
/// >>> frames = np.array([[[255, 0, 0]], [[0, 255, 0]], [[0, 0, 255]]], np.uint8)
/// >>> prf.motion_template(frames)  # tau was 0.1, then 0.5
/// array([[ 51, 255, 255]], dtype=uint8)
#[pyfunction]
#[pyo3(
    signature = (frames, **options),
    text_signature = "(frames, *, threshold=30, tau_start=0.1, tau_step=0.4, delta_divisor=None, duration=None, \
                      skip_still=False)"
)]
pub(crate) fn motion_template<'py>(
    frames: &Bound<'py, PyAny>,
    options: Option<Bound<'py, PyDict>>,
) -> PyResult<Bound<'py, PyArray2<u8>>> {
    let options = Options::new("motion_template", options);
    let params = options.motion()?;
    options.finish()?;
    let py = frames.py();
    let frames = Pictures::read("frames", frames)?;
    let ([height, width], views) = (frames.shape(), frames.views()?);
    let template = py.detach(|| {
        let mut template = Frame::new(width, height);
        Motion::of(params, views)?.history_into(&mut template);
        Ok(template)
    });
    picture(py, template.map_err(|error| value_error("frames", &error))?.view())
}

/// A motion template that takes in one frame after the other.
///
/// Parameters
/// ----------
/// threshold, tau_start, tau_step, delta_divisor, duration, skip_still
///     As for :func:`motion_template`.
///
/// Raises
/// ------
/// TypeError
///     An argument has another type.
/// ValueError
///     An argument is out of range.
///
/// Notes
/// -----
/// It belongs to one thread at a time: where another one is just using it, its methods raise RuntimeError rather
/// than wait. It can be pickled and copied with all that it remembers.
///
/// Examples
/// --------
/// >>> import numpy as np
/// >>> import prf
/// >>> motion = prf.MotionTemplate()
/// >>> for pixels in [[255, 0, 0], [0, 255, 0], [0, 0, 255]]:
/// ...     template = motion.update(np.array([pixels], np.uint8))
/// >>> template
/// array([[ 51, 255, 255]], dtype=uint8)
/// >>> motion.history
/// array([[0.1, 0.5, 0.5]], dtype=float32)
#[pyclass(frozen, module = "prf")]
pub(crate) struct MotionTemplate {
    params: MotionParams,
    motion: Exclusive<Motion>,
}

#[pymethods]
impl MotionTemplate {
    #[new]
    #[pyo3(
        signature = (**options),
        text_signature = "(*, threshold=30, tau_start=0.1, tau_step=0.4, delta_divisor=None, duration=None, \
                          skip_still=False)"
    )]
    fn new(options: Option<Bound<'_, PyDict>>) -> PyResult<MotionTemplate> {
        let options = Options::new("MotionTemplate", options);
        let params = options.motion()?;
        options.finish()?;
        let motion = Motion::new(params).map_err(|error| value_error("motion", &error))?;
        Ok(MotionTemplate { params, motion: Exclusive::new(motion) })
    }

    /// Takes in the next frame of the sequence.
    ///
    /// Parameters
    /// ----------
    /// frame : (H, W) ndarray of uint8
    ///     The first one is only what the second is compared with.
    ///
    /// Returns
    /// -------
    /// (H, W) ndarray of uint8
    ///     The template, as :attr:`template` has it.
    ///
    /// Raises
    /// ------
    /// TypeError
    ///     The frame is no array of ``uint8``.
    /// ValueError
    ///     It has another number of dimensions, a side of 0 or above 16384, or another size than the frames before it.
    /// RuntimeError
    ///     Another thread is using this object.
    fn update<'py>(&self, frame: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyArray2<u8>>> {
        let py = frame.py();
        let frame = Picture::read("frame", frame)?;
        let frame = frame.view()?;
        let template = self.motion.with(py, |motion| {
            motion.observe(frame)?;
            Ok(drawn(motion, Motion::history_into))
        })?;
        picture(py, template.map_err(|error| value_error("frame", &error))?.view())
    }

    /// Begins a new sequence, whose frames may have another size.
    ///
    /// Raises
    /// ------
    /// RuntimeError
    ///     Another thread is using this object.
    fn reset(&self) -> PyResult<()> {
        self.motion.lock()?.reset();
        Ok(())
    }

    /// (H, W) ndarray of uint8: ``255 * history / tau``, so that what moved last is white; (0, 0) before the first frame.
    #[getter]
    fn template<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<u8>>> {
        self.draw(py, Motion::history_into)
    }

    /// (H, W) ndarray of uint8: 255 where a movement is remembered, else 0; (0, 0) before the first frame.
    #[getter]
    fn energy<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<u8>>> {
        self.draw(py, Motion::energy_into)
    }

    /// (H, W) ndarray of float32: ``tau`` of each pixel's last movement, 0 where none is remembered; (0, 0) before the
    /// first frame.
    #[getter]
    fn history<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f32>>> {
        let motion = self.motion.lock()?;
        motion.history().to_pyarray(py).reshape(motion.shape())
    }

    /// float: ``tau`` of the last frame, the largest value in :attr:`history`; 0 before the second frame.
    #[getter]
    fn tau(&self) -> PyResult<f64> {
        Ok(decimal(self.motion.lock()?.tau()))
    }

    /// int: How many frames were compared with the one before them; those that were passed over don't count.
    #[getter]
    fn iterations(&self) -> PyResult<u64> {
        Ok(self.motion.lock()?.iterations())
    }

    /// bool: Whether a movement is remembered anywhere.
    #[getter]
    fn has_motion(&self) -> PyResult<bool> {
        Ok(self.motion.lock()?.has_motion())
    }

    /// Another one that has seen the same frames.
    ///
    /// Raises
    /// ------
    /// RuntimeError
    ///     Another thread is using this object.
    fn copy<'py>(slf: &Bound<'py, MotionTemplate>) -> PyResult<Bound<'py, PyAny>> {
        slf.py().import("copy")?.call_method1("copy", (slf,))
    }

    fn __getnewargs_ex__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyTuple>, Bound<'py, PyDict>)> {
        Ok((PyTuple::empty(py), self.options(py)?))
    }

    fn __getstate__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        Ok(PyBytes::new(py, &self.motion.lock()?.save_state()))
    }

    fn __setstate__(&self, state: &[u8]) -> PyResult<()> {
        self.motion.lock()?.load_state(state).map_err(|error| value_error("state", &error))
    }

    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        repr("MotionTemplate", None, &self.options(py)?)
    }
}

impl MotionTemplate {
    fn options<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let options = PyDict::new(py);
        add_motion(&options, &self.params)?;
        Ok(options)
    }

    fn draw<'py>(&self, py: Python<'py>, draw: fn(&Motion, &mut Frame)) -> PyResult<Bound<'py, PyArray2<u8>>> {
        let motion = self.motion.lock()?;
        if motion.shape() == [0, 0] {
            return Ok(PyArray2::zeros(py, [0, 0], false));
        }
        picture(py, drawn(&motion, draw).view())
    }
}

/// A picture of a template that has seen a frame.
fn drawn(motion: &Motion, draw: fn(&Motion, &mut Frame)) -> Frame {
    let [height, width] = motion.shape();
    let mut frame = Frame::new(width, height);
    draw(motion, &mut frame);
    frame
}
