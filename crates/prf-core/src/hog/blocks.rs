//! From cells to the features of normalised blocks.

use super::cells::Cells;
use super::normalize::{LANES, Lanes};
use super::{HogLayout, Norm};

/// Writes the features of all blocks to `out`; `spare` has room for those of a block.
#[inline(always)]
pub(super) fn collect(cells: &Cells, layout: &HogLayout, norm: Norm, spare: &mut [Lanes], out: &mut [f32]) {
    let columns = layout.blocks()[1];
    let rows = out.chunks_exact_mut(columns * layout.block_len());
    for (y, out) in rows.enumerate() {
        for (x, out) in out.chunks_mut(LANES * layout.block_len()).enumerate() {
            if layout.block_len() == 9 {
                // The most usual block, and the one that there are the most of, fits the registers.
                let mut features = [[0.0; LANES]; 9];
                gather(cells, layout, [y, x * LANES], &mut features);
                norm.apply(&mut features);
                scatter(&features, out);
            } else {
                gather(cells, layout, [y, x * LANES], spare);
                norm.apply(spare);
                scatter(spare, out);
            }
        }
    }
}

/// The features of the blocks from the one whose first cell this is.
#[inline(always)]
fn gather(cells: &Cells, layout: &HogLayout, [y, x]: [usize; 2], features: &mut [Lanes]) {
    let side = layout.block_cells();
    for (cell, features) in features.chunks_exact_mut(layout.orientations()).enumerate() {
        for (bin, feature) in features.iter_mut().enumerate() {
            if let Some(lanes) = cells.at(y + cell / side, x + cell % side, bin) {
                *feature = *lanes;
            }
        }
    }
}

/// Lays the blocks one behind the other, as many as there is room for.
#[inline(always)]
fn scatter(features: &[Lanes], out: &mut [f32]) {
    let len = features.len();
    for (lane, block) in out.chunks_exact_mut(len).enumerate() {
        for (out, feature) in block.iter_mut().zip(features) {
            *out = feature[lane];
        }
    }
}
