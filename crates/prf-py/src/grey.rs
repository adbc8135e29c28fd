//! `prf.to_grey`

use numpy::{PyArray2, PyArray3, PyArrayMethods, PyUntypedArray, PyUntypedArrayMethods};
use prf_core::{Error, Frame, FrameView, Resizer, luma};
use pyo3::exceptions::{PyOverflowError, PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};

use crate::error::value_error;
use crate::image::{self, Picture};
use crate::limits::MAX_SIDE;
use crate::options::Options;
use crate::values;

const SHAPES: &str = "(height, width), (height, width, 1), (height, width, 3) or (height, width, 4)";

/// A picture in grey, as goals and frames have to be.
///
/// Grey is the luma of ITU-R Rec. 601, ``0.299 R + 0.587 G + 0.114 B`` rounded, as OpenCV's ``COLOR_RGB2GRAY`` and
/// Pillow's ``convert("L")`` have it; what is transparent lies on black.
///
/// Parameters
/// ----------
/// image : (H, W), (H, W, 1), (H, W, 3) or (H, W, 4) ndarray of uint8
///     Grey, or red, green and blue, and alpha.
/// size : int or (int, int), optional
///     Side of a square, or height and width, in pixels to bring it to, 1 to 16384: bilinear, with a filter that is
///     widened along a side that shrinks.
///
/// Returns
/// -------
/// (H, W) ndarray of uint8
///     A new array, of the height and width of ``size`` if it is given.
///
/// Raises
/// ------
/// TypeError
///     The image is no array of ``uint8``, or ``size`` neither an integer nor a pair of them.
/// ValueError
///     The image has another shape, or a side of 0 or above 16384; or ``size`` is out of range.
///
/// Examples
/// --------
/// >>> import numpy as np
/// >>> import prf
/// >>> red = np.zeros((2, 4, 3), np.uint8)
/// >>> red[..., 0] = 255
/// >>> prf.to_grey(red)
/// array([[76, 76, 76, 76],
///        [76, 76, 76, 76]], dtype=uint8)
/// >>> prf.to_grey(red, size=(1, 2))
/// array([[76, 76]], dtype=uint8)
#[pyfunction]
#[pyo3(signature = (image, **options), text_signature = "(image, *, size=None)")]
pub(crate) fn to_grey<'py>(
    image: &Bound<'py, PyAny>,
    options: Option<Bound<'py, PyDict>>,
) -> PyResult<Bound<'py, PyArray2<u8>>> {
    let options = Options::new("to_grey", options);
    let size = options.raw("size")?.filter(|size| !size.is_none()).map(|size| read_size(&size)).transpose()?;
    options.finish()?;
    let py = image.py();
    let array = image::untyped("image", image, SHAPES)?;
    let grey = match array.ndim() {
        2 => Picture::read("image", image)?.view()?.to_frame(),
        3 => from_colours(array)?,
        _ => return Err(wrong_shape(array)),
    };
    let grey = match size {
        Some(size) if size != [grey.height(), grey.width()] => {
            py.detach(|| resized(grey.view(), size)).map_err(|error| value_error("image", &error))?
        }
        _ => grey,
    };
    values::picture(py, grey.view())
}

fn from_colours(array: &Bound<'_, PyUntypedArray>) -> PyResult<Frame> {
    let [height, width, channels] = [0, 1, 2].map(|axis| array.shape()[axis]);
    let is_side = |side| (1..=MAX_SIDE).contains(&side);
    let convert: fn(usize, usize, &[u8]) -> Result<Frame, Error> = match channels {
        1 => |width, height, pixels| Ok(FrameView::new(width, height, pixels)?.to_frame()),
        3 => luma::from_rgb,
        4 => luma::from_rgba,
        _ => return Err(wrong_shape(array)),
    };
    if !is_side(height) || !is_side(width) {
        return Err(wrong_shape(array));
    }
    let py = array.py();
    let rows = py.import("numpy")?.call_method1("ascontiguousarray", (array,))?;
    let Ok(rows) = rows.cast::<PyArray3<u8>>() else {
        return Err(image::wrong_dtype("image", array, image::BYTES));
    };
    let rows = rows.try_readonly()?;
    let pixels = rows.as_slice()?;
    py.detach(|| convert(width, height, pixels)).map_err(|error| value_error("image", &error))
}

fn wrong_shape(array: &Bound<'_, PyUntypedArray>) -> PyErr {
    image::wrong_shape("image", array.shape(), SHAPES, "")
}

fn read_size(size: &Bound<'_, PyAny>) -> PyResult<[usize; 2]> {
    let message = || -> PyResult<String> {
        Ok(format!("size: got {}, expected a side or (height, width) of 1 to {MAX_SIDE} pixels", size.repr()?))
    };
    let is_pair = size.is_instance_of::<PyTuple>();
    let sides = if is_pair { size.extract() } else { size.extract().map(|side: i64| (side, side)) };
    match sides {
        Ok((height, width)) => match [height, width].map(usize::try_from) {
            [Ok(height @ 1..=MAX_SIDE), Ok(width @ 1..=MAX_SIDE)] => Ok([height, width]),
            _ => Err(PyValueError::new_err(message()?)),
        },
        Err(error) if error.is_instance_of::<PyOverflowError>(size.py()) => Err(PyValueError::new_err(message()?)),
        Err(_) => Err(PyTypeError::new_err(message()?)),
    }
}

fn resized(frame: FrameView<'_>, [height, width]: [usize; 2]) -> Result<Frame, Error> {
    let mut resizer = Resizer::default();
    let plane = resizer.resize(frame, width, height)?;
    Frame::from_vec(width, height, plane.as_slice().iter().map(|value| (255.0 * value).round() as u8).collect())
}
