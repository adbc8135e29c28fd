//! Distance and reward (paper, section "Perceptual reward functions").

use serde::{Deserialize, Serialize};

use crate::{Error, HogLayout, HogParams};

/// Parameters of a perceptual reward `F(T_A, T_G) = exp(−D)` (paper, section "Perceptual reward functions"). In a file, every
/// key may be left out.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct RewardParams {
    /// What templates are compared by.
    pub hog: HogParams,
    /// What the distance is divided by.
    pub scale: DistanceScale,
}

impl RewardParams {
    /// Checks every parameter's range.
    ///
    /// # Errors
    ///
    /// [`Error::InvalidParam`] with the key of the first parameter that is out of range.
    pub fn validate(&self) -> Result<(), Error> {
        self.hog.validate().map_err(|error| error.within("hog"))
    }
}

/// What the distance between two HOGs is divided by.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum DistanceScale {
    /// 1: the paper's own distance. It grows with the number of cells, so rewards soon underflow.
    None,
    /// √(number of blocks): the root mean square over blocks. With the L1 and L2 norms it is at most
    /// √2, so that `F` is at least 0.24, whatever the picture's size.
    #[default]
    SqrtBlocks,
    /// √(number of features): the root mean square over features.
    SqrtFeatures,
}

impl DistanceScale {
    /// The divisor for HOGs of this layout, at least 1.
    #[must_use]
    pub fn divisor(self, layout: &HogLayout) -> f32 {
        let [rows, columns] = layout.blocks();
        match self {
            DistanceScale::None => 1.0,
            DistanceScale::SqrtBlocks => ((rows * columns) as f32).sqrt(),
            DistanceScale::SqrtFeatures => (layout.len() as f32).sqrt(),
        }
    }
}

/// How near a template is to the goal (paper, section "Perceptual reward functions").
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Score {
    /// `F = exp(-D)`, above 0 and at most 1; 1 for the goal itself. Where `exp` underflows it is the
    /// least positive normal number.
    pub reward: f32,
    /// `D = ‖H(T_A) − H(T_G)‖₂ / scale`, at least 0.
    pub distance: f32,
}

impl Score {
    /// The score of two HOGs of the same layout.
    pub(crate) fn of(agent: &[f32], goal: &[f32], divisor: f32) -> Score {
        let distance = squared_distance(agent, goal).sqrt() / divisor;
        Score { reward: (-distance).exp().max(f32::MIN_POSITIVE), distance }
    }
}

/// `‖a − b‖²`, summed in lanes so that it runs on SIMD.
fn squared_distance(a: &[f32], b: &[f32]) -> f32 {
    const LANES: usize = 16;
    debug_assert_eq!(a.len(), b.len());
    let ((a, a_rest), (b, b_rest)) = (a.as_chunks::<LANES>(), b.as_chunks::<LANES>());
    let mut sums = [0.0f32; LANES];
    for (a, b) in a.iter().zip(b) {
        for lane in 0..LANES {
            let d = a[lane] - b[lane];
            sums[lane] += d * d;
        }
    }
    let rest = a_rest.iter().zip(b_rest).map(|(a, b)| (a - b) * (a - b));
    sums.iter().sum::<f32>() + rest.sum::<f32>()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::CellSize;

    #[test]
    fn a_reward_never_reaches_zero() {
        let score = Score::of(&[1e4], &[0.0], 1.0);
        assert_eq!(score.distance, 1e4);
        assert!(score.reward > 0.0);
    }

    #[test]
    fn distances_of_any_length_are_euclidean() {
        for len in [1, 15, 16, 17, 40] {
            let a: Vec<f32> = (0..len).map(|i| i as f32).collect();
            let expected = a.iter().map(|v| v * v).sum::<f32>().sqrt();
            assert!((Score::of(&a, &vec![0.0; len], 2.0).distance - expected / 2.0).abs() < 1e-4);
        }
    }

    #[test]
    fn divisors_are_the_square_roots_of_their_counts() {
        let hog = HogParams { cell: CellSize::Px(2), block_cells: 2, ..HogParams::default() };
        let layout = HogLayout::new(&hog, 10, 6).expect("a block fits");
        assert_eq!(layout.blocks(), [2, 4]);
        assert_eq!(DistanceScale::None.divisor(&layout), 1.0);
        assert_eq!(DistanceScale::SqrtBlocks.divisor(&layout), 8f32.sqrt());
        assert_eq!(DistanceScale::SqrtFeatures.divisor(&layout), (8f32 * 36.0).sqrt());
    }

    #[test]
    fn a_bad_hog_is_named_from_the_root() {
        let hog = HogParams { cell: CellSize::Fraction(2.0), ..HogParams::default() };
        let error = RewardParams { hog, ..RewardParams::default() }.validate().expect_err("above 1");
        assert!(error.to_string().starts_with("hog.cell.fraction: got 2,"), "{error}");
    }
}
