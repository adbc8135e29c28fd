//! Central differences, one row at a time.

use crate::region::{Region, Sample};

/// Writes `d/dx` and `d/dy` of row `y` to `dx` and `dy`, for as many columns as these have, in the
/// sample's own unit: `I(x+1) − I(x−1)`, not halved. Where a neighbour lies outside of the picture
/// the difference is 0, as in scikit-image.
pub(crate) fn row<P: Sample>(image: Region<'_, P>, y: usize, dx: &mut [f32], dy: &mut [f32]) {
    horizontal(image.row(y), dx);
    if y == 0 || y + 1 == image.height() {
        dy.fill(0.0);
        return;
    }
    let (above, below) = (image.row(y - 1), image.row(y + 1));
    for ((d, &a), &b) in dy.iter_mut().zip(above).zip(below) {
        *d = b.minus(a);
    }
}

fn horizontal<P: Sample>(row: &[P], dx: &mut [f32]) {
    dx[0] = 0.0;
    if let Some(right) = row.get(2..) {
        for ((d, &r), &l) in dx[1..].iter_mut().zip(right).zip(row) {
            *d = r.minus(l);
        }
    }
    if dx.len() == row.len() {
        dx[row.len() - 1] = 0.0;
    }
}
