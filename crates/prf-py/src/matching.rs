//! `prf.match_template`

use numpy::{PyArray2, PyArray3, PyArrayMethods, ToPyArray};
use prf_core::{Error, FrameView, MatchMethod, Plane, TemplateMatcher};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::batch::{self, Threads};
use crate::error::value_error;
use crate::image::{self, Picture, Pictures};
use crate::options::Options;

/// How well a template fits at every place of a picture: their normalised correlation.
///
/// With the default it is ``skimage.feature.match_template(image, template)`` to 1e-4. A window all of whose
/// pixels are equal scores 0.
///
/// Parameters
/// ----------
/// image : (H, W) ndarray of uint8
///     Where to search. A C-contiguous array is read without a copy.
/// template : (h, w) ndarray of uint8
///     What to search for, nowhere larger than the image.
/// mask : (h, w) ndarray of uint8 or bool, optional
///     Only pixels of the template that are not 0 here count.
/// method : {"ccoeff-normed", "ccorr-normed"}
///     "ccoeff-normed" subtracts the means first, so neither brightness nor contrast count: OpenCV's
///     ``TM_CCOEFF_NORMED``. "ccorr-normed" doesn't: ``TM_CCORR_NORMED``, the paper's, and the default of
///     :class:`WindowGoal`.
///
/// Returns
/// -------
/// (H - h + 1, W - w + 1) ndarray of float32
///     The score of the window whose top left pixel is ``(x, y)`` at ``[y, x]``: at most 1, and at least -1, or 0
///     with "ccorr-normed".
///
/// Raises
/// ------
/// TypeError
///     An argument has another type, or an array another dtype.
/// ValueError
///     An array has another number of dimensions or a side of 0 or above 16384, the template is larger than the
///     image, or the mask has another size than the template or is 0 all over.
///
/// Examples
/// --------
/// >>> import numpy as np
/// >>> import prf
/// >>> image = np.random.default_rng(0).integers(0, 256, (84, 84), np.uint8)
/// >>> result = prf.match_template(image, image[30:39, 50:62])
/// >>> result.shape
/// (76, 73)
/// >>> y, x = np.unravel_index(result.argmax(), result.shape)
/// >>> (int(x), int(y))
/// (50, 30)
#[pyfunction]
#[pyo3(
    signature = (image, template, **options),
    text_signature = "(image, template, *, mask=None, method='ccoeff-normed')"
)]
pub(crate) fn match_template<'py>(
    image: &Bound<'py, PyAny>,
    template: &Bound<'py, PyAny>,
    options: Option<Bound<'py, PyDict>>,
) -> PyResult<Bound<'py, PyArray2<f32>>> {
    let options = Options::new("match_template", options);
    let mut search = Search::new(template, &options)?;
    options.finish()?;
    let py = image.py();
    let image = Picture::read("image", image)?;
    let image = image.view()?;
    let scores = py.detach(|| {
        search.matcher.scores_into(image, &mut search.scores)?;
        Ok(search.scores)
    });
    let scores = scores.map_err(|error| value_error("image", &error))?;
    scores.as_slice().to_pyarray(py).reshape([scores.height(), scores.width()])
}

/// :func:`match_template` of many pictures and one template, on several threads.
///
/// Parameters
/// ----------
/// images : (N, H, W) ndarray of uint8
///     Where to search. N may be 0.
/// template, mask, method
///     As for :func:`match_template`.
/// threads : int, 1 to 1024, optional
///     The most threads; as many as there are cores where it isn't given. The result is the same.
///
/// Returns
/// -------
/// (N, H - h + 1, W - w + 1) ndarray of float32
///     What :func:`match_template` gives for each.
///
/// Raises
/// ------
/// TypeError, ValueError
///     As :func:`match_template`.
/// MemoryError
///     There is no room for the result.
///
/// Examples
/// --------
/// >>> import numpy as np
/// >>> import prf
/// >>> images = np.random.default_rng(0).integers(0, 256, (5, 84, 84), np.uint8)
/// >>> results = prf.match_template_batch(images, images[3, 30:39, 50:62])
/// >>> image, y, x = np.unravel_index(results.argmax(), results.shape)
/// >>> (int(image), int(x), int(y))
/// (3, 50, 30)
#[pyfunction]
#[pyo3(
    signature = (images, template, **options),
    text_signature = "(images, template, *, mask=None, method='ccoeff-normed', threads=None)"
)]
pub(crate) fn match_template_batch<'py>(
    images: &Bound<'py, PyAny>,
    template: &Bound<'py, PyAny>,
    options: Option<Bound<'py, PyDict>>,
) -> PyResult<Bound<'py, PyArray3<f32>>> {
    let options = Options::new("match_template_batch", options);
    let mut search = Search::new(template, &options)?;
    let threads = Threads::read(&options)?;
    options.finish()?;
    let images = Pictures::read("images", images)?;
    let shape = images.shape();
    let [height, width] = search.prepare(images.py(), shape).map_err(|error| value_error("images", &error))?;
    batch::each("images", &images, threads, search, &[height, width], |search, pixels, results| {
        search.matcher.scores_into(FrameView::new(shape[1], shape[0], pixels)?, &mut search.scores)?;
        results.copy_from_slice(search.scores.as_slice());
        Ok(())
    })
}

/// What one thread searches with.
#[derive(Clone)]
struct Search {
    matcher: TemplateMatcher,
    /// Of the template, `[height, width]`.
    shape: [usize; 2],
    scores: Plane,
}

impl Search {
    fn new(template: &Bound<'_, PyAny>, options: &Options<'_>) -> PyResult<Search> {
        let template = Picture::read("template", template)?;
        let mask = options.raw("mask")?.filter(|mask| !mask.is_none());
        let mask = mask.map(|mask| image::mask(&mask)).transpose()?;
        let method = options.choice("method")?.unwrap_or(MatchMethod::CcoeffNormed);
        let (shape, frame) = (template.shape(), template.view()?.to_frame());
        let search = template.py().detach(|| {
            let matcher = TemplateMatcher::new(&frame, mask.as_ref(), method)?;
            Ok(Search { matcher, shape, scores: Plane::from_vec(1, 1, vec![0.0])? })
        });
        search.map_err(|error| value_error("template", &error))
    }

    /// Prepares for pictures of this shape and returns that of their results.
    fn prepare(&mut self, py: Python<'_>, shape: [usize; 2]) -> Result<[usize; 2], Error> {
        py.detach(|| self.matcher.prepare(shape))?;
        Ok([0, 1].map(|side| shape[side] - self.shape[side] + 1))
    }
}
