//! NumPy arrays as pictures.

use numpy::ndarray::{Dimension, Ix2, Ix3};
use numpy::{Element, PyArray, PyReadonlyArray, PyUntypedArray, prelude::*};
use prf_core::{Frame, FrameView};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::{IntoPyDict, PyType};

use crate::error::value_error;
use crate::limits::MAX_SIDE;

/// One picture or several of one size.
pub(crate) trait Rank: Dimension {
    const SHAPE: &str;
}

impl Rank for Ix2 {
    const SHAPE: &str = "(height, width)";
}

impl Rank for Ix3 {
    const SHAPE: &str = "(count, height, width)";
}

/// An array that was given as pictures. Its rows lie one after the other.
pub(crate) struct Array<'py, T: Element, R: Rank>(PyReadonlyArray<'py, T, R>);

/// A grey picture of bytes.
pub(crate) type Picture<'py> = Array<'py, u8, Ix2>;

/// Grey pictures of bytes. There may be none of them, but they have a size.
pub(crate) type Pictures<'py> = Array<'py, u8, Ix3>;

impl<'py, R: Rank> Array<'py, u8, R> {
    /// Takes the argument `name`, which must be an array of `uint8`.
    pub(crate) fn read(name: &str, value: &Bound<'py, PyAny>) -> PyResult<Self> {
        let array = untyped::<R>(name, value)?;
        Array::of(name, array)?.ok_or_else(|| {
            let hint = "uint8; for floats in [0, 1] give (255 * array).round().astype(np.uint8)";
            wrong_dtype(name, array, hint)
        })
    }
}

impl Picture<'_> {
    /// The picture, which can be read without the GIL.
    pub(crate) fn view(&self) -> PyResult<FrameView<'_>> {
        view(self.shape(), self.pixels()?)
    }
}

impl<T: Element> Array<'_, T, Ix3> {
    /// How many pictures there are.
    pub(crate) fn count(&self) -> usize {
        self.0.shape()[0]
    }
}

impl Pictures<'_> {
    /// The pictures in order, which can be read without the GIL.
    pub(crate) fn views(&self) -> PyResult<Vec<FrameView<'_>>> {
        let [height, width] = self.shape();
        self.pixels()?.chunks_exact(height * width).map(|pixels| view([height, width], pixels)).collect()
    }
}

impl<'py, T: Element, R: Rank> Array<'py, T, R> {
    /// Nothing where the array holds values of another type.
    fn of(name: &str, array: &Bound<'py, PyUntypedArray>) -> PyResult<Option<Self>> {
        if !array.dtype().is_equiv_to(&T::get_dtype(array.py())) {
            return Ok(None);
        }
        check_shape::<R>(name, array.shape())?;
        let array = array.cast::<PyArray<T, R>>()?;
        if array.is_c_contiguous() && array.is_aligned() {
            return Ok(Some(Array(array.try_readonly()?)));
        }
        let numpy = array.py().import("numpy")?;
        let copy = numpy.call_method("array", (array,), Some(&[("order", "C")].into_py_dict(array.py())?))?;
        Ok(Some(Array(copy.cast::<PyArray<T, R>>()?.try_readonly()?)))
    }

    pub(crate) fn py(&self) -> Python<'py> {
        self.0.py()
    }

    /// `[height, width]` of a picture.
    pub(crate) fn shape(&self) -> [usize; 2] {
        let shape = self.0.shape();
        [shape[shape.len() - 2], shape[shape.len() - 1]]
    }

    /// Row by row; can be read without the GIL.
    pub(crate) fn pixels(&self) -> PyResult<&[T]> {
        Ok(self.0.as_slice()?)
    }
}

/// Pictures of bytes or floats.
pub(crate) enum Image<'py, R: Rank> {
    Bytes(Array<'py, u8, R>),
    Floats(Array<'py, f32, R>),
    Doubles(Array<'py, f64, R>),
}

impl<'py, R: Rank> Image<'py, R> {
    /// Takes the argument `name`, which must be an array of `uint8`, `float32` or `float64`.
    pub(crate) fn read(name: &str, value: &Bound<'py, PyAny>) -> PyResult<Self> {
        let array = untyped::<R>(name, value)?;
        if let Some(bytes) = Array::of(name, array)? {
            Ok(Image::Bytes(bytes))
        } else if let Some(floats) = Array::of(name, array)? {
            Ok(Image::Floats(floats))
        } else if let Some(doubles) = Array::of(name, array)? {
            Ok(Image::Doubles(doubles))
        } else {
            Err(wrong_dtype(name, array, "uint8, float32 or float64"))
        }
    }
}

fn view([height, width]: [usize; 2], pixels: &[u8]) -> PyResult<FrameView<'_>> {
    FrameView::new(width, height, pixels).map_err(|error| value_error("frame", &error))
}

/// Which pixels the argument `mask` says count: an array of `uint8` or `bool`.
pub(crate) fn mask(value: &Bound<'_, PyAny>) -> PyResult<Frame> {
    let Some(bools) = Array::<bool, Ix2>::of("mask", untyped::<Ix2>("mask", value)?)? else {
        return Ok(Picture::read("mask", value)?.view()?.to_frame());
    };
    let [height, width] = bools.shape();
    let pixels = bools.pixels()?.iter().map(|&counts| u8::from(counts)).collect();
    Frame::from_vec(width, height, pixels).map_err(|error| value_error("mask", &error))
}

/// The array itself, of any type. One with masked values is refused: what the mask hides would count.
fn untyped<'a, 'py, R: Rank>(name: &str, value: &'a Bound<'py, PyAny>) -> PyResult<&'a Bound<'py, PyUntypedArray>> {
    let array = value.cast::<PyUntypedArray>().map_err(|_| {
        let got = value.get_type();
        PyTypeError::new_err(format!("{name}: got {}, expected a NumPy array of shape {}", name_of(&got), R::SHAPE))
    })?;
    if !value.is_exact_instance_of::<PyUntypedArray>() {
        static MASKED: PyOnceLock<Py<PyType>> = PyOnceLock::new();
        if value.is_instance(MASKED.import(value.py(), "numpy.ma", "MaskedArray")?)? {
            let message = format!("{name}: got a masked array, expected a plain one; give array.filled(0)");
            return Err(PyTypeError::new_err(message));
        }
    }
    Ok(array)
}

fn name_of(of: &Bound<'_, PyType>) -> String {
    of.name().map_or_else(|_| of.to_string(), |name| name.to_string())
}

fn wrong_dtype(name: &str, array: &Bound<'_, PyUntypedArray>, expected: &str) -> PyErr {
    PyTypeError::new_err(format!("{name}: got an array of {}, expected {expected}", array.dtype()))
}

fn check_shape<R: Rank>(name: &str, shape: &[usize]) -> PyResult<()> {
    let is_side = |side: &usize| (1..=MAX_SIDE).contains(side);
    if Some(shape.len()) == R::NDIM && shape[shape.len() - 2..].iter().all(is_side) {
        return Ok(());
    }
    let hint = if matches!(shape, [_, _, 3 | 4]) { "; turn colours to grey first, with prf.to_grey" } else { "" };
    let got = shape.iter().map(ToString::to_string).collect::<Vec<_>>().join(", ");
    let expected = format!("{} with sides of 1 to {MAX_SIDE}", R::SHAPE);
    Err(PyValueError::new_err(format!("{name}: got shape ({got}), expected {expected}{hint}")))
}
