//! Every pixel's vote, summed up along the columns of a row of cells.
//!
//! A histogram in memory would make each vote wait for the one before it. So every column of pixels has a sum for each
//! bin: side by side on SIMD lanes, where a vote is added to all bins, as 0 to all but one of them. While a few columns
//! are followed downwards, their sums stay in registers.

use super::bins::{Bins, cotangent, turn};
use super::strip::Strip;

/// Columns that are followed at a time.
pub(super) const LANES: usize = 16;

/// A sum for each bin and column; those of one bin lie side by side.
#[derive(Clone, Debug, Default)]
pub(super) struct Columns {
    stride: usize,
    sums: Vec<f32>,
}

impl Columns {
    /// Prepares for so many columns, rounded up to whole lanes.
    pub(super) fn resize(&mut self, columns: usize, orientations: usize) {
        self.stride = columns.next_multiple_of(LANES);
        self.sums.resize(self.stride * orientations, 0.0);
    }

    /// The sums of each bin in turn.
    #[inline(always)]
    pub(super) fn bins_mut(&mut self) -> impl Iterator<Item = &mut [f32]> {
        self.sums.chunks_exact_mut(self.stride)
    }

    /// Sums up the votes of these rows of the strip.
    #[inline(always)]
    pub(super) fn sum(&mut self, strip: &Strip, rows: std::ops::Range<usize>, bins: &Bins) {
        for x in (0..self.stride).step_by(LANES) {
            match bins.borders.as_array() {
                Some(borders) if !bins.signed => self.follow_nine(strip, rows.clone(), x, borders),
                _ => self.follow(strip, rows.clone(), x, bins),
            }
        }
    }

    /// The usual bins, whose sums fit the registers.
    #[inline(always)]
    fn follow_nine(&mut self, strip: &Strip, rows: std::ops::Range<usize>, x: usize, borders: &[f32; 8]) {
        let mut sums = [[0.0; LANES]; 9];
        for y in rows {
            let Some([dx, dy]) = gradients(strip, y, x) else { continue };
            let weights = lengths(&dx, &dy);
            let mut cotangents = [0.0; LANES];
            for lane in 0..LANES {
                cotangents[lane] = cotangent(dx[lane], dy[lane]);
            }
            for bin in 0..9 {
                for lane in 0..LANES {
                    let begun = bin == 0 || cotangents[lane] <= borders[bin - 1];
                    let ended = bin < 8 && cotangents[lane] <= borders[bin];
                    sums[bin][lane] += if begun & !ended { weights[lane] } else { 0.0 };
                }
            }
        }
        for (sums, column) in sums.iter().zip(self.bins_mut()) {
            column[x..x + LANES].copy_from_slice(sums);
        }
    }

    /// Any bins.
    #[inline(always)]
    fn follow(&mut self, strip: &Strip, rows: std::ops::Range<usize>, x: usize, bins: &Bins) {
        for column in self.bins_mut() {
            column[x..x + LANES].fill(0.0);
        }
        for y in rows {
            let Some([dx, dy]) = gradients(strip, y, x) else { continue };
            // What a lane has reached, it has reached all borders before. So its weight goes into the bin where it stops.
            let mut reached = lengths(&dx, &dy);
            let mut seen = [[0.0; LANES]; 2];
            for lane in 0..LANES {
                let [above, beyond] = turn(dx[lane], dy[lane]);
                seen[0][lane] = if bins.signed { above } else { cotangent(dx[lane], dy[lane]) };
                seen[1][lane] = beyond;
            }
            for (bin, column) in self.sums.chunks_exact_mut(self.stride).enumerate() {
                let seen = &seen[usize::from(bin >= bins.above)];
                let border = bins.borders.get(bin).copied().unwrap_or(f32::NEG_INFINITY);
                let last = bin == bins.borders.len();
                for (lane, sum) in column[x..x + LANES].iter_mut().enumerate() {
                    let further = if (seen[lane] <= border) & !last { reached[lane] } else { 0.0 };
                    *sum += reached[lane] - further;
                    reached[lane] = further;
                }
            }
        }
    }
}

/// `d/dx` and `d/dy` of some columns of a row, `I(x+1) − I(x−1)`, not halved; `None` where all is flat.
#[inline(always)]
fn gradients(strip: &Strip, y: usize, x: usize) -> Option<[[f32; LANES]; 2]> {
    let [above, row, below] = strip.around(y);
    let (left, right) = (row[x..].first_chunk::<LANES>()?, row[x + 2..].first_chunk::<LANES>()?);
    let (above, below) = (above[x..].first_chunk::<LANES>()?, below[x..].first_chunk::<LANES>()?);
    let (mut dx, mut dy) = ([0.0; LANES], [0.0; LANES]);
    let mut any = 0;
    for lane in 0..LANES {
        dx[lane] = right[lane] - left[lane];
        dy[lane] = below[lane] - above[lane];
        any |= dx[lane].to_bits() | dy[lane].to_bits();
    }
    (any != 0).then_some([dx, dy])
}

/// The lengths of gradients, which are the weights of their votes.
#[inline(always)]
fn lengths(dx: &[f32; LANES], dy: &[f32; LANES]) -> [f32; LANES] {
    let mut lengths = [0.0; LANES];
    for lane in 0..LANES {
        lengths[lane] = (dx[lane] * dx[lane] + dy[lane] * dy[lane]).sqrt();
    }
    lengths
}
