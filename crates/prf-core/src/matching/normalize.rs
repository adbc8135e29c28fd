//! From correlations to scores.

use super::integral::Integral;
use super::template::{Template, Terms};
use crate::FrameView;
use crate::simd::Kernel;

/// How far a score of the map may be from the exact one. Where more than that is possible, because the window is
/// nearly flat, the score is computed from whole numbers instead.
pub(super) const TOLERANCE: f32 = 4e-5;

/// Sums over the windows of one row of the map.
#[derive(Clone, Debug)]
pub(super) struct WindowRow {
    sums: Vec<f64>,
    squares: Vec<f64>,
}

impl WindowRow {
    pub(super) fn new(windows: usize) -> WindowRow {
        WindowRow { sums: vec![0.0; windows], squares: vec![0.0; windows] }
    }

    /// Windows in a row.
    pub(super) fn windows(&self) -> usize {
        self.sums.len()
    }

    #[inline(always)]
    fn fill(&mut self, template: &Template, integral: &Integral, y: usize) {
        self.sums.fill(0.0);
        self.squares.fill(0.0);
        for patch in template.patches() {
            integral.add_row(patch, y, &mut self.sums, &mut self.squares);
        }
    }
}

/// Turns the correlations in `map` into scores, in place.
pub(super) struct Normalize<'a> {
    pub(super) template: &'a Template,
    pub(super) frame: FrameView<'a>,
    pub(super) integral: &'a Integral,
    pub(super) row: &'a mut WindowRow,
    /// What was subtracted from the pixels.
    pub(super) centre: f64,
    /// How far a correlation may be from the exact one.
    pub(super) error: f64,
    pub(super) map: &'a mut [f32],
}

impl Kernel for Normalize<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let terms = self.template.terms(self.centre);
        let doubtful = (self.error * terms.scale / f64::from(TOLERANCE)).powi(2) as f32;
        let windows = self.row.windows();
        for (y, scores) in self.map.chunks_exact_mut(windows).enumerate() {
            self.row.fill(self.template, self.integral, y);
            if normalize(&terms, self.row, doubtful, scores) {
                for (x, score) in scores.iter_mut().enumerate() {
                    let energy = terms.energy(self.row.sums[x], self.row.squares[x]) as f32;
                    if energy > 0.0 && energy < doubtful {
                        let sums = self.integral.window(self.template.patches(), x, y);
                        *score = self.template.score(self.frame, x, y, sums) as f32;
                    }
                }
            }
        }
    }
}

/// Whether the row has windows with less energy than `doubtful`, flat ones aside.
#[inline(always)]
fn normalize(terms: &Terms, row: &WindowRow, doubtful: f32, scores: &mut [f32]) -> bool {
    let mut seen = false;
    for ((score, &sum), &square) in scores.iter_mut().zip(&row.sums).zip(&row.squares) {
        let energy = terms.energy(sum, square) as f32;
        let numerator = (terms.numerator(*score, sum) * terms.scale) as f32;
        let value = (numerator / energy.sqrt()).max(terms.least).min(1.0);
        *score = if energy > 0.0 { value } else { 0.0 };
        seen |= (energy > 0.0) & (energy < doubtful);
    }
    seen
}
