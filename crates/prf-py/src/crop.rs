//! `prf.crop` and `prf.crop_box`

use numpy::PyArray2;
use prf_core::{FrameView, Rect};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PySlice};

use crate::batch::{self, Threads};
use crate::image::{Picture, Pictures};
use crate::options::Options;
use crate::results;

/// The smallest box around what is not black.
///
/// As ``cv2.boundingRect`` of a grey picture; but of one that is black all over it is the whole picture.
///
/// Parameters
/// ----------
/// image : (H, W) ndarray of uint8
///     In grey: 0 is black.
///
/// Returns
/// -------
/// Rect
///     ``(x, y, width, height)`` in pixels.
///
/// Raises
/// ------
/// TypeError
///     The image is no array of ``uint8``.
/// ValueError
///     It has another number of dimensions, or a side of 0 or above 16384.
///
/// Examples
/// --------
/// >>> import numpy as np
/// >>> import prf
/// >>> image = np.zeros((8, 10), np.uint8)
/// >>> image[2, 3] = image[5, 7] = 255
/// >>> prf.crop_box(image)
/// Rect(x=3, y=2, width=5, height=4)
#[pyfunction]
pub(crate) fn crop_box<'py>(image: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
    results::rect(image.py(), rect(image)?)
}

/// The part of a picture within :func:`crop_box`, with which templates are compared.
///
/// Takes the arguments of :func:`crop_box` and raises the same errors.
///
/// Returns
/// -------
/// (height, width) ndarray of uint8
///     A view of the image: no pixel is copied.
///
/// Examples
/// --------
/// >>> import numpy as np
/// >>> import prf
/// >>> image = np.zeros((8, 10), np.uint8)
/// >>> image[2:4, 3:6] = 7
/// >>> prf.crop(image)
/// array([[7, 7, 7],
///        [7, 7, 7]], dtype=uint8)
#[pyfunction]
pub(crate) fn crop<'py>(image: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
    let Rect { x, y, width, height } = rect(image)?;
    let slice = |start: usize, len: usize| PySlice::new(image.py(), start as isize, (start + len) as isize, 1);
    image.get_item((slice(y, height), slice(x, width)))
}

/// :func:`crop_box` of many pictures, on several threads.
///
/// Parameters
/// ----------
/// images : (N, H, W) ndarray of uint8
///     In grey: 0 is black. N may be 0.
/// threads : int, 1 to 1024, optional
///     The most threads; as many as there are cores where it isn't given. The result is the same.
///
/// Returns
/// -------
/// (N, 4) ndarray of int64
///     ``x, y, width, height`` of each.
///
/// Raises
/// ------
/// TypeError, ValueError
///     As :func:`crop_box`.
///
/// Examples
/// --------
/// >>> import numpy as np
/// >>> import prf
/// >>> images = np.zeros((2, 8, 10), np.uint8)
/// >>> images[0, 2, 3] = images[0, 5, 7] = 255
/// >>> prf.crop_box_batch(images)
/// array([[ 3,  2,  5,  4],
///        [ 0,  0, 10,  8]])
#[pyfunction]
#[pyo3(signature = (images, **options), text_signature = "(images, *, threads=None)")]
pub(crate) fn crop_box_batch<'py>(
    images: &Bound<'py, PyAny>,
    options: Option<Bound<'py, PyDict>>,
) -> PyResult<Bound<'py, PyArray2<i64>>> {
    let options = Options::new("crop_box_batch", options);
    let threads = Threads::read(&options)?;
    options.finish()?;
    let images = Pictures::read("images", images)?;
    let [height, width] = images.shape();
    batch::each("images", &images, threads, (), &[4], |(), pixels, numbers| {
        let Rect { x, y, width, height } = prf_core::crop_box(FrameView::new(width, height, pixels)?);
        numbers.copy_from_slice(&[x, y, width, height].map(|number| number as i64));
        Ok(())
    })
}

fn rect(image: &Bound<'_, PyAny>) -> PyResult<Rect> {
    let picture = Picture::read("image", image)?;
    let view = picture.view()?;
    Ok(image.py().detach(|| prf_core::crop_box(view)))
}
