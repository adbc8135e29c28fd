//! Which bin a gradient's direction falls into, without an arc tangent.
//!
//! Bin `k` of `n` holds the directions from `k · span/n` (included) to `(k+1) · span/n` (excluded),
//! where `span` is 180° for unsigned bins and 360° for signed ones. So the bin is the number of
//! borders that the direction has reached. Turned into the upper half plane, a direction has reached
//! a border when its cotangent `dx/dy` is not above the border's. That division is exact where it
//! matters: on the only borders with rational cotangents, 45°, 90° and 135°, which differences of
//! bytes do hit, and where `dy` is 0 (infinite, so below every border).

use super::lanes::{Lanes, WIDTH};

/// The borders of a HOG's bins, by their cotangents once turned into the upper half plane.
#[derive(Clone, Debug)]
pub(super) struct Bins {
    signed: bool,
    above: Vec<f32>,
    /// Those at 180° or beyond.
    beyond: Vec<f32>,
}

impl Bins {
    pub(super) fn new(orientations: usize, signed: bool) -> Bins {
        let span = if signed { 360.0 } else { 180.0 };
        let degrees = (1..orientations).map(|k| span * k as f64 / orientations as f64);
        let (above, beyond): (Vec<_>, Vec<_>) = degrees.partition(|&degrees| degrees < 180.0);
        Bins {
            signed,
            above: above.into_iter().map(border).collect(),
            beyond: beyond.into_iter().map(|degrees| border(degrees - 180.0)).collect(),
        }
    }

    /// The bins that these gradients fall into.
    #[inline(always)]
    pub(super) fn assign(&self, dx: &Lanes<f32>, dy: &Lanes<f32>, bins: &mut Lanes<u32>) {
        *bins = Lanes::zero();
        let mut cotangents = Lanes::zero();
        for i in 0..WIDTH {
            cotangents.0[i] = cotangent(dx.0[i], dy.0[i]);
        }
        if self.signed {
            let (mut above, mut beyond) = (Lanes::zero(), Lanes::zero());
            for i in 0..WIDTH {
                // One below the x axis has reached every border above it.
                let turned = (dy.0[i] < 0.0) | ((dy.0[i] == 0.0) & (dx.0[i] < 0.0));
                above.0[i] = if turned { f32::NEG_INFINITY } else { cotangents.0[i] };
                beyond.0[i] = if turned { cotangents.0[i] } else { f32::NAN };
            }
            count(&self.beyond, &beyond, bins);
            cotangents = above;
        }
        count(&self.above, &cotangents, bins);
    }
}

/// Cotangent of an angle from 0 up to 180 degrees.
fn border(degrees: f64) -> f32 {
    let (sin, cos) = degrees.to_radians().sin_cos();
    if sin == 0.0 {
        return f32::INFINITY;
    }
    // At 90° the cosine comes out as 6e-17, and at 45° the two differ by a bit.
    ((cos / sin * 1e12).round() / 1e12) as f32
}

/// Turning a direction around changes the signs of both, so their ratio stays.
#[inline(always)]
pub(super) fn cotangent(x: f32, y: f32) -> f32 {
    // Infinite where y is 0, and never minus that. Chosen before dividing, SIMD lanes need not part.
    let x = if y == 0.0 { x.abs() } else { x };
    x / y
}

/// Adds to each bin how many borders its cotangent has reached.
#[inline(always)]
fn count(borders: &[f32], cotangents: &Lanes<f32>, bins: &mut Lanes<u32>) {
    for &border in borders {
        for i in 0..WIDTH {
            bins.0[i] += u32::from(cotangents.0[i] <= border);
        }
    }
}
