//! `prf.hog`

use numpy::ndarray::Ix2;
use numpy::{IntoPyArray, PyArrayDyn, prelude::*};
use prf_core::{Error, FrameView, Hog, HogLayout, HogParams, PlaneView};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::error::value_error;
use crate::image::{Image, Pixels};
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
    let py = image.py();
    let image = Image::<Ix2>::read("image", image)?;
    let (shape, pixels) = (image.shape(), image.pixels()?);
    check_features(&params, shape)?;
    let (features, layout) =
        py.detach(|| compute(params, shape, pixels)).map_err(|error| value_error("image", &error))?;
    let features = features.into_pyarray(py);
    if feature_vector {
        return Ok(features.to_dyn().clone());
    }
    let ([rows, columns], block) = (layout.blocks(), layout.block_cells());
    Ok(features.reshape([rows, columns, block, block, layout.orientations()])?.to_dyn().clone())
}

fn compute(params: HogParams, [height, width]: [usize; 2], pixels: Pixels<'_>) -> Result<(Vec<f32>, HogLayout), Error> {
    let mut hog = Hog::new(params)?;
    let mut features = Vec::new();
    let layout = match pixels {
        Pixels::Bytes(bytes) => hog.compute_bytes_into(FrameView::new(width, height, bytes)?, &mut features),
        Pixels::Floats(floats) => hog.compute_into(PlaneView::new(width, height, floats)?, &mut features),
        Pixels::Doubles(doubles) => {
            let floats: Vec<f32> = doubles.iter().map(|&v| v as f32).collect();
            hog.compute_into(PlaneView::new(width, height, &floats)?, &mut features)
        }
    }?;
    Ok((features, layout))
}
