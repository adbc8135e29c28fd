//! Histograms of oriented gradients (Dalal and Triggs, 2005), as scikit-image defines them.

mod bins;
mod layout;
mod normalize;
mod params;

pub use layout::HogLayout;
pub use params::{CellSize, HogParams, Norm};

use bins::{Bins, Votes};

use crate::gradient;
use crate::region::{Region, Sample};
use crate::{Error, FrameView, PlaneView};

/// Computes HOGs (paper, section "HOG features") and keeps its working memory, so that after the first picture of a size
/// nothing is allocated.
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
    params: HogParams,
    bins: Bins,
    votes: Votes,
    /// One histogram a cell, row by row.
    histograms: Vec<f32>,
}

impl Hog {
    /// A HOG with these parameters, for pictures of any size.
    ///
    /// # Errors
    ///
    /// [`Error::InvalidParam`] as [`HogParams::validate`].
    pub fn new(params: HogParams) -> Result<Hog, Error> {
        params.validate()?;
        Ok(Hog {
            params,
            bins: Bins::new(params.orientations, params.signed),
            votes: Votes::default(),
            histograms: Vec::new(),
        })
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
        self.fill_histograms(layout, image);
        self.collect_blocks(layout, out);
    }

    fn fill_histograms<P: Sample>(&mut self, layout: &HogLayout, image: Region<'_, P>) {
        let ([rows, columns], cell_px) = (layout.cells(), layout.cell_px());
        let orientations = layout.orientations();
        self.histograms.clear();
        self.histograms.resize(rows * columns * orientations, 0.0);
        self.votes.resize(columns, cell_px, orientations);
        let cell_rows = self.histograms.chunks_exact_mut(columns * orientations);
        for (cell_row, histograms) in cell_rows.enumerate() {
            for y in cell_row * cell_px..(cell_row + 1) * cell_px {
                gradient::row(image, y, &mut self.votes.dx, &mut self.votes.dy);
                self.bins.assign(&mut self.votes);
                cast(&self.votes, histograms);
            }
            // Cell sums become means, and bytes become fractions of 255.
            let unit = 1.0 / (P::WHITE * (cell_px * cell_px) as f32);
            histograms.iter_mut().for_each(|v| *v *= unit);
        }
    }

    fn collect_blocks(&self, layout: &HogLayout, out: &mut Vec<f32>) {
        let [block_rows, block_columns] = layout.blocks();
        let (orientations, block_cells) = (layout.orientations(), layout.block_cells());
        let stride = layout.cells()[1] * orientations;
        out.clear();
        out.reserve(layout.len());
        if block_cells == 1 {
            out.extend_from_slice(&self.histograms);
        } else {
            for (y, x) in (0..block_rows).flat_map(|y| (0..block_columns).map(move |x| (y, x))) {
                for row in y..y + block_cells {
                    let left = row * stride + x * orientations;
                    out.extend_from_slice(&self.histograms[left..][..block_cells * orientations]);
                }
            }
        }
        self.params.norm.apply(out, layout.block_len());
    }
}

/// Adds the votes of one row of pixels to the histograms of its row of cells.
fn cast(votes: &Votes, histograms: &mut [f32]) {
    for (&weight, &place) in votes.weight.iter().zip(&votes.place) {
        // Much of a picture is flat; adding nothing would still wait for the sum before it.
        if weight > 0.0 {
            histograms[place as usize] += weight;
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
        let mut votes = Votes::default();
        votes.resize(1, 3, orientations);
        gradient::row(image.region(), 1, &mut votes.dx, &mut votes.dy);
        Bins::new(orientations, signed).assign(&mut votes);
        votes.place[1] as usize
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
