//! Every pixel's vote, summed up along the columns of a row of cells.
//!
//! A histogram in memory would make each vote wait for the one before it. So every column of pixels has a sum for each
//! bin, side by side on SIMD lanes, of all votes that have reached the bin. While some columns are
//! followed downwards, once for some bins, their sums stay in registers. What has reached a bin and not the next lies in it: where
//! that is nothing, both sums had the same terms and their difference is exactly 0; otherwise it can't be negative, as rounding keeps the order.

use std::ops::Range;

use super::bins::{BINS, Bins, Border, Directions};
use super::lanes::{Lanes, WIDTH};
use super::strip::Strip;

/// The votes of some columns of a row of cells, row by row.
#[derive(Clone, Debug, Default)]
pub(super) struct Votes {
    /// The length of the gradient.
    pub(super) weights: Vec<Lanes<f32>>,
    /// Where it points.
    pub(super) directions: Vec<Directions>,
}

impl Votes {
    /// Prepares for cells of this many rows.
    pub(super) fn resize(&mut self, cell_px: usize) {
        self.weights.resize(cell_px, Lanes::zero());
        self.directions.resize(cell_px, Directions::none());
    }

    /// Takes the votes in these rows of the strip, from column `x` on, and says whether there is one.
    #[inline(always)]
    pub(super) fn take(&mut self, strip: &Strip, rows: Range<usize>, x: usize, bins: &Bins) -> bool {
        let votes = self.weights.iter_mut().zip(&mut self.directions);
        let mut any = false;
        for (y, (weights, directions)) in rows.zip(votes) {
            any |= cast(strip, [y, x], bins, weights, directions);
        }
        any
    }

    /// The votes that have reached these borders, added downwards.
    #[inline(always)]
    pub(super) fn reached(&self, borders: [Border; BINS]) -> [Lanes<f32>; BINS] {
        // Where there are few rows, a sum that has to wait in memory for the next one costs more than all else.
        match self.weights.len() {
            1 => self.first::<1>(borders),
            2 => self.first::<2>(borders),
            3 => self.first::<3>(borders),
            rows => {
                let mut sums = self.first::<4>(borders);
                for row in 4..rows {
                    let (weights, seen) =
                        (&self.weights[row], borders.map(|border| self.directions[row].seen_by(border)));
                    for i in 0..WIDTH {
                        for (k, sums) in sums.iter_mut().enumerate() {
                            sums.0[i] += vote(weights.0[i], borders[k].is_reached(seen[k].0[i]));
                        }
                    }
                }
                sums
            }
        }
    }

    /// The votes that have reached these borders in the first rows.
    #[inline(always)]
    fn first<const ROWS: usize>(&self, borders: [Border; BINS]) -> [Lanes<f32>; BINS] {
        let mut sums = [Lanes::zero(); BINS];
        let (Some(weights), Some(directions)) =
            (self.weights.first_chunk::<ROWS>(), self.directions.first_chunk::<ROWS>())
        else {
            return sums;
        };
        let seen = directions.each_ref().map(|directions| borders.map(|border| directions.seen_by(border)));
        for i in 0..WIDTH {
            let mut sum = [0.0; BINS];
            for row in 0..ROWS {
                for (k, sum) in sum.iter_mut().enumerate() {
                    *sum += vote(weights[row].0[i], borders[k].is_reached(seen[row][k].0[i]));
                }
            }
            for k in 0..BINS {
                sums[k].0[i] = sum[k];
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
fn cast(strip: &Strip, [y, x]: [usize; 2], bins: &Bins, weights: &mut Lanes<f32>, directions: &mut Directions) -> bool {
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
    bins.directions(&dx, &dy, directions);
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
