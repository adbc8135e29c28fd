//! Which cells differ, as warmth.

use embedded_graphics::pixelcolor::Rgb888;

use super::canvas::{Colour, Panel, Picture};
use crate::{HogLayout, Rect};

/// From no difference to the largest; even steps look even, also in grey.
const WARMTH: [[f32; 3]; 6] = [
    [8.0, 8.0, 20.0],
    [62.0, 18.0, 96.0],
    [140.0, 40.0, 110.0],
    [215.0, 72.0, 80.0],
    [250.0, 150.0, 50.0],
    [252.0, 250.0, 190.0],
];

/// Draws a square for each cell, the warmest for the largest share.
pub(super) fn draw(picture: &mut Picture, panel: Panel, layout: HogLayout, shares: &[f32]) {
    let [height, width] = layout.shape();
    let panel = panel.fit(width, height);
    picture.fill(panel, colour(0.0));
    let largest = shares.iter().copied().fold(0.0, f32::max);
    if largest == 0.0 {
        return;
    }
    let (columns, side) = (layout.cells()[1], layout.cell_px());
    for (index, share) in shares.iter().enumerate() {
        let rect = Rect { x: index % columns * side, y: index / columns * side, width: side, height: side };
        // The square root keeps small shares visible.
        picture.fill(panel.part([width, height], rect), colour((share / largest).sqrt()));
    }
}

/// The colour of a value in [0, 1].
fn colour(value: f32) -> Colour {
    let place = value.clamp(0.0, 1.0) * (WARMTH.len() - 1) as f32;
    let below = (place as usize).min(WARMTH.len() - 2);
    let part = place - below as f32;
    let [r, g, b] = [0, 1, 2].map(|i| (WARMTH[below][i] + part * (WARMTH[below + 1][i] - WARMTH[below][i])) as u8);
    Rgb888::new(r, g, b)
}
