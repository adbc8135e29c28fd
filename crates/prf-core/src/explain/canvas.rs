//! A picture in colour to draw on.

use std::convert::Infallible;

use embedded_graphics::mono_font::{MonoFont, MonoTextStyle, iso_8859_1};
use embedded_graphics::pixelcolor::Rgb888;
use embedded_graphics::prelude::*;
use embedded_graphics::primitives::{Line, PrimitiveStyle, Rectangle};
use embedded_graphics::text::{Baseline, Text};

use crate::Rect;

pub(super) type Colour = Rgb888;

pub(super) const INK: Colour = Rgb888::new(24, 28, 34);
pub(super) const GREY: Colour = Rgb888::new(110, 116, 126);
const PAPER: Colour = Rgb888::new(255, 255, 255);
/// Around what was compared.
pub(super) const BOX: Colour = Rgb888::new(0, 190, 120);
/// Around the window that matched.
pub(super) const WINDOW: Colour = Rgb888::new(255, 150, 0);

const TITLE_FONT: &MonoFont<'_> = &iso_8859_1::FONT_10X20;
const FONT: &MonoFont<'_> = &iso_8859_1::FONT_9X15;

/// A picture in colour: `height` rows of `width` pixels of red, green and blue.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Picture {
    width: usize,
    height: usize,
    rgb: Vec<u8>,
}

impl Picture {
    /// White paper.
    pub(super) fn new(width: usize, height: usize) -> Picture {
        Picture { width, height, rgb: vec![255; width * height * 3] }
    }

    /// Width in pixels.
    #[must_use]
    pub fn width(&self) -> usize {
        self.width
    }

    /// Height in pixels.
    #[must_use]
    pub fn height(&self) -> usize {
        self.height
    }

    /// All pixels, row by row from the top: red, green and blue of each.
    #[must_use]
    pub fn as_rgb(&self) -> &[u8] {
        &self.rgb
    }

    pub(super) fn title(&mut self, x: usize, y: usize, text: &str, colour: Colour) {
        self.write(TITLE_FONT, x, y, text, colour);
    }

    pub(super) fn text(&mut self, x: usize, y: usize, text: &str, colour: Colour) {
        self.write(FONT, x, y, text, colour);
    }

    fn write(&mut self, font: &MonoFont<'_>, x: usize, y: usize, text: &str, colour: Colour) {
        let text = Text::with_baseline(text, point(x, y), MonoTextStyle::new(font, colour), Baseline::Top);
        let Ok(_) = text.draw(self);
    }

    pub(super) fn fill(&mut self, panel: Panel, colour: Colour) {
        let Ok(()) = self.fill_solid(&panel.rectangle(), colour);
    }

    pub(super) fn outline(&mut self, panel: Panel, colour: Colour) {
        let Ok(()) = panel.rectangle().into_styled(PrimitiveStyle::with_stroke(colour, 2)).draw(self);
    }

    pub(super) fn line(&mut self, from: [f32; 2], to: [f32; 2], colour: Colour) {
        let end = |[x, y]: [f32; 2]| Point::new(x.round() as i32, y.round() as i32);
        let Ok(()) = Line::new(end(from), end(to)).into_styled(PrimitiveStyle::with_stroke(colour, 1)).draw(self);
    }

    /// Fills `panel` with a picture of `[width, height]` grey values, each a square of the panel.
    pub(super) fn grey(&mut self, panel: Panel, value: impl Fn(usize, usize) -> u8, [width, height]: [usize; 2]) {
        for y in 0..panel.height {
            for x in 0..panel.width {
                let grey = value(x * width / panel.width, y * height / panel.height);
                self.set(panel.left + x, panel.top + y, Rgb888::new(grey, grey, grey));
            }
        }
    }

    pub(super) fn set(&mut self, x: usize, y: usize, colour: Colour) {
        if x < self.width && y < self.height {
            let at = (y * self.width + x) * 3;
            self.rgb[at..at + 3].copy_from_slice(&[colour.r(), colour.g(), colour.b()]);
        }
    }
}

impl OriginDimensions for Picture {
    fn size(&self) -> Size {
        Size::new(self.width as u32, self.height as u32)
    }
}

impl DrawTarget for Picture {
    type Color = Colour;
    type Error = Infallible;

    fn draw_iter<I: IntoIterator<Item = Pixel<Colour>>>(&mut self, pixels: I) -> Result<(), Infallible> {
        for Pixel(at, colour) in pixels {
            if let (Ok(x), Ok(y)) = (usize::try_from(at.x), usize::try_from(at.y)) {
                self.set(x, y, colour);
            }
        }
        Ok(())
    }
}

fn point(x: usize, y: usize) -> Point {
    Point::new(x as i32, y as i32)
}

/// A part of the picture, in pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Panel {
    pub(super) left: usize,
    pub(super) top: usize,
    pub(super) width: usize,
    pub(super) height: usize,
}

impl Panel {
    fn rectangle(self) -> Rectangle {
        Rectangle::new(point(self.left, self.top), Size::new(self.width as u32, self.height as u32))
    }

    /// The largest part of the panel with the proportions of `width` and `height`, in its middle. A very long picture
    /// keeps a few pixels of its short side.
    pub(super) fn fit(self, width: usize, height: usize) -> Panel {
        const LEAST: usize = 4;
        let scale = (self.width as f64 / width as f64).min(self.height as f64 / height as f64);
        let side = |px: usize, most: usize| ((px as f64 * scale).round() as usize).clamp(LEAST, most);
        let (width, height) = (side(width, self.width), side(height, self.height));
        Panel { left: self.left + (self.width - width) / 2, top: self.top + (self.height - height) / 2, width, height }
    }

    /// Where `rect` of a picture of `[width, height]` lies when the panel shows that picture.
    pub(super) fn part(self, [width, height]: [usize; 2], rect: Rect) -> Panel {
        let x = |px: usize| self.left + px * self.width / width;
        let y = |px: usize| self.top + px * self.height / height;
        let (left, top) = (x(rect.x), y(rect.y));
        Panel {
            left,
            top,
            width: (x(rect.x + rect.width) - left).max(2),
            height: (y(rect.y + rect.height) - top).max(2),
        }
    }

    /// The panel with this many more pixels on each side, as far as there is room at the left and above.
    pub(super) fn grown(self, by: usize) -> Panel {
        let (left, top) = (self.left.saturating_sub(by), self.top.saturating_sub(by));
        Panel { left, top, width: self.width + 2 * by, height: self.height + 2 * by }
    }

    /// Two lines under the panel.
    pub(super) fn caption(self, picture: &mut Picture, [title, detail]: &[&str; 2]) {
        let below = self.top + self.height;
        picture.text(self.left, below + 3, title, INK);
        picture.text(self.left, below + 20, detail, GREY);
    }

    pub(super) fn lines(self, picture: &mut Picture, lines: &[String]) {
        picture.fill(self, PAPER);
        for (index, line) in lines.iter().enumerate() {
            picture.text(self.left, self.top + 20 * index, line, if index == 0 { GREY } else { INK });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_picture_keeps_its_proportions_in_a_panel() {
        let panel = Panel { left: 10, top: 20, width: 100, height: 100 };
        assert_eq!(panel.fit(50, 25), Panel { left: 10, top: 45, width: 100, height: 50 });
        assert_eq!(panel.fit(1, 1000), Panel { left: 58, top: 20, width: 4, height: 100 });
    }

    #[test]
    fn a_part_lies_where_its_pixels_are_drawn() {
        let panel = Panel { left: 10, top: 20, width: 100, height: 50 };
        let rect = Rect { x: 5, y: 2, width: 3, height: 4 };
        assert_eq!(panel.part([10, 10], rect), Panel { left: 60, top: 30, width: 30, height: 20 });
        let mut picture = Picture::new(120, 80);
        picture.grey(panel, |x, y| if (5..8).contains(&x) && (2..6).contains(&y) { 0 } else { 200 }, [10, 10]);
        let grey = |x: usize, y: usize| picture.as_rgb()[(y * 120 + x) * 3];
        assert_eq!([grey(59, 30), grey(60, 30), grey(89, 49), grey(90, 49)], [200, 0, 0, 200]);
        assert_eq!([grey(60, 29), grey(60, 50), grey(9, 20)], [200, 200, 255]);
    }

    #[test]
    fn drawing_over_the_edge_is_no_panic() {
        let mut picture = Picture::new(20, 20);
        picture.line([-30.0, -30.0], [50.0, 50.0], INK);
        picture.text(15, 15, "far too long a text", INK);
        assert_eq!(&picture.as_rgb()[..3], [INK.r(), INK.g(), INK.b()]);
    }
}
