//! NumPy arrays as pictures.

use numpy::{Element, PyArray2, PyReadonlyArray2, PyUntypedArray, prelude::*};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::IntoPyDict;

use crate::limits::MAX_SIDE;

/// An array that was given as a picture. Its rows lie one after the other.
pub(crate) struct Array<'py, T: Element>(PyReadonlyArray2<'py, T>);

impl<'py> Array<'py, u8> {
    /// Takes the argument `name`, which must be an array of `uint8`.
    pub(crate) fn read(name: &str, value: &Bound<'py, PyAny>) -> PyResult<Array<'py, u8>> {
        let array = untyped(name, value)?;
        Array::of(name, array)?.ok_or_else(|| {
            let hint = "uint8; for floats in [0, 1] give (255 * array).round().astype(np.uint8)";
            wrong_dtype(name, array, hint)
        })
    }
}

impl<'py, T: Element> Array<'py, T> {
    /// Nothing where the array holds values of another type.
    fn of(name: &str, array: &Bound<'py, PyUntypedArray>) -> PyResult<Option<Array<'py, T>>> {
        if !array.dtype().is_equiv_to(&T::get_dtype(array.py())) {
            return Ok(None);
        }
        check_shape(name, array.shape())?;
        let array = array.cast::<PyArray2<T>>()?;
        if array.is_c_contiguous() && array.is_aligned() {
            return Ok(Some(Array(array.try_readonly()?)));
        }
        let numpy = array.py().import("numpy")?;
        let copy = numpy.call_method("array", (array,), Some(&[("order", "C")].into_py_dict(array.py())?))?;
        Ok(Some(Array(copy.cast::<PyArray2<T>>()?.try_readonly()?)))
    }

    /// `[height, width]`
    pub(crate) fn shape(&self) -> [usize; 2] {
        [self.0.shape()[0], self.0.shape()[1]]
    }

    /// Row by row; can be read without the GIL.
    pub(crate) fn pixels(&self) -> PyResult<&[T]> {
        Ok(self.0.as_slice()?)
    }
}

/// A picture of bytes or floats.
pub(crate) enum Image<'py> {
    Bytes(Array<'py, u8>),
    Floats(Array<'py, f32>),
    Doubles(Array<'py, f64>),
}

impl<'py> Image<'py> {
    /// Takes the argument `name`, which must be an array of `uint8`, `float32` or `float64`.
    pub(crate) fn read(name: &str, value: &Bound<'py, PyAny>) -> PyResult<Image<'py>> {
        let array = untyped(name, value)?;
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

    /// `[height, width]`
    pub(crate) fn shape(&self) -> [usize; 2] {
        match self {
            Image::Bytes(array) => array.shape(),
            Image::Floats(array) => array.shape(),
            Image::Doubles(array) => array.shape(),
        }
    }

    pub(crate) fn pixels(&self) -> PyResult<Pixels<'_>> {
        Ok(match self {
            Image::Bytes(array) => Pixels::Bytes(array.pixels()?),
            Image::Floats(array) => Pixels::Floats(array.pixels()?),
            Image::Doubles(array) => Pixels::Doubles(array.pixels()?),
        })
    }
}

/// The pixels of an [`Image`], row by row; can be read without the GIL.
#[derive(Clone, Copy)]
pub(crate) enum Pixels<'a> {
    Bytes(&'a [u8]),
    Floats(&'a [f32]),
    Doubles(&'a [f64]),
}

fn untyped<'a, 'py>(name: &str, value: &'a Bound<'py, PyAny>) -> PyResult<&'a Bound<'py, PyUntypedArray>> {
    value.cast().or_else(|_| {
        let got = value.get_type().name()?;
        Err(PyTypeError::new_err(format!("{name}: got {got}, expected a NumPy array of shape (height, width)")))
    })
}

fn wrong_dtype(name: &str, array: &Bound<'_, PyUntypedArray>, expected: &str) -> PyErr {
    PyTypeError::new_err(format!("{name}: got an array of {}, expected {expected}", array.dtype()))
}

fn check_shape(name: &str, shape: &[usize]) -> PyResult<()> {
    let hint = match shape {
        [height, width] if [height, width].iter().all(|side| (1..=MAX_SIDE).contains(*side)) => return Ok(()),
        [_, _, 3 | 4] => "; turn colours to grey first",
        _ => "",
    };
    let got = shape.iter().map(ToString::to_string).collect::<Vec<_>>().join(", ");
    let expected = format!("(height, width) with sides of 1 to {MAX_SIDE}");
    Err(PyValueError::new_err(format!("{name}: got shape ({got}), expected {expected}{hint}")))
}
