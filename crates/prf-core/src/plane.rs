//! Grey pictures of floats: what HOG works on once a template has been rescaled.

use crate::frame::check_shape;
use crate::region::Region;
use crate::{Error, FrameView};

/// The largest value that a pixel may have; its square still fits an `f32` many times over.
const MAX_VALUE: f32 = 1e6;

/// A grey picture that owns its pixels: `height` rows of `width` floats, 0 black and 1 white. Both sides are at least 1.
#[derive(Clone, Debug, PartialEq)]
pub struct Plane {
    width: usize,
    height: usize,
    pixels: Vec<f32>,
}

impl Plane {
    /// A picture of these pixels, row by row from the top.
    ///
    /// # Errors
    ///
    /// As [`PlaneView::new`].
    pub fn from_vec(width: usize, height: usize, pixels: Vec<f32>) -> Result<Plane, Error> {
        PlaneView::new(width, height, &pixels)?;
        Ok(Plane { width, height, pixels })
    }

    /// Bytes 0 to 255 as floats 0 to 1.
    #[must_use]
    pub fn from_frame(frame: FrameView<'_>) -> Plane {
        Plane {
            width: frame.width(),
            height: frame.height(),
            pixels: frame.as_slice().iter().map(|&v| f32::from(v) / 255.0).collect(),
        }
    }

    /// Gives it another size, both sides at least 1, and lends its pixels, which hold anything finite. Allocates only
    /// to grow.
    pub(crate) fn reshape(&mut self, width: usize, height: usize) -> &mut [f32] {
        (self.width, self.height) = (width, height);
        self.pixels.resize(width * height, 0.0);
        &mut self.pixels
    }

    /// Width in pixels.
    #[must_use]
    pub fn width(&self) -> usize {
        self.width
    }

    /// Height in pixels.
    #[must_use]
    pub fn height(&self) -> usize {
        self.height
    }

    /// All pixels, row by row from the top.
    #[must_use]
    pub fn as_slice(&self) -> &[f32] {
        &self.pixels
    }

    /// The picture, borrowed.
    #[must_use]
    pub fn view(&self) -> PlaneView<'_> {
        PlaneView { width: self.width, height: self.height, pixels: &self.pixels }
    }
}

/// A grey picture whose pixels are borrowed: `height` rows of `width` floats with no gap between them, 0 black and 1 white.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlaneView<'a> {
    width: usize,
    height: usize,
    pixels: &'a [f32],
}

impl<'a> PlaneView<'a> {
    /// A view of these pixels, row by row from the top. Values are meant to lie in [0, 1]; others
    /// are taken as they are.
    ///
    /// # Errors
    ///
    /// [`Error::Shape`] when a side is 0 or `pixels` doesn't hold `width * height` values,
    /// [`Error::PixelValue`] when one is not finite or larger than a million.
    pub fn new(width: usize, height: usize, pixels: &'a [f32]) -> Result<PlaneView<'a>, Error> {
        check_shape(width, height, pixels.len())?;
        // Without an early exit, so that it runs many at a time. NaN is not below anything.
        let is_fine = |v: f32| v.abs() <= MAX_VALUE;
        if !pixels.iter().fold(true, |fine, &v| fine & is_fine(v)) {
            let at = pixels.iter().position(|&v| !is_fine(v)).unwrap_or(0);
            return Err(Error::PixelValue { x: at % width, y: at / width, value: pixels[at] });
        }
        Ok(PlaneView { width, height, pixels })
    }

    /// Width in pixels.
    #[must_use]
    pub fn width(&self) -> usize {
        self.width
    }

    /// Height in pixels.
    #[must_use]
    pub fn height(&self) -> usize {
        self.height
    }

    /// All pixels, row by row from the top.
    #[must_use]
    pub fn as_slice(&self) -> &'a [f32] {
        self.pixels
    }

    pub(crate) fn region(&self) -> Region<'a, f32> {
        Region::whole(self.width, self.height, self.pixels)
    }
}
