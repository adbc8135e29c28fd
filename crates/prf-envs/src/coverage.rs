//! Filling smooth shapes: how much of each pixel lies inside an outline.

use prf_core::FrameMut;

/// Fills outlines. Its memory is kept from one to the next.
///
/// Each edge adds to the pixels that it crosses what it changes of their coverage, so that a running sum along a row is
/// the coverage itself: exact for straight edges, in one pass over the outline's box.
#[derive(Clone, Debug, Default)]
pub(crate) struct Coverage {
    /// The outline's box, in pixels: left column, top row, width and height.
    area: [usize; 4],
    /// What changes from each pixel to its right neighbour, with one column more than the box has.
    changes: Vec<f32>,
}

impl Coverage {
    /// Fills the inside of a closed outline, `[x, y]` in pixels of the frame, with `grey`; pixels on its edge get as much of it as they are
    /// covered. What lies outside the frame is cut off. Outlines go round once, in either direction.
    pub(crate) fn fill(&mut self, frame: &mut FrameMut<'_>, outline: &[[f32; 2]], grey: u8) {
        if !self.begin(frame, outline) {
            return;
        }
        let mut from = outline[outline.len() - 1];
        for &to in outline {
            self.edge(from, to);
            from = to;
        }
        self.blend(frame, grey);
    }

    /// Prepares the outline's box; `false` if nothing of it is inside the frame.
    fn begin(&mut self, frame: &FrameMut<'_>, outline: &[[f32; 2]]) -> bool {
        let range = |axis: usize, side: usize| {
            let values = || outline.iter().map(|point| point[axis]);
            let first = values().fold(f32::INFINITY, f32::min).floor().clamp(0.0, side as f32);
            let end = values().fold(f32::NEG_INFINITY, f32::max).ceil().clamp(0.0, side as f32);
            (first as usize, (end - first).max(0.0) as usize)
        };
        let ((left, width), (top, height)) = (range(0, frame.width()), range(1, frame.height()));
        self.area = [left, top, width, height];
        self.changes.clear();
        self.changes.resize((width + 1) * height, 0.0);
        width > 0 && height > 0
    }

    fn edge(&mut self, from: [f32; 2], to: [f32; 2]) {
        let [left, top, width, height] = self.area;
        let local = |[x, y]: [f32; 2]| [x - left as f32, y - top as f32];
        let (from, to) = (local(from), local(to));
        if from[1] == to[1] {
            return;
        }
        let (upper, lower, direction) = if from[1] < to[1] { (from, to, 1.0) } else { (to, from, -1.0) };
        let slope = (lower[0] - upper[0]) / (lower[1] - upper[1]);
        let (start, end) = (upper[1].clamp(0.0, height as f32), lower[1].clamp(0.0, height as f32));
        let mut x = upper[0] + (start - upper[1]) * slope;
        for row in start as usize..height.min(end.ceil() as usize) {
            let share = (end.min(row as f32 + 1.0) - start.max(row as f32)).max(0.0);
            let next = x + share * slope;
            let changes = &mut self.changes[row * (width + 1)..][..width + 1];
            add_clipped(changes, x.min(next), x.max(next), direction * share);
            x = next;
        }
    }

    fn blend(&self, frame: &mut FrameMut<'_>, grey: u8) {
        let [left, top, width, _] = self.area;
        let grey = f32::from(grey);
        for (y, changes) in self.changes.chunks_exact(width + 1).enumerate() {
            let row = &mut frame.row_mut(top + y)[left..left + width];
            let mut sum = 0.0;
            for (pixel, &change) in row.iter_mut().zip(changes) {
                sum += change;
                let covered = f32::abs(sum).min(1.0);
                let before = f32::from(*pixel);
                *pixel = (before + (grey - before) * covered + 0.5) as u8;
            }
        }
    }
}

/// Adds an edge as [`add_to_row`] does, which may reach over the box: what is left of it covers the whole row, what is right of it nothing.
fn add_clipped(changes: &mut [f32], left: f32, right: f32, share: f32) {
    let width = (changes.len() - 1) as f32;
    let part = |from: f32, to: f32| if right > left { (to - from) / (right - left) } else { 1.0 };
    if left < 0.0 {
        changes[0] += share * part(left, right.min(0.0));
    }
    if right > 0.0 && left < width {
        let (from, to) = (left.max(0.0), right.min(width));
        add_to_row(changes, from, to, share * part(from, to));
    } else if left >= 0.0 && right == 0.0 {
        changes[0] += share;
    }
}

/// Adds an edge that crosses a part `share` (with its direction's sign) of a row's height, from column `left` to column `right`. All that is right of it
/// is covered by the share, a pixel that it crosses by what of the pixel is right of it.
fn add_to_row(changes: &mut [f32], left: f32, right: f32, share: f32) {
    let (first, last) = (left as usize, right.ceil() as usize);
    if last <= first + 1 {
        // Within one pixel: the middle of the edge decides.
        let uncovered = (left + right) / 2.0 - first as f32;
        changes[first] += share * (1.0 - uncovered);
        if let Some(next) = changes.get_mut(first + 1) {
            *next += share * uncovered;
        }
        return;
    }
    let per_column = share / (right - left);
    // What is covered of the pixel's column, from the edge's first one on.
    let mut before = 0.0;
    for (column, change) in (first..last).zip(&mut changes[first..]) {
        let [from, to] = [left.max(column as f32), right.min(column as f32 + 1.0)];
        let (crossed_before, crossed_here) = (from - left, to - from);
        let right_of_middle = column as f32 + 1.0 - (from + crossed_here / 2.0);
        let covered = per_column * (crossed_before + crossed_here * right_of_middle);
        *change += covered - before;
        before = covered;
    }
    if let Some(next) = changes.get_mut(last) {
        *next += share - before;
    }
}

#[cfg(test)]
mod tests {
    use prf_core::Frame;

    use super::*;
    use crate::rng::{stream, unit_f32};

    fn filled(outline: &[[f32; 2]], width: usize, height: usize) -> Frame {
        let mut frame = Frame::new(width, height);
        Coverage::default().fill(&mut frame.view_mut(), outline, 255);
        frame
    }

    /// The share of a pixel's points, on a fine grid, that a triangle holds.
    fn sampled([a, b, c]: [[f32; 2]; 3], x: usize, y: usize) -> f32 {
        const FINE: usize = 24;
        let side = |p: [f32; 2], q: [f32; 2], at: [f32; 2]| {
            (q[0] - p[0]) * (at[1] - p[1]) - (q[1] - p[1]) * (at[0] - p[0]) >= 0.0
        };
        let holds = |at: [f32; 2]| {
            let sides = [side(a, b, at), side(b, c, at), side(c, a, at)];
            sides == [true; 3] || sides == [false; 3]
        };
        let fine = |index: usize, step: usize| index as f32 + (step as f32 + 0.5) / FINE as f32;
        let points = (0..FINE * FINE).map(|point| [fine(x, point % FINE), fine(y, point / FINE)]);
        points.filter(|&at| holds(at)).count() as f32 / (FINE * FINE) as f32
    }

    #[test]
    fn shares_by_hand() {
        // From 1.25 to 3.5 and 0.5 to 2, on 4 × 3 pixels.
        let frame = filled(&[[1.25, 0.5], [3.5, 0.5], [3.5, 2.0], [1.25, 2.0]], 4, 3);
        assert_eq!(frame.as_slice(), [0, 96, 128, 64, 0, 191, 255, 128, 0, 0, 0, 0]);
        // The other way round, and half of it outside.
        let frame = filled(&[[-3.0, 1.0], [-3.0, 9.0], [1.5, 9.0], [1.5, 1.0]], 3, 2);
        assert_eq!(frame.as_slice(), [0, 0, 0, 255, 128, 0]);
        assert_eq!(filled(&[[5.0, 0.0], [9.0, 0.0], [9.0, 3.0]], 4, 3).as_slice(), [0; 12]);
    }

    #[test]
    fn triangles_cover_what_they_hold_also_across_borders() {
        let mut rng = stream(1, "coverage", 0);
        for round in 0..400 {
            // Every other one has its corners on borders of pixels.
            let mut place = || {
                let at = unit_f32(&mut rng) * 24.0 - 8.0;
                if round % 2 == 0 { at } else { at.round() }
            };
            let corners: [[f32; 2]; 3] = std::array::from_fn(|_| [place(), place()]);
            let frame = filled(&corners, 9, 8);
            for y in 0..8 {
                for x in 0..9 {
                    let (got, expected) = (f32::from(frame.view().row(y)[x]) / 255.0, sampled(corners, x, y));
                    assert!((got - expected).abs() < 0.06, "{corners:?} at ({x}, {y}): {got}, sampled {expected}");
                }
            }
        }
    }
}
