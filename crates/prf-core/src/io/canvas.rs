//! What an animation shows: patches laid on a canvas, and taken off again.
//!
//! The canvas is grey and opaque, not of colours with alpha: luma is linear, and whatever is laid over
//! something transparent on black is the same as laid on black at once.

use super::pixels;
use crate::{Frame, Rect, luma};

/// Grey and opacity.
pub(super) type Pixel = [u8; 2];

/// The part of an animation's picture that one of its frames brings.
#[derive(Clone, Copy, Debug)]
pub(super) struct Patch {
    /// Where it lies. What reaches beyond the canvas is not seen.
    pub(super) rect: Rect,
    pub(super) blend: Blend,
    pub(super) disposal: Disposal,
    /// How long it is shown.
    pub(super) delay_ms: f64,
}

/// How a patch meets what is there.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Blend {
    /// It replaces it.
    Source,
    /// It is laid over it.
    Over,
}

/// What becomes of a patch's place before the next one comes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Disposal {
    /// It stays.
    Keep,
    /// It becomes transparent, which is black.
    Background,
    /// It becomes what it was before the patch.
    Previous,
}

pub(super) struct Canvas {
    shown: Frame,
    /// What was shown before the last patch, if that one is to be taken off again.
    before: Frame,
    last: Option<(Rect, Disposal)>,
}

impl Canvas {
    /// A black one; both sides at least 1.
    pub(super) fn new(width: u32, height: u32) -> Canvas {
        let shown = Frame::new(width as usize, height as usize);
        Canvas { shown, before: Frame::new(1, 1), last: None }
    }

    /// Takes off what was there only for one frame, and lays the patch on. `pixels` are those of its
    /// rectangle, row by row.
    pub(super) fn draw(&mut self, patch: &Patch, pixels: &[Pixel]) -> &Frame {
        self.dispose();
        let rect = self.visible(patch.rect);
        if patch.disposal == Disposal::Previous {
            pixels::copy_into(&self.shown, &mut self.before);
        }
        for (y, row) in (rect.y..).zip(pixels.chunks_exact(patch.rect.width)).take(rect.height) {
            lay(row, &mut self.shown.row_mut(y)[rect.x..][..rect.width], patch.blend);
        }
        self.last = Some((rect, patch.disposal));
        &self.shown
    }

    fn dispose(&mut self) {
        let Some((rect, disposal)) = self.last.take() else { return };
        for y in rect.y..rect.y + rect.height {
            let shown = &mut self.shown.row_mut(y)[rect.x..][..rect.width];
            match disposal {
                Disposal::Keep => return,
                Disposal::Background => shown.fill(0),
                Disposal::Previous => shown.copy_from_slice(&self.before.row(y)[rect.x..][..rect.width]),
            }
        }
    }

    /// The part of a rectangle that lies on the canvas; it may have no pixels.
    fn visible(&self, rect: Rect) -> Rect {
        let (x, y) = (rect.x.min(self.shown.width()), rect.y.min(self.shown.height()));
        let width = rect.width.min(self.shown.width() - x);
        let height = rect.height.min(self.shown.height() - y);
        Rect { x, y, width, height }
    }
}

fn lay(pixels: &[Pixel], to: &mut [u8], blend: Blend) {
    for (to, &[grey, alpha]) in to.iter_mut().zip(pixels) {
        *to = match (blend, alpha) {
            (_, 255) => grey,
            (Blend::Source, _) => luma::on_black(grey, alpha),
            (Blend::Over, _) => over(grey, alpha, *to),
        };
    }
}

/// `grey` with opacity `alpha` laid on an opaque `below`.
fn over(grey: u8, alpha: u8, below: u8) -> u8 {
    let (grey, alpha, below) = (u32::from(grey), u32::from(alpha), u32::from(below));
    // A mean of two bytes is a byte.
    ((grey * alpha + below * (255 - alpha) + 127) / 255) as u8
}

#[cfg(test)]
mod tests {
    use super::*;

    fn drawn(canvas: &mut Canvas, x: usize, width: usize, pixel: Pixel, blend: Blend, disposal: Disposal) -> Vec<u8> {
        let rect = Rect { x, y: 0, width, height: 1 };
        let patch = Patch { rect, blend, disposal, delay_ms: 0.0 };
        canvas.draw(&patch, &vec![pixel; width]).as_slice().to_vec()
    }

    #[test]
    fn patches_are_laid_on_and_taken_off() {
        use Blend::{Over, Source};
        use Disposal::{Background, Keep, Previous};
        let mut canvas = Canvas::new(4, 1);
        assert_eq!(drawn(&mut canvas, 0, 4, [100, 255], Source, Keep), [100; 4]);
        // Half of 200 on half of what is there; then alone, on black.
        assert_eq!(drawn(&mut canvas, 0, 2, [200, 128], Over, Background), [150, 150, 100, 100]);
        assert_eq!(drawn(&mut canvas, 1, 2, [200, 128], Source, Previous), [0, 100, 100, 100]);
        // The one before was taken off to what its own predecessor had left: black, not 150.
        assert_eq!(drawn(&mut canvas, 3, 1, [9, 255], Over, Previous), [0, 0, 100, 9]);
        assert_eq!(drawn(&mut canvas, 0, 1, [7, 0], Over, Keep), [0, 0, 100, 100]);
    }

    #[test]
    fn what_reaches_beyond_is_not_seen() {
        let mut canvas = Canvas::new(3, 1);
        for disposal in [Disposal::Background, Disposal::Previous, Disposal::Keep] {
            assert_eq!(drawn(&mut canvas, 2, 9, [5, 255], Blend::Over, disposal), [0, 0, 5]);
        }
        assert_eq!(drawn(&mut canvas, 7, 2, [8, 255], Blend::Over, Disposal::Background), [0, 0, 5]);
        let low = Patch {
            rect: Rect { x: 0, y: 1, width: 1, height: 1 },
            blend: Blend::Source,
            disposal: Disposal::Keep,
            delay_ms: 0.0,
        };
        assert_eq!(canvas.draw(&low, &[[8, 255]]).as_slice(), [0, 0, 5]);
    }
}
