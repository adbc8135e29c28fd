//! Good picture files.

use std::path::Path;

use image::{GrayImage, Luma};

/// Side of the good pictures, in pixels.
const SIDE: u32 = 40;

/// A picture with every pixel `grey`.
pub(crate) fn flat(path: &Path, grey: u8) {
    save(path, &GrayImage::from_pixel(SIDE, SIDE, Luma([grey])));
}

/// A black picture with `count` bars, whose greys vary so that there are edges of every direction.
/// Dots in two corners keep it from being cropped.
pub(crate) fn bars(path: &Path, count: u32) {
    let is_dot = |x, y| x == y && (x == 0 || x == SIDE - 1);
    let is_bar = |x, y| y % 4 < 2 && y / 4 < count && (4..SIDE - 4).contains(&x);
    let grey = |x: u32, y: u32| u8::try_from(60 + (x * x + 3 * x * y) % 190).expect("it is below 250");
    save(
        path,
        &GrayImage::from_fn(SIDE, SIDE, |x, y| Luma([if is_bar(x, y) || is_dot(x, y) { grey(x, y) } else { 0 }])),
    );
}

fn save(path: &Path, picture: &GrayImage) {
    picture.save(path).expect("the folder is ours");
}
