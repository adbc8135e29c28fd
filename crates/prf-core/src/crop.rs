//! The box around what is not black (paper, section "Perceptual reward functions").

use crate::FrameView;
use crate::region::Region;

/// A rectangle of a picture, in pixels; `x` and `y` are its left column and top row, counted from 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rect {
    /// Left column.
    pub x: usize,
    /// Top row.
    pub y: usize,
    /// Columns, at least 1.
    pub width: usize,
    /// Rows, at least 1.
    pub height: usize,
}

/// The smallest box that holds every pixel that is not black, which is also the smallest box around
/// their convex hull. A picture that is black all over has no hull: the box is the whole picture (paper, section
/// "Perceptual reward functions").
///
/// ```
/// use prf_core::{crop_box, Frame, Rect};
/// let mut frame = Frame::new(10, 8);
/// frame.row_mut(2)[3] = 255;
/// frame.row_mut(5)[7] = 1;
/// assert_eq!(crop_box(frame.view()), Rect { x: 3, y: 2, width: 5, height: 4 });
/// ```
#[must_use]
pub fn crop_box(frame: FrameView<'_>) -> Rect {
    crop_box_of(frame.region())
}

/// The same for a part of a picture, in the part's own coordinates.
pub(crate) fn crop_box_of(frame: Region<'_, u8>) -> Rect {
    let (width, height) = (frame.width(), frame.height());
    let lit = |&y: &usize| has_light(frame.row(y));
    let (Some(top), Some(bottom)) = ((0..height).find(lit), (0..height).rfind(lit)) else {
        return Rect { x: 0, y: 0, width, height };
    };
    let rows = || (top..=bottom).map(|y| frame.row(y));
    let left = first_light(width, |x, len| lit_columns(rows(), x, len));
    // The same from the other side.
    let right = width - first_light(width, |x, len| reversed(lit_columns(rows(), width - x - len, len), len));
    Rect { x: left, y: top, width: right - left, height: bottom - top + 1 }
}

/// Columns that are looked at together.
const COLUMNS: usize = 64;

/// How many columns are black before the first that isn't, of `width`; `lit` tells about the `len` columns from `x` on.
fn first_light(width: usize, lit: impl Fn(usize, usize) -> [u8; COLUMNS]) -> usize {
    let light = |x: usize| lit(x, COLUMNS.min(width - x)).iter().position(|&v| v != 0).map(|at| x + at);
    (0..width).step_by(COLUMNS).find_map(light).unwrap_or(width)
}

/// Of each of these columns something that is 0 only if all its pixels are.
fn lit_columns<'a>(rows: impl Iterator<Item = &'a [u8]>, x: usize, len: usize) -> [u8; COLUMNS] {
    let mut seen = [0; COLUMNS];
    for row in rows {
        for (seen, &v) in seen.iter_mut().zip(&row[x..x + len]) {
            *seen |= v;
        }
    }
    seen
}

fn reversed(mut columns: [u8; COLUMNS], len: usize) -> [u8; COLUMNS] {
    columns[..len].reverse();
    columns
}

/// Whether a pixel is not black. Without an early exit, so that it runs many bytes at a time.
fn has_light(row: &[u8]) -> bool {
    row.iter().fold(0, |seen, &v| seen | v) != 0
}
