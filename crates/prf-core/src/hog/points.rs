//! Cells of a single pixel that are blocks of their own: one vote makes all features of a block.

use super::bins::Bins;
use super::lanes::WIDTH;
use super::normalize::Feature;
use super::strip::Strip;
use super::votes::Votes;
use super::{HogLayout, Norm};

/// Writes the features of row `y` of the strip to `out`. Votes are multiplied by `unit`.
#[inline(always)]
pub(super) fn fill_row(
    votes: &mut Votes,
    strip: &Strip,
    y: usize,
    (bins, unit, norm): (&Bins, f32, Norm),
    layout: &HogLayout,
    out: &mut [f32],
) {
    let len = layout.block_len();
    for (chunk, out) in out.chunks_mut(WIDTH * len).enumerate() {
        votes.take(strip, y..y + 1, chunk * WIDTH, bins);
        let mut feature = Feature::zero();
        for i in 0..WIDTH {
            feature.0[i] = votes.weights[0].0[i] * unit;
        }
        // The features that are 0 change no norm.
        norm.apply(std::slice::from_mut(&mut feature));
        out.fill(0.0);
        let places = bins.places(&votes.directions[0]);
        let votes = feature.0.iter().zip(&places.0);
        for (block, (&value, &place)) in out.chunks_exact_mut(len).zip(votes) {
            block[place as usize] = value;
        }
    }
}
