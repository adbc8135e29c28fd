//! How cells and blocks lie on a picture of one size.

use super::HogParams;
use crate::Error;

/// The grid of a HOG on pictures of one size. Cells lie side by side from the top left corner; pixels
/// beyond the last whole cell get no vote. Blocks overlap: one begins at every cell.
///
/// ```
/// use prf_core::{HogLayout, HogParams};
/// let layout = HogLayout::new(&HogParams::default(), 84, 60)?; // 1 px cells: 0.03 of 60 is 1.8
/// assert_eq!(layout.cells(), [60, 84]);
/// assert_eq!(layout.len(), 60 * 84 * 9);
/// # Ok::<(), prf_core::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct HogLayout {
    shape: [usize; 2],
    cell_px: usize,
    block_cells: usize,
    orientations: usize,
}

impl HogLayout {
    /// The grid that `params` ask for on a picture of `width` by `height` pixels.
    ///
    /// # Errors
    ///
    /// [`Error::InvalidParam`] as [`HogParams::validate`], [`Error::TooSmall`] when no block fits.
    pub fn new(params: &HogParams, width: usize, height: usize) -> Result<HogLayout, Error> {
        params.validate()?;
        let cell_px = params.cell.cell_px(height);
        let min = cell_px.saturating_mul(params.block_cells);
        if width.min(height) < min {
            return Err(Error::TooSmall { width, height, cell_px, block_cells: params.block_cells, min });
        }
        Ok(HogLayout {
            shape: [height, width],
            cell_px,
            block_cells: params.block_cells,
            orientations: params.orientations,
        })
    }

    /// As [`HogLayout::new`] with valid `params`, but where no block fits, the cells are made just
    /// small enough for one, and where not even cells of 1 px are, blocks get fewer cells. Crops have
    /// any size, and a reward must come out for each.
    pub(crate) fn fitted(params: &HogParams, [height, width]: [usize; 2]) -> HogLayout {
        let side = width.min(height);
        let block_cells = params.block_cells.min(side);
        HogLayout {
            shape: [height, width],
            cell_px: params.cell.cell_px(height).min(side / block_cells),
            block_cells,
            orientations: params.orientations,
        }
    }

    /// Shape of the picture, `[height, width]` in pixels.
    #[must_use]
    pub fn shape(&self) -> [usize; 2] {
        self.shape
    }

    /// Side of a cell in pixels.
    #[must_use]
    pub fn cell_px(&self) -> usize {
        self.cell_px
    }

    /// Cells on the side of a block.
    #[must_use]
    pub fn block_cells(&self) -> usize {
        self.block_cells
    }

    /// Bins of each histogram.
    #[must_use]
    pub fn orientations(&self) -> usize {
        self.orientations
    }

    /// Cells, `[rows, columns]`.
    #[must_use]
    pub fn cells(&self) -> [usize; 2] {
        self.shape.map(|side| side / self.cell_px)
    }

    /// Blocks, `[rows, columns]`.
    #[must_use]
    pub fn blocks(&self) -> [usize; 2] {
        self.cells().map(|side| side - self.block_cells + 1)
    }

    /// Features of a block: `block_cells² · orientations`.
    #[must_use]
    pub fn block_len(&self) -> usize {
        self.block_cells * self.block_cells * self.orientations
    }

    /// Features in all; their order is `[block row, block column, cell row, cell column, bin]`.
    #[must_use]
    #[expect(clippy::len_without_is_empty, reason = "there is always a block")]
    pub fn len(&self) -> usize {
        let [rows, columns] = self.blocks();
        rows * columns * self.block_len()
    }
}

#[cfg(test)]
mod tests {
    use super::super::CellSize;
    use super::*;

    fn params(cell: usize, block_cells: usize) -> HogParams {
        HogParams { cell: CellSize::Px(cell), block_cells, ..HogParams::default() }
    }

    #[test]
    fn what_is_too_small_says_what_would_do() {
        let error = HogLayout::new(&params(8, 3), 40, 23).expect_err("24 rows are needed").to_string();
        assert!(error.contains("40x23 px is too small for 3x3 cells of 8 px"), "{error}");
        assert!(error.contains("at least 24 px on each side"), "{error}");
        assert_eq!(HogLayout::new(&params(8, 3), 40, 24).expect("just enough").blocks(), [1, 3]);
        assert!(HogLayout::new(&params(usize::MAX, 3), 40, 24).is_err());
    }

    #[test]
    fn fitting_changes_nothing_that_fits_and_shrinks_the_rest() {
        let fits = params(8, 3);
        assert_eq!(HogLayout::fitted(&fits, [24, 40]), HogLayout::new(&fits, 40, 24).expect("fits"));
        let smaller = HogLayout::fitted(&fits, [23, 40]);
        assert_eq!((smaller.cell_px(), smaller.block_cells()), (7, 3));
        let tiny = HogLayout::fitted(&fits, [2, 40]);
        assert_eq!((tiny.cell_px(), tiny.block_cells(), tiny.blocks()), (1, 2, [1, 39]));
    }
}
