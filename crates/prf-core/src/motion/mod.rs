//! Motion templates (paper, section "Motion templates"; Davis, 1999; Bobick and Davis, 2001).

mod bytes;
mod kernel;
mod params;
mod state;

pub use params::{DeltaSchedule, MotionParams};
pub use state::MotionState;

use kernel::{EnergyBytes, HistoryBytes, Moment, Moves, Observe, Update};

use crate::simd::Simd;
use crate::{Error, Frame, FrameView};

/// Motion template `Ψ`: one picture of where and when something moved in a sequence of frames (paper, section "Motion
/// templates").
///
/// With the silhouette `σ_t` of the pixels that differ by more than the threshold (the paper leaves
/// open what happens at the threshold itself; here that is no motion) between two frames, each pixel becomes
///
/// ```text
/// μ_t = τ_t        where σ_t > 0
///       0          where σ_t = 0 and μ_{t−1} < τ_t − δ_t
///       μ_{t−1}    elsewhere
/// ```
///
/// Frames come one at a time and none is kept but the last. A sequence of no frame or of one has no
/// silhouette: its template is black.
///
/// ```
/// use prf_core::{Frame, FrameView, MotionParams, MotionTemplate};
/// let mut template = MotionTemplate::new(MotionParams::default())?;
/// for pixels in [[255, 0, 0], [0, 255, 0], [0, 0, 255]] {
///     template.observe(FrameView::new(3, 1, &pixels)?)?;
/// }
/// assert_eq!(template.history(), [0.1, 0.5, 0.5]); // τ was 0.1, then 0.5
///
/// let mut picture = Frame::new(3, 1);
/// template.history_into(&mut picture);
/// assert_eq!(picture.as_slice(), [51, 255, 255]);
/// # Ok::<(), prf_core::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct MotionTemplate {
    simd: Simd,
    params: MotionParams,
    state: MotionState,
}

impl MotionTemplate {
    /// A template of a sequence that has no frame yet.
    ///
    /// # Errors
    ///
    /// [`Error::InvalidParam`] as [`MotionParams::validate`].
    pub fn new(params: MotionParams) -> Result<MotionTemplate, Error> {
        params.validate()?;
        Ok(MotionTemplate { simd: Simd::detect(), params, state: MotionState::default() })
    }

    /// `Ψ(I)`, the template of all these frames.
    ///
    /// # Errors
    ///
    /// As [`MotionTemplate::new`] and [`MotionTemplate::observe`].
    pub fn of<'a>(
        params: MotionParams,
        frames: impl IntoIterator<Item = FrameView<'a>>,
    ) -> Result<MotionTemplate, Error> {
        let mut template = MotionTemplate::new(params)?;
        for frame in frames {
            template.observe(frame)?;
        }
        Ok(template)
    }

    /// What this template was made with.
    #[must_use]
    pub fn params(&self) -> &MotionParams {
        &self.params
    }

    /// Begins a new sequence, `S_0 = {}`; its frames may have another size.
    pub fn reset(&mut self) {
        self.state.clear();
    }

    /// Takes in the next frame of the sequence, at the schedule's next `τ` and `δ`. The first frame
    /// is only what the second one is compared with. With [`skip_still`](MotionParams::skip_still), a frame without movement changes
    /// nothing: the next one is compared with what this one was compared with, so that a slow movement is seen in the end.
    ///
    /// # Errors
    ///
    /// [`Error::FrameSize`] when the frame has another size than the ones before it, [`Error::InvalidParam`]
    /// when an [`update`](MotionTemplate::update) was at a later time than the schedule's next one. The
    /// template is then left as it was.
    pub fn observe(&mut self, frame: FrameView<'_>) -> Result<(), Error> {
        if self.state.reference.is_empty() {
            self.fit(frame)?;
            self.state.reference.extend_from_slice(frame.as_slice());
            return Ok(());
        }
        if self.params.skip_still && self.is_still(frame)? {
            return Ok(());
        }
        let moment = self.scheduled();
        self.advance(frame, moment)?;
        let MotionState { reference, history, .. } = &mut self.state;
        let (frame, threshold) = (frame.as_slice(), self.params.threshold);
        self.simd.run(Observe { frame, threshold, reference, history, moment });
        Ok(())
    }

    /// Takes in a silhouette, which is not 0 where something moved, at a time of the caller's own:
    /// OpenCV's `updateMotionHistory` with `tau` as timestamp and `delta` as duration.
    ///
    /// Equal to the bit where OpenCV is built with IPP, as its Python wheels for x86 are: there `τ − δ` is taken
    /// of 32-bit floats. Other builds take it of the 64-bit arguments and may decide otherwise about
    /// a movement that is exactly as old as `delta`.
    ///
    /// # Errors
    ///
    /// [`Error::FrameSize`] when the silhouette has another size than what came before it,
    /// [`Error::InvalidParam`] when `tau` lies before the last one or below 0 or is not finite, or `delta` is
    /// not 0 or more. The template is then left as it was.
    pub fn update(&mut self, silhouette: FrameView<'_>, tau: f32, delta: f32) -> Result<(), Error> {
        if delta.is_nan() || delta < 0.0 {
            return Err(Error::invalid("delta", &delta, "at least 0"));
        }
        let moment = Moment { now: tau, oldest: tau - delta };
        self.advance(silhouette, moment)?;
        self.simd.run(Update { silhouette: silhouette.as_slice(), history: &mut self.state.history, moment });
        Ok(())
    }

    /// The motion history image: `255 · μ/τ` rounded to the nearest byte, so the newest movement is white. This is
    /// the paper's `T_A` or `T_G`, and what a network sees.
    ///
    /// `out` takes the size of the frames, in new memory only if it had another. Before the first
    /// frame there is no size: `out` keeps its own and becomes black.
    ///
    /// As `τ` grows, older movements darken: those of one iteration and of the next are about `255/t` apart at
    /// iteration `t`, from 510 on less than half a byte. A constant `δ` far below `τ` leaves all that is
    /// remembered nearly white.
    pub fn history_into(&self, out: &mut Frame) {
        self.prepare(out);
        self.simd.run(HistoryBytes { history: &self.state.history, tau: self.tau(), bytes: out.as_mut_slice() });
    }

    /// The motion energy image: 255 where a movement is remembered, 0 elsewhere. `out` is treated as by
    /// [`history_into`](MotionTemplate::history_into).
    pub fn energy_into(&self, out: &mut Frame) {
        self.prepare(out);
        self.simd.run(EnergyBytes { history: &self.state.history, bytes: out.as_mut_slice() });
    }

    /// `μ`, of [`shape`](MotionTemplate::shape): 0 where no movement is remembered, else the `τ` of the
    /// last one. Empty before the first frame.
    #[must_use]
    pub fn history(&self) -> &[f32] {
        &self.state.history
    }

    /// `[h, w]` of the frames; `[0, 0]` before the first one.
    #[must_use]
    pub fn shape(&self) -> [usize; 2] {
        self.state.shape
    }

    /// How many silhouettes have been taken in: one fewer than frames were observed, not counting those that were passed over.
    #[must_use]
    pub fn iterations(&self) -> u64 {
        self.state.iterations
    }

    /// `τ` of the last iteration, the largest value that `μ` can have; 0 before the first one.
    #[must_use]
    pub fn tau(&self) -> f32 {
        self.state.tau
    }

    /// Whether a movement is remembered anywhere.
    #[must_use]
    pub fn has_motion(&self) -> bool {
        self.state.history.iter().any(|&mu| mu > 0.0)
    }

    /// All that is remembered, for a checkpoint.
    #[must_use]
    pub fn state(&self) -> &MotionState {
        &self.state
    }

    /// Takes up the [`state`](MotionTemplate::state) of a checkpoint: the template goes on as if it had
    /// never stopped, bit by bit, if its parameters are the same.
    ///
    /// # Errors
    ///
    /// [`Error::Restore`] when no template can have come to this state; it is then left as it was.
    pub fn restore(&mut self, state: &MotionState) -> Result<(), Error> {
        state.validate()?;
        self.state.clone_from(state);
        Ok(())
    }

    /// The [`state`](MotionTemplate::state) as bytes.
    #[must_use]
    pub fn save_state(&self) -> Vec<u8> {
        bytes::write(&self.state)
    }

    /// Takes up what [`save_state`](MotionTemplate::save_state) gave, of a template that has only
    /// [observed](MotionTemplate::observe) and so is at its schedule's time.
    ///
    /// # Errors
    ///
    /// As [`MotionTemplate::restore`], also when the bytes are none that it gives or their time is another. The template is
    /// then left as it was.
    pub fn load_state(&mut self, bytes: &[u8]) -> Result<(), Error> {
        let state = bytes::read(bytes)?;
        let tau = state.iterations.checked_sub(1).map_or(0.0, |last| self.params.tau(last) as f32);
        if state.tau != tau {
            let got = format!("the time {} after {} iterations", state.tau, state.iterations);
            return Err(Error::Restore { got, expected: format!("{tau}") });
        }
        self.restore(&state)
    }

    /// The times of the schedule's next iteration, each rounded once.
    fn scheduled(&self) -> Moment {
        let t = self.state.iterations;
        let (tau, delta) = (self.params.tau(t), self.params.delta.delta(t));
        Moment { now: tau as f32, oldest: (tau - delta) as f32 }
    }

    fn is_still(&mut self, frame: FrameView<'_>) -> Result<bool, Error> {
        self.fit(frame)?;
        let (frame, threshold, reference) = (frame.as_slice(), self.params.threshold, &self.state.reference[..]);
        Ok(!self.simd.run(Moves { frame, threshold, reference }))
    }

    /// Checks an iteration and notes its time.
    fn advance(&mut self, frame: FrameView<'_>, moment: Moment) -> Result<(), Error> {
        let (now, last) = (moment.now, self.state.tau);
        if !(now >= last && now.is_finite()) {
            let expected = format!("a finite time of at least {last}, the last one; reset before a new sequence");
            return Err(Error::invalid("tau", &now, expected));
        }
        self.fit(frame)?;
        self.state.iterations = self.state.iterations.saturating_add(1);
        self.state.tau = now;
        Ok(())
    }

    /// The first frame sets the size, the others have to have it.
    fn fit(&mut self, frame: FrameView<'_>) -> Result<(), Error> {
        let shape = [frame.height(), frame.width()];
        if self.state.shape == shape {
            return Ok(());
        }
        if self.state.shape != [0, 0] {
            return Err(Error::FrameSize { shape, expected: self.state.shape });
        }
        self.state.shape = shape;
        self.state.history.resize(frame.as_slice().len(), 0.0);
        Ok(())
    }

    fn prepare(&self, out: &mut Frame) {
        let [height, width] = self.state.shape;
        if height == 0 {
            out.fill(0);
        } else if [out.height(), out.width()] != self.state.shape {
            *out = Frame::new(width, height);
        }
    }
}
