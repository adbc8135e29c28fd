//! How a terminal's room is shared between the picture and the words.

/// Columns that the words have beside the picture, the gap before them included.
const PANEL_COLUMNS: usize = 26;
const GAP_COLUMNS: usize = 2;
/// Rows that the words have below the picture where there is no room beside it.
const ROWS_BELOW: usize = 2;

/// Where picture and words go.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Layout {
    /// The picture's width and height in pixels, two of which lie above each other in a character; 0 if there is no room.
    pub(super) picture: [usize; 2],
    pub(super) words: Words,
}

/// Where the words go, counted from 0 in columns and rows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Words {
    /// A word group a line.
    Beside { column: usize },
    /// Few, long lines.
    Below { row: usize },
}

impl Layout {
    /// For a terminal of `columns` and `rows` and a world of `world` = (width, height) pixels: what makes the picture
    /// largest.
    pub(super) fn new([columns, rows]: [usize; 2], world: [usize; 2]) -> Layout {
        let beside = fit(world, [columns.saturating_sub(PANEL_COLUMNS), 2 * rows]);
        let below = fit(world, [columns, 2 * rows.saturating_sub(ROWS_BELOW)]);
        if beside[0] >= below[0] && beside[0] > 0 {
            return Layout { picture: beside, words: Words::Beside { column: beside[0] + GAP_COLUMNS } };
        }
        Layout { picture: below, words: Words::Below { row: below[1].div_ceil(2) } }
    }
}

/// The largest picture of the world's shape in `room`.
fn fit([width, height]: [usize; 2], room: [usize; 2]) -> [usize; 2] {
    if room[0] * height <= room[1] * width {
        [room[0], room[0] * height / width]
    } else {
        [room[1] * width / height, room[1]]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SQUARE: [usize; 2] = [84, 84];

    #[test]
    fn the_words_are_beside_the_picture_where_that_costs_nothing() {
        let layout = Layout::new([80, 24], SQUARE);
        assert_eq!(layout, Layout { picture: [48, 48], words: Words::Beside { column: 50 } });
        let layout = Layout::new([200, 60], SQUARE);
        assert_eq!(layout, Layout { picture: [120, 120], words: Words::Beside { column: 122 } });
    }

    #[test]
    fn in_a_narrow_terminal_they_are_below_it() {
        let layout = Layout::new([20, 10], SQUARE);
        assert_eq!(layout, Layout { picture: [16, 16], words: Words::Below { row: 8 } });
        let layout = Layout::new([40, 24], SQUARE);
        assert_eq!(layout, Layout { picture: [40, 40], words: Words::Below { row: 20 } });
    }

    #[test]
    fn the_worlds_shape_is_kept() {
        assert_eq!(Layout::new([80, 24], [100, 50]).picture, [80, 40]);
        assert_eq!(Layout::new([80, 24], [50, 100]).picture, [24, 48]);
    }

    #[test]
    fn any_size_has_a_layout_that_fits() {
        for columns in 0..90 {
            for rows in 0..40 {
                let Layout { picture: [width, height], words } = Layout::new([columns, rows], SQUARE);
                assert!(width <= columns && height <= 2 * rows, "{columns}x{rows}");
                match words {
                    Words::Beside { column } => assert!(column + 20 <= columns, "{columns}x{rows}"),
                    Words::Below { row } => assert!(row + ROWS_BELOW <= rows || rows < ROWS_BELOW, "{columns}x{rows}"),
                }
            }
        }
    }
}
