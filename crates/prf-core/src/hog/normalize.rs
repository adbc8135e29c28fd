//! Normalisation of blocks, in place.

use super::Norm;

/// The small number of scikit-image, here too: a feature below it counts as nothing.
const EPSILON: f32 = 1e-5;
/// Where L2-Hys cuts off.
const CLIP: f32 = 0.2;

impl Norm {
    /// Normalises features, block by block.
    pub(super) fn apply(self, features: &mut [f32], block_len: usize) {
        let blocks = features.chunks_exact_mut(block_len);
        match self {
            Norm::None => {}
            Norm::L1 => blocks.for_each(|block| scale(block, l1(block))),
            Norm::L1Sqrt => blocks.for_each(|block| {
                scale(block, l1(block));
                block.iter_mut().for_each(|v| *v = v.sqrt());
            }),
            Norm::L2 => blocks.for_each(|block| scale(block, l2(block))),
            Norm::L2Hys => blocks.for_each(|block| {
                scale(block, l2(block));
                block.iter_mut().for_each(|v| *v = v.min(CLIP));
                scale(block, l2(block));
            }),
        }
    }
}

/// `1 / (‖v‖₁ + ε)`; histograms are never negative.
fn l1(block: &[f32]) -> f32 {
    1.0 / (block.iter().sum::<f32>() + EPSILON)
}

/// `1 / √(‖v‖₂² + ε²)`
fn l2(block: &[f32]) -> f32 {
    1.0 / (block.iter().map(|v| v * v).sum::<f32>() + EPSILON * EPSILON).sqrt()
}

fn scale(block: &mut [f32], factor: f32) {
    block.iter_mut().for_each(|v| *v *= factor);
}
