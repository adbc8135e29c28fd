//! What goes into tiles and comes out of them, sixteen columns at a time.

use super::fft::{LANES, Lanes};
use super::template::Template;
use crate::FrameView;

/// Where the numbers of a tile come from.
pub(super) trait Source {
    /// Real and imaginary parts of sixteen columns, from column `x`, in row `y`.
    fn lanes(&mut self, y: usize, x: usize) -> [Lanes; 2];
}

/// The template as a tile.
pub(super) struct TemplateTile<'a> {
    pub(super) template: &'a Template,
}

impl Source for TemplateTile<'_> {
    #[inline(always)]
    fn lanes(&mut self, y: usize, x: usize) -> [Lanes; 2] {
        let [height, width] = self.template.shape();
        if y >= height || x >= width {
            return [Lanes::ZERO; 2];
        }
        [lanes(&self.template.kernel()[y * width..][x..width], |v| v), Lanes::ZERO]
    }
}

/// Two tiles of a frame, centred; 0 outside of the frame and for a tile that isn't there.
pub(super) struct FrameTiles<'a> {
    pub(super) frame: FrameView<'a>,
    pub(super) centre: f32,
    pub(super) origins: [Option<[usize; 2]>; 2],
    /// Of all that was loaded, summed up.
    pub(super) squares: Lanes,
}

impl Source for FrameTiles<'_> {
    #[inline(always)]
    fn lanes(&mut self, y: usize, x: usize) -> [Lanes; 2] {
        let [re, im] = self.origins;
        let (re, im) = (self.tile(re, y, x), self.tile(im, y, x));
        for lane in 0..LANES {
            self.squares.0[lane] += re.0[lane] * re.0[lane] + im.0[lane] * im.0[lane];
        }
        [re, im]
    }
}

impl FrameTiles<'_> {
    #[inline(always)]
    fn tile(&self, origin: Option<[usize; 2]>, y: usize, x: usize) -> Lanes {
        match origin {
            Some([top, left]) if top + y < self.frame.height() && left + x < self.frame.width() => {
                lanes(&self.frame.row(top + y)[left + x..], |v| f32::from(v) - self.centre)
            }
            _ => Lanes::ZERO,
        }
    }
}

/// The first sixteen values, 0 where there are fewer.
#[inline(always)]
fn lanes<T: Copy>(values: &[T], value: impl Fn(T) -> f32) -> Lanes {
    let mut lanes = Lanes::ZERO;
    // Of known length, the loop is unrolled.
    if let Some(values) = values.first_chunk::<LANES>() {
        for (lane, &v) in lanes.0.iter_mut().zip(values) {
            *lane = value(v);
        }
    } else {
        for (lane, &v) in lanes.0.iter_mut().zip(values) {
            *lane = value(v);
        }
    }
    lanes
}

/// Sixteen rows to sixteen columns.
#[inline(always)]
pub(super) fn transpose(from: &[Lanes; LANES], to: &mut [Lanes; LANES]) {
    // Four rows at a time: with more the compiler takes gathers, which take twice as long.
    for (block, rows) in from.as_chunks::<4>().0.iter().enumerate() {
        for (column, to) in to.iter_mut().enumerate() {
            for (row, from) in rows.iter().enumerate() {
                to.0[4 * block + row] = from.0[column];
            }
        }
    }
}

/// Where scores go.
pub(super) struct Map<'a> {
    /// In a row.
    pub(super) windows: usize,
    pub(super) scores: &'a mut [f32],
}

impl Map<'_> {
    /// Writes the first `columns` of these rows to `[y, x]`, as far as they lie within.
    #[inline(always)]
    pub(super) fn write(&mut self, [y, x]: [usize; 2], columns: usize, rows: &[Lanes]) {
        let columns = columns.min(self.windows.saturating_sub(x));
        for (out, row) in self.scores.chunks_exact_mut(self.windows).skip(y).zip(rows) {
            match out[x.min(self.windows)..].first_chunk_mut::<LANES>() {
                Some(out) if columns == LANES => *out = row.0,
                _ if columns == 0 => {}
                _ => out[x..x + columns].copy_from_slice(&row.0[..columns]),
            }
        }
    }
}
