//! How large things may be. Rust ends the process where memory runs out, and a process with a Python
//! interpreter in it must not end: what can't be meant is refused before it is asked for.

use prf_core::{CellSize, FrameView, HogParams, crop_box};
use pyo3::exceptions::PyValueError;
use pyo3::{PyErr, PyResult};

/// The longest side of a picture, in pixels.
pub(crate) const MAX_SIDE: usize = 1 << 14;

/// The most features of a HOG: 1 GiB of `float32`.
const MAX_FEATURES: usize = 1 << 28;

/// Refuses parameters that would give a picture of this shape more than [`MAX_FEATURES`]. `params` are
/// valid and the picture's sides are 1 to [`MAX_SIDE`], so nothing here overflows.
pub(crate) fn check_features(params: &HogParams, shape: [usize; 2]) -> PyResult<()> {
    let [height, width] = shape;
    // Too large a block or cell is made to fit, as a reward does with small crops.
    let side = width.min(height);
    let block_cells = params.block_cells.min(side);
    let cell_px = params.cell.cell_px(height).min(side / block_cells);
    let blocks = shape.map(|side| side / cell_px - block_cells + 1);
    let len = blocks[0] * blocks[1] * block_cells * block_cells * params.orientations;
    if len <= MAX_FEATURES { Ok(()) } else { Err(too_many(shape, len)) }
}

/// Refuses parameters that would give some part of a picture of this shape more than [`MAX_FEATURES`].
pub(crate) fn check_crops(params: &HogParams, shape: [usize; 2]) -> PyResult<()> {
    let len = features_of_crops(params, shape);
    if len <= MAX_FEATURES { Ok(()) } else { Err(too_many(shape, len)) }
}

/// Refuses so many tasks, whose pictures are no larger than one of these shapes, that together they would have more than
/// [`MAX_FEATURES`].
pub(crate) fn check_tasks(params: &HogParams, shapes: &[[usize; 2]], count: usize) -> PyResult<()> {
    let most = shapes.iter().map(|&shape| features_of_crops(params, shape)).max().unwrap_or(0);
    let len = most.saturating_mul(count);
    if len <= MAX_FEATURES {
        return Ok(());
    }
    Err(PyValueError::new_err(format!(
        "num_envs: got {count}, whose HOGs could have {len} features, expected at most {MAX_FEATURES}: take fewer \
         environments, larger cells or fewer cells a block"
    )))
}

/// The most that the HOG of a part of a picture of this shape can have.
fn features_of_crops(params: &HogParams, [height, width]: [usize; 2]) -> usize {
    let (side, long) = (width.min(height), width.max(height));
    let block_cells = params.block_cells.min(side);
    // Where a part is narrow and cells are made to fit, it is fewer than two blocks wide.
    let narrow = 2 * block_cells * long;
    let others = match params.cell {
        CellSize::Px(px) => (height / px) * (width / px),
        // Half a cell may be lost to rounding.
        CellSize::Fraction(fraction) => ((2.0 / f64::from(fraction)).ceil() as usize).saturating_mul(width),
    };
    let blocks = narrow.max(others).min(height * width);
    blocks * block_cells * block_cells * params.orientations
}

/// Refuses parameters that would give what is not black in a picture more than [`MAX_FEATURES`].
pub(crate) fn check_picture(params: &HogParams, picture: FrameView<'_>) -> PyResult<()> {
    // Hardly ever is the crop needed, so it isn't searched for twice.
    check_crops(params, [picture.height(), picture.width()]).or_else(|_| {
        let crop = crop_box(picture);
        check_features(params, [crop.height, crop.width])
    })
}

fn too_many([height, width]: [usize; 2], len: usize) -> PyErr {
    PyValueError::new_err(format!(
        "a HOG of {width}x{height} px would have {len} features, expected at most {MAX_FEATURES}: take larger \
         cells, fewer cells a block or a smaller picture"
    ))
}
