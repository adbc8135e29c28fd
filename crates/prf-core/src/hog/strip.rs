//! Some rows of a picture as floats, with a border that makes every gradient a plain difference.

use crate::region::{Region, Sample};

/// Floats of a cache line.
const LINE: usize = 16;

/// Rows that lie one above the other, with one more above and below and a column more on both sides.
///
/// Outside of the picture the pixels are mirrored at its outermost ones, so that the differences across these are 0.
#[derive(Clone, Debug, Default)]
pub(super) struct Strip {
    stride: usize,
    /// Where the first row's first pixel lies: at the beginning of a cache line, so that loads cross few borders of lines.
    origin: usize,
    pixels: Vec<f32>,
}

impl Strip {
    /// Makes room for so many rows of which `room` columns can be asked for.
    pub(super) fn reserve(&mut self, rows: usize, width: usize, room: usize) {
        self.stride = (width.max(room) + 2).next_multiple_of(LINE);
        self.pixels.resize((rows + 2) * self.stride + 2 * LINE, 0.0);
        self.origin = LINE + self.pixels.as_ptr().align_offset(LINE * size_of::<f32>()).min(LINE - 1);
    }

    /// Takes rows of the picture, in its own unit, from `top` on.
    #[inline(always)]
    pub(super) fn fill<P: Sample>(&mut self, image: Region<'_, P>, top: usize, rows: usize) {
        let last = image.height() - 1;
        for (i, out) in self.pixels[self.origin - 1..].chunks_exact_mut(self.stride).enumerate().take(rows + 2) {
            // Row `y`, counted from 1.
            let y = match top + i {
                0 => 1.min(last),
                y if y > last + 1 => last.saturating_sub(1),
                y => y - 1,
            };
            widen(image.row(y), out);
        }
    }

    /// Row `y` of the strip: the row above, itself from one column before its first, and the row below.
    #[inline(always)]
    pub(super) fn around(&self, y: usize) -> [&[f32]; 3] {
        let rows = &self.pixels[self.origin - 1 + y * self.stride..];
        [&rows[1..], &rows[self.stride..], &rows[2 * self.stride + 1..]]
    }
}

#[inline(always)]
fn widen<P: Sample>(row: &[P], out: &mut [f32]) {
    for (out, pixel) in out[1..].iter_mut().zip(row) {
        *out = pixel.value();
    }
    let width = row.len();
    out[0] = out[2.min(width)];
    out[width + 1] = out[width - 1];
}
