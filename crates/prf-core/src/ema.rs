//! States that remember (paper, section "State representation").

use crate::{Error, FrameView};

/// Exponential moving average of the frames of an episode: `a_t = (1 − λ) s_t + λ a_{t−1}` with
/// `a_0 = s_0` (paper, section "State representation"). Kept in `f32`, handed out as bytes.
///
/// ```
/// use prf_core::{EmaState, FrameView};
/// let mut state = EmaState::new(2, 1, 0.7)?;
/// assert_eq!(state.update(FrameView::new(2, 1, &[100, 0])?), [100, 0]);
/// assert_eq!(state.update(FrameView::new(2, 1, &[0, 200])?), [70, 60]);
/// # Ok::<(), prf_core::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct EmaState {
    width: usize,
    height: usize,
    lambda: f32,
    /// `a_t` in 0 to 255; empty before the first frame.
    values: Vec<f32>,
    rounded: Vec<u8>,
}

impl EmaState {
    /// A state for frames of `width` by `height` pixels that has seen none yet. `lambda` is the
    /// weight of the past, at least 0 and below 1.
    ///
    /// # Errors
    ///
    /// [`Error::InvalidParam`] when `lambda` is out of range, [`Error::Shape`] when a side is 0.
    pub fn new(width: usize, height: usize, lambda: f32) -> Result<EmaState, Error> {
        if !(0.0..1.0).contains(&lambda) {
            return Err(Error::invalid("lambda", &lambda, "at least 0 and below 1"));
        }
        let len = match width.checked_mul(height) {
            Some(len) if len > 0 => len,
            _ => {
                let len = 0;
                return Err(Error::Shape { width, height, len });
            }
        };
        Ok(EmaState { width, height, lambda, values: Vec::with_capacity(len), rounded: vec![0; len] })
    }

    /// Forgets every frame; the next one is `s_0`.
    pub fn reset(&mut self) {
        self.values.clear();
        self.rounded.fill(0);
    }

    /// Takes the frame `s_t` in and returns `a_t`, `width * height` values row by row, each rounded to the nearest byte.
    ///
    /// # Panics
    ///
    /// When the frame has another size than the state.
    pub fn update(&mut self, mirror: FrameView<'_>) -> &[u8] {
        assert_eq!(
            (mirror.width(), mirror.height()),
            (self.width, self.height),
            "an EMA state takes frames of its own size"
        );
        let frame = mirror.as_slice();
        if self.values.is_empty() {
            self.values.extend(frame.iter().map(|&s| f32::from(s)));
        } else {
            for (a, &s) in self.values.iter_mut().zip(frame) {
                // The same as (1 − λ) s + λ a, but never a rounding outside of 0 to 255.
                let s = f32::from(s);
                *a = s + self.lambda * (*a - s);
            }
        }
        self.round();
        &self.rounded
    }

    /// The bytes that the last [`update`](EmaState::update) returned; black before the first one.
    #[must_use]
    pub fn as_slice(&self) -> &[u8] {
        &self.rounded
    }

    /// `a_t` as it is kept, in 0 to 255, for a checkpoint; empty before the first frame.
    #[must_use]
    pub fn values(&self) -> &[f32] {
        &self.values
    }

    /// Takes up the [`values`](EmaState::values) of a checkpoint: the state goes on as if it had
    /// never stopped, bit by bit.
    ///
    /// # Errors
    ///
    /// [`Error::Restore`] when there are neither none nor `width * height` of them or one is outside
    /// of 0 to 255; the state is then left as it was.
    pub fn restore(&mut self, values: &[f32]) -> Result<(), Error> {
        let len = self.rounded.len();
        if !values.is_empty() && values.len() != len {
            return Err(Error::Restore {
                got: format!("{} values", values.len()),
                expected: format!("{len}, one a pixel"),
            });
        }
        if let Some(value) = values.iter().find(|v| !(0.0..=255.0).contains(*v)) {
            return Err(Error::Restore { got: format!("the value {value}"), expected: "0 to 255".to_owned() });
        }
        self.reset();
        self.values.extend_from_slice(values);
        self.round();
        Ok(())
    }

    fn round(&mut self) {
        for (byte, &a) in self.rounded.iter_mut().zip(&self.values) {
            // Beside 2²³ an f32 has no room for a fraction: adding rounds to the nearest whole number,
            // which then stands in the lowest bits. A plain cast checks its range, pixel by pixel.
            *byte = (a + 8_388_608.0).to_bits() as u8;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn frame(step: usize) -> [u8; 6] {
        std::array::from_fn(|i| (step * 57 + i * 101) as u8)
    }

    fn feed(state: &mut EmaState, steps: std::ops::Range<usize>) {
        for step in steps {
            state.update(FrameView::new(3, 2, &frame(step)).expect("3 x 2 pixels"));
        }
    }

    #[test]
    fn a_restored_state_goes_on_bit_by_bit() {
        let mut through = EmaState::new(3, 2, 0.7).expect("valid");
        feed(&mut through, 0..20);
        let mut resumed = EmaState::new(3, 2, 0.7).expect("valid");
        resumed.restore(through.values()).expect("its own values");
        assert_eq!(resumed.as_slice(), through.as_slice());
        feed(&mut through, 20..40);
        feed(&mut resumed, 20..40);
        assert_eq!(resumed.values(), through.values());

        // Saved before the first frame: the next one is s_0 again.
        resumed.restore(&[]).expect("nothing seen yet");
        feed(&mut resumed, 3..4);
        assert_eq!(resumed.as_slice(), frame(3));
    }

    #[test]
    fn a_reset_forgets() {
        let mut state = EmaState::new(3, 2, 0.7).expect("valid");
        feed(&mut state, 0..5);
        state.reset();
        assert_eq!((state.values(), state.as_slice()), (&[][..], &[0; 6][..]));
        feed(&mut state, 7..8);
        assert_eq!(state.as_slice(), frame(7));
    }

    #[test]
    fn rounding_never_leaves_the_range() {
        for lambda in (0..100).map(|percent| percent as f32 / 100.0) {
            let mut state = EmaState::new(2, 1, lambda).expect("valid");
            for step in 0..200u8 {
                let flicker = if step % 3 == 0 { 254 } else { 255 };
                state.update(FrameView::new(2, 1, &[255, flicker]).expect("2 x 1 pixels"));
                assert_eq!(state.values()[0], 255.0);
                state.clone().restore(state.values()).expect("its own values");
            }
        }
    }

    #[test]
    fn bytes_are_the_nearest() {
        let mut state = EmaState::new(2, 1, 0.5).expect("valid");
        for (values, bytes) in [([0.49, 0.51], [0, 1]), ([254.4, 254.6], [254, 255]), ([128.0, 127.7], [128, 128])] {
            state.restore(&values).expect("within range");
            assert_eq!(state.as_slice(), bytes);
        }
    }

    #[test]
    fn without_memory_it_is_the_frame() {
        let mut state = EmaState::new(3, 2, 0.0).expect("valid");
        feed(&mut state, 0..9);
        assert_eq!(state.as_slice(), frame(8));
    }

    #[test]
    fn what_does_not_belong_is_refused() {
        for lambda in [-0.1, 1.0, f32::NAN] {
            let error = EmaState::new(3, 2, lambda).expect_err("out of range").to_string();
            assert!(error.starts_with("lambda: got "), "{error}");
        }
        assert!(EmaState::new(0, 2, 0.5).is_err());
        let mut state = EmaState::new(3, 2, 0.7).expect("valid");
        feed(&mut state, 0..2);
        let before = state.clone();
        for values in [&[1.0; 5][..], &[f32::NAN; 6], &[256.0; 6], &[-1.0; 6]] {
            assert!(state.restore(values).is_err());
            assert_eq!(state.values(), before.values());
        }
    }
}
