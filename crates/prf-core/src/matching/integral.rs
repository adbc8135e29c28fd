//! Sums of pixels and of their squares over windows.

use super::rectangles::Patch;
use crate::FrameView;
use crate::simd::Kernel;

/// Each byte, and its square in the upper half.
static BOTH: [u64; 256] = {
    let mut both = [0; 256];
    let mut v = 0u64;
    while v < 256 {
        both[v as usize] = v | ((v * v) << 32);
        v += 1;
    }
    both
};

/// For every corner, the sums over all that is above it and to the left, kept modulo 2³². Sums over rectangles are
/// differences of four of them, and exact as long as they themselves fit, which [`Patch`] takes care of.
#[derive(Clone, Debug)]
pub(super) struct Integral {
    /// Corners in a row: one more than pixels.
    stride: usize,
    sums: Vec<u32>,
    squares: Vec<u32>,
    /// Working memory: a row's own sums.
    starts: Vec<u64>,
}

impl Integral {
    /// For frames of this size.
    pub(super) fn new([height, width]: [usize; 2]) -> Integral {
        let corners = vec![0; (height + 1) * (width + 1)];
        Integral { stride: width + 1, sums: corners.clone(), squares: corners, starts: vec![0; width] }
    }

    /// Takes in a frame of the size it was made for and returns its mean.
    #[inline(always)]
    pub(super) fn update(&mut self, frame: FrameView<'_>) -> f64 {
        let mut total = 0;
        for y in 0..frame.height() {
            total += self.start(frame.row(y));
            let corners = y * self.stride..(y + 2) * self.stride;
            add(&self.starts, &mut self.sums[corners.clone()], |both| both as u32);
            add(&self.starts, &mut self.squares[corners], |both| (both >> 32) as u32);
        }
        total as f64 / frame.as_slice().len() as f64
    }

    /// Sums over each start of a row: pixels in the lower half, squares in the upper. The whole row's are returned.
    #[inline(always)]
    fn start(&mut self, row: &[u8]) -> u64 {
        let mut both = 0u64;
        for (start, &v) in self.starts.iter_mut().zip(row) {
            // Each sum waits for the one before, so two in one take half the time.
            both = both.wrapping_add(BOTH[usize::from(v)]);
            *start = both;
        }
        both & u64::from(u32::MAX)
    }

    /// Adds the sums over a patch of all windows whose top row is `y`, one after the other.
    #[inline(always)]
    pub(super) fn add_row(&self, patch: &Patch, y: usize, sums: &mut [f64], squares: &mut [f64]) {
        self.add_differences(&self.sums, patch, y, sums);
        self.add_differences(&self.squares, patch, y, squares);
    }

    #[inline(always)]
    fn add_differences(&self, corners: &[u32], patch: &Patch, y: usize, out: &mut [f64]) {
        let top = &corners[(y + patch.top) * self.stride..][..self.stride];
        let bottom = &corners[(y + patch.bottom) * self.stride..][..self.stride];
        let len = out.len();
        let left = top[patch.left..][..len].iter().zip(&bottom[patch.left..][..len]);
        let right = top[patch.right..][..len].iter().zip(&bottom[patch.right..][..len]);
        for ((out, left), right) in out.iter_mut().zip(left).zip(right) {
            *out += f64::from(difference([*left.0, *left.1, *right.0, *right.1]));
        }
    }

    /// Sum and sum of squares over the patches of the window at (`x`, `y`).
    #[inline(always)]
    pub(super) fn window(&self, patches: &[Patch], x: usize, y: usize) -> [u64; 2] {
        [&self.sums, &self.squares].map(|corners| {
            let at = |row: usize, column: usize| corners[(y + row) * self.stride + x + column];
            let sum = |p: &Patch| {
                difference([at(p.top, p.left), at(p.bottom, p.left), at(p.top, p.right), at(p.bottom, p.right)])
            };
            patches.iter().map(|patch| u64::from(sum(patch))).sum()
        })
    }
}

/// Sums up a frame and returns its mean.
pub(super) struct Integrate<'a> {
    pub(super) integral: &'a mut Integral,
    pub(super) frame: FrameView<'a>,
}

impl Kernel for Integrate<'_> {
    type Output = f64;

    #[inline(always)]
    fn run(self) -> f64 {
        self.integral.update(self.frame)
    }
}

/// From the corners of the row above, and a row's own sums, to the corners below.
#[inline(always)]
fn add(starts: &[u64], corners: &mut [u32], part: impl Fn(u64) -> u32) {
    let (above, below) = corners.split_at_mut(starts.len() + 1);
    for ((below, above), &start) in below[1..].iter_mut().zip(&above[1..]).zip(starts) {
        *below = above.wrapping_add(part(start));
    }
}

/// Of the sums at top left, bottom left, top right and bottom right.
#[inline(always)]
fn difference([top_left, bottom_left, top_right, bottom_right]: [u32; 4]) -> u32 {
    bottom_right.wrapping_sub(top_right).wrapping_sub(bottom_left.wrapping_sub(top_left))
}
