//! Draws the best and the worst frames side by side, as the paper's figures of its experiments do.

use super::canvas::{GREY, INK, Panel, Picture};
use super::shortened;
use crate::FrameView;

/// Side of a panel, in pixels.
const PANEL: usize = 200;
const MARGIN: usize = 16;
const HEADLINE: usize = 48;
/// Over a row, and under its panels.
const ROW_TITLE: usize = 26;
const CAPTION: usize = 50;
/// Width of a character of captions, in pixels.
const CHARACTER: usize = 9;

/// A frame with its reward.
#[derive(Clone, Debug)]
pub struct Ranked<'a> {
    /// The frame.
    pub frame: FrameView<'a>,
    /// `F`.
    pub reward: f32,
    /// What is known of it, such as its file or its score.
    pub name: String,
}

/// Draws the best frames above the worst, each with its reward and its name.
///
/// ```
/// use prf_core::{Frame, Ranked, draw_ranking};
/// let frame = Frame::new(84, 84);
/// let ranked = |reward| Ranked { frame: frame.view(), reward, name: "score 3".to_owned() };
/// let picture = draw_ranking("breakout", &[ranked(0.9), ranked(0.8)], &[ranked(0.2)]);
/// assert_eq!((picture.width(), picture.height()), (448, 632));
/// ```
#[must_use]
pub fn draw_ranking(headline: &str, best: &[Ranked<'_>], worst: &[Ranked<'_>]) -> Picture {
    let columns = best.len().max(worst.len()).max(1);
    let row_height = ROW_TITLE + PANEL + CAPTION;
    let width = columns * (PANEL + MARGIN) + MARGIN;
    let mut picture = Picture::new(width, HEADLINE + 2 * row_height + 2 * MARGIN);
    picture.text(MARGIN, 16, &shortened(headline, (width - 2 * MARGIN) / CHARACTER), INK);
    for (row, (title, frames)) in [("highest rewards", best), ("lowest rewards", worst)].into_iter().enumerate() {
        let top = HEADLINE + row * (row_height + MARGIN);
        picture.text(MARGIN, top, title, GREY);
        for (column, ranked) in frames.iter().enumerate() {
            let left = MARGIN + column * (PANEL + MARGIN);
            draw(&mut picture, Panel { left, top: top + ROW_TITLE, width: PANEL, height: PANEL }, ranked);
        }
    }
    picture
}

fn draw(picture: &mut Picture, panel: Panel, ranked: &Ranked<'_>) {
    let Ranked { frame, reward, name } = ranked;
    let fitted = panel.fit(frame.width(), frame.height());
    picture.grey(fitted, |x, y| frame.row(y)[x], [frame.width(), frame.height()]);
    let name = shortened(name, PANEL / CHARACTER);
    panel.caption(picture, &[&format!("F = {}", super::number(*reward)), &name]);
}
