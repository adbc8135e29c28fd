//! Some rows of a picture as floats, with a border that makes every gradient a plain difference.

use super::lanes::WIDTH;
use crate::region::Rows;

/// Floats of a cache line.
const LINE: usize = 16;

/// Sections that lie side by side, each of some rows of the picture with one more above and below and a column more on
/// both sides. With several, rows that are no multiple of what is worked on at a time leave less of it empty.
///
/// Outside of the picture the pixels are mirrored at its outermost ones, so that the differences across these are 0.
#[derive(Clone, Debug, Default)]
pub(super) struct Strip {
    rows: usize,
    /// From one section to the next.
    section_px: usize,
    stride: usize,
    /// Where the first row's first pixel lies: at the beginning of a cache line, so that few loads cross a border of lines.
    origin: usize,
    pixels: Vec<f32>,
}

impl Strip {
    /// Makes room for so many sections of `rows` rows, which begin `section_px` apart.
    pub(super) fn reserve(&mut self, rows: usize, section_px: usize, sections: usize) {
        (self.rows, self.section_px) = (rows, section_px);
        self.stride = (sections * section_px + WIDTH + 2).next_multiple_of(LINE);
        self.pixels.resize((rows + 2) * self.stride + 2 * LINE, 0.0);
        self.origin = LINE + self.pixels.as_ptr().align_offset(LINE * size_of::<f32>()).min(LINE - 1);
    }

    /// Fills so many sections with rows of the picture, in its own unit, from `top` on. Rows below it are made up.
    #[inline(always)]
    pub(super) fn fill<R: Rows>(&mut self, image: &mut R, top: usize, sections: usize) {
        let [height, width] = image.shape();
        let last = height - 1;
        for (section, i) in (0..sections).flat_map(|section| (0..self.rows + 2).map(move |i| (section, i))) {
            // Counted from 1.
            let y = match top + section * self.rows + i {
                0 => 1.min(last),
                y if y > last + 1 => last.saturating_sub(1),
                y => y - 1,
            };
            let begin = self.origin - 1 + i * self.stride + section * self.section_px;
            let out = &mut self.pixels[begin..][..width + 2];
            image.row_into(y, &mut out[1..=width]);
            out[0] = out[2.min(width)];
            out[width + 1] = out[width - 1];
        }
    }

    /// Row `y`: the row above, itself from one column before its first, and the row below.
    #[inline(always)]
    pub(super) fn around(&self, y: usize) -> [&[f32]; 3] {
        let rows = &self.pixels[self.origin - 1 + y * self.stride..];
        [&rows[1..], &rows[self.stride..], &rows[2 * self.stride + 1..]]
    }
}
