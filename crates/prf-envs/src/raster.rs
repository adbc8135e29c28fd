//! Drawing rectangles of a world at any scale.

use std::ops::Range;

use prf_core::{FrameMut, Rect};

/// Fills `rect`, given in a world of `world` = (width, height) units, in a frame of any size.
///
/// Pixels are filled whose centre lies in the rectangle or on its edge. So at a whole multiple of the world's size
/// every edge is exact, neighbours leave no gap at any scale, and a mirrored world gives the mirrored picture. A
/// rectangle too thin to hold a pixel's centre still fills the pixel, or the two, at its own centre.
///
/// What lies outside the frame is cut off; an empty rectangle fills nothing.
pub fn fill_rect(frame: &mut FrameMut<'_>, world: (usize, usize), rect: Rect, value: u8) {
    let columns = covered(rect.x, rect.width, world.0, frame.width());
    let rows = covered(rect.y, rect.height, world.1, frame.height());
    let width = frame.width();
    for row in frame.as_mut_slice()[rows.start * width..rows.end * width].chunks_exact_mut(width) {
        fill(&mut row[columns.clone()], value);
    }
}

/// Fills a few pixels faster than a call to the system's `memset`, which is made for many.
fn fill(pixels: &mut [u8], value: u8) {
    const AT_ONCE: usize = 8;
    let len = pixels.len();
    match len {
        AT_ONCE..=16 => {
            // These may overlap.
            pixels[..AT_ONCE].copy_from_slice(&[value; AT_ONCE]);
            pixels[len - AT_ONCE..].copy_from_slice(&[value; AT_ONCE]);
        }
        0..AT_ONCE => {
            for pixel in pixels {
                *pixel = value;
            }
        }
        _ => pixels.fill(value),
    }
}

/// The pixels, of `pixels` along a side of `units`, that [`fill_rect`] fills for `len` units from `start`.
pub fn covered(start: usize, len: usize, units: usize, pixels: usize) -> Range<usize> {
    let end = start.saturating_add(len).min(units);
    if start >= end {
        return 0..0;
    }
    if pixels == units {
        return start..end;
    }
    // In half pixels, times `units`: pixel `i` has its centre at `(2i + 1) * units`.
    let (units, pixels) = (units as u64, pixels as u64);
    let edge = |at: usize| 2 * at as u64 * pixels;
    let first = edge(start).saturating_sub(units).div_ceil(2 * units);
    let after = (edge(end) + units) / (2 * units);
    let range = if first < after {
        first..after
    } else {
        let centre = edge(start) + edge(end);
        centre.div_ceil(4 * units).saturating_sub(1)..centre / (4 * units) + 1
    };
    range.start as usize..range.end.min(pixels) as usize
}

#[cfg(test)]
mod tests {
    use prf_core::Frame;

    use super::*;

    #[test]
    fn multiples_are_exact() {
        for factor in 1..6 {
            assert_eq!(covered(3, 4, 84, 84 * factor), 3 * factor..7 * factor);
        }
    }

    #[test]
    fn mirrored_rectangles_give_mirrored_pixels() {
        for pixels in 1..300 {
            for start in 0..84 {
                for len in 1..=(84 - start) {
                    let here = covered(start, len, 84, pixels);
                    let there = covered(84 - start - len, len, 84, pixels);
                    assert!(!here.is_empty() && here.end <= pixels, "{pixels} {start} {len}");
                    assert_eq!(here, pixels - there.end..pixels - there.start, "{pixels} {start} {len}");
                }
            }
        }
    }

    #[test]
    fn neighbours_leave_no_gap() {
        for pixels in 1..300 {
            for edge in 1..84 {
                let (left, right) = (covered(0, edge, 84, pixels), covered(edge, 84 - edge, 84, pixels));
                assert_eq!((left.start, right.end), (0, pixels));
                assert!(left.end >= right.start, "{pixels} {edge}");
            }
        }
    }

    #[test]
    fn what_lies_outside_is_cut_off() {
        assert_eq!(covered(80, 10, 84, 84), 80..84);
        assert_eq!(covered(90, 10, 84, 42), 0..0);
        assert_eq!(covered(5, 0, 84, 42), 0..0);
        let mut frame = Frame::new(4, 2);
        fill_rect(&mut frame.view_mut(), (4, 2), Rect { x: 3, y: 1, width: 9, height: usize::MAX }, 7);
        assert_eq!(frame.as_slice(), [0, 0, 0, 0, 0, 0, 0, 7]);
    }
}
