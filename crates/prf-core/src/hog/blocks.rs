//! From cells to the features of normalised blocks.

use super::cells::Cells;
use super::lanes::WIDTH;
use super::normalize::Feature;
use super::{HogLayout, Norm};

/// Writes the features of all blocks to `out`, of the cells' values times `unit`; `spare` has room for one block's.
#[inline(always)]
pub(super) fn collect(
    cells: &Cells,
    unit: f32,
    layout: &HogLayout,
    norm: Norm,
    spare: &mut [Feature],
    out: &mut [f32],
) {
    let ([rows, columns], stride) = (layout.blocks(), layout.cells()[1]);
    let mut out = out;
    // By their first cells, whose order is that of the blocks. A block that would lie across the right border is left out.
    for first in (0..(rows - 1) * stride + columns).step_by(WIDTH) {
        gather(cells, unit, layout, first, spare);
        norm.apply(spare);
        let mut lane = 0;
        while lane < WIDTH && !out.is_empty() {
            let column = (first + lane) % stride;
            let count = columns.saturating_sub(column).min(WIDTH - lane);
            let (blocks, rest) = out.split_at_mut(count * layout.block_len());
            interleave(spare, lane, blocks);
            out = rest;
            lane += count.max(1).max((stride - column).min(WIDTH - lane) * usize::from(column + count >= columns));
        }
    }
}

/// Lays blocks one behind the other, from this one on.
#[inline(always)]
fn interleave(features: &[Feature], lane: usize, out: &mut [f32]) {
    let len = features.len();
    for (i, feature) in features.iter().enumerate() {
        for (block, value) in out.chunks_exact_mut(len).zip(&feature.0[lane..]) {
            block[i] = *value;
        }
    }
}

/// The features of some blocks.
#[inline(always)]
fn gather(cells: &Cells, unit: f32, layout: &HogLayout, first: usize, features: &mut [Feature]) {
    let (side, stride) = (layout.block_cells(), layout.cells()[1]);
    for (cell, features) in features.chunks_exact_mut(layout.orientations()).enumerate() {
        let at = first + cell / side * stride + cell % side;
        for (bin, feature) in features.iter_mut().enumerate() {
            if let Some(cells) = cells.from(bin, at) {
                for i in 0..WIDTH {
                    feature.0[i] = cells[i] * unit;
                }
            }
        }
    }
}
