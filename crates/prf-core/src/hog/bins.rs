//! Which bins a gradient's direction has reached, without an arc tangent.
//!
//! Bin `k` of `n` holds the directions from `k · span/n` (included) to `(k+1) · span/n` (excluded),
//! where `span` is 180° for unsigned bins and 360° for signed ones. So a direction has reached all bins
//! up to its own. Turned into the upper half plane, a direction has reached
//! a bin's border when its cotangent `dx/dy` is not above the border's. That division is exact where it
//! matters: on the only borders with rational cotangents, 45°, 90° and 135°, which differences of
//! bytes do hit, and where `dy` is 0 (infinite, so below every border).

use super::lanes::{Lanes, WIDTH};

/// Bins that are asked for at a time.
pub(super) const BINS: usize = 3;

/// Where the bins of a HOG begin, by the cotangents once turned into the upper half plane.
#[derive(Clone, Debug)]
pub(super) struct Bins {
    signed: bool,
    borders: Vec<Border>,
}

/// Where a bin begins.
#[derive(Clone, Copy, Debug)]
pub(super) struct Border {
    cotangent: f32,
    /// Whether it lies at 180° or beyond.
    is_beyond: bool,
}

/// Cotangents of directions, as the borders see them.
#[derive(Clone, Copy, Debug)]
pub(super) struct Directions {
    /// By the borders up to 180°.
    above: Lanes<f32>,
    /// By those beyond; only signed bins have some.
    beyond: Lanes<f32>,
}

impl Directions {
    pub(super) fn none() -> Directions {
        Directions { above: Lanes::zero(), beyond: Lanes::zero() }
    }

    /// The cotangents that this border sees.
    #[inline(always)]
    pub(super) fn seen_by(&self, border: Border) -> &Lanes<f32> {
        if border.is_beyond { &self.beyond } else { &self.above }
    }
}

impl Border {
    /// Of no bin: nothing reaches it, as nothing compares with NaN.
    const NONE: Border = Border { cotangent: f32::NAN, is_beyond: false };

    #[inline(always)]
    pub(super) fn is_reached(self, cotangent: f32) -> bool {
        cotangent <= self.cotangent
    }
}

impl Bins {
    pub(super) fn new(orientations: usize, signed: bool) -> Bins {
        let span = if signed { 360.0 } else { 180.0 };
        let border = |k: usize| match span * k as f64 / orientations as f64 {
            // Every direction has reached the first bin, also one whose cotangent is infinite.
            0.0 => Border { cotangent: f32::INFINITY, is_beyond: false },
            degrees if degrees < 180.0 => Border { cotangent: cotangent_of(degrees), is_beyond: false },
            degrees => Border { cotangent: cotangent_of(degrees - 180.0), is_beyond: true },
        };
        let mut borders: Vec<Border> = (0..orientations).map(border).collect();
        borders.resize(orientations + BINS, Border::NONE);
        Bins { signed, borders }
    }

    /// Where some bins from this one on begin; nothing reaches those behind the last.
    #[inline(always)]
    pub(super) fn from(&self, bin: usize) -> [Border; BINS] {
        self.borders[bin..].first_chunk().copied().unwrap_or([Border::NONE; BINS])
    }

    /// The directions of these gradients.
    #[inline(always)]
    pub(super) fn directions(&self, dx: &Lanes<f32>, dy: &Lanes<f32>, directions: &mut Directions) {
        let Directions { above, beyond } = directions;
        for i in 0..WIDTH {
            above.0[i] = cotangent(dx.0[i], dy.0[i]);
        }
        if self.signed {
            for i in 0..WIDTH {
                // One below the x axis has reached every border above it.
                let turned = (dy.0[i] < 0.0) | ((dy.0[i] == 0.0) & (dx.0[i] < 0.0));
                beyond.0[i] = if turned { above.0[i] } else { f32::NAN };
                above.0[i] = if turned { f32::NEG_INFINITY } else { above.0[i] };
            }
        }
    }

    /// The bins that these directions fall into.
    #[inline(always)]
    pub(super) fn places(&self, directions: &Directions) -> Lanes<u32> {
        let mut places = Lanes::zero();
        for &border in &self.borders[1..] {
            let seen = directions.seen_by(border);
            for i in 0..WIDTH {
                places.0[i] += u32::from(border.is_reached(seen.0[i]));
            }
        }
        places
    }
}

/// Cotangent of an angle from 0 up to 180 degrees.
fn cotangent_of(degrees: f64) -> f32 {
    let (sin, cos) = degrees.to_radians().sin_cos();
    if sin == 0.0 {
        return f32::INFINITY;
    }
    // At 90° the cosine comes out as 6e-17, and at 45° the two differ by a bit.
    ((cos / sin * 1e12).round() / 1e12) as f32
}

/// Turning a direction around changes the signs of both, so their ratio stays.
#[inline(always)]
fn cotangent(x: f32, y: f32) -> f32 {
    // Infinite where y is 0, and never minus that. Chosen before dividing, SIMD lanes need not part.
    let x = if y == 0.0 { x.abs() } else { x };
    x / y
}
