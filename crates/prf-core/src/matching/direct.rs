//! Correlation as it is defined, for small templates.

use super::template::Template;
use crate::FrameView;
use crate::simd::Kernel;

/// Templates of up to so many pixels: their sums of products, at most 255² each, stay below 2²⁴, where an `f32` holds
/// whole numbers exactly.
pub(super) const MAX_PIXELS: usize = 256;
/// Sums that are collected side by side, in registers.
pub(super) const WIDTH: usize = 64;

/// The frame as centred floats, with room behind each row for a whole block of sums.
#[derive(Clone, Debug)]
pub(super) struct Direct {
    stride: usize,
    pixels: Vec<f32>,
}

impl Direct {
    pub(super) fn new([height, width]: [usize; 2]) -> Direct {
        let stride = width + WIDTH;
        Direct { stride, pixels: vec![0.0; height * stride] }
    }
}

/// Writes `Σ (I − centre)(T − t₀)` of every window to `map`.
pub(super) struct Correlate<'a> {
    pub(super) direct: &'a mut Direct,
    pub(super) template: &'a Template,
    pub(super) frame: FrameView<'a>,
    pub(super) centre: f32,
    pub(super) map: &'a mut [f32],
}

impl Kernel for Correlate<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let stride = self.direct.stride;
        for (y, row) in self.direct.pixels.chunks_exact_mut(stride).enumerate() {
            for (out, &v) in row.iter_mut().zip(self.frame.row(y)) {
                *out = f32::from(v) - self.centre;
            }
        }
        let windows = self.frame.width() - self.template.shape()[1] + 1;
        for (y, sums) in self.map.chunks_exact_mut(windows).enumerate() {
            let rows = &self.direct.pixels[y * stride..];
            for (block, sums) in sums.chunks_mut(WIDTH).enumerate() {
                let block = correlate(self.template, &rows[block * WIDTH..], stride);
                sums.copy_from_slice(&block[..sums.len()]);
            }
        }
    }
}

/// The sums of the windows whose top left corners are the first pixels.
#[inline(always)]
fn correlate(template: &Template, pixels: &[f32], stride: usize) -> [f32; WIDTH] {
    let mut sums = [0.0; WIDTH];
    let width = template.shape()[1];
    for (weights, row) in template.kernel().chunks_exact(width).zip(pixels.chunks(stride)) {
        for (x, &weight) in weights.iter().enumerate() {
            let Some(pixels) = row[x..].first_chunk::<WIDTH>() else { continue };
            for i in 0..WIDTH {
                sums[i] += weight * pixels[i];
            }
        }
    }
    sums
}
