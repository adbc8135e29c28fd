//! Which bin a gradient's direction falls into, without an arc tangent.
//!
//! Bin `k` of `n` holds the directions from `k · span/n` (included) to `(k+1) · span/n` (excluded),
//! where `span` is 180° for unsigned bins and 360° for signed ones. So the bin is the number of
//! borders that the direction has reached. Turned into the upper half plane, a direction has reached
//! a border when its cotangent `dx/dy` is not above the border's. That division is exact where it
//! matters: on the only borders with rational cotangents, 45°, 90° and 135°, which differences of
//! bytes do hit, and where `dy` is 0 (infinite, so below every border).

/// The gradients of one row and the votes that they cast. All have the same length.
#[derive(Clone, Debug, Default)]
pub(super) struct Votes {
    pub(super) dx: Vec<f32>,
    pub(super) dy: Vec<f32>,
    /// The gradient's length: the weight of the vote.
    pub(super) weight: Vec<f32>,
    /// Where the vote goes in the histograms of a row of cells.
    pub(super) place: Vec<u32>,
    /// The first place of the pixel's cell.
    first: Vec<u32>,
    /// The cotangent, as the borders in the upper half plane see it.
    above: Vec<f32>,
    /// The cotangent, as the borders at 180° and beyond see it.
    beyond: Vec<f32>,
}

impl Votes {
    /// Prepares for a row of cells of this size.
    pub(super) fn resize(&mut self, cells: usize, cell_px: usize, orientations: usize) {
        let len = cells * cell_px;
        self.dx.resize(len, 0.0);
        self.dy.resize(len, 0.0);
        self.weight.resize(len, 0.0);
        self.place.resize(len, 0);
        self.above.resize(len, 0.0);
        self.beyond.resize(len, 0.0);
        self.first.clear();
        let places = (0..cells * orientations).step_by(orientations);
        self.first.extend(places.flat_map(|first| std::iter::repeat_n(first as u32, cell_px)));
    }

    fn weigh(&mut self) {
        for ((weight, x), y) in self.weight.iter_mut().zip(&self.dx).zip(&self.dy) {
            *weight = (x * x + y * y).sqrt();
        }
    }

    /// Cotangents of directions of which opposite ones are the same.
    fn turn_unsigned(&mut self) {
        for ((above, &x), &y) in self.above.iter_mut().zip(&self.dx).zip(&self.dy) {
            *above = cotangent(x, y);
        }
    }

    /// Cotangents of directions all around: one below the x axis has reached every border above it.
    fn turn_signed(&mut self) {
        let seen = self.above.iter_mut().zip(&mut self.beyond);
        for (((above, beyond), &x), &y) in seen.zip(&self.dx).zip(&self.dy) {
            let turned = (y < 0.0) | ((y == 0.0) & (x < 0.0));
            *above = if turned { f32::NEG_INFINITY } else { cotangent(x, y) };
            *beyond = if turned { cotangent(x, y) } else { f32::NAN };
        }
    }
}

/// Turning a direction around changes the signs of both, so their ratio stays.
fn cotangent(x: f32, y: f32) -> f32 {
    // Infinite where y is 0, and never minus that. Chosen before dividing, SIMD lanes need not part.
    let x = if y == 0.0 { x.abs() } else { x };
    x / y
}

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

    /// From the gradients of a row to its votes.
    pub(super) fn assign(&self, row: &mut Votes) {
        row.weigh();
        row.place.copy_from_slice(&row.first);
        if self.signed {
            row.turn_signed();
            count(&self.beyond, &row.beyond, &mut row.place);
        } else {
            row.turn_unsigned();
        }
        count(&self.above, &row.above, &mut row.place);
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

/// Adds to each place how many borders its cotangent has reached.
fn count(borders: &[f32], cotangents: &[f32], places: &mut [u32]) {
    // Border by border over a row that stays in cache: such a loop runs on SIMD lanes.
    for &border in borders {
        for (place, &cotangent) in places.iter_mut().zip(cotangents) {
            *place += u32::from(cotangent <= border);
        }
    }
}
