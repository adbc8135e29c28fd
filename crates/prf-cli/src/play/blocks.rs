//! A grey picture as text: each character is two pixels, one above the other.

use std::fmt::Write as _;

use prf_core::FrameView;

/// The character whose upper half has the foreground's colour and whose lower half the background's.
const UPPER_HALF: char = '▀';

/// The greys that a terminal can show.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Greys {
    /// All 256.
    All,
    /// The 24 of the palette of 256 colours, black and white.
    Palette,
}

impl Greys {
    /// What a terminal promises in the environment variable `COLORTERM`.
    pub(super) fn promised(colorterm: Option<&str>) -> Greys {
        match colorterm {
            Some("truecolor" | "24bit") => Greys::All,
            _ => Greys::Palette,
        }
    }

    /// The numbers that select `grey`, behind those that select foreground or background.
    fn colour(self, grey: u8) -> Colour {
        match self {
            Greys::All => Colour::Rgb(grey),
            Greys::Palette => Colour::Index(palette_index(grey)),
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Colour {
    Rgb(u8),
    Index(u8),
}

impl Colour {
    fn select(self, place: Place, out: &mut String) {
        let place = place as u8;
        // Writing to a string cannot fail.
        let _ = match self {
            Colour::Rgb(grey) => write!(out, "\x1b[{place};2;{grey};{grey};{grey}m"),
            Colour::Index(index) => write!(out, "\x1b[{place};5;{index}m"),
        };
    }
}

/// What a colour is for, as its control sequence says it.
#[derive(Clone, Copy)]
enum Place {
    Foreground = 38,
    Background = 48,
}

/// The palette's nearest grey: 232 to 255 are 8, 18 … 238; 16 is black and 231 white.
fn palette_index(grey: u8) -> u8 {
    let step = (i32::from(grey) - 8 + 5).div_euclid(10).clamp(0, 23) as u8;
    let candidates = [(16, 0), (232 + step, 8 + 10 * step), (231, 255)];
    let nearest = candidates.into_iter().min_by_key(|&(_, shown): &(u8, u8)| shown.abs_diff(grey));
    nearest.map_or(16, |(index, _)| index)
}

/// One line of text for each two rows of `picture`; below an odd last row it is black. Every line ends in the
/// terminal's own colours.
pub(super) fn lines(picture: FrameView<'_>, greys: Greys) -> Vec<String> {
    (0..picture.height()).step_by(2).map(|y| line(picture, y, greys)).collect()
}

fn line(picture: FrameView<'_>, y: usize, greys: Greys) -> String {
    let mut text = String::new();
    let (mut foreground, mut background) = (None, None);
    let lower_row = (y + 1 < picture.height()).then(|| picture.row(y + 1));
    for (x, &upper) in picture.row(y).iter().enumerate() {
        let lower = greys.colour(lower_row.map_or(0, |row| row[x]));
        let upper = greys.colour(upper);
        if background != Some(lower) {
            lower.select(Place::Background, &mut text);
            background = Some(lower);
        }
        // Two equal halves are a blank, which no font can draw with a seam.
        if upper == lower {
            text.push(' ');
            continue;
        }
        if foreground != Some(upper) {
            upper.select(Place::Foreground, &mut text);
            foreground = Some(upper);
        }
        text.push(UPPER_HALF);
    }
    text.push_str("\x1b[0m");
    text
}

#[cfg(test)]
mod tests {
    use prf_core::Frame;

    use super::*;

    fn drawn(width: usize, pixels: &[u8], greys: Greys) -> Vec<String> {
        let frame = Frame::from_vec(width, pixels.len() / width, pixels.to_vec()).expect("that is its size");
        lines(frame.view(), greys)
    }

    #[test]
    fn two_rows_are_a_line_and_colours_are_set_where_they_change() {
        assert_eq!(
            drawn(3, &[7, 7, 9, 0, 0, 9], Greys::All),
            ["\x1b[48;2;0;0;0m\x1b[38;2;7;7;7m▀▀\x1b[48;2;9;9;9m \x1b[0m"]
        );
        assert_eq!(drawn(2, &[0, 255, 255, 255], Greys::Palette), ["\x1b[48;5;231m\x1b[38;5;16m▀ \x1b[0m"]);
    }

    #[test]
    fn below_an_odd_last_row_it_is_black() {
        let lines = drawn(1, &[5, 5, 200], Greys::All);
        assert_eq!(lines, ["\x1b[48;2;5;5;5m \x1b[0m", "\x1b[48;2;0;0;0m\x1b[38;2;200;200;200m▀\x1b[0m"]);
    }

    #[test]
    fn the_palettes_grey_is_the_nearest_there_is() {
        let shown = |index: u8| match index {
            16 => 0,
            231 => 255,
            232..=255 => 8 + 10 * (index - 232),
            other => panic!("{other} is no grey"),
        };
        for grey in 0..=255u8 {
            let off = shown(palette_index(grey)).abs_diff(grey);
            let least = [16, 231].into_iter().chain(232..=255).map(|index| shown(index).abs_diff(grey)).min();
            assert_eq!(Some(off), least, "{grey}");
        }
        assert_eq!([0, 255, 8, 238, 120].map(palette_index), [16, 231, 232, 255, 243]);
    }

    #[test]
    fn terminals_say_what_they_can_show() {
        assert_eq!(Greys::promised(Some("truecolor")), Greys::All);
        assert_eq!(Greys::promised(Some("24bit")), Greys::All);
        assert_eq!([Greys::promised(Some("yes")), Greys::promised(None)], [Greys::Palette; 2]);
    }
}
