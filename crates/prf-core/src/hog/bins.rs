//! Which bin a gradient's direction falls into, without an arc tangent.
//!
//! Bin `k` of `n` holds the directions from `k · span/n` (included) to `(k+1) · span/n` (excluded),
//! where `span` is 180° for unsigned bins and 360° for signed ones. So the bin is the number of
//! borders that the direction has reached. Turned into the upper half plane, a direction has reached
//! a border when its cotangent `dx/dy` is not above the border's. That division is exact where it
//! matters: on the only borders with rational cotangents, 45°, 90° and 135°, which differences of
//! bytes do hit, and where `dy` is 0 (infinite, so below every border).

/// The borders of a HOG's bins, by their cotangents once turned into the upper half plane.
#[derive(Clone, Debug)]
pub(super) struct Bins {
    pub(super) signed: bool,
    /// One fewer than there are bins, by angle.
    pub(super) borders: Vec<f32>,
    /// How many of them lie below 180°; the others are those that only signed directions reach.
    pub(super) above: usize,
}

impl Bins {
    pub(super) fn new(orientations: usize, signed: bool) -> Bins {
        let span = if signed { 360.0 } else { 180.0 };
        let degrees = (1..orientations).map(|k| span * k as f64 / orientations as f64);
        let (above, beyond): (Vec<_>, Vec<_>) = degrees.partition(|&degrees| degrees < 180.0);
        let turned = beyond.iter().map(|degrees| degrees - 180.0);
        let borders = above.iter().copied().chain(turned).map(border).collect();
        Bins { signed, borders, above: above.len() }
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

/// As the borders at 180° and beyond see a direction, and as those before see it.
#[inline(always)]
pub(super) fn turn(x: f32, y: f32) -> [f32; 2] {
    let cotangent = cotangent(x, y);
    // One below the x axis has reached every border above it.
    if (y < 0.0) | ((y == 0.0) & (x < 0.0)) { [f32::NEG_INFINITY, cotangent] } else { [cotangent, f32::NAN] }
}

/// Turning a direction around changes the signs of both, so their ratio stays.
#[inline(always)]
pub(super) fn cotangent(x: f32, y: f32) -> f32 {
    // Infinite where y is 0, and never minus that. Chosen before dividing, SIMD lanes need not part.
    let x = if y == 0.0 { x.abs() } else { x };
    x / y
}
