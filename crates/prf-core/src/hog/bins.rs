//! Which bin a gradient's direction falls into, without an arc tangent.
//!
//! Bin `k` of `n` holds the directions from `k · span/n` (included) to `(k+1) · span/n` (excluded),
//! where `span` is 180° for unsigned bins and 360° for signed ones. So the bin is the number of
//! borders that the direction has reached. Turned into the upper half plane, a direction has reached
//! a border when its cotangent `dx/dy` is not above the border's. That division is exact where it
//! matters: on the only borders with rational cotangents, 45°, 90° and 135°, which differences of
//! bytes do hit, and where `dy` is 0 (infinite, so below every border).

/// A border between two bins.
#[derive(Clone, Copy, Debug)]
struct Border {
    /// Of the border, turned into the upper half plane.
    cotangent: f32,
    /// Whether it lies at 180° or beyond.
    beyond: bool,
}

impl Border {
    fn at(degrees: f64) -> Border {
        let beyond = degrees >= 180.0;
        let turned = if beyond { degrees - 180.0 } else { degrees };
        let (sin, cos) = turned.to_radians().sin_cos();
        // At 90° the cosine comes out as 6e-17, and at 45° the two differ by a bit.
        let cotangent = if sin == 0.0 { f64::INFINITY } else { (cos / sin * 1e12).round() / 1e12 };
        Border { cotangent: cotangent as f32, beyond }
    }

    /// Adds 1 to the bin of every gradient that has reached this border.
    fn count(self, cotangents: &[f32], below: &[u32], bins: &mut [u32]) {
        let reached = |cotangent: f32| u32::from(cotangent <= self.cotangent);
        let gradients = bins.iter_mut().zip(cotangents).zip(below);
        // The test stands outside of the loop, so that the loop runs on SIMD lanes.
        if self.beyond {
            gradients.for_each(|((bin, &c), &below)| *bin += reached(c) & below);
        } else {
            gradients.for_each(|((bin, &c), &below)| *bin += reached(c) | below);
        }
    }
}

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
    /// All ones where a signed gradient pointed below the x axis.
    below: Vec<u32>,
}

impl Votes {
    /// Prepares for a row of cells of this size.
    pub(super) fn resize(&mut self, cells: usize, cell_px: usize, orientations: usize) {
        let len = cells * cell_px;
        self.dx.resize(len, 0.0);
        self.dy.resize(len, 0.0);
        self.weight.resize(len, 0.0);
        self.place.resize(len, 0);
        self.below.resize(len, 0);
        self.first.clear();
        let places = (0..cells * orientations).step_by(orientations);
        self.first.extend(places.flat_map(|first| std::iter::repeat_n(first as u32, cell_px)));
    }

    /// Weighs the gradients, turns them into the upper half plane and leaves their cotangents in `dx`.
    fn prepare(&mut self, signed: bool) {
        let signed = u32::from(signed);
        let gradients = self.dx.iter_mut().zip(&self.dy);
        let votes = self.weight.iter_mut().zip(&mut self.below);
        for ((x, &y), (weight, below)) in gradients.zip(votes) {
            *weight = (*x * *x + y * y).sqrt();
            *below = u32::from((y < 0.0) | ((y == 0.0) & (*x < 0.0))) & signed;
            // Turning changes both signs, so their ratio stays, except for that of infinity.
            *x = if y == 0.0 { f32::INFINITY } else { *x / y };
        }
        self.place.copy_from_slice(&self.first);
    }
}

/// The borders of a HOG's bins.
#[derive(Clone, Debug)]
pub(super) struct Bins {
    borders: Vec<Border>,
    signed: bool,
}

impl Bins {
    pub(super) fn new(orientations: usize, signed: bool) -> Bins {
        let span = if signed { 360.0 } else { 180.0 };
        let border = |k| Border::at(span * k as f64 / orientations as f64);
        Bins { borders: (1..orientations).map(border).collect(), signed }
    }

    /// From the gradients of a row to its votes; the gradients are used up.
    pub(super) fn assign(&self, row: &mut Votes) {
        row.prepare(self.signed);
        for border in &self.borders {
            border.count(&row.dx, &row.below, &mut row.place);
        }
    }
}
