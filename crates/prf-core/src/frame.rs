//! Grey pictures of bytes: what worlds draw and files hold.

use crate::Error;
use crate::region::Region;

/// A grey picture that owns its pixels: `height` rows of `width` bytes, 0 black and 255 white.
/// Both sides are at least 1.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Frame {
    width: usize,
    height: usize,
    pixels: Vec<u8>,
}

impl Frame {
    /// A black picture.
    ///
    /// # Panics
    ///
    /// When a side is 0, or the picture doesn't fit the address space.
    #[must_use]
    pub fn new(width: usize, height: usize) -> Frame {
        assert!(width > 0 && height > 0, "a frame of {width}x{height} has no pixels");
        let len = width.checked_mul(height);
        let len = len.expect("a frame's pixels can be counted");
        Frame { width, height, pixels: vec![0; len] }
    }

    /// A picture of these pixels, row by row from the top.
    ///
    /// # Errors
    ///
    /// [`Error::Shape`] when a side is 0 or `pixels` doesn't hold `width * height` values.
    pub fn from_vec(width: usize, height: usize, pixels: Vec<u8>) -> Result<Frame, Error> {
        check_shape(width, height, pixels.len())?;
        Ok(Frame { width, height, pixels })
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
    pub fn as_slice(&self) -> &[u8] {
        &self.pixels
    }

    /// All pixels, row by row from the top.
    pub fn as_mut_slice(&mut self) -> &mut [u8] {
        &mut self.pixels
    }

    /// Row `y`, counted from the top.
    ///
    /// # Panics
    ///
    /// When there is no such row.
    #[must_use]
    pub fn row(&self, y: usize) -> &[u8] {
        &self.pixels[y * self.width..][..self.width]
    }

    /// Row `y`, counted from the top.
    ///
    /// # Panics
    ///
    /// When there is no such row.
    pub fn row_mut(&mut self, y: usize) -> &mut [u8] {
        &mut self.pixels[y * self.width..][..self.width]
    }

    /// Gives every pixel the same value.
    pub fn fill(&mut self, value: u8) {
        self.pixels.fill(value);
    }

    /// Makes every pixel black whose counterpart in `mask`, of the same width and height, is.
    pub(crate) fn blacken_outside(&mut self, mask: FrameView<'_>) {
        debug_assert_eq!([self.width, self.height], [mask.width, mask.height]);
        for (pixel, &mask) in self.pixels.iter_mut().zip(mask.pixels) {
            if mask == 0 {
                *pixel = 0;
            }
        }
    }

    /// The picture, borrowed.
    #[must_use]
    pub fn view(&self) -> FrameView<'_> {
        FrameView { width: self.width, height: self.height, pixels: &self.pixels }
    }

    /// The picture, borrowed to be drawn on.
    pub fn view_mut(&mut self) -> FrameMut<'_> {
        FrameMut { width: self.width, height: self.height, pixels: &mut self.pixels }
    }
}

/// A grey picture to be drawn on, whose pixels are borrowed: `height` rows of `width` bytes with no gap between them.
#[derive(Debug)]
pub struct FrameMut<'a> {
    width: usize,
    height: usize,
    pixels: &'a mut [u8],
}

impl<'a> FrameMut<'a> {
    /// A view of these pixels, row by row from the top.
    ///
    /// # Errors
    ///
    /// [`Error::Shape`] when a side is 0 or `pixels` doesn't hold `width * height` values.
    pub fn new(width: usize, height: usize, pixels: &'a mut [u8]) -> Result<FrameMut<'a>, Error> {
        check_shape(width, height, pixels.len())?;
        Ok(FrameMut { width, height, pixels })
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
    pub fn as_mut_slice(&mut self) -> &mut [u8] {
        self.pixels
    }

    /// Row `y`, counted from the top.
    ///
    /// # Panics
    ///
    /// When there is no such row.
    pub fn row_mut(&mut self, y: usize) -> &mut [u8] {
        &mut self.pixels[y * self.width..][..self.width]
    }

    /// Gives every pixel the same value.
    pub fn fill(&mut self, value: u8) {
        self.pixels.fill(value);
    }
}

/// A grey picture whose pixels are borrowed: `height` rows of `width` bytes with no gap between them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FrameView<'a> {
    width: usize,
    height: usize,
    pixels: &'a [u8],
}

impl<'a> FrameView<'a> {
    /// A view of these pixels, row by row from the top.
    ///
    /// # Errors
    ///
    /// [`Error::Shape`] when a side is 0 or `pixels` doesn't hold `width * height` values.
    pub fn new(width: usize, height: usize, pixels: &'a [u8]) -> Result<FrameView<'a>, Error> {
        check_shape(width, height, pixels.len())?;
        Ok(FrameView { width, height, pixels })
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
    pub fn as_slice(&self) -> &'a [u8] {
        self.pixels
    }

    /// Row `y`, counted from the top.
    ///
    /// # Panics
    ///
    /// When there is no such row.
    #[must_use]
    pub fn row(&self, y: usize) -> &'a [u8] {
        &self.pixels[y * self.width..][..self.width]
    }

    /// A copy that owns its pixels.
    #[must_use]
    pub fn to_frame(&self) -> Frame {
        Frame { width: self.width, height: self.height, pixels: self.pixels.to_vec() }
    }

    pub(crate) fn region(&self) -> Region<'a, u8> {
        Region::whole(self.width, self.height, self.pixels)
    }
}

/// Both sides are at least 1 and `len` is their product.
pub(crate) fn check_shape(width: usize, height: usize, len: usize) -> Result<(), Error> {
    if width > 0 && height > 0 && width.checked_mul(height) == Some(len) {
        return Ok(());
    }
    Err(Error::Shape { width, height, len })
}
