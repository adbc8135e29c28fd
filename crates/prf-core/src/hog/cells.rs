//! From columns of pixels to cells.

use super::normalize::LANES;

/// The histograms of all cells. Those of a row of cells lie together, and among them the same bin of all cells.
#[derive(Clone, Debug, Default)]
pub(super) struct Cells {
    orientations: usize,
    columns: usize,
    stride: usize,
    values: Vec<f32>,
    spare: Vec<f32>,
}

impl Cells {
    /// Prepares for so many rows and columns of cells.
    pub(super) fn resize(&mut self, [rows, columns]: [usize; 2], cell_px: usize, orientations: usize) {
        // Blocks are read some at a time, so the last of them need not be there.
        (self.orientations, self.columns, self.stride) = (orientations, columns, columns + LANES);
        self.values.resize(rows * orientations * self.stride, 0.0);
        self.spare.resize(columns * cell_px, 0.0);
    }

    /// Bin `bin` of the cells in this row, from this column on; as many as are read at a time.
    #[inline(always)]
    pub(super) fn at(&self, row: usize, column: usize, bin: usize) -> Option<&[f32; LANES]> {
        self.values[(row * self.orientations + bin) * self.stride + column..].first_chunk()
    }

    /// Sums up each `cell_px` columns of each bin, which are overwritten, and multiplies the sums by `unit`.
    #[inline(always)]
    pub(super) fn fill_row<'a>(
        &mut self,
        row: usize,
        bins: impl Iterator<Item = &'a mut [f32]>,
        cell_px: usize,
        unit: f32,
    ) {
        let begin = row * self.orientations * self.stride;
        for (cells, sums) in self.values[begin..].chunks_exact_mut(self.stride).zip(bins) {
            let sums = &mut sums[..self.columns * cell_px];
            let sums = fold(sums, &mut self.spare, cell_px);
            for (cell, sum) in cells[..self.columns].iter_mut().zip(sums) {
                *cell = sum * unit;
            }
        }
    }
}

/// Sums of each `side` values, in a fixed order: by twos and threes for as long as that goes, as SIMD can do that.
#[inline(always)]
fn fold<'a>(mut from: &'a mut [f32], mut to: &'a mut [f32], mut side: usize) -> &'a [f32] {
    while side > 1 {
        let factor = [2, 3].into_iter().find(|&factor| side.is_multiple_of(factor)).unwrap_or(side);
        match factor {
            2 => add_each::<2>(from, to),
            3 => add_each::<3>(from, to),
            _ => add_any(from, to, factor),
        }
        let len = from.len() / factor;
        (from, to) = (&mut to[..len], from);
        side /= factor;
    }
    from
}

#[inline(always)]
fn add_each<const N: usize>(from: &[f32], to: &mut [f32]) {
    for (values, to) in from.as_chunks::<N>().0.iter().zip(to) {
        let mut sum = values[0];
        for value in &values[1..] {
            sum += value;
        }
        *to = sum;
    }
}

#[inline(always)]
fn add_any(from: &[f32], to: &mut [f32], count: usize) {
    for (values, to) in from.chunks_exact(count).zip(to) {
        let mut sum = 0.0;
        for value in values {
            sum += value;
        }
        *to = sum;
    }
}
