//! Windows to choose from around one that was cut out by hand.

use crate::Rect;

/// Steps of width and of height, down and up.
const FEWER: isize = 2;
const MORE: isize = 3;
/// A step, as a part of the window's longer side.
const STEP: usize = 8;

/// Windows of other widths and heights around the same middle, those that lie within a picture of this `[height, width]`. `window` itself
/// comes first. Widths and heights go in steps of an eighth of its longer side, two down and three up.
///
/// ```
/// use prf_core::{Rect, windows_around};
/// let window = Rect { x: 13, y: 26, width: 20, height: 32 };
/// let windows = windows_around(window, [84, 84]);
/// assert_eq!(windows.len(), 36);
/// assert_eq!(windows[0], window);
/// assert!(windows.contains(&Rect { x: 7, y: 24, width: 32, height: 36 }));
/// ```
#[must_use]
pub fn windows_around(window: Rect, [height, width]: [usize; 2]) -> Vec<Rect> {
    let step = (window.width.max(window.height) / STEP).max(1) as isize;
    let sides = |side: usize, start: usize, room: usize| -> Vec<(usize, usize)> {
        let around = |by: isize| {
            let longer = side.checked_add_signed(by * step).filter(|&longer| longer > 0)?;
            // Half of what is added lies before the window, which keeps its middle.
            let start = start.checked_add_signed(-(by * step / 2))?;
            (start + longer <= room).then_some((start, longer))
        };
        (-FEWER..=MORE).filter_map(around).collect()
    };
    let rows = sides(window.height, window.y, height);
    let mut windows = vec![window];
    for (x, width) in sides(window.width, window.x, width) {
        let rects = rows.iter().map(|&(y, height)| Rect { x, y, width, height });
        windows.extend(rects.filter(|rect| *rect != window));
    }
    windows
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn windows_keep_their_middle_and_stay_inside() {
        let window = Rect { x: 3, y: 30, width: 16, height: 24 };
        let windows = windows_around(window, [84, 84]);
        for rect in &windows {
            assert!(rect.x + rect.width <= 84 && rect.y + rect.height <= 84);
            let off = |start: usize, len: usize, middle: usize| (2 * start + len).abs_diff(2 * middle);
            assert!(off(rect.x, rect.width, 11) <= 1 && off(rect.y, rect.height, 42) <= 1, "{rect:?}");
        }
        // 3 px a step: widths 10 to 22 (25 would begin left of the picture), heights 18 to 33.
        assert_eq!(windows.len(), 5 * 6);
    }

    #[test]
    fn a_whole_picture_can_only_be_cut_down() {
        let whole = Rect { x: 0, y: 0, width: 20, height: 30 };
        let windows = windows_around(whole, [30, 20]);
        assert_eq!(windows.len(), 9);
        assert_eq!(windows[0], whole);
        assert!(windows.contains(&Rect { x: 3, y: 3, width: 14, height: 24 }));
        assert_eq!(windows_around(Rect { x: 0, y: 0, width: 1, height: 1 }, [1, 1]).len(), 1);
    }
}
