//! HOGs as stars: a stroke for each direction of an edge, the brighter the stronger.

use super::canvas::{Colour, Panel, Picture};
use crate::HogLayout;
use embedded_graphics::pixelcolor::Rgb888;

/// A star smaller than this shows no directions.
const LEAST_PX: usize = 12;
/// Strokes fainter than this part of the brightest are not drawn.
const LEAST: f32 = 0.04;

/// Draws the features of a HOG, whose bins cover the angle `span`; what is as large as `strongest` becomes white. Returns how many cells on a side share a
/// star, so that stars stay large enough to be read.
pub(super) fn draw(
    picture: &mut Picture,
    panel: Panel,
    layout: HogLayout,
    features: &[f32],
    (strongest, span): (f32, f32),
) -> usize {
    let [height, width] = layout.shape();
    let panel = panel.fit(width, height);
    picture.fill(panel, Colour::new(14, 16, 20));
    let merged = merged_cells(panel, layout);
    if features.is_empty() || strongest <= 0.0 {
        return merged;
    }
    let [rows, columns] = layout.cells();
    let cells = cell_means(layout, features);
    let directions = layout.orientations();
    for top in (0..rows).step_by(merged) {
        for left in (0..columns).step_by(merged) {
            let group = [top..(top + merged).min(rows), left..(left + merged).min(columns)];
            let mut star = vec![0.0; directions];
            let members = group[0].clone().flat_map(|y| group[1].clone().map(move |x| y * columns + x));
            for cell in members.clone() {
                let histogram = &cells[cell * directions..][..directions];
                star.iter_mut().zip(histogram).for_each(|(sum, value)| *sum += value);
            }
            let count = members.count() as f32;
            star.iter_mut().for_each(|value| *value /= count * strongest);
            draw_star(picture, star_place(panel, layout, &group), &star, span);
        }
    }
    merged
}

fn merged_cells(panel: Panel, layout: HogLayout) -> usize {
    let cell = layout.cell_px() as f64 * panel.height as f64 / layout.shape()[0] as f64;
    (LEAST_PX as f64 / cell).ceil().max(1.0) as usize
}

/// Histogram of each cell, `[row, column, direction]`: the mean over the blocks it lies in.
fn cell_means(layout: HogLayout, features: &[f32]) -> Vec<f32> {
    let ([rows, columns], [_, block_columns]) = (layout.cells(), layout.blocks());
    let (directions, side) = (layout.orientations(), layout.block_cells());
    let mut sums = vec![0.0; rows * columns * directions];
    let mut counts = vec![0.0f32; rows * columns];
    for (index, histogram) in features.chunks_exact(directions).enumerate() {
        let (block, within) = (index / (side * side), index % (side * side));
        let cell = (block / block_columns + within / side) * columns + block % block_columns + within % side;
        counts[cell] += 1.0;
        sums[cell * directions..][..directions].iter_mut().zip(histogram).for_each(|(sum, value)| *sum += value);
    }
    for (histogram, count) in sums.chunks_exact_mut(directions).zip(counts) {
        histogram.iter_mut().for_each(|value| *value /= count.max(1.0));
    }
    sums
}

/// Centre and radius of the star of a group of cells, `[rows, columns]`.
fn star_place(panel: Panel, layout: HogLayout, [rows, columns]: &[std::ops::Range<usize>; 2]) -> ([f32; 2], f32) {
    let [height, width] = layout.shape().map(|side| side as f32);
    let scale = [panel.width as f32 / width, panel.height as f32 / height].map(|scale| scale * layout.cell_px() as f32);
    let middle = |range: &std::ops::Range<usize>| (range.start + range.end) as f32 / 2.0;
    let centre = [panel.left as f32 + middle(columns) * scale[0], panel.top as f32 + middle(rows) * scale[1]];
    let radius = (columns.len() as f32 * scale[0]).min(rows.len() as f32 * scale[1]) / 2.0 - 0.5;
    (centre, radius)
}

/// Strokes along the edges, across the gradients, the faintest first.
fn draw_star(picture: &mut Picture, ([x, y], radius): ([f32; 2], f32), star: &[f32], span: f32) {
    let mut order: Vec<usize> = (0..star.len()).filter(|&bin| star[bin] > LEAST).collect();
    order.sort_by(|&a, &b| star[a].total_cmp(&star[b]));
    for bin in order {
        let angle = (bin as f32 + 0.5) * span / star.len() as f32;
        let (dx, dy) = (-angle.sin() * radius, angle.cos() * radius);
        // The square root keeps faint strokes visible.
        let grey = (255.0 * star[bin].min(1.0).sqrt()) as u8;
        picture.line([x - dx, y - dy], [x + dx, y + dy], Rgb888::new(grey, grey, grey));
    }
}

#[cfg(test)]
mod tests {
    use std::f32::consts::PI;

    use super::*;
    use crate::{CellSize, Hog, HogParams, Norm, PlaneView};

    fn panel(side: usize) -> Panel {
        Panel { left: 0, top: 0, width: side, height: side }
    }

    #[test]
    fn a_stroke_lies_along_the_edge() {
        // Dark above, light below: the edge is level.
        let pixels: Vec<f32> = (0..64).map(|i| if i / 8 < 4 { 0.0 } else { 1.0 }).collect();
        let params = HogParams { cell: CellSize::Px(8), orientations: 8, norm: Norm::L2, ..HogParams::default() };
        let mut features = Vec::new();
        let image = PlaneView::new(8, 8, &pixels).expect("8 x 8");
        let layout = Hog::new(params).expect("valid").compute_into(image, &mut features).expect("one cell");
        let mut picture = Picture::new(80, 80);
        assert_eq!(draw(&mut picture, panel(80), layout, &features, (1.0, PI)), 1);
        let bright = |x: usize, y: usize| picture.as_rgb()[(y * 80 + x) * 3] > 200;
        let across = (0..80).filter(|&x| (30..50).any(|y| bright(x, y))).count();
        let along = (0..80).filter(|&y| (0..80).any(|x| bright(x, y))).count();
        assert!(across > 70 && along < 20, "{across} columns and {along} rows are bright");
    }

    #[test]
    fn cells_too_small_for_a_star_share_one() {
        let params = HogParams { cell: CellSize::Px(1), ..HogParams::default() };
        let layout = HogLayout::new(&params, 60, 60).expect("fits");
        let mut picture = Picture::new(120, 120);
        assert_eq!(draw(&mut picture, panel(120), layout, &vec![0.1; layout.len()], (1.0, PI)), 6);
    }

    #[test]
    fn a_cell_in_several_blocks_shows_their_mean() {
        let params = HogParams { cell: CellSize::Px(2), block_cells: 2, orientations: 1, ..HogParams::default() };
        let layout = HogLayout::new(&params, 6, 4).expect("3 x 2 cells");
        // Blocks (a b / d e) and (b c / e f).
        let means = cell_means(layout, &[1.0, 2.0, 3.0, 4.0, 6.0, 7.0, 8.0, 9.0]);
        assert_eq!(means, [1.0, 4.0, 7.0, 3.0, 6.0, 9.0]);
    }
}
