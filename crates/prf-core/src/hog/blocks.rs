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
    let ([rows, columns], stride) = (layout.blocks(), cells.row_stride());
    let mut out = out;
    // By their first cells, whose order is that of the blocks. A block that would lie across the right border is left out.
    for first in (0..(rows - 1) * stride + columns).step_by(WIDTH) {
        gather(cells, unit, layout, first, spare);
        norm.apply(spare);
        let mut lane = 0;
        while lane < WIDTH {
            let column = (first + lane) % stride;
            let cells = (stride - column).min(WIDTH - lane);
            let blocks = columns.saturating_sub(column).min(cells);
            let (now, rest) = out.split_at_mut(out.len().min(blocks * layout.block_len()));
            interleave(spare, lane, now);
            (out, lane) = (rest, lane + cells);
        }
    }
}

/// Blocks and features that are turned at a time; 9 bins are the most usual.
const TILE: [usize; 2] = [8, 9];

/// Lays blocks one behind the other, from this one on.
#[inline(always)]
fn interleave(features: &[Feature], lane: usize, out: &mut [f32]) {
    let len = features.len();
    let count = out.len() / len;
    let (tiles, rest) = features.as_chunks::<{ TILE[1] }>();
    if count < TILE[0] {
        return interleave_each(features, lane, out, len, 0);
    }
    for block in (0..count).step_by(TILE[0]) {
        // The last tile may cover some blocks of the one before again.
        let block = block.min(count - TILE[0]);
        for (i, tile) in tiles.iter().enumerate() {
            turn(tile, lane + block, &mut out[block * len + i * TILE[1]..], len);
        }
    }
    interleave_each(rest, lane, out, len, len - rest.len());
}

/// The same feature by feature, to blocks of this length, in which the first one has this place.
#[inline(always)]
fn interleave_each(features: &[Feature], lane: usize, out: &mut [f32], len: usize, first: usize) {
    for (i, feature) in features.iter().enumerate() {
        for (block, value) in out.chunks_exact_mut(len).zip(&feature.0[lane..]) {
            block[first + i] = *value;
        }
    }
}

/// The same for a tile, to blocks of this length.
#[inline(always)]
fn turn(features: &[Feature; TILE[1]], lane: usize, out: &mut [f32], len: usize) {
    let columns: [&[f32; TILE[0]]; TILE[1]] = std::array::from_fn(|i| lanes(&features[i], lane));
    for block in 0..TILE[0] {
        let turned: [f32; TILE[1]] = std::array::from_fn(|i| columns[i][block]);
        out[block * len..][..TILE[1]].copy_from_slice(&turned);
    }
}

#[inline(always)]
fn lanes(feature: &Feature, lane: usize) -> &[f32; TILE[0]] {
    feature.0[lane..].first_chunk().unwrap_or(&[0.0; TILE[0]])
}

/// The features of some blocks.
#[inline(always)]
fn gather(cells: &Cells, unit: f32, layout: &HogLayout, first: usize, features: &mut [Feature]) {
    let (side, stride) = (layout.block_cells(), cells.row_stride());
    for (cell, features) in features.chunks_exact_mut(layout.orientations()).enumerate() {
        let at = first + cell / side * stride + cell % side;
        for (bin, feature) in features.iter_mut().enumerate() {
            if let Some(cells) = cells.from(bin, at) {
                for (value, cell) in feature.0.iter_mut().zip(cells) {
                    *value = cell * unit;
                }
            }
        }
    }
}
