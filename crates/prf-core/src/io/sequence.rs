//! The motion template of a sequence in files, and what keeps a sequence from being a goal.

use std::collections::BTreeSet;
use std::fmt;
use std::path::Path;

use super::{FrameSource, sequence_error};
use crate::error::{DIVISOR, DURATION};
use crate::{DeltaSchedule, Error, Frame, FrameView, MotionParams, MotionTemplate, SequenceProblem};

/// From so many movements on, a template that holds only the newest was hardly meant so.
const MANY: u64 = 3;

/// What [`read_motion`] made of a sequence of frames.
#[derive(Debug)]
#[non_exhaustive]
pub struct MotionSequence {
    /// The motion template, of the frames' size: a goal for the [`MotionDescriptor`](crate::MotionDescriptor).
    pub template: Frame,
    /// How many frames it was made of, at least 2.
    pub frames: u64,
    /// In how many of them something moved, at least 1.
    pub movements: u64,
    /// How many movements the template still shows somewhere, at least 1.
    pub remembered: u64,
    /// What is wrong with the frames that were left out.
    pub damaged: Vec<Error>,
    /// Why the template is probably not what its maker meant.
    pub warning: Option<SequenceWarning>,
}

/// Reads a sequence (a folder of pictures in natural order, an animation or a video) and makes its motion template.
///
/// With `skip_damaged`, frames that can't be read are left out, and the next one is compared with the last that could;
/// of an animation or a video, nothing is read after the first that can't.
///
/// ```
/// use prf_core::{FrameView, MotionParams, io};
/// # let folder = std::env::temp_dir().join(format!("prf-motion-{}", std::process::id()));
/// # std::fs::create_dir_all(&folder)?;
/// for (name, pixels) in [("1.png", [255, 0, 0]), ("2.png", [0, 255, 0]), ("3.png", [0, 0, 255])] {
///     io::write_frame(FrameView::new(3, 1, &pixels)?, folder.join(name))?;
/// }
/// let sequence = io::read_motion(&folder, MotionParams::default(), false)?;
/// assert_eq!(sequence.template.as_slice(), [51, 255, 255]);
/// assert_eq!((sequence.frames, sequence.movements, sequence.remembered), (3, 2, 2));
/// # std::fs::remove_dir_all(&folder)?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
///
/// As [`MotionSequence::of`], and as [`FrameSource::open`].
pub fn read_motion(path: impl AsRef<Path>, params: MotionParams, skip_damaged: bool) -> Result<MotionSequence, Error> {
    MotionSequence::of(FrameSource::open(path)?, params, skip_damaged)
}

impl MotionSequence {
    /// Makes the motion template of all frames that are still to come; see [`read_motion`].
    ///
    /// # Errors
    ///
    /// [`Error::Picture`] with the file of a frame that can't be read, unless these are left out;
    /// [`Error::Sequence`] when there are fewer than two frames, one has another size, nothing moves, or all that moved is
    /// forgotten by the end; [`Error::InvalidParam`] as [`MotionParams::validate`].
    pub fn of(mut source: FrameSource, params: MotionParams, skip_damaged: bool) -> Result<MotionSequence, Error> {
        let mut reading = Reading::new(params)?;
        let mut frame = Frame::new(1, 1);
        while let Some(read) = source.next_into(&mut frame) {
            match read {
                Ok(info) => reading.take(&info.path, frame.view())?,
                Err(error) if skip_damaged => reading.damaged.push(error),
                Err(error) => return Err(error),
            }
        }
        reading.finish(frame).map_err(|problem| sequence_error(source.path(), problem))
    }

    /// Makes the motion template of frames in memory; errors call them `name`.
    ///
    /// ```
    /// use prf_core::{FrameView, MotionParams, io::MotionSequence};
    /// let frames = [[255, 0, 0], [0, 255, 0], [0, 0, 255]];
    /// let views = frames.iter().map(|pixels| FrameView::new(3, 1, pixels)).collect::<Result<Vec<_>, _>>()?;
    /// let sequence = MotionSequence::of_frames("goal", views, MotionParams::default())?;
    /// assert_eq!(sequence.template.as_slice(), [51, 255, 255]);
    /// # Ok::<(), prf_core::Error>(())
    /// ```
    ///
    /// # Errors
    ///
    /// As [`MotionSequence::of`].
    pub fn of_frames<'a>(
        name: &str,
        frames: impl IntoIterator<Item = FrameView<'a>>,
        params: MotionParams,
    ) -> Result<MotionSequence, Error> {
        let name = Path::new(name);
        let mut reading = Reading::new(params)?;
        for frame in frames {
            reading.take(name, frame)?;
        }
        reading.finish(Frame::new(1, 1)).map_err(|problem| sequence_error(name, problem))
    }
}

/// A sequence of which some frames have been read.
struct Reading {
    motion: MotionTemplate,
    frames: u64,
    /// The largest change of a pixel so far.
    largest: u8,
    movements: u64,
    /// The iterations of the newest movement and of the one before it.
    newest: [u64; 2],
    damaged: Vec<Error>,
}

impl Reading {
    fn new(params: MotionParams) -> Result<Reading, Error> {
        let motion = MotionTemplate::new(params)?;
        Ok(Reading { motion, frames: 0, largest: 0, movements: 0, newest: [0; 2], damaged: Vec::new() })
    }

    fn take(&mut self, file: &Path, frame: FrameView<'_>) -> Result<(), Error> {
        let change = self.change(frame);
        self.motion.observe(frame).map_err(|error| match error {
            Error::FrameSize { shape, expected } => {
                sequence_error(file, SequenceProblem::FrameSize { shape, expected })
            }
            other => other,
        })?;
        self.largest = self.largest.max(change);
        if change > self.motion.params().threshold {
            self.movements += 1;
            self.newest = [self.iteration(), self.newest[0]];
        }
        self.frames += 1;
        Ok(())
    }

    /// The largest change of a pixel against what the template compares the frame with.
    fn change(&self, frame: FrameView<'_>) -> u8 {
        let pairs = frame.as_slice().iter().zip(&self.motion.state().reference);
        pairs.map(|(now, before)| now.abs_diff(*before)).max().unwrap_or(0)
    }

    /// The template's last iteration, from 0.
    fn iteration(&self) -> u64 {
        self.motion.iterations().saturating_sub(1)
    }

    /// `out` becomes the template.
    fn finish(self, mut out: Frame) -> Result<MotionSequence, SequenceProblem> {
        let Reading { frames, largest, movements, .. } = self;
        if frames < 2 {
            return Err(SequenceProblem::TooFewFrames { readable: frames, damaged: self.damaged });
        }
        if movements == 0 {
            return Err(SequenceProblem::Still { largest, threshold: self.motion.params().threshold });
        }
        let remembered = remembered(self.motion.history());
        if remembered == 0 {
            return Err(self.forgotten());
        }
        self.motion.history_into(&mut out);
        let warning = (remembered == 1 && movements >= MANY).then(|| self.only_newest());
        let damaged = self.damaged;
        Ok(MotionSequence { template: out, frames, movements, remembered, damaged, warning })
    }

    /// How old the movement of an iteration is at the end.
    fn age(&self, iteration: u64) -> f64 {
        let params = self.motion.params();
        params.tau(self.iteration()) - params.tau(iteration)
    }

    fn forgotten(&self) -> SequenceProblem {
        let (movements, age) = (self.movements, self.age(self.newest[0]));
        let (key, got, needed) = match self.motion.params().delta {
            DeltaSchedule::Duration(duration) => (DURATION, duration, rounded(age, f64::ceil)),
            // As δ grows, a movement that is remembered at the end has been all the time.
            DeltaSchedule::Divisor(divisor) => {
                (DIVISOR, divisor, rounded((self.iteration() as f64 + 1.0) / age, f64::floor))
            }
        };
        SequenceProblem::Forgotten { movements, key, got, needed }
    }

    fn only_newest(&self) -> SequenceWarning {
        let (params, now) = (self.motion.params(), self.iteration());
        let key = match params.delta {
            DeltaSchedule::Duration(_) => DURATION,
            DeltaSchedule::Divisor(_) => DIVISOR,
        };
        // What is young enough and still not there lies under the newest movement.
        let oldest = (params.tau(now) - params.delta.delta(now)) as f32;
        let is_forgotten = (params.tau(self.newest[1]) as f32) < oldest;
        SequenceWarning::OnlyNewest { movements: self.movements, forgotten_by: is_forgotten.then_some(key) }
    }
}

/// How many different times there are in a history.
fn remembered(history: &[f32]) -> u64 {
    let mut times = BTreeSet::new();
    let mut last = 0.0;
    for &mu in history.iter().filter(|&&mu| mu > 0.0) {
        // Neighbours are mostly equal, so the set is asked seldom.
        if mu != last {
            times.insert(mu.to_bits());
            last = mu;
        }
    }
    times.len() as u64
}

/// A number with three digits, or all of its whole ones.
fn rounded(value: f64, round: fn(f64) -> f64) -> f64 {
    let decimals = (2.0 - value.log10().floor()).max(0.0);
    let scale = 10_f64.powf(decimals);
    round(value * scale) / scale
}

/// Why the motion template of a sequence is probably not what its maker meant.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum SequenceWarning {
    /// Of at least three movements only the newest is left, so the template doesn't say in which direction things moved.
    OnlyNewest {
        /// In how many frames something moved.
        movements: u64,
        /// The parameter by which the others were forgotten; nothing if the newest movement lies over all of them.
        forgotten_by: Option<&'static str>,
    },
}

impl SequenceWarning {
    /// What to do about it.
    #[must_use]
    pub fn hint(&self) -> &'static str {
        let SequenceWarning::OnlyNewest { forgotten_by, .. } = self;
        match *forgotten_by {
            Some(DURATION) => "take a larger `delta.duration`",
            Some(_) => "take a smaller `delta.divisor`",
            None => "take a higher `threshold`, or a sequence in which not everything moves at its end",
        }
    }
}

impl fmt::Display for SequenceWarning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let SequenceWarning::OnlyNewest { movements, forgotten_by } = self;
        let why = if forgotten_by.is_some() { "the others are forgotten" } else { "it lies over all others" };
        write!(f, "of {movements} movements the template holds only the newest: {why}, so it has no direction")
    }
}
