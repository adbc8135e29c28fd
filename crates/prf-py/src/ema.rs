//! `prf.EmaState`

use numpy::{IntoPyArray, PyArray2, PyArrayMethods, PyUntypedArrayMethods, ToPyArray};
use prf_core::{EmaState as Ema, Error};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};

use crate::error::value_error;
use crate::exclusive::Exclusive;
use crate::image::Picture;
use crate::options::Options;
use crate::values::{decimal, repr};

/// Exponential moving average of the frames of an episode: what an agent sees in place of a single frame.
///
/// ``a = (1 - decay) * frame + decay * a``, and the first frame itself at first. It is kept as floats.
///
/// Parameters
/// ----------
/// decay : float, at least 0 and below 1
///     Weight of the past.
///
/// Raises
/// ------
/// TypeError, ValueError
///     ``decay`` is no float, or out of range.
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
/// >>> state = prf.EmaState()
/// >>> state.update(np.array([[100, 0]], np.uint8))
/// array([[100,   0]], dtype=uint8)
/// >>> state.update(np.array([[0, 200]], np.uint8))
/// array([[70, 60]], dtype=uint8)
#[pyclass(frozen, module = "prf")]
pub(crate) struct EmaState {
    decay: f32,
    /// Nothing before the first frame, which sets the size.
    average: Exclusive<Option<Average>>,
}

struct Average {
    /// `[height, width]`
    shape: [usize; 2],
    ema: Ema,
}

impl Average {
    fn new(shape: [usize; 2], decay: f32) -> Result<Average, Error> {
        Ok(Average { shape, ema: Ema::new(shape[1], shape[0], decay)? })
    }
}

#[pymethods]
impl EmaState {
    #[new]
    #[pyo3(signature = (**options), text_signature = "(*, decay=0.7)")]
    fn new(options: Option<Bound<'_, PyDict>>) -> PyResult<EmaState> {
        let options = Options::new("EmaState", options);
        let decay = options.get("decay")?.unwrap_or(0.7);
        options.finish()?;
        Average::new([1, 1], decay).map_err(|error| value_error("decay", &error))?;
        Ok(EmaState { decay, average: Exclusive::new(None) })
    }

    /// Takes in the next frame.
    ///
    /// Parameters
    /// ----------
    /// frame : (H, W) ndarray of uint8
    ///     A C-contiguous array is read without a copy.
    ///
    /// Returns
    /// -------
    /// (H, W) ndarray of uint8
    ///     The average, rounded.
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
        let (shape, frame) = (frame.shape(), frame.view()?);
        let updated = self.average.with(py, |average| {
            let average = match average {
                Some(average) if average.shape != shape => {
                    return Err(Error::FrameSize { shape, expected: average.shape });
                }
                Some(average) => average,
                none => none.insert(Average::new(shape, self.decay)?),
            };
            Ok(average.ema.update(frame).to_vec())
        })?;
        updated.map_err(|error| value_error("frame", &error))?.into_pyarray(py).reshape(shape)
    }

    /// Begins an episode, whose frames may have another size.
    ///
    /// Raises
    /// ------
    /// RuntimeError
    ///     Another thread is using this object.
    fn reset(&self) -> PyResult<()> {
        *self.average.lock()? = None;
        Ok(())
    }

    /// float: Weight of the past.
    #[getter]
    fn decay(&self) -> f64 {
        decimal(self.decay)
    }

    /// (H, W) ndarray of uint8: What the last :meth:`update` returned; (0, 0) before the first one.
    #[getter]
    fn state<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<u8>>> {
        match &*self.average.lock()? {
            Some(Average { shape, ema }) => ema.as_slice().to_pyarray(py).reshape(*shape),
            None => Ok(PyArray2::zeros(py, [0, 0], false)),
        }
    }

    /// (H, W) ndarray of float32: The average as it is kept, 0 to 255; (0, 0) before the first frame.
    #[getter]
    fn values<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f32>>> {
        match &*self.average.lock()? {
            Some(Average { shape, ema }) => ema.values().to_pyarray(py).reshape(*shape),
            None => Ok(PyArray2::zeros(py, [0, 0], false)),
        }
    }

    /// Another one that has seen the same frames.
    ///
    /// Raises
    /// ------
    /// RuntimeError
    ///     Another thread is using this object.
    fn copy<'py>(slf: &Bound<'py, EmaState>) -> PyResult<Bound<'py, PyAny>> {
        slf.py().import("copy")?.call_method1("copy", (slf,))
    }

    fn __getnewargs_ex__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyTuple>, Bound<'py, PyDict>)> {
        Ok((PyTuple::empty(py), self.options(py)?))
    }

    fn __getstate__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f32>>> {
        self.values(py)
    }

    fn __setstate__(&self, values: &Bound<'_, PyArray2<f32>>) -> PyResult<()> {
        let shape = [values.shape()[0], values.shape()[1]];
        *self.average.lock()? = match shape {
            [0, 0] => None,
            _ => {
                // Row by row, whatever the order of the array itself is.
                let values = values.call_method0("copy")?.cast_into::<PyArray2<f32>>()?.try_readonly()?;
                let values = values.as_slice()?;
                let restored = Average::new(shape, self.decay).and_then(|mut average| {
                    average.ema.restore(values)?;
                    Ok(average)
                });
                Some(restored.map_err(|error| value_error("state", &error))?)
            }
        };
        Ok(())
    }

    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        repr("EmaState", None, &self.options(py)?)
    }
}

impl EmaState {
    fn options<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let options = PyDict::new(py);
        options.set_item("decay", self.decay())?;
        Ok(options)
    }
}
