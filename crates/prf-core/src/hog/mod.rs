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

#[cfg(test)]
mod tests;

pub use layout::HogLayout;
pub use params::{CellSize, HogParams, Norm};

use bins::Bins;
use cells::Cells;
use normalize::Feature;
use strip::Strip;
use votes::Votes;

use crate::region::Rows;
use crate::simd::{Kernel, Simd};
use crate::{Error, FrameView, PlaneView};

/// Computes HOGs (paper, section "HOG features") and keeps its working memory, so that after the first picture of a size
/// nothing is allocated.
///
/// Equal to `skimage.feature.hog` (`feature_vector=True`, `transform_sqrt=False`) to 1e-5; of floats under L1-sqrt, whose slope has
/// no limit at 0, to 1e-4.
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
    pub(crate) fn compute<R: Rows>(&mut self, layout: &HogLayout, image: R, out: &mut Vec<f32>) {
        debug_assert_eq!(layout.shape(), image.shape());
        let cut = Cut::of(layout);
        self.memory.fit(layout, cut);
        out.resize(layout.len(), 0.0);
        let (bins, norm, memory) = (&self.bins, self.params.norm, &mut self.memory);
        self.simd.run(Compute { layout, cut, image, bins, norm, memory, out });
    }
}

/// How the work on pictures of one size is cut up.
#[derive(Clone, Copy, Debug)]
struct Cut {
    /// Rows of pixels in a section of the strip, sections that are worked on at a time, and their distance in cells.
    rows: usize,
    sections: usize,
    section_cells: usize,
}

impl Cut {
    /// Floats that fit into the cache next to the processor, with some room for all else.
    const NEAR: usize = 6000;

    fn of(layout: &HogLayout) -> Cut {
        let ([_, columns], cell_px) = (layout.cells(), layout.cell_px());
        // What is left of the picture, and a column more on both sides, lie between two sections.
        let section_cells = (layout.shape()[1] + 2).div_ceil(cell_px);
        if is_point(layout) {
            // The rows above and below are read again for each section, which counts where cells are small.
            return Cut { rows: 16, sections: 1, section_cells };
        }
        let evenly = (columns * cell_px).is_multiple_of(lanes::WIDTH);
        let near = Cut::NEAR / ((cell_px + 2) * section_cells * cell_px);
        Cut { rows: cell_px, sections: if evenly { 1 } else { near.max(1) }, section_cells }
    }
}

/// Whether a block is one pixel.
fn is_point(layout: &HogLayout) -> bool {
    layout.cell_px() * layout.block_cells() == 1
}

impl Memory {
    fn fit(&mut self, layout: &HogLayout, cut: Cut) {
        let (rows, cell_px) = (layout.cells()[0], layout.cell_px());
        self.strip.reserve(cut.rows, cut.section_cells * cell_px, cut.sections);
        self.votes.resize(cell_px);
        if !is_point(layout) {
            self.cells.resize(cell_px, rows, cut.section_cells, layout.orientations());
            self.blocks.resize(layout.block_len(), lanes::Lanes::zero());
        }
    }
}

/// Writes the HOG of `image` to `out`, which has its length.
struct Compute<'a, R> {
    layout: &'a HogLayout,
    cut: Cut,
    image: R,
    bins: &'a Bins,
    norm: Norm,
    memory: &'a mut Memory,
    out: &'a mut [f32],
}

impl<R: Rows> Kernel for Compute<'_, R> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let [rows, columns] = self.layout.cells();
        // Cell sums become means, and bytes become fractions of 255.
        let unit = 1.0 / (R::WHITE * self.layout.cell_px().pow(2) as f32);
        let Compute { layout, cut, mut image, bins, norm, memory, out } = self;
        let Memory { strip, votes, cells, blocks } = memory;
        if is_point(layout) {
            let out = out.chunks_exact_mut(columns * layout.block_len());
            for (y, out) in out.enumerate() {
                if y % cut.rows == 0 {
                    strip.fill(&mut image, y, 1);
                }
                points::fill_row(votes, strip, y % cut.rows, (bins, unit, norm), layout, out);
            }
            return;
        }
        for row in (0..rows).step_by(cut.sections) {
            let sections = cut.sections.min(rows - row);
            strip.fill(&mut image, row * cut.rows, sections);
            cells.fill(row, (sections - 1) * cut.section_cells + columns, votes, strip, bins);
        }
        blocks::collect(cells, unit, layout, norm, blocks, out);
    }
}
