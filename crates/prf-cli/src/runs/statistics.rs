//! What several runs come to, and how sure that is.

use prf_envs::rng::{below, stream};

use crate::args::Aggregate;

/// How often runs are drawn anew for an interval.
const RESAMPLES: usize = 2000;
/// What lies within an interval.
const COVERAGE: f64 = 0.95;

impl Aggregate {
    /// Of at least one value, which is left sorted.
    pub(crate) fn of(self, values: &mut [f64]) -> f64 {
        values.sort_by(f64::total_cmp);
        let cut = match self {
            Aggregate::Mean => 0,
            // Whole runs are cut off, as rliable does it: of up to three, none.
            Aggregate::Iqm => values.len() / 4,
        };
        let kept = &values[cut..values.len() - cut];
        kept.iter().sum::<f64>() / kept.len() as f64
    }

    /// In words.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Aggregate::Mean => "mean",
            Aggregate::Iqm => "interquartile mean",
        }
    }
}

/// The 95 % intervals of the aggregate of each row, which holds a value for each run, by the percentile bootstrap over
/// runs. The same runs are drawn for every row, and in every call. Nothing for a single run: it doesn't tell how runs differ.
pub(crate) fn intervals(rows: &[Vec<f64>], aggregate: Aggregate) -> Option<Vec<[f64; 2]>> {
    let runs = rows.first().map_or(0, Vec::len);
    if runs < 2 {
        return None;
    }
    let mut rng = stream(0, "bootstrap", 0);
    let draws: Vec<Vec<usize>> = (0..RESAMPLES).map(|_| (0..runs).map(|_| below(&mut rng, runs)).collect()).collect();
    let mut drawn = vec![0.0; runs];
    let mut interval = |row: &Vec<f64>| {
        let mut outcomes: Vec<f64> = Vec::with_capacity(RESAMPLES);
        for draw in &draws {
            drawn.iter_mut().zip(draw).for_each(|(value, &run)| *value = row[run]);
            outcomes.push(aggregate.of(&mut drawn));
        }
        outcomes.sort_by(f64::total_cmp);
        let tail = (1.0 - COVERAGE) / 2.0;
        [quantile(&outcomes, tail), quantile(&outcomes, 1.0 - tail)]
    };
    Some(rows.iter().map(&mut interval).collect())
}

/// Of sorted values, linear between neighbours.
fn quantile(sorted: &[f64], share: f64) -> f64 {
    let place = share * (sorted.len() - 1) as f64;
    let (below, above) = (sorted[place.floor() as usize], sorted[place.ceil() as usize]);
    below + (above - below) * place.fract()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn iqm(values: &[f64]) -> f64 {
        Aggregate::Iqm.of(&mut values.to_vec())
    }

    #[test]
    fn the_interquartile_mean_leaves_a_quarter_out_at_each_end() {
        // By hand, and the same as scipy.stats.trim_mean(values, 0.25).
        assert_eq!(iqm(&[7.0]), 7.0);
        assert_eq!(iqm(&[1.0, 100.0, 4.0]), 35.0);
        assert_eq!(iqm(&[100.0, 2.0, 4.0, -50.0]), 3.0);
        assert_eq!(iqm(&[9.0, 1.0, 2.0, 3.0, 100.0]), (2.0 + 3.0 + 9.0) / 3.0);
        assert_eq!(iqm(&[8.0, 7.0, 6.0, 5.0, 4.0, 3.0, 2.0, 1000.0]), (4.0 + 5.0 + 6.0 + 7.0) / 4.0);
        assert_eq!(Aggregate::Mean.of(&mut [1.0, 2.0, 6.0]), 3.0);
    }

    #[test]
    fn quantiles_lie_between_neighbours() {
        let sorted = [1.0, 2.0, 4.0, 8.0, 16.0];
        assert_eq!([0.0, 0.25, 0.5, 1.0].map(|share| quantile(&sorted, share)), [1.0, 2.0, 4.0, 16.0]);
        assert_eq!(quantile(&sorted, 0.375), 3.0);
    }

    #[test]
    fn intervals_of_two_runs_are_their_values() {
        // Each of the two alone is drawn in a quarter of all draws, far more than what is cut off.
        let rows = [vec![3.0, 1.0], vec![5.0, 5.0]];
        assert_eq!(intervals(&rows, Aggregate::Mean), Some(vec![[1.0, 3.0], [5.0, 5.0]]));
        assert_eq!(intervals(&[vec![3.0]], Aggregate::Mean), None);
        assert_eq!(intervals(&[], Aggregate::Mean), None);
    }

    #[test]
    fn intervals_of_many_runs_are_those_of_the_normal_distribution() {
        // 0 and 1 equally often: the mean of 400 has a standard deviation of 0.025.
        let row: Vec<f64> = (0..400).map(|run| f64::from(run % 2)).collect();
        let rows = [row.clone(), row.iter().map(|value| 10.0 * value - 3.0).collect()];
        let found = intervals(&rows, Aggregate::Mean).expect("there are many");
        let [low, high] = found[0];
        assert!(
            (low - (0.5 - 1.96 * 0.025)).abs() < 0.005 && (high - (0.5 + 1.96 * 0.025)).abs() < 0.005,
            "{low} {high}"
        );
        // The same runs were drawn, so the second follows from the first.
        assert!(found[1].iter().zip(found[0]).all(|(a, b)| (a - (10.0 * b - 3.0)).abs() < 1e-9), "{found:?}");
        assert_eq!(intervals(&rows, Aggregate::Mean), Some(found));
    }
}
