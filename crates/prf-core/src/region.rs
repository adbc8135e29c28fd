//! A rectangle of pixels inside a larger picture, the two kinds of pixel, and rows of them one after the other.

/// A pixel's value: a byte, or a float in [0, 1].
pub(crate) trait Sample: Copy + PartialEq {
    /// White, in the sample's own unit; black is 0.
    const WHITE: f32;
    /// The value in its own unit, exactly.
    fn value(self) -> f32;
}

impl Sample for u8 {
    const WHITE: f32 = 255.0;

    fn value(self) -> f32 {
        f32::from(self)
    }
}

impl Sample for f32 {
    const WHITE: f32 = 1.0;

    fn value(self) -> f32 {
        // −0 becomes 0: a difference of −0 would turn a direction around.
        self + 0.0
    }
}

/// Pixels whose rows lie `stride` apart.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Region<'a, P> {
    pixels: &'a [P],
    stride: usize,
    width: usize,
    height: usize,
}

impl<'a, P> Region<'a, P> {
    /// A whole picture. `pixels` holds `width * height` values, both at least 1.
    pub(crate) fn whole(width: usize, height: usize, pixels: &'a [P]) -> Region<'a, P> {
        debug_assert_eq!(pixels.len(), width * height);
        Region { pixels, stride: width, width, height }
    }

    /// The part of it inside `rect`, which lies within it.
    pub(crate) fn within(self, rect: crate::Rect) -> Region<'a, P> {
        debug_assert!(rect.x + rect.width <= self.width && rect.y + rect.height <= self.height);
        Region { pixels: &self.pixels[rect.y * self.stride + rect.x..], width: rect.width, height: rect.height, ..self }
    }

    pub(crate) fn width(&self) -> usize {
        self.width
    }

    pub(crate) fn height(&self) -> usize {
        self.height
    }

    /// `[height, width]`.
    pub(crate) fn shape(&self) -> [usize; 2] {
        [self.height, self.width]
    }

    pub(crate) fn row(&self, y: usize) -> &'a [P] {
        &self.pixels[y * self.stride..][..self.width]
    }
}

/// A picture whose rows are taken one after the other: one that is there, or one that is made on the way.
pub(crate) trait Rows {
    /// White, in the unit of the values; black is 0.
    const WHITE: f32;

    /// `[height, width]`.
    fn shape(&self) -> [usize; 2];

    /// Writes row `y`. Rows are asked for from the top on, and none that lies more than two above the lowest so far.
    fn row_into(&mut self, y: usize, out: &mut [f32]);
}

impl<P: Sample> Rows for Region<'_, P> {
    const WHITE: f32 = P::WHITE;

    fn shape(&self) -> [usize; 2] {
        Region::shape(self)
    }

    #[inline(always)]
    fn row_into(&mut self, y: usize, out: &mut [f32]) {
        for (out, pixel) in out.iter_mut().zip(self.row(y)) {
            *out = pixel.value();
        }
    }
}
