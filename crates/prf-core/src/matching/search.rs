//! The best window of a map.

use super::Match;
use super::integral::Integral;
use super::normalize::TOLERANCE;
use super::template::Template;
use crate::simd::Kernel;
use crate::{FrameView, Rect};

/// Finds the best window: exact scores of all that may be it by the map.
pub(super) struct Search<'a> {
    pub(super) template: &'a Template,
    pub(super) frame: FrameView<'a>,
    pub(super) integral: &'a Integral,
    /// Windows in a row of the map.
    pub(super) windows: usize,
    pub(super) map: &'a [f32],
}

impl Kernel for Search<'_> {
    type Output = Match;

    #[inline(always)]
    fn run(self) -> Match {
        // The best one may be this much too low in the map, and another one as much too high.
        let least = largest(self.map) - 2.0 * TOLERANCE;
        let mut best = (f64::NEG_INFINITY, [0, 0]);
        for (y, row) in self.map.chunks_exact(self.windows).enumerate() {
            if !any_reaches(row, least) {
                continue;
            }
            for (x, &approximate) in row.iter().enumerate() {
                if approximate >= least {
                    let sums = self.integral.window(self.template.patches(), x, y);
                    let score = self.template.score(self.frame, x, y, sums);
                    if score > best.0 {
                        best = (score, [y, x]);
                    }
                }
            }
        }
        let ((score, [y, x]), [height, width]) = (best, self.template.shape());
        Match { rect: Rect { x, y, width, height }, score: score as f32 }
    }
}

/// Of scores, which are at least −1; taken in lanes, so that it runs on SIMD.
#[inline(always)]
fn largest(scores: &[f32]) -> f32 {
    let (chunks, rest) = scores.as_chunks::<32>();
    let mut lanes = [-1.0f32; 32];
    for chunk in chunks {
        for (lane, &score) in lanes.iter_mut().zip(chunk) {
            *lane = if score > *lane { score } else { *lane };
        }
    }
    lanes.iter().chain(rest).fold(-1.0, |most, &score| most.max(score))
}

/// Without an early exit, so that it runs many scores at a time: most rows have none.
#[inline(always)]
fn any_reaches(scores: &[f32], least: f32) -> bool {
    let mut seen = false;
    for &score in scores {
        seen |= score >= least;
    }
    seen
}
