//! `prf.Goal` and what can be made one

mod classes;
mod parts;
mod source;
mod watcher;

use numpy::{PyArray1, PyArray2, PyArray3, PyArrayMethods, ToPyArray};
use prf_core::{CellSize, DescriptorParams, Error, FrameView, Match, Score, TaskDescriptor, draw_explanation};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict, PyTuple};

pub(crate) use self::classes::{DirectGoal, MotionGoal, WindowGoal};
pub(crate) use self::parts::GoalParts;
use self::watcher::Watcher;
use crate::batch::{self, Threads};
use crate::error::value_error;
use crate::image::{Picture, Pictures};
use crate::limits::{check_crops, check_picture};
use crate::options::Options;
use crate::results;
use crate::values::{decimal, name_of, picture, repr};

/// A finished task, shown by a picture or a movement: scores how near frames are to it.
///
/// What :class:`DirectGoal`, :class:`WindowGoal` and :class:`MotionGoal` have in common; it can't be made
/// by itself. Goals can be pickled, copied and sent to other processes.
///
/// Direct and window goals score every frame by itself and may be shared by threads. A motion goal
/// remembers the frames of an episode, so it belongs to one thread at a time: where another one is
/// just using it, its methods raise RuntimeError rather than wait.
///
/// Examples
/// --------
/// >>> import numpy as np
/// >>> import prf
/// >>> goal = prf.DirectGoal(np.zeros((84, 84), np.uint8))
/// >>> isinstance(goal, prf.Goal)
/// True
/// >>> goal
/// DirectGoal(<84x84 px>, orientations=9, signed=False, cell=0.03, block_cells=1, norm='l2', scale='sqrt-blocks')
#[pyclass(frozen, subclass, module = "prf")]
pub(crate) struct Goal {
    parts: GoalParts,
    watcher: Watcher,
}

/// The parts of a Python object that is a goal.
///
/// # Errors
///
/// TypeError where it is none.
pub(crate) fn goal_parts(goal: &Bound<'_, PyAny>) -> PyResult<GoalParts> {
    Ok(goal.cast::<Goal>()?.get().parts.clone())
}

impl Goal {
    /// # Errors
    ///
    /// ValueError where the parts don't fit each other or ask for too much memory.
    fn new(py: Python<'_>, parts: GoalParts) -> PyResult<Goal> {
        py.detach(|| {
            let picture = parts.goal.picture.view();
            match parts.descriptor {
                DescriptorParams::Window(_) => check_crops(&parts.params.hog, shape(picture))?,
                _ => check_picture(&parts.params.hog, picture)?,
            }
            let watcher = Watcher::new(&parts)?;
            Ok(Goal { parts, watcher })
        })
    }

    /// Refuses a frame, the argument `name`, whose features would take too much memory, or in which a window has no place.
    fn check(&self, name: &str, frame: FrameView<'_>) -> PyResult<()> {
        let hog = &self.parts.params.hog;
        match self.parts.descriptor {
            DescriptorParams::Direct => check_picture(hog, frame),
            // What is compared is no larger than the goal.
            DescriptorParams::Window(_) => {
                let (template, frame) = (shape(self.parts.goal.picture.view()), shape(frame));
                let fits = template[0] <= frame[0] && template[1] <= frame[1];
                fits.then_some(()).ok_or_else(|| value_error(name, &Error::TemplateTooLarge { template, frame }))
            }
            DescriptorParams::Motion(_) => check_crops(hog, shape(frame)),
        }
    }

    /// Scores one frame.
    fn observe(&self, py: Python<'_>, frame: FrameView<'_>) -> PyResult<(Score, Option<Match>)> {
        self.check("frame", frame)?;
        let scored = self.watcher.with(py, &self.parts, |descriptor| {
            let score = descriptor.observe(frame)?;
            Ok((score, descriptor.explain(frame).matched))
        })?;
        scored.map_err(|error| value_error("frame", &error))
    }

    /// A descriptor that has seen the same episode, for what mustn't change this one's.
    fn descriptor(&self) -> PyResult<Box<dyn TaskDescriptor>> {
        let mut descriptor = self.parts.describe()?;
        if let Some(state) = self.watcher.save_state()? {
            descriptor.load_state(&state).map_err(|error| value_error("state", &error))?;
        }
        Ok(descriptor)
    }
}

/// `[height, width]`
fn shape(picture: FrameView<'_>) -> [usize; 2] {
    [picture.height(), picture.width()]
}

#[pymethods]
impl Goal {
    /// Begins an episode: what was seen before no longer counts.
    ///
    /// Parameters
    /// ----------
    /// frame : (H, W) ndarray of uint8, optional
    ///     What the world looks like before the first action. It gets no reward, but a motion goal
    ///     sees by it what the first action moves.
    ///
    /// Raises
    /// ------
    /// TypeError, ValueError
    ///     ``frame`` is no picture, or smaller than the goal of a window goal.
    /// RuntimeError
    ///     Another thread is using this motion goal.
    #[pyo3(signature = (frame=None))]
    fn reset(&self, py: Python<'_>, frame: Option<&Bound<'_, PyAny>>) -> PyResult<()> {
        let frame = frame.map(|frame| Picture::read("frame", frame)).transpose()?;
        let frame = frame.as_ref().map(Picture::view).transpose()?;
        frame.map_or(Ok(()), |frame| self.check("frame", frame))?;
        let passed = self.watcher.with(py, &self.parts, |descriptor| {
            descriptor.reset();
            frame.map_or(Ok(()), |frame| descriptor.pass(frame))
        })?;
        passed.map_err(|error| value_error("frame", &error))
    }

    /// The reward of a frame: ``score(frame).reward``.
    ///
    /// A motion goal takes the frame in as the episode's next one, so it is to be called once a step.
    ///
    /// Parameters
    /// ----------
    /// frame : (H, W) ndarray of uint8
    ///     What the world looks like now, in grey. A C-contiguous array is read without a copy.
    ///
    /// Returns
    /// -------
    /// float
    ///     Above 0 and at most 1; exactly 1 for the goal itself.
    ///
    /// Raises
    /// ------
    /// TypeError
    ///     The frame is no array of ``uint8``.
    /// ValueError
    ///     It has no two dimensions, a side of 0 or above 16384, is smaller than the goal of a window
    ///     goal, or has another size than the episode's frames before it.
    /// RuntimeError
    ///     Another thread is using this motion goal.
    fn reward(&self, frame: &Bound<'_, PyAny>) -> PyResult<f32> {
        let py = frame.py();
        let frame = Picture::read("frame", frame)?;
        Ok(self.observe(py, frame.view()?)?.0.reward)
    }

    /// Reward and distance of a frame, and where the goal was found in it.
    ///
    /// Takes the frame of :meth:`reward` in its stead and raises the same errors.
    ///
    /// Returns
    /// -------
    /// Score
    ///     ``reward``, ``distance`` and, for a window goal, ``match``.
    fn score<'py>(&self, frame: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
        let py = frame.py();
        let frame = Picture::read("frame", frame)?;
        let (score, matched) = self.observe(py, frame.view()?)?;
        results::score(py, score, matched)
    }

    /// The rewards of many frames.
    ///
    /// Direct and window goals use several threads. A motion goal takes the frames in one after the other as
    /// the episode's next ones.
    ///
    /// Parameters
    /// ----------
    /// frames : (N, H, W) ndarray of uint8
    ///     N may be 0.
    /// threads : int, 1 to 1024, optional
    ///     The most threads; as many as there are cores where it isn't given. The result is the same.
    ///
    /// Returns
    /// -------
    /// (N,) ndarray of float32
    ///     What :meth:`reward` gives for each frame.
    ///
    /// Raises
    /// ------
    /// TypeError, ValueError, RuntimeError
    ///     As :meth:`reward`. No frame is taken in then.
    #[pyo3(signature = (frames, **options), text_signature = "($self, frames, *, threads=None)")]
    fn rewards<'py>(
        &self,
        frames: &Bound<'py, PyAny>,
        options: Option<Bound<'py, PyDict>>,
    ) -> PyResult<Bound<'py, PyArray1<f32>>> {
        let py = frames.py();
        let options = Options::new("rewards", options);
        let threads = Threads::read(&options)?;
        options.finish()?;
        let frames = Pictures::read("frames", frames)?;
        let (count, shape, pixels) = (frames.count(), frames.shape(), frames.pixels()?);
        let mut views = frames.views()?;
        py.detach(|| views.try_for_each(|frame| self.check("frames", frame)))?;
        let threads = threads.count(count, shape);
        let rewards = batch::empty(py, &[count])?;
        let mut writing = rewards.try_readwrite()?;
        let values = writing.as_slice_mut()?;
        let scored = self.watcher.with_many(py, &self.parts, threads, |descriptors| {
            batch::run(descriptors, count, pixels, values, |descriptor, pixels, reward| {
                let frame = FrameView::new(shape[1], shape[0], pixels)?;
                reward[0] = descriptor.observe(frame)?.reward;
                Ok::<(), Error>(())
            })
        })?;
        scored.map_err(|(_, error)| value_error("frames", &error))?;
        drop(writing);
        Ok(rewards)
    }

    /// Draws where the score of a frame comes from, and leaves the episode as it is.
    ///
    /// For a motion goal it is what :meth:`score` would say if this were the episode's next frame, so it is to be
    /// asked before the frame is scored.
    ///
    /// Parameters
    /// ----------
    /// frame : (H, W) ndarray of uint8
    ///     As for :meth:`reward`.
    ///
    /// Returns
    /// -------
    /// (882, 1160, 3) ndarray of uint8
    ///     Red, green and blue: goal, agent and the share of each cell in the distance above; the HOGs of
    ///     both and the numbers in words below.
    ///
    /// Raises
    /// ------
    /// TypeError, ValueError, RuntimeError
    ///     As :meth:`reward`.
    fn explain<'py>(&self, frame: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyArray3<u8>>> {
        let py = frame.py();
        let frame = Picture::read("frame", frame)?;
        let frame = frame.view()?;
        let picture = py.detach(|| {
            self.check("frame", frame)?;
            let mut descriptor = self.descriptor()?;
            descriptor.observe(frame).map_err(|error| value_error("frame", &error))?;
            Ok::<_, PyErr>(draw_explanation(&descriptor.explain(frame), ""))
        })?;
        picture.as_rgb().to_pyarray(py).reshape([picture.height(), picture.width(), 3])
    }

    /// Another goal of the same kind that has seen the same episode.
    ///
    /// Raises
    /// ------
    /// RuntimeError
    ///     Another thread is using this motion goal.
    fn copy<'py>(slf: &Bound<'py, Goal>) -> PyResult<Bound<'py, PyAny>> {
        slf.py().import("copy")?.call_method1("copy", (slf,))
    }

    fn __getnewargs_ex__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyTuple>, Bound<'py, PyDict>)> {
        Ok((PyTuple::new(py, [self.goal(py)?])?, self.parts.options(py)?))
    }

    fn __getstate__<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyBytes>>> {
        Ok(self.watcher.save_state()?.map(|state| PyBytes::new(py, &state)))
    }

    fn __setstate__(&self, py: Python<'_>, state: &[u8]) -> PyResult<()> {
        let loaded = self.watcher.with(py, &self.parts, |descriptor| descriptor.load_state(state))?;
        loaded.map_err(|error| value_error("state", &error))
    }

    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let picture = self.parts.goal.picture.view();
        let size = format!("<{}x{} px>", picture.width(), picture.height());
        repr(self.parts.class(), Some(size), &self.parts.options(py)?)
    }

    /// (H, W) ndarray of uint8: what is compared with frames, in grey; of a motion goal its template.
    #[getter]
    fn goal<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<u8>>> {
        picture(py, self.parts.goal.picture.view())
    }

    /// int: Bins of a histogram.
    #[getter]
    fn orientations(&self) -> usize {
        self.parts.params.hog.orientations
    }

    /// bool: Whether the bins cover the full turn.
    #[getter]
    fn signed(&self) -> bool {
        self.parts.params.hog.signed
    }

    /// float or None: Side of a cell as a part of the height of what is compared, if it is one.
    #[getter]
    fn cell(&self) -> Option<f64> {
        match self.parts.params.hog.cell {
            CellSize::Fraction(fraction) => Some(decimal(fraction)),
            CellSize::Px(_) => None,
        }
    }

    /// int or None: Side of a cell in pixels, if it is fixed.
    #[getter]
    fn cell_px(&self) -> Option<usize> {
        match self.parts.params.hog.cell {
            CellSize::Px(px) => Some(px),
            CellSize::Fraction(_) => None,
        }
    }

    /// int: Cells on the side of a block.
    #[getter]
    fn block_cells(&self) -> usize {
        self.parts.params.hog.block_cells
    }

    /// str: How a block is normalised.
    #[getter]
    fn norm(&self) -> String {
        name_of(&self.parts.params.hog.norm)
    }

    /// str: What the distance is divided by.
    #[getter]
    fn scale(&self) -> String {
        name_of(&self.parts.params.scale)
    }
}
