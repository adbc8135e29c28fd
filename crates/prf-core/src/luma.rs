//! Colour to grey, in this one place.
//!
//! Luma is that of ITU-R Rec. 601, `Y = 0.299 R + 0.587 G + 0.114 B` on the gamma-coded bytes,
//! rounded: what OpenCV (`COLOR_RGB2GRAY`) and Pillow (`convert("L")`) give. The `image` crate and
//! scikit-image weigh by Rec. 709 instead, so convert here and not there.

use crate::{Error, Frame};

// The weights in 1/65536; they add up to 65536, so that grey stays the same grey.
const RED: u32 = 19_595;
const GREEN: u32 = 38_470;
const BLUE: u32 = 7_471;

/// Luma of one colour, 0 to 255: `0.299 R + 0.587 G + 0.114 B`, rounded.
///
/// ```
/// use prf_core::luma;
/// assert_eq!(luma::rgb([255, 255, 255]), 255);
/// assert_eq!(luma::rgb([255, 0, 0]), 76); // 0.299 * 255 = 76.2
/// ```
#[must_use]
pub fn rgb([r, g, b]: [u8; 3]) -> u8 {
    let sum = RED * u32::from(r) + GREEN * u32::from(g) + BLUE * u32::from(b);
    // The weights add up to 65536, so this is at most 255.
    ((sum + (1 << 15)) >> 16) as u8
}

/// A grey value with opacity `alpha` (255 opaque), laid on black: `grey · alpha/255`, rounded.
#[must_use]
pub fn on_black(grey: u8, alpha: u8) -> u8 {
    // The product is at most 255 * 255, so this is at most 255.
    ((u32::from(grey) * u32::from(alpha) + 127) / 255) as u8
}

/// Grey picture of `pixels` with 3 bytes each: red, green, blue.
///
/// # Errors
///
/// [`Error::Shape`] when a side is 0 or there aren't `width * height * 3` bytes.
pub fn from_rgb(width: usize, height: usize, pixels: &[u8]) -> Result<Frame, Error> {
    convert(width, height, pixels, rgb)
}

/// Grey picture of `pixels` with 4 bytes each: red, green, blue, alpha (not premultiplied), laid on
/// black.
///
/// # Errors
///
/// [`Error::Shape`] when a side is 0 or there aren't `width * height * 4` bytes.
pub fn from_rgba(width: usize, height: usize, pixels: &[u8]) -> Result<Frame, Error> {
    convert(width, height, pixels, |[r, g, b, a]| on_black(rgb([r, g, b]), a))
}

/// Grey picture of `pixels` with 2 bytes each: grey and alpha, laid on black.
///
/// # Errors
///
/// [`Error::Shape`] when a side is 0 or there aren't `width * height * 2` bytes.
pub fn from_grey_alpha(width: usize, height: usize, pixels: &[u8]) -> Result<Frame, Error> {
    convert(width, height, pixels, |[grey, a]| on_black(grey, a))
}

fn convert<const N: usize>(
    width: usize,
    height: usize,
    pixels: &[u8],
    grey: impl Fn([u8; N]) -> u8,
) -> Result<Frame, Error> {
    let (whole, rest) = pixels.as_chunks::<N>();
    if !rest.is_empty() {
        let len = pixels.len();
        return Err(Error::Shape { width, height, len });
    }
    Frame::from_vec(width, height, whole.iter().map(|&p| grey(p)).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn weights_are_those_of_rec_601() {
        for (colour, luma) in [([255, 0, 0], 76), ([0, 255, 0], 150), ([0, 0, 255], 29), ([10, 200, 90], 131)] {
            assert_eq!(rgb(colour), luma, "{colour:?}");
        }
    }

    #[test]
    fn grey_stays_grey_and_transparency_darkens() {
        for v in 0..=255 {
            assert_eq!(rgb([v; 3]), v);
            assert_eq!((on_black(v, 255), on_black(v, 0)), (v, 0));
        }
        assert_eq!(from_rgba(1, 1, &[255, 255, 255, 128]).expect("one pixel").as_slice(), [128]);
    }

    #[test]
    fn a_buffer_of_the_wrong_length_is_an_error() {
        for len in [0, 5, 7, 9] {
            assert!(from_rgb(2, 1, &vec![0; len]).is_err());
        }
        assert!(from_grey_alpha(0, 3, &[]).is_err());
    }
}
