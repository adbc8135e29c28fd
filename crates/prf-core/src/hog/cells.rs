//! From columns of pixels to cells.

use std::ops::Range;

use super::bins::{BINS, Bins};
use super::lanes::{Lanes, WIDTH};
use super::strip::Strip;
use super::votes::Votes;

/// Cells that are written at a time where there are not more.
const FEW: usize = 16;

/// The histograms of all cells: of each bin in turn all cells, row by row.
#[derive(Clone, Debug, Default)]
pub(super) struct Cells {
    cell_px: usize,
    /// From one row to the next.
    row_stride: usize,
    /// From one bin to the next.
    bin_stride: usize,
    values: Vec<f32>,
    fold: Fold,
}

impl Cells {
    /// Prepares for so many rows, of which one begins `row_stride` cells after the last.
    pub(super) fn resize(&mut self, cell_px: usize, rows: usize, row_stride: usize, orientations: usize) {
        (self.cell_px, self.row_stride) = (cell_px, row_stride);
        // Cells are written and read some at a time, also where there are fewer left.
        self.bin_stride = rows * row_stride + WIDTH;
        self.values.resize(orientations * self.bin_stride, 0.0);
        self.fold = Fold::new(cell_px);
    }

    /// From one row to the next.
    pub(super) fn row_stride(&self) -> usize {
        self.row_stride
    }

    /// A bin of some cells that follow each other, also from one row to the next.
    #[inline(always)]
    pub(super) fn from(&self, bin: usize, cell: usize) -> Option<&[f32; WIDTH]> {
        self.values[bin * self.bin_stride + cell..].first_chunk()
    }

    /// Fills so many cells, from the beginning of this row on, with the sums of the votes in the strip.
    #[inline(always)]
    pub(super) fn fill(&mut self, row: usize, count: usize, votes: &mut Votes, strip: &Strip, bins: &Bins) {
        let first = row * self.row_stride;
        if self.cell_px > WIDTH {
            return self.fill_large(first..first + count, votes, strip, bins);
        }
        let at_a_time = WIDTH / self.cell_px;
        for cell in (0..count).step_by(at_a_time) {
            let any = votes.take(strip, 0..self.cell_px, cell * self.cell_px, bins);
            // From the last bin on, as a bin has what reached it and not the next.
            let mut next = Lanes::zero();
            for (i, some) in self.values.chunks_mut(BINS * self.bin_stride).enumerate().rev() {
                let mut sums = [Lanes::zero(); BINS];
                if any {
                    sums = votes.reached(bins.from(i * BINS));
                    next = within(&mut sums, &next);
                }
                for (cells, sums) in some.chunks_exact_mut(self.bin_stride).zip(&mut sums) {
                    if any {
                        self.fold.apply(sums);
                    }
                    put(sums, &mut cells[first + cell..], at_a_time);
                }
            }
        }
    }

    /// As above for cells of more columns than are worked on at a time.
    #[inline(always)]
    fn fill_large(&mut self, range: Range<usize>, votes: &mut Votes, strip: &Strip, bins: &Bins) {
        for (i, cell) in range.enumerate() {
            for x in (0..self.cell_px).step_by(WIDTH) {
                votes.take(strip, 0..self.cell_px, i * self.cell_px + x, bins);
                for (bin, cells) in self.values.chunks_exact_mut(self.bin_stride).enumerate() {
                    let mut sum = if x == 0 { 0.0 } else { cells[cell] };
                    let mut sums = votes.reached(bins.from(bin));
                    within(&mut sums, &Lanes::zero());
                    for value in &sums[0].0[..WIDTH.min(self.cell_px - x)] {
                        sum += value;
                    }
                    cells[cell] = sum;
                }
            }
        }
    }
}

/// Takes from the votes that reached each bin those that reached the next one, and returns those that reached the first.
#[inline(always)]
fn within(sums: &mut [Lanes<f32>; BINS], next: &Lanes<f32>) -> Lanes<f32> {
    let reached = sums[0];
    for k in 0..BINS {
        let next = if k + 1 < BINS { sums[k + 1] } else { *next };
        for i in 0..WIDTH {
            sums[k].0[i] -= next.0[i];
        }
    }
    reached
}

/// Writes `count` cells or some more. What lies beyond the last of a row is overwritten by the next row.
#[inline(always)]
fn put(sums: &Lanes<f32>, cells: &mut [f32], count: usize) {
    if count > FEW {
        cells[..WIDTH].copy_from_slice(&sums.0);
    } else {
        cells[..FEW].copy_from_slice(&sums.0[..FEW]);
    }
}

/// Sums of each so many values, in a fixed order: by small factors for as long as that goes, as SIMD can do that.
#[derive(Clone, Copy, Debug, Default)]
struct Fold {
    sixes: u32,
    twos: u32,
    threes: u32,
    rest: usize,
}

impl Fold {
    fn new(side: usize) -> Fold {
        let mut rest = side;
        let mut divide = |factor: usize| {
            let mut count = 0;
            while rest.is_multiple_of(factor) {
                (rest, count) = (rest / factor, count + 1);
            }
            count
        };
        let (sixes, twos, threes) = (divide(6), divide(2), divide(3));
        Fold { sixes, twos, threes, rest }
    }

    #[inline(always)]
    fn apply(self, sums: &mut Lanes<f32>) {
        for _ in 0..self.sixes {
            add_each::<6>(sums);
        }
        for _ in 0..self.twos {
            add_each::<2>(sums);
        }
        for _ in 0..self.threes {
            add_each::<3>(sums);
        }
        match self.rest {
            1 => {}
            5 => add_each::<5>(sums),
            7 => add_each::<7>(sums),
            rest => add_any(sums, rest),
        }
    }
}

#[inline(always)]
fn add_each<const N: usize>(sums: &mut Lanes<f32>) {
    let from = sums.0;
    for i in 0..WIDTH / N {
        let mut sum = from[i * N];
        for j in 1..N {
            sum += from[i * N + j];
        }
        sums.0[i] = sum;
    }
}

#[inline(always)]
fn add_any(sums: &mut Lanes<f32>, count: usize) {
    for i in 0..WIDTH / count {
        let mut sum = 0.0;
        for j in 0..count {
            sum += sums.0[i * count + j];
        }
        sums.0[i] = sum;
    }
}
