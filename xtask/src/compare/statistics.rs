//! Medians and ratios.

/// The middle value, or the mean of the two in the middle; NaN of nothing.
pub fn median(values: &[f64]) -> f64 {
    quantile(values, 0.5)
}

/// The value that the share `at` (0 to 1) of all lies below, between two values on the line that joins them; NaN of
/// nothing.
pub fn quantile(values: &[f64], at: f64) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let Some(last) = sorted.len().checked_sub(1) else { return f64::NAN };
    let place = at * last as f64;
    let below = (place.floor() as usize).min(last);
    let above = (below + 1).min(last);
    sorted[below] + (place - below as f64) * (sorted[above] - sorted[below])
}

/// How many times faster we are, over all rounds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ratio {
    /// Of the rounds' ratios.
    pub median: f64,
    /// The first and the third quartile: half of all rounds lie between.
    pub middle_half: [f64; 2],
    /// The worst and the best round.
    pub all: [f64; 2],
}

impl Ratio {
    /// Of the times of rounds, which belong together in pairs.
    pub fn of(ours: &[f64], theirs: &[f64]) -> Ratio {
        let ratios: Vec<f64> = ours.iter().zip(theirs).map(|(ours, theirs)| theirs / ours).collect();
        Ratio {
            median: median(&ratios),
            middle_half: [0.25, 0.75].map(|at| quantile(&ratios, at)),
            all: [0.0, 1.0].map(|at| quantile(&ratios, at)),
        }
    }
}
