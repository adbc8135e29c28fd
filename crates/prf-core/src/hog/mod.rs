//! Histograms of oriented gradients (Dalal and Triggs, 2005), as scikit-image defines them.

mod bins;
mod blocks;
mod cells;
mod lanes;
mod layout;
mod normalize;
mod params;
mod points;
mod strip;
mod votes;

pub use layout::HogLayout;
pub use params::{CellSize, HogParams, Norm};

use bins::Bins;
use cells::Cells;
use normalize::Feature;
use strip::Strip;
use votes::Votes;

use crate::region::{Region, Sample};
use crate::simd::{Kernel, Simd};
use crate::{Error, FrameView, PlaneView};

/// Computes HOGs and keeps its working memory, so that after the first picture of a size nothing is
/// allocated.
///
/// Equal to `skimage.feature.hog` (`feature_vector=True`, `transform_sqrt=False`) to 1e-5.
///
/// ```
/// use prf_core::{CellSize, Hog, HogParams, Norm, PlaneView};
/// let params = HogParams {
///     orientations: 2,
///     cell: CellSize::Px(3),
///     norm: Norm::None,
///     ..HogParams::default()
/// };
/// // A step from black to white along x: 3 of the 9 pixels have a gradient, of length 1.
/// let picture = [0.0, 0.5, 1.0, 0.0, 0.5, 1.0, 0.0, 0.5, 1.0];
/// let mut features = Vec::new();
/// Hog::new(params)?.compute_into(PlaneView::new(3, 3, &picture)?, &mut features)?;
/// assert_eq!(features, [3.0 / 9.0, 0.0]);
/// # Ok::<(), prf_core::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Hog {
    simd: Simd,
    params: HogParams,
    bins: Bins,
    memory: Memory,
}

/// What is worked on, kept from picture to picture.
#[derive(Clone, Debug, Default)]
struct Memory {
    strip: Strip,
    votes: Votes,
    cells: Cells,
    /// The features of some blocks.
    blocks: Vec<Feature>,
}

impl Hog {
    /// A HOG with these parameters, for pictures of any size.
    ///
    /// # Errors
    ///
    /// [`Error::InvalidParam`] as [`HogParams::validate`].
    pub fn new(params: HogParams) -> Result<Hog, Error> {
        params.validate()?;
        let bins = Bins::new(params.orientations, params.signed);
        Ok(Hog { simd: Simd::detect(), params, bins, memory: Memory::default() })
    }

    /// The parameters it was made with.
    #[must_use]
    pub fn params(&self) -> &HogParams {
        &self.params
    }

    /// Writes the features of `image` to `out`, which is overwritten, and returns their layout.
    /// Features are never negative; with a norm they are at most 1.
    ///
    /// # Errors
    ///
    /// [`Error::TooSmall`] when no block fits the picture.
    pub fn compute_into(&mut self, image: PlaneView<'_>, out: &mut Vec<f32>) -> Result<HogLayout, Error> {
        let layout = HogLayout::new(&self.params, image.width(), image.height())?;
        self.compute(&layout, image.region(), out);
        Ok(layout)
    }

    /// As [`Hog::compute_into`] for bytes, which are taken as fractions of 255. Their differences
    /// are exact, so this is the more precise of the two as well as the faster.
    ///
    /// # Errors
    ///
    /// As [`Hog::compute_into`].
    pub fn compute_bytes_into(&mut self, image: FrameView<'_>, out: &mut Vec<f32>) -> Result<HogLayout, Error> {
        let layout = HogLayout::new(&self.params, image.width(), image.height())?;
        self.compute(&layout, image.region(), out);
        Ok(layout)
    }

    /// The HOG of an image whose shape and orientations are those of `layout`.
    pub(crate) fn compute<P: Sample>(&mut self, layout: &HogLayout, image: Region<'_, P>, out: &mut Vec<f32>) {
        debug_assert_eq!(layout.shape(), image.shape());
        self.memory.fit(layout);
        out.resize(layout.len(), 0.0);
        let (bins, norm, memory) = (&self.bins, self.params.norm, &mut self.memory);
        self.simd.run(Compute { layout, image, bins, norm, memory, out });
    }
}

impl Memory {
    fn fit(&mut self, layout: &HogLayout) {
        let ([rows, columns], cell_px) = (layout.cells(), layout.cell_px());
        let orientations = layout.orientations();
        let room = columns * cell_px + lanes::WIDTH;
        self.strip.reserve(strip_rows(cell_px), layout.shape()[1], room);
        self.votes.resize(cell_px);
        self.cells.resize([rows, columns], cell_px, orientations);
        self.blocks.resize(layout.block_len(), lanes::Lanes::zero());
    }
}

/// How many rows of pixels are made floats at a time. Small enough for the cache next to the processor; large enough that
/// the two rows at its border, which are read twice, hardly count.
fn strip_rows(cell_px: usize) -> usize {
    16usize.next_multiple_of(cell_px)
}

/// Writes the HOG of `image` to `out`, which has its length.
struct Compute<'a, P> {
    layout: &'a HogLayout,
    image: Region<'a, P>,
    bins: &'a Bins,
    norm: Norm,
    memory: &'a mut Memory,
    out: &'a mut [f32],
}

impl<P: Sample> Kernel for Compute<'_, P> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Memory { strip, votes, cells, blocks } = self.memory;
        let (layout, bins, norm) = (self.layout, self.bins, self.norm);
        let (rows, cell_px) = (layout.cells()[0], layout.cell_px());
        // Cell sums become means, and bytes become fractions of 255.
        let unit = 1.0 / (P::WHITE * (cell_px * cell_px) as f32);
        let is_point = layout.cell_px() * layout.block_cells() == 1;
        let row_len = layout.cells()[1] * layout.orientations();
        let at_a_time = strip_rows(cell_px) / cell_px;
        for row in 0..rows {
            let y = row % at_a_time * cell_px;
            if y == 0 {
                let count = at_a_time.min(rows - row);
                strip.fill(self.image, row * cell_px, count * cell_px);
            }
            if is_point {
                let out = &mut self.out[row * row_len..][..row_len];
                points::fill_row(votes, strip, y, (bins, unit, norm), layout, out);
            } else {
                cells.fill_row(row, votes, strip, y..y + cell_px, bins);
            }
        }
        if !is_point {
            blocks::collect(cells, unit, layout, norm, blocks, self.out);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A 3×3 picture, as one cell, whose centre has this gradient and no other pixel a slanted one.
    fn bin_of(dx: i16, dy: i16, orientations: usize, signed: bool) -> usize {
        let towards = |d: i16| (d.max(0) as u8, (-d).max(0) as u8);
        let ((right, left), (below, above)) = (towards(dx), towards(dy));
        let mut pixels = [0; 9];
        (pixels[1], pixels[3], pixels[5], pixels[7]) = (above, left, right, below);
        let image = FrameView::new(3, 3, &pixels).expect("3 x 3 pixels");
        let params =
            HogParams { orientations, signed, cell: CellSize::Px(1), norm: Norm::None, ..HogParams::default() };
        let mut features = Vec::new();
        Hog::new(params).expect("valid").compute_bytes_into(image, &mut features).expect("a cell fits");
        let centre = &features[4 * orientations..5 * orientations];
        centre.iter().position(|&v| v > 0.0).expect("a gradient")
    }

    #[test]
    fn a_direction_on_a_border_belongs_to_the_bin_that_begins_there() {
        let eighths = [(9, 0), (9, 9), (0, 9), (-9, 9), (-9, 0), (-9, -9), (0, -9), (9, -9)];
        for length in [1, 7, 28] {
            for (eighth, (dx, dy)) in eighths.into_iter().enumerate() {
                let (dx, dy) = (dx * length, dy * length);
                assert_eq!(bin_of(dx, dy, 8, true), eighth, "{dx}, {dy}");
                assert_eq!(bin_of(dx, dy, 4, false), eighth % 4, "{dx}, {dy}");
            }
        }
    }

    /// Every instruction set of this machine gives the same bits.
    #[test]
    fn all_instruction_sets_give_the_same_bits() {
        let noise = |i: usize| ((i + 1) * 2_654_435_761) >> 11;
        let shapes = [[1, 1], [3, 2], [17, 66], [64, 64], [40, 131], [151, 90]];
        let norms = [Norm::None, Norm::L1, Norm::L1Sqrt, Norm::L2, Norm::L2Hys];
        for (i, [height, width]) in shapes.into_iter().cycle().take(300).enumerate() {
            let pixels: Vec<u8> = (0..width * height).map(|i| noise(i) as u8 & [255, 3][i % 2]).collect();
            let plane: Vec<f32> = pixels.iter().map(|&v| f32::from(v) / 255.0).collect();
            let params = HogParams {
                orientations: [9, 9, 1, 4, 16][noise(i) % 5],
                signed: i % 3 == 0,
                cell: CellSize::Px([1, 2, 3, 4, 5, 7, 8, 12, 15, 33, 70, 90][noise(i) / 7 % 12].min(height.min(width))),
                block_cells: 1,
                norm: norms[i % 5],
            };
            let larger = HogParams { block_cells: 1 + noise(i) / 3 % 3, ..params };
            let params = if HogLayout::new(&larger, width, height).is_ok() { larger } else { params };
            let layout = HogLayout::new(&params, width, height).expect("a block fits");
            let (mut expected, mut features) = ([Vec::new(), Vec::new()], Vec::new());
            for simd in Simd::available() {
                let mut hog = Hog { simd, ..Hog::new(params).expect("valid") };
                for (kind, expected) in expected.iter_mut().enumerate() {
                    match kind {
                        0 => hog.compute(&layout, Region::whole(width, height, &pixels), &mut features),
                        _ => hog.compute(&layout, Region::whole(width, height, &plane), &mut features),
                    }
                    let bits: Vec<u32> = features.iter().map(|v| v.to_bits()).collect();
                    if expected.is_empty() {
                        expected.clone_from(&bits);
                    }
                    assert!(bits == *expected, "{simd:?}, {width}x{height}, {params:?}");
                }
            }
        }
    }

    #[test]
    fn signs_count_only_where_asked() {
        // 30°, 150°, 210° and 330°, in 3 bins of the full turn and of half of it.
        let directions = [(173, 100), (-173, 100), (-173, -100), (173, -100)];
        let bins = |signed| directions.map(|(dx, dy)| bin_of(dx, dy, 3, signed));
        assert_eq!(bins(true), [0, 1, 1, 2]);
        assert_eq!(bins(false), [0, 2, 0, 2]);
    }

    #[test]
    fn pixels_beyond_the_last_whole_cell_have_no_vote() {
        let params = HogParams { cell: CellSize::Px(4), norm: Norm::None, ..HogParams::default() };
        let mut hog = Hog::new(params).expect("valid parameters");
        let mut features = Vec::new();
        let mut pixels = [0; 49];
        pixels[5 * 7 + 6] = 255; // seen by the gradients of its neighbours alone, all beyond column 4
        let image = FrameView::new(7, 7, &pixels).expect("7 x 7 pixels");
        let layout = hog.compute_bytes_into(image, &mut features).expect("a cell fits");
        assert_eq!(layout.cells(), [1, 1]);
        assert_eq!(features, [0.0; 9]);
    }
}
