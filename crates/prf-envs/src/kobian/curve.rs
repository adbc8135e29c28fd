//! Smooth outlines through a few points, by additions and products alone: the same on every machine.

use super::face::Point;

/// Appends the curve through `points`, without its last point, in pieces of straight lines: a Catmull-Rom spline with `pieces` lines from
/// each point to the next. Its ends are corners.
pub(super) fn through(points: &[Point], pieces: usize, outline: &mut Vec<Point>) {
    for (index, pair) in points.windows(2).enumerate() {
        let before = points[index.saturating_sub(1)];
        let after = points[(index + 2).min(points.len() - 1)];
        span([before, pair[0], pair[1], after], pieces, outline);
    }
}

/// Appends the closed curve through `points`, which has no corner.
pub(super) fn around(points: &[Point], pieces: usize, outline: &mut Vec<Point>) {
    let count = points.len();
    for index in 0..count {
        let at = |step: usize| points[(index + count - 1 + step) % count];
        span([at(0), at(1), at(2), at(3)], pieces, outline);
    }
}

/// From the second of four points to the third, which is left out.
fn span([a, b, c, d]: [Point; 4], pieces: usize, outline: &mut Vec<Point>) {
    for piece in 0..pieces {
        let t = piece as f32 / pieces as f32;
        outline.push([0, 1].map(|axis| {
            let (a, b, c, d) = (a[axis], b[axis], c[axis], d[axis]);
            let (slope, bend, twist) = (c - a, 2.0 * a - 5.0 * b + 4.0 * c - d, 3.0 * (b - c) + d - a);
            b + 0.5 * t * (slope + t * (bend + t * twist))
        }));
    }
}

/// Appends the ellipse around `centre` with these radii.
pub(super) fn ellipse(centre: Point, radii: Point, pieces: usize, outline: &mut Vec<Point>) {
    // A quarter of the unit circle, from its right to its top, without sines: ((1 - t²) / (1 + t²), 2 t / (1 + t²)).
    let quarter = |piece: usize| {
        let t = piece as f32 / pieces as f32;
        let below = 1.0 + t * t;
        [(1.0 - t * t) / below, 2.0 * t / below]
    };
    // The quarters are mirror images of each other, so that the ellipse is its own.
    for (side, height, from_right) in [(1.0, 1.0, true), (-1.0, 1.0, false), (-1.0, -1.0, true), (1.0, -1.0, false)] {
        for piece in 0..pieces {
            let [x, y] = quarter(if from_right { piece } else { pieces - piece });
            outline.push([centre[0] + side * radii[0] * x, centre[1] + height * radii[1] * y]);
        }
    }
}
