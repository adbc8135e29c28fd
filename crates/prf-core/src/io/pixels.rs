//! Decoded pixels as bytes of grey, in buffers that are used again.

use image::DynamicImage;

use super::canvas::Pixel;
use crate::{Frame, luma};

/// The frame's pixels at this size, both sides at least 1. Only another size than before takes memory.
pub(super) fn reshape(frame: &mut Frame, width: usize, height: usize) -> &mut [u8] {
    if (frame.width(), frame.height()) != (width, height) {
        *frame = Frame::new(width, height);
    }
    frame.as_mut_slice()
}

pub(super) fn copy_into(from: &Frame, to: &mut Frame) {
    reshape(to, from.width(), from.height()).copy_from_slice(from.as_slice());
}

/// A picture of any colour and depth, laid on black.
pub(super) fn picture_into(picture: DynamicImage, frame: &mut Frame) {
    let pixels = reshape(frame, picture.width() as usize, picture.height() as usize);
    let colour = picture.color();
    match (colour.has_color(), colour.has_alpha()) {
        (false, false) => pixels.copy_from_slice(&picture.into_luma8()),
        (false, true) => convert(&picture.into_luma_alpha8(), pixels, |[grey, a]| luma::on_black(grey, a)),
        (true, false) => convert(&picture.into_rgb8(), pixels, luma::rgb),
        (true, true) => convert(&picture.into_rgba8(), pixels, |[r, g, b, a]| luma::on_black(luma::rgb([r, g, b]), a)),
    }
}

/// 0 where the picture is wholly transparent, and how opaque it is elsewhere.
pub(super) fn opacity(picture: &DynamicImage) -> Frame {
    let mut opacity = Frame::new(picture.width() as usize, picture.height() as usize);
    convert(&picture.to_rgba8(), opacity.as_mut_slice(), |[_, _, _, alpha]| alpha);
    opacity
}

fn convert<const N: usize>(from: &[u8], to: &mut [u8], grey: impl Fn([u8; N]) -> u8) {
    for (to, &from) in to.iter_mut().zip(from.as_chunks().0) {
        *to = grey(from);
    }
}

/// Grey and opacity of a colour with alpha.
pub(super) fn grey_alpha([r, g, b, a]: [u8; 4]) -> Pixel {
    [luma::rgb([r, g, b]), a]
}
