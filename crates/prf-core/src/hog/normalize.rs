//! Normalisation of blocks, several side by side.

use super::Norm;
use super::lanes::{Lanes, WIDTH};

/// The small number of scikit-image, here too: a feature below it counts as nothing.
const EPSILON: f32 = 1e-5;
/// Where L2-Hys cuts off.
const CLIP: f32 = 0.2;
/// One feature of some blocks.
pub(super) type Feature = Lanes<f32>;

impl Norm {
    /// Normalises blocks of these features.
    #[inline(always)]
    pub(super) fn apply(self, features: &mut [Feature]) {
        match self {
            Norm::None => {}
            Norm::L1 => scale(features, l1(features)),
            Norm::L1Sqrt => {
                scale(features, l1(features));
                for feature in features {
                    for value in &mut feature.0 {
                        *value = value.sqrt();
                    }
                }
            }
            Norm::L2 => scale(features, l2(features)),
            Norm::L2Hys => {
                scale(features, l2(features));
                for feature in &mut *features {
                    for value in &mut feature.0 {
                        *value = if *value < CLIP { *value } else { CLIP };
                    }
                }
                scale(features, l2(features));
            }
        }
    }
}

/// `1 / (‖v‖₁ + ε)`; histograms are never negative.
#[inline(always)]
fn l1(features: &[Feature]) -> Feature {
    let mut sums = Feature::zero();
    for feature in features {
        for i in 0..WIDTH {
            sums.0[i] += feature.0[i];
        }
    }
    for sum in &mut sums.0 {
        *sum = 1.0 / (*sum + EPSILON);
    }
    sums
}

/// `1 / √(‖v‖₂² + ε²)`
#[inline(always)]
fn l2(features: &[Feature]) -> Feature {
    let mut sums = Feature::zero();
    for feature in features {
        for i in 0..WIDTH {
            sums.0[i] += feature.0[i] * feature.0[i];
        }
    }
    for sum in &mut sums.0 {
        *sum = 1.0 / (*sum + EPSILON * EPSILON).sqrt();
    }
    sums
}

#[inline(always)]
fn scale(features: &mut [Feature], factors: Feature) {
    for feature in features {
        for i in 0..WIDTH {
            feature.0[i] *= factors.0[i];
        }
    }
}
