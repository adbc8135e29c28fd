//! Normalisation of blocks, several side by side.

use super::Norm;

/// The small number of scikit-image, here too: a feature below it counts as nothing.
const EPSILON: f32 = 1e-5;
/// Where L2-Hys cuts off.
const CLIP: f32 = 0.2;
/// Blocks that are normalised at a time, each on its own lane.
pub(super) const LANES: usize = 8;

/// One feature of each block.
pub(super) type Lanes = [f32; LANES];

impl Norm {
    /// Normalises blocks of these features.
    #[inline(always)]
    pub(super) fn apply(self, features: &mut [Lanes]) {
        match self {
            Norm::None => {}
            Norm::L1 => scale(features, l1(features)),
            Norm::L1Sqrt => {
                scale(features, l1(features));
                each(features, f32::sqrt);
            }
            Norm::L2 => scale(features, l2(features)),
            Norm::L2Hys => {
                scale(features, l2(features));
                each(features, |v| if v < CLIP { v } else { CLIP });
                scale(features, l2(features));
            }
        }
    }
}

/// `1 / (‖v‖₁ + ε)`; histograms are never negative.
#[inline(always)]
fn l1(features: &[Lanes]) -> Lanes {
    sums(features, |v| v).map(|sum| 1.0 / (sum + EPSILON))
}

/// `1 / √(‖v‖₂² + ε²)`
#[inline(always)]
fn l2(features: &[Lanes]) -> Lanes {
    sums(features, |v| v * v).map(|sum| 1.0 / (sum + EPSILON * EPSILON).sqrt())
}

#[inline(always)]
fn sums(features: &[Lanes], term: impl Fn(f32) -> f32) -> Lanes {
    let mut sums = [0.0; LANES];
    for feature in features {
        for lane in 0..LANES {
            sums[lane] += term(feature[lane]);
        }
    }
    sums
}

#[inline(always)]
fn scale(features: &mut [Lanes], factors: Lanes) {
    for feature in features {
        for lane in 0..LANES {
            feature[lane] *= factors[lane];
        }
    }
}

#[inline(always)]
fn each(features: &mut [Lanes], change: impl Fn(f32) -> f32) {
    for feature in features {
        for lane in feature {
            *lane = change(*lane);
        }
    }
}
