//! Every pixel's vote, summed up along the columns of a row of cells.
//!
//! A histogram in memory would make each vote wait for the one before it. So every column of pixels has a sum for each
//! bin, side by side on SIMD lanes: a vote is added to all bins, as 0 to all but one of them. While some columns are
//! followed downwards, once for each bin, their sums stay in registers.

use std::ops::Range;

use super::bins::Bins;
use super::lanes::{Lanes, WIDTH};
use super::strip::Strip;

/// Bins that are counted at a time: weights and places are read once for all of them, and their sums fit the registers.
pub(super) const BINS: usize = 3;

/// The votes of some columns of a row of cells, row by row.
#[derive(Clone, Debug, Default)]
pub(super) struct Votes {
    /// The length of the gradient.
    pub(super) weights: Vec<Lanes<f32>>,
    /// The bin.
    pub(super) places: Vec<Lanes<u32>>,
}

impl Votes {
    /// Prepares for cells of this many rows.
    pub(super) fn resize(&mut self, cell_px: usize) {
        self.weights.resize(cell_px, Lanes::zero());
        self.places.resize(cell_px, Lanes::zero());
    }

    /// Takes the votes in these rows of the strip, from column `x` on, and says whether there is one.
    #[inline(always)]
    pub(super) fn take(&mut self, strip: &Strip, rows: Range<usize>, x: usize, bins: &Bins) -> bool {
        let votes = self.weights.iter_mut().zip(&mut self.places);
        let mut any = false;
        for (y, (weights, places)) in rows.zip(votes) {
            any |= cast(strip, [y, x], bins, weights, places);
        }
        any
    }

    /// The votes for some bins from this one on, added downwards.
    #[inline(always)]
    pub(super) fn count(&self, bin: usize) -> [Lanes<f32>; BINS] {
        // Where there are few rows, a sum that has to wait in memory for the next one costs more than all else.
        match self.weights.len() {
            1 => self.first::<1>(bin),
            2 => self.first::<2>(bin),
            3 => self.first::<3>(bin),
            rows => {
                let mut sums = self.first::<4>(bin);
                for row in 4..rows {
                    let (weights, places) = (&self.weights[row], &self.places[row]);
                    for i in 0..WIDTH {
                        for (k, sums) in sums.iter_mut().enumerate() {
                            sums.0[i] += vote(weights.0[i], places.0[i] == (bin + k) as u32);
                        }
                    }
                }
                sums
            }
        }
    }

    /// The votes for these bins in the first rows.
    #[inline(always)]
    fn first<const ROWS: usize>(&self, bin: usize) -> [Lanes<f32>; BINS] {
        let mut sums = [Lanes::zero(); BINS];
        if let (Some(weights), Some(places)) = (self.weights.first_chunk::<ROWS>(), self.places.first_chunk::<ROWS>()) {
            for i in 0..WIDTH {
                let mut sum = [0.0; BINS];
                for row in 0..ROWS {
                    for (k, sum) in sum.iter_mut().enumerate() {
                        *sum += vote(weights[row].0[i], places[row].0[i] == (bin + k) as u32);
                    }
                }
                for k in 0..BINS {
                    sums[k].0[i] = sum[k];
                }
            }
        }
        sums
    }
}

/// A weight where it counts, else 0. By its bits: a choice would skip reading it, which not all SIMD can do.
#[inline(always)]
fn vote(weight: f32, counts: bool) -> f32 {
    f32::from_bits(weight.to_bits() & u32::from(counts).wrapping_neg())
}

/// The votes of some columns of one row, and whether there is one.
#[inline(always)]
fn cast(strip: &Strip, [y, x]: [usize; 2], bins: &Bins, weights: &mut Lanes<f32>, places: &mut Lanes<u32>) -> bool {
    let [above, row, below] = strip.around(y);
    let dx = differences(&row[x..], &row[x + 2..]);
    let dy = differences(&above[x..], &below[x..]);
    let mut any = 0;
    for i in 0..WIDTH {
        any |= dx.0[i].to_bits() | dy.0[i].to_bits();
    }
    // Much of a picture is flat.
    if any == 0 {
        *weights = Lanes::zero();
        return false;
    }
    for i in 0..WIDTH {
        weights.0[i] = (dx.0[i] * dx.0[i] + dy.0[i] * dy.0[i]).sqrt();
    }
    bins.assign(&dx, &dy, places);
    true
}

/// `to − from`, not halved where it is a central difference.
#[inline(always)]
fn differences(from: &[f32], to: &[f32]) -> Lanes<f32> {
    let mut differences = Lanes::zero();
    if let (Some(from), Some(to)) = (from.first_chunk::<WIDTH>(), to.first_chunk::<WIDTH>()) {
        for i in 0..WIDTH {
            differences.0[i] = to[i] - from[i];
        }
    }
    differences
}
