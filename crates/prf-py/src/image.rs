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

/// The type of a picture's values, and what to do with others.
pub(crate) const BYTES: &str = "uint8; for floats in [0, 1] give (255 * array).round().astype(np.uint8)";

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
        let array = untyped(name, value, R::SHAPE)?;
        Array::of(name, array)?.ok_or_else(|| wrong_dtype(name, array, BYTES))
    }
}

impl Picture<'_> {
    /// The picture, which can be read without the GIL.
    pub(crate) fn view(&self) -> PyResult<FrameView<'_>> {
        let [height, width] = self.shape();
        FrameView::new(width, height, self.pixels()?).map_err(|error| value_error("frame", &error))
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
    pub(crate) fn views(&self) -> PyResult<impl Iterator<Item = FrameView<'_>>> {
        let [height, width] = self.shape();
        // The shape has been checked, so each chunk is a picture.
        let view = move |pixels| FrameView::new(width, height, pixels).ok();
        Ok(self.pixels()?.chunks_exact(height * width).filter_map(view))
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
        let array = untyped(name, value, R::SHAPE)?;
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

/// Which pixels the argument `mask` says count: an array of `uint8` or `bool`.
pub(crate) fn mask(value: &Bound<'_, PyAny>) -> PyResult<Frame> {
    let array = untyped("mask", value, Ix2::SHAPE)?;
    if let Some(bytes) = Picture::of("mask", array)? {
        return Ok(bytes.view()?.to_frame());
    }
    let Some(bools) = Array::<bool, Ix2>::of("mask", array)? else {
        return Err(wrong_dtype("mask", array, "uint8 or bool; for floats give array > 0"));
    };
    let [height, width] = bools.shape();
    let pixels = bools.pixels()?.iter().map(|&counts| u8::from(counts)).collect();
    Frame::from_vec(width, height, pixels).map_err(|error| value_error("mask", &error))
}

/// The array itself, of any type; `shape` says what it should be like. One with masked values is refused: what the mask
/// hides would count.
pub(crate) fn untyped<'a, 'py>(
    name: &str,
    value: &'a Bound<'py, PyAny>,
    shape: &str,
) -> PyResult<&'a Bound<'py, PyUntypedArray>> {
    let array = value.cast::<PyUntypedArray>().map_err(|_| {
        let got = value.get_type();
        PyTypeError::new_err(format!("{name}: got {}, expected a NumPy array of shape {shape}", name_of(&got)))
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

pub(crate) fn wrong_dtype(name: &str, array: &Bound<'_, PyUntypedArray>, expected: &str) -> PyErr {
    PyTypeError::new_err(format!("{name}: got an array of {}, expected {expected}", array.dtype()))
}

fn check_shape<R: Rank>(name: &str, shape: &[usize]) -> PyResult<()> {
    let is_side = |side: &usize| (1..=MAX_SIDE).contains(side);
    if Some(shape.len()) == R::NDIM && shape[shape.len() - 2..].iter().all(is_side) {
        return Ok(());
    }
    let has_colours = Some(shape.len()) == R::NDIM.map(|ndim| ndim + 1);
    let hint = match shape.last() {
        Some(1) if has_colours => "; give array[..., 0]",
        Some(3 | 4) if has_colours => "; turn colours to grey first, with prf.to_grey",
        _ => "",
    };
    Err(wrong_shape(name, shape, R::SHAPE, hint))
}

/// What to say of an array that has not the shape it should have.
pub(crate) fn wrong_shape(name: &str, shape: &[usize], expected: &str, hint: &str) -> PyErr {
    let got = shape.iter().map(ToString::to_string).collect::<Vec<_>>().join(", ");
    let message = format!("{name}: got shape ({got}), expected {expected} with sides of 1 to {MAX_SIDE}{hint}");
    PyValueError::new_err(message)
}
