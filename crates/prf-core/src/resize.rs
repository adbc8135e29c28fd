//! Bilinear rescaling to an exact size, in `f32`.
//!
//! Pixel centres lie at half integers, so the whole picture maps onto the whole picture. Along a side
//! that shrinks, the triangle filter is widened by the same factor, so that no pixel is skipped. The
//! weights of a pair of sizes are prepared once and kept until another pair comes.
//!
//! Where neighbours are equal the result is exactly their value: an interpolated flat area has no
//! gradient at all. Normalisation knows no scale, so HOG would blow up the least rounding.

use crate::region::{Region, Rows, Sample};
use crate::simd::{Kernel, Simd};
use crate::{Error, FrameView, PlaneView};

/// Rescales pictures and keeps its working memory: after the first picture of a size nothing is
/// allocated. Bilinear, with pixel centres at half integers; along a side that shrinks the filter is widened, so that no
/// pixel is lost. (Paper, section "Perceptual reward functions", which leaves the filter open.)
///
/// ```
/// use prf_core::{FrameView, Resizer};
/// let mut resizer = Resizer::default();
/// let wide = resizer.resize(FrameView::new(2, 1, &[0, 255])?, 4, 1)?;
/// assert_eq!(wide.as_slice(), [0.0, 0.25, 0.75, 1.0]);
/// # Ok::<(), prf_core::Error>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct Resizer {
    simd: Simd,
    across: Taps,
    down: Taps,
    lines: Lines,
    /// The rows of the source that are worked on, with their width already rescaled; one takes the place of another.
    widened: Vec<f32>,
    output: Vec<f32>,
}

impl Resizer {
    /// The picture at `width` by `height` pixels, as floats from 0 (black) to 1 (white).
    ///
    /// # Errors
    ///
    /// [`Error::Shape`] when a side is 0 or their product doesn't fit a `usize`.
    pub fn resize(&mut self, image: FrameView<'_>, width: usize, height: usize) -> Result<PlaneView<'_>, Error> {
        let len = width.checked_mul(height).unwrap_or(0);
        crate::frame::check_shape(width, height, len)?;
        let mut output = std::mem::take(&mut self.output);
        output.resize(len, 0.0);
        let simd = self.simd;
        simd.run(Rescale { rows: self.rows(image.region(), [height, width]), output: &mut output });
        self.output = output;
        PlaneView::new(width, height, &self.output)
    }

    /// The region at `[height, width]`, made row by row where it is needed, in the unit of bytes: whole numbers until they are mixed,
    /// so that their differences are exact.
    pub(crate) fn rows<'a>(&'a mut self, image: Region<'a, u8>, [height, width]: [usize; 2]) -> Rescaled<'a> {
        self.across.prepare(image.width(), width);
        self.down.prepare(image.height(), height);
        // As many as three rows of the result lie between, and those that were widened with the last of them.
        let reach = self.down.count + 2 * image.height().div_ceil(height) + ROWS;
        let kept = reach.next_multiple_of(ROWS);
        self.widened.resize(kept * width, 0.0);
        let Resizer { across, down, lines, widened, .. } = self;
        Rescaled { image, across, down, lines, widened, kept, ready: 0 }
    }
}

/// Writes all rows to `output`, as floats from 0 to 1.
struct Rescale<'a> {
    rows: Rescaled<'a>,
    output: &'a mut [f32],
}

impl Kernel for Rescale<'_> {
    type Output = ();

    #[inline(always)]
    fn run(mut self) {
        for (y, out) in self.output.chunks_exact_mut(self.rows.across.to).enumerate() {
            self.rows.row_into(y, out);
            for value in out {
                *value /= Rescaled::WHITE;
            }
        }
    }
}

/// A picture that is rescaled while its rows are taken.
pub(crate) struct Rescaled<'a> {
    image: Region<'a, u8>,
    across: &'a Taps,
    down: &'a Taps,
    lines: &'a mut Lines,
    widened: &'a mut [f32],
    /// How many rows of the source are kept widened; row `y` lies at `y % kept`.
    kept: usize,
    /// Rows of the source that have been widened.
    ready: usize,
}

impl Rows for Rescaled<'_> {
    const WHITE: f32 = <u8 as Sample>::WHITE;

    fn shape(&self) -> [usize; 2] {
        [self.down.to, self.across.to]
    }

    #[inline(always)]
    fn row_into(&mut self, y: usize, out: &mut [f32]) {
        let width = self.across.to;
        while self.ready < self.down.starts[y] + self.down.count {
            let place = self.ready % self.kept * width;
            self.lines.fill(self.image, self.ready);
            self.across.mix_pixels(self.lines, &mut self.widened[place..][..ROWS * width]);
            self.ready += ROWS;
        }
        debug_assert!(self.ready <= self.down.starts[y] + self.kept, "row {y} is gone");
        let (widened, kept) = (&*self.widened, self.kept);
        self.down.mix_rows(|row| &widened[row % kept * width..][..width], y, out);
    }
}

/// Rows that are widened together.
const ROWS: usize = 2;

/// Rows of the source, to be widened.
#[derive(Clone, Debug, Default)]
struct Lines {
    /// In their own unit, those of a column together.
    columns: Vec<[f32; ROWS]>,
    /// The two columns that each of the result lies between. To look them up takes a load for each, where nothing can be
    /// done for several at once; all else then can.
    pairs: Vec<[[f32; ROWS]; 2]>,
}

impl Lines {
    /// Takes the rows from this one on; behind the last row it comes again.
    #[inline(always)]
    fn fill(&mut self, image: Region<'_, u8>, first: usize) {
        self.columns.resize(image.width(), [0.0; ROWS]);
        let [above, below] = [first, first + 1].map(|y| image.row(y.min(image.height() - 1)));
        for ((column, above), below) in self.columns.iter_mut().zip(above).zip(below) {
            *column = [above.value(), below.value()];
        }
    }
}

/// For every position along a side of the result: the source's positions that go into it, which lie
/// side by side, and their weights. As weights add up to 1, the first one follows from the others:
/// `Σ w_k p_k = p_0 + Σ_{k>0} w_k (p_k − p_0)`.
#[derive(Clone, Debug, Default)]
struct Taps {
    from: usize,
    to: usize,
    starts: Vec<usize>,
    /// Source positions for each result.
    count: usize,
    /// The second weights of all results, then the third, up to the last.
    weights: Vec<f32>,
}

impl Taps {
    fn prepare(&mut self, from: usize, to: usize) {
        if (self.from, self.to) == (from, to) {
            return;
        }
        (self.from, self.to) = (from, to);
        self.starts.clear();
        self.weights.clear();
        if from == to {
            self.count = 1;
            self.starts.extend(0..to);
            return;
        }
        let scale = from as f64 / to as f64;
        let reach = scale.max(1.0);
        self.count = ((2.0 * reach).ceil() as usize).min(from);
        self.weights.resize(to * (self.count - 1), 0.0);
        for i in 0..to {
            let centre = (i as f64 + 0.5) * scale - 0.5;
            self.set(i, centre, reach);
        }
    }

    /// Gives result `i` the triangle of half width `reach` around `centre`, cut off at the border.
    fn set(&mut self, i: usize, centre: f64, reach: f64) {
        let first = (centre - reach).floor() as isize + 1;
        let start = usize::try_from(first).unwrap_or(0).min(self.from - self.count);
        let weight = |k: usize| (1.0 - ((start + k) as f64 - centre).abs() / reach).max(0.0);
        let total: f64 = (0..self.count).map(weight).sum();
        self.starts.push(start);
        for k in 1..self.count {
            self.weights[(k - 1) * self.to + i] = (weight(k) / total) as f32;
        }
    }

    /// Along rows, to rows that lie one after the other.
    #[inline(always)]
    fn mix_pixels(&self, Lines { columns, pairs }: &mut Lines, out: &mut [f32]) {
        let (above, below) = out.split_at_mut(self.to);
        let mut rounds = (1..).zip(self.weights.chunks_exact(self.to));
        let Some((_, weights)) = rounds.next() else {
            // There is one pixel for each.
            for ((above, below), &start) in above.iter_mut().zip(below).zip(&self.starts) {
                [*above, *below] = columns[start];
            }
            return;
        };
        pairs.resize(self.to, [[0.0; ROWS]; 2]);
        for (pair, &start) in pairs.iter_mut().zip(&self.starts) {
            *pair = [columns[start], columns[start + 1]];
        }
        for (((above, below), [pixel, next]), weight) in above.iter_mut().zip(&mut *below).zip(&*pairs).zip(weights) {
            *above = pixel[0] + weight * (next[0] - pixel[0]);
            *below = pixel[1] + weight * (next[1] - pixel[1]);
        }
        for (k, weights) in rounds {
            for (((above, below), &start), weight) in above.iter_mut().zip(&mut *below).zip(&self.starts).zip(weights) {
                let (pixel, first) = (columns[start + k], columns[start]);
                *above += weight * (pixel[0] - first[0]);
                *below += weight * (pixel[1] - first[1]);
            }
        }
    }

    /// Row `i` of the result, of whole rows.
    #[inline(always)]
    fn mix_rows<'a>(&self, row: impl Fn(usize) -> &'a [f32], i: usize, out: &mut [f32]) {
        let start = self.starts[i];
        let first = row(start);
        let mut rounds = (1..).zip(self.weights.chunks_exact(self.to));
        let Some((_, weights)) = rounds.next() else { return out.copy_from_slice(first) };
        for ((out, pixel), first) in out.iter_mut().zip(row(start + 1)).zip(first) {
            *out = first + weights[i] * (pixel - first);
        }
        for (k, weights) in rounds {
            let weight = weights[i];
            for ((out, pixel), first) in out.iter_mut().zip(row(start + k)).zip(first) {
                *out += weight * (pixel - first);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use fast_image_resize as fir;

    use super::*;
    use crate::{CellSize, Frame, Hog, HogLayout, HogParams, Norm};

    fn noise(width: usize, height: usize) -> Frame {
        let pixel = |i: usize| (i.wrapping_mul(2_654_435_761) >> 13) as u8;
        Frame::from_vec(width, height, (0..width * height).map(pixel).collect()).expect("sides above 0")
    }

    /// The same by an independent implementation.
    fn reference(image: &Frame, width: usize, height: usize) -> Vec<f32> {
        let pixels = image.as_slice().iter().map(|&v| fir::pixels::F32::new(f32::from(v) / 255.0)).collect();
        let (from_width, from_height) = (image.width() as u32, image.height() as u32);
        let source = fir::images::TypedImage::from_pixels(from_width, from_height, pixels).expect("as many pixels");
        let mut target = fir::images::TypedImage::new(width as u32, height as u32);
        let bilinear = fir::ResizeAlg::Convolution(fir::FilterType::Bilinear);
        let options = fir::ResizeOptions::new().resize_alg(bilinear);
        fir::Resizer::new().resize_typed(&source, &mut target, &options).expect("sides above 0");
        target.pixels().iter().map(|pixel| pixel.0).collect()
    }

    #[test]
    fn agrees_with_an_independent_implementation() {
        let mut resizer = Resizer::default();
        // Larger, smaller, both at once, by whole and broken factors, single rows and columns.
        for (from, to) in [
            ((20, 30), (84, 84)),
            ((84, 84), (20, 31)),
            ((40, 12), (9, 33)),
            ((33, 33), (33, 50)),
            ((1, 9), (5, 1)),
            ((17, 1), (4, 6)),
        ] {
            let image = noise(from.0, from.1);
            let got = resizer.resize(image.view(), to.0, to.1).expect("sides above 0");
            for (got, expected) in got.as_slice().iter().zip(reference(&image, to.0, to.1)) {
                assert!((got - expected).abs() < 2e-6, "{got} for {expected}, {from:?} to {to:?}");
            }
        }
    }

    #[test]
    fn all_instruction_sets_give_the_same_bits() {
        for (from, to) in [((20, 30), (84, 84)), ((84, 84), (20, 31)), ((33, 70), (71, 50)), ((1, 9), (5, 1))] {
            let image = noise(from.0, from.1);
            let mut results = Simd::available().map(|simd| {
                let mut resizer = Resizer { simd, ..Resizer::default() };
                let plane = resizer.resize(image.view(), to.0, to.1).expect("sides above 0");
                plane.as_slice().iter().map(|v| v.to_bits()).collect::<Vec<u32>>()
            });
            let first = results.next().expect("there is always one");
            assert!(results.all(|other| other == first), "{from:?} to {to:?}");
        }
    }

    /// Rows are asked for again where HOG's strips overlap, and each time only some of the source is at hand.
    #[test]
    fn rows_made_on_the_way_are_those_of_one_pass() {
        let mut resizer = Resizer::default();
        let shapes = [
            ((20, 30), (84, 84)),
            ((84, 90), (20, 31)),
            ((40, 12), (19, 63)),
            ((5, 200), (30, 17)),
            ((33, 33), (33, 50)),
        ];
        for ((from, (width, height)), cell_px) in
            shapes.into_iter().flat_map(|shape| [1, 2, 3, 8].map(|px| (shape, px)))
        {
            let image = noise(from.0, from.1);
            let mut pixels = vec![0.0; width * height];
            let mut rows = resizer.rows(image.view().region(), [height, width]);
            pixels.chunks_exact_mut(width).enumerate().for_each(|(y, out)| rows.row_into(y, out));
            let params = HogParams { cell: CellSize::Px(cell_px), norm: Norm::None, ..HogParams::default() };
            let layout = HogLayout::new(&params, width, height).expect("a cell fits");
            let mut hog = Hog::new(params).expect("valid parameters");
            let (mut whole, mut made) = (Vec::new(), Vec::new());
            hog.compute(&layout, Region::whole(width, height, &pixels), &mut whole);
            hog.compute(&layout, resizer.rows(image.view().region(), layout.shape()), &mut made);
            assert_eq!(made.len(), whole.len());
            for (made, whole) in made.iter().zip(&whole) {
                let off = (made - whole / Rescaled::WHITE).abs();
                assert!(off < 1e-6, "{off}: {from:?} to {width}x{height}, cells of {cell_px} px");
            }
        }
    }

    #[test]
    fn flat_stays_exactly_flat() {
        let mut image = Frame::new(13, 7);
        image.fill(187);
        let mut resizer = Resizer::default();
        for (width, height) in [(84, 60), (5, 3), (3, 50), (13, 7)] {
            let plane = resizer.resize(image.view(), width, height).expect("sides above 0");
            assert!(plane.as_slice().iter().all(|v| *v == plane.as_slice()[0]));
        }
    }

    #[test]
    fn a_size_without_pixels_is_an_error() {
        let image = noise(4, 4);
        let mut resizer = Resizer::default();
        for (width, height) in [(0, 4), (4, 0), (usize::MAX, 2)] {
            assert!(resizer.resize(image.view(), width, height).is_err());
        }
    }
}
