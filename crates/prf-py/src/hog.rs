//! `prf.hog`

use numpy::ndarray::{Ix2, Ix3};
use numpy::{Element, IntoPyArray, PyArrayDyn, prelude::*};
use prf_core::{Error, FrameView, Hog, HogLayout, HogParams, PlaneView};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::batch::{self, Threads};
use crate::error::value_error;
use crate::image::{Array, Image};
use crate::limits::check_features;
use crate::options::Options;

/// Histograms of oriented gradients of a grey picture.
///
/// Agrees with ``skimage.feature.hog`` (``transform_sqrt=False``) to 1e-5. Cells are square and lie side
/// by side from the top left corner; a block begins at every cell.
///
/// Parameters
/// ----------
/// image : (H, W) ndarray of uint8, float32 or float64
///     Bytes are taken as fractions of 255; floats are meant to lie in [0, 1]. A C-contiguous array of
///     bytes or float32 is read without a copy, float64 is rounded to float32.
/// orientations : int, 1 to 64
///     Bins of a histogram.
/// signed : bool
///     Whether the bins cover the full turn rather than half of it.
/// cell : float, above 0 and at most 1
///     Side of a cell as a part of the picture's height: ``max(1, floor(cell * H))`` pixels. 0.03
///     where neither this nor ``cell_px`` is given.
/// cell_px : int, at least 1
///     Side of a cell in pixels, instead of ``cell``.
/// block_cells : int, at least 1
///     Cells on the side of a block, over which histograms are normalised.
/// norm : {"none", "l1", "l1-sqrt", "l2", "l2-hys"}
///     How a block is normalised.
/// feature_vector : bool
///     Whether to return the features in one dimension.
///
/// Returns
/// -------
/// ndarray of float32
///     Shape ``(rows, columns, block_cells, block_cells, orientations)`` with one row and column a
///     block, or the same flattened. Never negative; with a norm at most 1.
///
/// Raises
/// ------
/// TypeError
///     An argument has another type, or the array another dtype.
/// ValueError
///     An argument is out of range, the array has another number of dimensions, a side of 0 or above
///     16384, a pixel that is no finite number, or no room for a block.
///
/// Examples
/// --------
/// >>> import numpy as np
/// >>> import prf
/// >>> image = np.tile(np.linspace(0, 1, 16, dtype=np.float32), (16, 1))
/// >>> prf.hog(image, cell_px=8, orientations=4, feature_vector=False).shape
/// (2, 2, 1, 1, 4)
#[pyfunction]
#[pyo3(
    signature = (image, **options),
    text_signature = "(image, *, orientations=9, signed=False, cell=None, cell_px=None, block_cells=1, norm='l2', \
                      feature_vector=True)"
)]
pub(crate) fn hog<'py>(
    image: &Bound<'py, PyAny>,
    options: Option<Bound<'py, PyDict>>,
) -> PyResult<Bound<'py, PyArrayDyn<f32>>> {
    let options = Options::new("hog", options);
    let params = options.hog(HogParams::default().cell)?;
    let feature_vector = options.get("feature_vector")?.unwrap_or(true);
    options.finish()?;
    match Image::<Ix2>::read("image", image)? {
        Image::Bytes(image) => one(&image, params, feature_vector),
        Image::Floats(image) => one(&image, params, feature_vector),
        Image::Doubles(image) => one(&image, params, feature_vector),
    }
}

/// :func:`hog` of many pictures, on several threads.
///
/// Parameters
/// ----------
/// images : (N, H, W) ndarray of uint8, float32 or float64
///     Grey pictures, as for :func:`hog`. N may be 0.
/// orientations, signed, cell, cell_px, block_cells, norm, feature_vector
///     As for :func:`hog`.
/// threads : int, 1 to 1024, optional
///     The most threads; as many as there are cores where it isn't given. The result is the same.
///
/// Returns
/// -------
/// ndarray of float32
///     What :func:`hog` gives for each, of shape ``(N, features)`` or
///     ``(N, rows, columns, block_cells, block_cells, orientations)``.
///
/// Raises
/// ------
/// TypeError, ValueError
///     As :func:`hog`.
/// MemoryError
///     There is no room for the result.
///
/// Examples
/// --------
/// >>> import numpy as np
/// >>> import prf
/// >>> prf.hog_batch(np.zeros((100, 84, 84), np.uint8), cell_px=8).shape
/// (100, 900)
#[pyfunction]
#[pyo3(
    signature = (images, **options),
    text_signature = "(images, *, orientations=9, signed=False, cell=None, cell_px=None, block_cells=1, norm='l2', \
                      feature_vector=True, threads=None)"
)]
pub(crate) fn hog_batch<'py>(
    images: &Bound<'py, PyAny>,
    options: Option<Bound<'py, PyDict>>,
) -> PyResult<Bound<'py, PyArrayDyn<f32>>> {
    let options = Options::new("hog_batch", options);
    let params = options.hog(HogParams::default().cell)?;
    let feature_vector = options.get("feature_vector")?.unwrap_or(true);
    let threads = Threads::read(&options)?;
    options.finish()?;
    match Image::<Ix3>::read("images", images)? {
        Image::Bytes(images) => many(&images, params, feature_vector, threads),
        Image::Floats(images) => many(&images, params, feature_vector, threads),
        Image::Doubles(images) => many(&images, params, feature_vector, threads),
    }
}

fn one<'py, P: Pixel>(
    image: &Array<'py, P, Ix2>,
    params: HogParams,
    feature_vector: bool,
) -> PyResult<Bound<'py, PyArrayDyn<f32>>> {
    let (py, shape, pixels) = (image.py(), image.shape(), image.pixels()?);
    let (layout, mut worker) = prepare("image", params, shape)?;
    py.detach(|| P::compute(&mut worker, shape, pixels)).map_err(|error| value_error("image", &error))?;
    let features = worker.features.into_pyarray(py);
    features.reshape(lengths(&layout, feature_vector))
}

fn many<'py, P: Pixel>(
    images: &Array<'py, P, Ix3>,
    params: HogParams,
    feature_vector: bool,
    threads: Threads,
) -> PyResult<Bound<'py, PyArrayDyn<f32>>> {
    let shape = images.shape();
    let (layout, worker) = prepare("images", params, shape)?;
    let lengths = lengths(&layout, feature_vector);
    batch::each("images", images, threads, worker, &lengths, |worker, pixels, features| {
        P::compute(worker, shape, pixels)?;
        features.copy_from_slice(&worker.features);
        Ok(())
    })
}

fn prepare(name: &str, params: HogParams, shape: [usize; 2]) -> PyResult<(HogLayout, Worker)> {
    check_features(&params, shape)?;
    let layout = HogLayout::new(&params, shape[1], shape[0]).map_err(|error| value_error(name, &error))?;
    let hog = Hog::new(params).map_err(|error| value_error(name, &error))?;
    Ok((layout, Worker { hog, floats: Vec::new(), features: Vec::new() }))
}

/// The shape of one picture's features.
fn lengths(layout: &HogLayout, feature_vector: bool) -> Vec<usize> {
    if feature_vector {
        return vec![layout.len()];
    }
    let ([rows, columns], block) = (layout.blocks(), layout.block_cells());
    vec![rows, columns, block, block, layout.orientations()]
}

/// What one thread computes with.
#[derive(Clone)]
struct Worker {
    hog: Hog,
    floats: Vec<f32>,
    features: Vec<f32>,
}

/// What pictures may consist of.
trait Pixel: Element {
    /// Leaves the features of a picture in the worker.
    fn compute(worker: &mut Worker, shape: [usize; 2], pixels: &[Self]) -> Result<(), Error>;
}

impl Pixel for u8 {
    fn compute(worker: &mut Worker, [height, width]: [usize; 2], pixels: &[u8]) -> Result<(), Error> {
        worker.hog.compute_bytes_into(FrameView::new(width, height, pixels)?, &mut worker.features)?;
        Ok(())
    }
}

impl Pixel for f32 {
    fn compute(worker: &mut Worker, [height, width]: [usize; 2], pixels: &[f32]) -> Result<(), Error> {
        worker.hog.compute_into(PlaneView::new(width, height, pixels)?, &mut worker.features)?;
        Ok(())
    }
}

impl Pixel for f64 {
    fn compute(worker: &mut Worker, [height, width]: [usize; 2], pixels: &[f64]) -> Result<(), Error> {
        worker.floats.clear();
        worker.floats.extend(pixels.iter().map(|&v| v as f32));
        worker.hog.compute_into(PlaneView::new(width, height, &worker.floats)?, &mut worker.features)?;
        Ok(())
    }
}
