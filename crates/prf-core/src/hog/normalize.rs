//! Normalisation of blocks, in place.

use super::Norm;

/// The small number of scikit-image, here too: a feature below it counts as nothing.
const EPSILON: f32 = 1e-5;
/// Where L2-Hys cuts off.
const CLIP: f32 = 0.2;

impl Norm {
    /// Normalises features, block by block.
    pub(super) fn apply(self, features: &mut [f32], block_len: usize) {
        match self {
            Norm::None => {}
            Norm::L1 => each(features, block_len, |block| scale(block, l1(block))),
            Norm::L1Sqrt => each(features, block_len, |block| {
                scale(block, l1(block));
                block.iter_mut().for_each(|v| *v = v.sqrt());
            }),
            Norm::L2 => each(features, block_len, |block| scale(block, l2(block))),
            Norm::L2Hys => each(features, block_len, |block| {
                scale(block, l2(block));
                block.iter_mut().for_each(|v| *v = v.min(CLIP));
                scale(block, l2(block));
            }),
        }
    }
}

fn each(features: &mut [f32], block_len: usize, normalize: impl Fn(&mut [f32])) {
    // One cell of 9 orientations is the most usual block, and the one that there are the most of:
    // with its length known, its loops are unrolled.
    if let (9, (blocks, [])) = (block_len, features.as_chunks_mut::<9>()) {
        blocks.iter_mut().for_each(|block| normalize(block));
    } else {
        features.chunks_exact_mut(block_len).for_each(normalize);
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
