//! Which way a correlation goes, by a rough count of what each costs.
//!
//! The unit is one product of the direct way, about 32 ps with AVX-512. Measured on one core of an Intel Xeon; with
//! other vector widths both ways change alike.

use super::direct;
use super::fft::{LANES, radices};

/// One pass of a transform and its inverse, for one complex number.
const PASS: usize = 8;
/// All else that happens to a complex number: loading, transposing, multiplying, storing.
const MOVE: usize = 20;

/// The most that a tile's side exceeds the template's, in pixels. Beyond, longer tiles gain nothing.
const MAX_STEP: usize = 2048;

/// How templates are correlated with frames of one size.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Plan {
    /// Product by product.
    Direct,
    /// By Fourier transforms of tiles.
    Spectral(Tiling),
}

impl Plan {
    /// The cheaper way. Shapes are `[height, width]`, and the template fits into the frame.
    pub(super) fn new(template: [usize; 2], frame: [usize; 2]) -> Plan {
        let tiling = Tiling::new(template, frame);
        if direct_cost(template, frame).is_some_and(|cost| cost <= tiling.cost()) {
            return Plan::Direct;
        }
        Plan::Spectral(tiling)
    }
}

/// `None` where the direct way wouldn't be exact.
fn direct_cost(template: [usize; 2], frame: [usize; 2]) -> Option<usize> {
    let pixels = template[0] * template[1];
    let [rows, windows] = windows(template, frame);
    (pixels <= direct::MAX_PIXELS).then(|| rows * windows.next_multiple_of(direct::WIDTH) * pixels)
}

/// Windows of a frame, `[rows, columns]`.
pub(super) fn windows(template: [usize; 2], frame: [usize; 2]) -> [usize; 2] {
    [0, 1].map(|side| frame[side] - template[side] + 1)
}

/// A frame cut into overlapping tiles, such that each window lies within one (overlap-save). Two tiles are transformed
/// at once, as the real and the imaginary part of one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Tiling {
    /// Of a tile, `[height, width]`, multiples of 16.
    pub(super) shape: [usize; 2],
    /// From one tile to the next: as many windows as a tile holds in each direction.
    pub(super) step: [usize; 2],
    /// Tiles, `[rows, columns]`.
    pub(super) grid: [usize; 2],
}

impl Tiling {
    /// The cheapest.
    pub(super) fn new(template: [usize; 2], frame: [usize; 2]) -> Tiling {
        let [heights, widths] = [0, 1].map(|side| lengths(template[side], frame[side]));
        let mut best = Tiling::of(template, frame, [heights[0], widths[0]]);
        for (&height, &width) in heights.iter().flat_map(|h| widths.iter().map(move |w| (h, w))) {
            let tiling = Tiling::of(template, frame, [height, width]);
            if tiling.cost() < best.cost() {
                best = tiling;
            }
        }
        best
    }

    pub(super) fn of(template: [usize; 2], frame: [usize; 2], shape: [usize; 2]) -> Tiling {
        let step = windows(template, shape);
        let windows = windows(template, frame);
        Tiling { shape, step, grid: [0, 1].map(|side| windows[side].div_ceil(step[side])) }
    }

    fn cost(&self) -> usize {
        let passes: usize = self.shape.iter().flat_map(|&side| radices(side)).map(|found| found.len()).sum();
        self.pairs() * self.shape[0] * self.shape[1] * (PASS * passes + MOVE)
    }

    /// How often two tiles are transformed; the last may lack its second.
    pub(super) fn pairs(&self) -> usize {
        (self.grid[0] * self.grid[1]).div_ceil(2)
    }

    /// The window that tile `index` begins with, as `[y, x]`; `None` behind the last one.
    pub(super) fn origin(&self, index: usize) -> Option<[usize; 2]> {
        let [rows, columns] = self.grid;
        (index < rows * columns).then(|| [index / columns * self.step[0], index % columns * self.step[1]])
    }
}

/// Sides that a tile may have: from the template's to the first that holds the whole frame, or [`MAX_STEP`] more.
fn lengths(template: usize, frame: usize) -> Vec<usize> {
    let most = frame.min(template + MAX_STEP);
    let mut found = Vec::new();
    for len in (template.next_multiple_of(LANES)..).step_by(LANES) {
        if radices(len).is_some() {
            found.push(len);
            if len >= most {
                break;
            }
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tiny_templates_go_the_direct_way_and_large_ones_do_not() {
        for frame in [[84, 84], [160, 210], [288, 512], [480, 640]] {
            for template in [[1, 1], [3, 3], [1, 20]] {
                assert_eq!(Plan::new(template, frame), Plan::Direct, "{template:?} in {frame:?}");
            }
            for template in [[16, 16], [28, 28], [64, 64], frame] {
                assert!(matches!(Plan::new(template, frame), Plan::Spectral(_)), "{template:?} in {frame:?}");
            }
        }
    }

    #[test]
    fn tiles_cover_every_window_once() {
        for (template, frame) in [
            ([28, 28], [84, 84]),
            ([5, 90], [700, 123]),
            ([40, 3], [41, 1000]),
            ([7, 9], [7, 9]),
            ([2, 2], [3, 20_000]),
        ] {
            let tiling = Tiling::new(template, frame);
            let [rows, columns] = windows(template, frame);
            let mut covered = vec![0; rows * columns];
            for [top, left] in (0..2 * tiling.pairs()).filter_map(|index| tiling.origin(index)) {
                for y in top..(top + tiling.step[0]).min(rows) {
                    covered[y * columns..][left..(left + tiling.step[1]).min(columns)].iter_mut().for_each(|n| *n += 1);
                }
            }
            assert!(covered.iter().all(|&times| times == 1), "{tiling:?}");
            assert!([0, 1].iter().all(|&side| tiling.shape[side] == tiling.step[side] + template[side] - 1));
        }
    }

    #[test]
    fn large_frames_are_cut_into_tiles() {
        let tiling = Tiling::new([20, 20], [2000, 3000]);
        assert!(tiling.pairs() > 10, "{tiling:?}");
    }
}
