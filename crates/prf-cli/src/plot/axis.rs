//! Axes: what they reach over and where their marks are.

use std::ops::Range;

use plotters::coord::ranged1d::{DefaultFormatting, KeyPointHint, Ranged};

/// How many marks an axis has at most, give or take one.
const MARKS: f64 = 8.0;
/// How far an axis reaches beyond its values, as a share of them, so that nothing is drawn on the border.
const BEYOND: f64 = 0.015;

/// An axis of a diagram.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Axis {
    pub(crate) name: &'static str,
    pub(crate) range: Range<f64>,
    /// The values with a mark, in order.
    pub(crate) marks: Vec<f64>,
    /// Between two marks.
    step: f64,
}

impl Axis {
    /// Frames from 0 to `last`, counted in whole ones.
    pub(crate) fn frames(last: f64) -> Axis {
        Axis::over("frame", 0.0, last, nice_step(last).max(1.0))
    }

    /// Seconds from 0 to `last`.
    pub(crate) fn seconds(last: f64) -> Axis {
        Axis::over("time (s)", 0.0, last, nice_step(last))
    }

    /// Whole pixels from 0 to `last`.
    pub(crate) fn pixels(last: f64) -> Axis {
        Axis::over("displaced by (px)", 0.0, last, nice_step(last).max(1.0))
    }

    /// Scores from `least` to `largest`.
    pub(crate) fn scores(least: f64, largest: f64) -> Axis {
        Axis::over("score", least, largest, nice_step(largest - least))
    }

    /// Any values from `low` to `high`, and 0 if that is not far.
    #[cfg(feature = "train")]
    pub(crate) fn spanning(name: &'static str, low: f64, high: f64) -> Axis {
        const NEAR: f64 = 0.4;
        let low = if (0.0..NEAR * high).contains(&low) { 0.0 } else { low };
        Axis::over(name, low, high, nice_step(high - low))
    }

    /// Rewards from `least` to `largest`: all there can be, 0 to 1, if they spread far; otherwise as much as shows
    /// how they differ, but no less than a hundredth of them, so that rounding doesn't look like a result.
    pub(crate) fn rewards(least: f64, largest: f64) -> Axis {
        const FAR: f64 = 0.5;
        const LEAST_SPREAD: f64 = 0.01;
        let (mut low, mut high) = (0.0, 1.0);
        if largest - least < FAR {
            let spread = (largest - least).max(LEAST_SPREAD * largest);
            let aside = (spread - (largest - least)) / 2.0 + 0.05 * spread;
            (low, high) = ((least - aside).max(0.0), (largest + aside).min(1.0));
            if low < 0.4 * high {
                low = 0.0;
            }
        }
        Axis::over("reward F", low, high, nice_step(high - low))
    }

    fn over(name: &'static str, low: f64, high: f64, step: f64) -> Axis {
        // A single frame has an axis too.
        let beyond = if high > low { (high - low) * BEYOND } else { step / 2.0 };
        // A mark may not be lost to rounding.
        let slack = 1e-9;
        let (first, last) = ((low / step - slack).ceil() as i64, (high / step + slack).floor() as i64);
        let marks = (first..=last).map(|mark| mark as f64 * step).collect();
        Axis { name, range: low - beyond..high + beyond, marks, step }
    }

    /// A number between marks, with a digit more than they have.
    pub(crate) fn finer_number(&self, value: f64) -> String {
        let decimals = (1.0 - self.step.log10().floor()).max(0.0) as usize;
        format!("{value:.decimals$}")
    }

    /// A mark's number, with as many digits as tell it from its neighbours.
    pub(crate) fn number(&self, mark: f64) -> String {
        const SHORT_ENOUGH: f64 = 1e-4;
        if self.step >= SHORT_ENOUGH || mark == 0.0 {
            let decimals = (-self.step.log10().floor()).max(0.0) as usize;
            return format!("{mark:.*}", if mark == 0.0 { 0 } else { decimals });
        }
        let digits = (mark.abs().log10().floor() - self.step.log10().floor()).max(0.0) as usize;
        format!("{mark:.digits$e}")
    }
}

impl Ranged for Axis {
    type FormatOption = DefaultFormatting;
    type ValueType = f64;

    fn map(&self, value: &f64, (from, to): (i32, i32)) -> i32 {
        let share = (value - self.range.start) / (self.range.end - self.range.start);
        from + (share * f64::from(to - from)).round() as i32
    }

    fn key_points<Hint: KeyPointHint>(&self, _: Hint) -> Vec<f64> {
        self.marks.clone()
    }

    fn range(&self) -> Range<f64> {
        self.range.clone()
    }
}

/// 1, 2 or 5 times a power of ten, of which `span` has no more than an axis has marks.
fn nice_step(span: f64) -> f64 {
    if span <= 0.0 {
        return 1.0;
    }
    let rough = span / MARKS;
    let power = 10f64.powi(rough.log10().floor() as i32);
    let times = [1.0, 2.0, 5.0].into_iter().find(|times| times * power >= rough);
    times.unwrap_or(10.0) * power
}

#[cfg(test)]
mod tests {
    use super::*;

    fn numbers(axis: &Axis) -> Vec<String> {
        axis.marks.iter().map(|&mark| axis.number(mark)).collect()
    }

    #[test]
    fn marks_are_round_numbers() {
        assert_eq!(numbers(&Axis::frames(2999.0)), ["0", "500", "1000", "1500", "2000", "2500"]);
        assert_eq!(numbers(&Axis::frames(2.0)), ["0", "1", "2"]);
        assert_eq!(numbers(&Axis::frames(0.0)), ["0"]);
        assert_eq!(numbers(&Axis::seconds(1.1)), ["0", "0.2", "0.4", "0.6", "0.8", "1.0"]);
        assert_eq!(numbers(&Axis::rewards(0.1, 0.9)), ["0", "0.2", "0.4", "0.6", "0.8", "1.0"]);
        assert_eq!(numbers(&Axis::rewards(0.56, 0.8)), ["0.55", "0.60", "0.65", "0.70", "0.75", "0.80"]);
    }

    #[test]
    fn small_rewards_have_short_numbers() {
        let axis = Axis::rewards(1e-12, 1.1e-11);
        assert_eq!(numbers(&axis), ["0", "2e-12", "4e-12", "6e-12", "8e-12", "1.0e-11"]);
        let least = f64::from(f32::MIN_POSITIVE);
        assert!(!Axis::rewards(least, least).marks.is_empty());
    }

    #[test]
    fn all_values_lie_inside() {
        let values = [1.2e-38, 1e-6, 0.1, 0.3, 0.5, 0.5001, 0.9999, 1.0];
        for (at, &least) in values.iter().enumerate() {
            for &largest in &values[at..] {
                let axis = Axis::rewards(least, largest);
                assert!(axis.range.start < least && largest < axis.range.end, "{least} to {largest}: {axis:?}");
                assert!((3..=9).contains(&axis.marks.len()), "{least} to {largest}: {axis:?}");
                assert!(axis.range.start > -0.02 && axis.range.end < 1.02, "{axis:?}");
            }
        }
    }
}
