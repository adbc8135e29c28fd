//! What a motion template can be told, as it stands in a configuration file.

use std::ops::RangeInclusive;

use serde::{Deserialize, Serialize};

use crate::Error;

/// The threshold of 255 is left out: no difference of bytes is above it.
const MAX_THRESHOLD: u8 = 254;

/// Keeps `τ` far from where an `f32` has no room for it or for its steps.
const TAU_RANGE: RangeInclusive<f64> = 0.001..=1000.0;

/// Parameters of a motion template (paper, sections "Motion templates" and "Motion template task"). In a file, every key may
/// be left out.
///
/// Iterations are counted from `t = 0`, the silhouette of the first two frames. With the paper's schedules
/// many a movement gets exactly as old as `δ` and has to be kept then (0.1 is not below 1.6 − 6/4). So times are
/// calculated in 64 bits and rounded to the `f32` of `μ` at the end, which makes equal times equal.
///
/// ```
/// use prf_core::{DeltaSchedule, MotionParams};
/// let human: MotionParams = serde_json::from_str(r#"{ "tau_step": 0.3, "delta": { "divisor": 4 } }"#)?;
/// assert_eq!(human, MotionParams { tau_step: 0.3, delta: DeltaSchedule::Divisor(4.0), ..MotionParams::default() });
/// # Ok::<(), serde_json::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct MotionParams {
    /// A pixel has moved when it differs by more than this from the frame before; 0 to 254.
    pub threshold: u8,
    /// `τ` of the first iteration, 0.001 to 1000.
    pub tau_start: f64,
    /// How much `τ` grows from one iteration to the next, 0.001 to 1000.
    pub tau_step: f64,
    /// How long a movement is remembered, in the unit of `τ`.
    pub delta: DeltaSchedule,
    /// A frame in which nothing has moved since the last one that counted is passed over: it is no iteration, and nothing grows older
    /// by it. So an agent that rests keeps its template (the paper's no-op action "did not effect its face or motion
    /// template"), and a video may begin and end with a pause.
    pub skip_still: bool,
}

impl Default for MotionParams {
    /// The paper's schedule for the robot's goal, `τ_t = 0.1 + 0.4 t` and `δ_t = (t + 1)/3`; for the human's it is
    /// 0.3 and 4. With both, a movement of iteration `k` is remembered up to iteration `6 k + 5`. The paper leaves the
    /// threshold open; 30 of 255 is a common choice against a camera's noise.
    fn default() -> MotionParams {
        MotionParams {
            threshold: 30,
            tau_start: 0.1,
            tau_step: 0.4,
            delta: DeltaSchedule::Divisor(3.0),
            skip_still: false,
        }
    }
}

impl MotionParams {
    /// Checks every parameter's range.
    ///
    /// # Errors
    ///
    /// [`Error::InvalidParam`] with the key of the first parameter that is out of range.
    pub fn validate(&self) -> Result<(), Error> {
        if self.threshold > MAX_THRESHOLD {
            let expected = format!("0 to {MAX_THRESHOLD}, as a difference of bytes has to be above it");
            return Err(Error::invalid("threshold", &self.threshold, expected));
        }
        for (key, value) in [("tau_start", self.tau_start), ("tau_step", self.tau_step)] {
            if !TAU_RANGE.contains(&value) {
                let expected = format!("{} to {}", TAU_RANGE.start(), TAU_RANGE.end());
                return Err(Error::invalid(key, &value, expected));
            }
        }
        self.delta.validate()
    }

    /// `τ_t = tau_start + tau_step · t`, the time of iteration `t`.
    ///
    /// Calculated anew for each `t`, so that no rounding adds up. As `f32`, which `μ` holds, the times of
    /// all iterations differ as long as `τ` is below 8 million steps. Beyond, neighbours fall together,
    /// but a later one is never below an earlier one.
    #[must_use]
    pub fn tau(&self, t: u64) -> f64 {
        self.tau_start + self.tau_step * t as f64
    }
}

/// How `δ`, the age up to which a movement is remembered, depends on the iteration `t = 0, 1, 2, …`
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum DeltaSchedule {
    /// `δ_t = |t + 1| / divisor`, with a divisor above 0: the paper's, longer and longer.
    Divisor(f64),
    /// The same `δ` at any time, at least 0, in the unit of `τ`.
    Duration(f64),
}

impl DeltaSchedule {
    /// `δ_t`, at least 0, in the unit of `τ`.
    ///
    /// ```
    /// use prf_core::DeltaSchedule;
    /// assert_eq!(DeltaSchedule::Divisor(4.0).delta(1), 0.5);
    /// assert_eq!(DeltaSchedule::Duration(0.8).delta(1), 0.8);
    /// ```
    #[must_use]
    pub fn delta(self, t: u64) -> f64 {
        match self {
            DeltaSchedule::Divisor(divisor) => (t as f64 + 1.0) / divisor,
            DeltaSchedule::Duration(duration) => duration,
        }
    }

    fn validate(self) -> Result<(), Error> {
        match self {
            // Written so that NaN is refused too.
            DeltaSchedule::Divisor(divisor) if !(divisor > 0.0 && divisor.is_finite()) => {
                Err(Error::invalid("delta.divisor", &divisor, "a finite number above 0"))
            }
            DeltaSchedule::Duration(duration) if !(duration >= 0.0 && duration.is_finite()) => {
                Err(Error::invalid("delta.duration", &duration, "a finite number of at least 0"))
            }
            _ => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn refused(params: MotionParams) -> String {
        params.validate().expect_err("out of range").to_string()
    }

    #[test]
    fn parameters_out_of_range_are_named() {
        let default = MotionParams::default();
        default.validate().expect("the default is valid");
        assert!(refused(MotionParams { threshold: 255, ..default }).starts_with("threshold: got 255"));
        for tau in [0.0, -0.1, 1e4, f64::NAN, f64::INFINITY] {
            assert!(refused(MotionParams { tau_start: tau, ..default }).starts_with("tau_start: got "));
            assert!(refused(MotionParams { tau_step: tau, ..default }).starts_with("tau_step: got "));
        }
        for bad in [-1.0, f64::NAN, f64::INFINITY] {
            let [divisor, duration] = [DeltaSchedule::Divisor(bad), DeltaSchedule::Duration(bad)];
            assert!(refused(MotionParams { delta: divisor, ..default }).starts_with("delta.divisor: got "));
            assert!(refused(MotionParams { delta: duration, ..default }).starts_with("delta.duration: got "));
        }
        assert!(refused(MotionParams { delta: DeltaSchedule::Divisor(0.0), ..default }).contains("above 0"));
        let only_now = MotionParams { delta: DeltaSchedule::Duration(0.0), ..default };
        only_now.validate().expect("only what moves now is remembered");
    }

    #[test]
    fn an_unknown_key_is_refused() {
        let read = |json| serde_json::from_str::<MotionParams>(json);
        let error = read(r#"{ "tau": 0.1 }"#).expect_err("a misspelt key").to_string();
        assert!(error.contains("unknown field `tau`, expected one of `threshold`, `tau_start`"), "{error}");
        assert!(read(r#"{ "delta": { "divisor": 3, "duration": 0.5 } }"#).is_err());
        assert!(read(r#"{ "delta": { "seconds": 3 } }"#).is_err());
        assert!(read(r#"{ "threshold": 256 }"#).is_err());
    }

    #[test]
    fn every_value_survives_a_file() {
        for delta in [DeltaSchedule::Divisor(3.0), DeltaSchedule::Duration(0.7)] {
            let params = MotionParams { threshold: 12, tau_start: 0.3, tau_step: 0.1, delta, skip_still: true };
            let json = serde_json::to_string(&params).expect("plain values");
            assert_eq!(serde_json::from_str::<MotionParams>(&json).expect("what was written"), params);
        }
    }
}
