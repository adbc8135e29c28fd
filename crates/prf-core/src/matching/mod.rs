//! Where a template lies in a frame: normalised correlation (paper, section "Visual task descriptors").
//!
//! The scores are OpenCV's (`matchTemplate` with `TM_CCORR_NORMED` and `TM_CCOEFF_NORMED`), but for flat windows,
//! which score 0 here.

mod dft;
mod direct;
mod fft;
mod integral;
mod normalize;
mod plan;
mod rectangles;
mod search;
mod spectral;
mod template;
mod tiles;

use serde::{Deserialize, Serialize};

use crate::frame::check_shape;
use crate::simd::Simd;
use crate::{Error, Frame, FrameView, Plane, Rect};

use direct::Direct;
use integral::{Integral, Integrate};
use normalize::{Normalize, WindowRow};
use plan::Plan;
use search::Search;
use spectral::Spectral;
use template::Template;

#[cfg(test)]
mod tests;

/// How a window `I` of a frame is compared with the template `T`; sums go over all pixels, or those under the mask. Where a
/// denominator is 0 the score is 0.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum MatchMethod {
    /// `Σ I T / √(Σ I² Σ T²)`, in [0, 1]: the paper's. Brightness counts.
    #[default]
    CcorrNormed,
    /// The same of `I − mean(I)` and `T − mean(T)`, in [−1, 1]. Neither brightness nor contrast count.
    CcoeffNormed,
}

/// The window of a frame that is most like the template.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Match {
    /// Where it lies, in the frame's pixels. It has the template's size.
    pub rect: Rect,
    /// In [0, 1] (plain) or [−1, 1] (zero-mean); 1 for the template itself.
    pub score: f32,
}

/// Finds a template in frames. Keeps all that depends on the template and on the frames' size, so that nothing is
/// allocated after the first frame of a size.
///
/// This is the paper's search for the window with the largest normalised correlation (section "Mirror task descriptors").
/// Small templates are correlated directly, all others by Fourier transforms; the best match is the same either way.
///
/// ```
/// use prf_core::{Frame, MatchMethod, Rect, TemplateMatcher};
/// let mut frame = Frame::new(40, 30);
/// frame.row_mut(12)[20..24].fill(200);
/// frame.row_mut(13)[20..22].fill(90);
/// let mut template = Frame::new(4, 2);
/// template.row_mut(0).fill(100);
/// template.row_mut(1)[..2].fill(45);
///
/// let mut matcher = TemplateMatcher::new(&template, None, MatchMethod::CcorrNormed)?;
/// let found = matcher.best(frame.view())?;
/// assert_eq!(found.rect, Rect { x: 20, y: 12, width: 4, height: 2 });
/// assert_eq!(found.score, 1.0); // twice as bright is the same
/// # Ok::<(), prf_core::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct TemplateMatcher {
    simd: Simd,
    template: Template,
    prepared: Option<Prepared>,
}

/// What depends on the frames' size.
#[derive(Clone, Debug)]
struct Prepared {
    shape: [usize; 2],
    correlator: Correlator,
    integral: Integral,
    row: WindowRow,
    map: Vec<f32>,
}

#[derive(Clone, Debug)]
enum Correlator {
    Direct(Direct),
    Spectral(Box<Spectral>),
}

impl TemplateMatcher {
    /// Prepares a template. With a mask only those of its pixels count where the mask is not 0. A template all of
    /// whose pixels are equal (zero-mean) or black (plain) scores 0 everywhere.
    ///
    /// # Errors
    ///
    /// [`Error::InvalidParam`] when the mask has another size than the template, or is 0 all over.
    pub fn new(template: &Frame, mask: Option<&Frame>, method: MatchMethod) -> Result<TemplateMatcher, Error> {
        let template = Template::new(template, mask, method)?;
        Ok(TemplateMatcher { simd: Simd::detect(), template, prepared: None })
    }

    /// Prepares for frames of this `[height, width]`: spectrum, plans and buffers. Does nothing when the last frames
    /// had the same.
    ///
    /// # Errors
    ///
    /// [`Error::TemplateTooLarge`] when the template doesn't fit into such frames, [`Error::Shape`] when their pixels
    /// can't be counted.
    pub fn prepare(&mut self, shape: [usize; 2]) -> Result<(), Error> {
        self.prepared(shape).map(|_| ())
    }

    /// The window with the highest score; the first in reading order among exactly equal ones.
    ///
    /// # Errors
    ///
    /// As [`TemplateMatcher::prepare`].
    pub fn best(&mut self, frame: FrameView<'_>) -> Result<Match, Error> {
        let (simd, template, prepared) = self.prepared([frame.height(), frame.width()])?;
        let mut map = std::mem::take(&mut prepared.map);
        prepared.score(simd, template, frame, &mut map);
        let (integral, windows) = (&prepared.integral, prepared.row.windows());
        let found = simd.run(Search { template, frame, integral, windows, map: &map });
        prepared.map = map;
        Ok(found)
    }

    /// Writes the score of every window to `out`, which gets the shape `[H − h + 1, W − w + 1]` for a frame of
    /// `[H, W]` and a template of `[h, w]`. Each is within 4e-5 of the exact one.
    ///
    /// # Errors
    ///
    /// As [`TemplateMatcher::prepare`].
    pub fn scores_into(&mut self, frame: FrameView<'_>, out: &mut Plane) -> Result<(), Error> {
        let (simd, template, prepared) = self.prepared([frame.height(), frame.width()])?;
        let [height, width] = plan::windows(template.shape(), prepared.shape);
        prepared.score(simd, template, frame, out.reshape(width, height));
        Ok(())
    }

    fn prepared(&mut self, shape: [usize; 2]) -> Result<(Simd, &Template, &mut Prepared), Error> {
        let (simd, template) = (self.simd, &self.template);
        let prepared = match self.prepared.take_if(|prepared| prepared.shape == shape) {
            Some(prepared) => prepared,
            None => Prepared::new(simd, template, shape)?,
        };
        Ok((simd, template, self.prepared.insert(prepared)))
    }
}

impl Prepared {
    fn new(simd: Simd, template: &Template, shape: [usize; 2]) -> Result<Prepared, Error> {
        if (0..2).any(|side| template.shape()[side] > shape[side]) {
            return Err(Error::TemplateTooLarge { template: template.shape(), frame: shape });
        }
        let [height, width] = shape;
        check_shape(width, height, height.checked_mul(width).unwrap_or(0))?;
        Ok(Prepared::planned(Plan::new(template.shape(), shape), simd, template, shape))
    }

    fn planned(plan: Plan, simd: Simd, template: &Template, shape: [usize; 2]) -> Prepared {
        let [rows, columns] = plan::windows(template.shape(), shape);
        Prepared {
            shape,
            correlator: match plan {
                Plan::Direct => Correlator::Direct(Direct::new(shape)),
                Plan::Spectral(tiling) => Correlator::Spectral(Box::new(Spectral::new(tiling, template, simd))),
            },
            integral: Integral::new(shape),
            row: WindowRow::new(columns),
            map: vec![0.0; rows * columns],
        }
    }

    /// Writes the score of every window to `map`.
    fn score(&mut self, simd: Simd, template: &Template, frame: FrameView<'_>, map: &mut [f32]) {
        let centre = simd.run(Integrate { integral: &mut self.integral, frame }).round();
        let windows = self.row.windows();
        let error = match &mut self.correlator {
            Correlator::Direct(direct) => {
                simd.run(direct::Correlate { direct, template, frame, centre: centre as f32, map });
                0.0
            }
            Correlator::Spectral(spectral) => {
                simd.run(spectral::Correlate { spectral, frame, centre: centre as f32, windows, map })
            }
        };
        let (integral, row) = (&self.integral, &mut self.row);
        simd.run(Normalize { template, frame, integral, row, centre, error, map });
    }
}
