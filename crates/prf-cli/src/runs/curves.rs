//! What the runs of groups come to while they go on.

use prf_dqn::record::{EvaluationRecord, TrainRecord};

use super::Run;
use super::group::Group;
use super::statistics::intervals;
use crate::args::{Aggregate, Place, Quantity};
use crate::printer::Printer;

/// Points of a common grid, at most.
const GRID: usize = 200;
/// A group that ends earlier than this share of its longest run is worth a note.
const SHORT: f64 = 0.95;

/// What is drawn, over what, and how runs are summed up.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Question {
    pub(crate) y: Quantity,
    pub(crate) x: Place,
    pub(crate) aggregate: Aggregate,
}

/// The curve of a group.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct LearningCurve {
    pub(crate) name: String,
    /// How many runs are in it.
    pub(crate) seeds: usize,
    /// At least one, at places going up.
    pub(crate) points: Vec<Point>,
}

impl LearningCurve {
    pub(crate) fn seeds_in_words(&self) -> String {
        if self.seeds == 1 { "1 seed".to_owned() } else { format!("{} seeds", self.seeds) }
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Point {
    pub(crate) x: f64,
    pub(crate) y: f64,
    /// The 95 % interval of `y`, of two runs or more.
    pub(crate) interval: Option<[f64; 2]>,
}

/// A run's values, at places going up.
type Series = Vec<(f64, f64)>;

impl Question {
    /// The curves of all groups in which something is recorded. Tells of runs that are left out.
    pub(crate) fn curves(&self, groups: &[Group], printer: &mut Printer) -> Vec<LearningCurve> {
        groups.iter().filter_map(|group| self.curve(group, printer)).collect()
    }

    fn curve(&self, group: &Group, printer: &mut Printer) -> Option<LearningCurve> {
        let mut series = Vec::new();
        for run in &group.runs {
            let values = self.series(run);
            if values.is_empty() {
                printer.warning(format_args!("{} is left out: {}", run.shown(), self.nothing_recorded()), None);
            } else {
                series.push(values);
            }
        }
        let curve = align(&series, self.aggregate);
        if curve.is_none() && !series.is_empty() {
            let words = "is left out: there is no part that all of its runs have gone through";
            printer.warning(format_args!("{} {words}", group.name), Some("take runs of about the same length"));
        }
        let points = curve?;
        let longest = series.iter().filter_map(|values| values.last()).map(|last| last.0).fold(0.0, f64::max);
        let end = points.last()?.x;
        if series.len() > 1 && end < SHORT * longest {
            let (end, longest) = (self.x.shown(end), self.x.shown(longest));
            let words = "the longest goes on to";
            printer.note(format_args!(
                "{} is drawn up to the end of its shortest run, {end}; {words} {longest}",
                group.name
            ));
        }
        Some(LearningCurve { name: group.name.clone(), seeds: series.len(), points })
    }

    fn series(&self, run: &Run) -> Series {
        let metrics = &run.metrics;
        let values: Series = match self.y.of() {
            Source::Evaluation(value) => {
                metrics.evaluations.iter().map(|record| (self.x.of_evaluation(record), value(record))).collect()
            }
            Source::Training(value) => metrics
                .training
                .iter()
                .filter_map(|record| Some((self.x.of_training(record), value(record)?)))
                .collect(),
        };
        rising(values)
    }

    fn nothing_recorded(&self) -> &'static str {
        match self.y.of() {
            Source::Evaluation(_) => "it has no evaluation yet",
            Source::Training(_) => "nothing of this kind is recorded yet",
        }
    }
}

/// Where a quantity is recorded.
enum Source {
    Evaluation(fn(&EvaluationRecord) -> f64),
    Training(fn(&TrainRecord) -> Option<f64>),
}

impl Quantity {
    fn of(self) -> Source {
        match self {
            Quantity::Score => Source::Evaluation(|record| record.mean_score),
            Quantity::Reward => Source::Evaluation(|record| record.mean_reward),
            Quantity::Length => Source::Evaluation(|record| record.mean_steps),
            Quantity::TrainScore => Source::Training(|record| record.mean_score),
            Quantity::TrainReward => Source::Training(|record| record.mean_reward),
            Quantity::Loss => Source::Training(|record| record.mean_loss),
            Quantity::Epsilon => Source::Training(|record| Some(record.epsilon.into())),
            Quantity::Speed => Source::Training(|record| Some(record.steps_per_s)),
        }
    }

    /// Whether players of the world have it, too.
    pub(crate) fn is_score(self) -> bool {
        matches!(self, Quantity::Score | Quantity::TrainScore)
    }

    pub(crate) fn name(self) -> &'static str {
        match self {
            Quantity::Score => "greedy score",
            Quantity::Reward => "greedy reward",
            Quantity::Length => "greedy steps",
            Quantity::TrainScore => "training score",
            Quantity::TrainReward => "training reward",
            Quantity::Loss => "loss",
            Quantity::Epsilon => "exploration ε",
            Quantity::Speed => "steps a second",
        }
    }
}

impl Place {
    fn of_evaluation(self, record: &EvaluationRecord) -> f64 {
        match self {
            Place::Steps => record.step as f64,
            Place::Episodes => record.episode as f64,
            Place::Time => record.time_s,
        }
    }

    fn of_training(self, record: &TrainRecord) -> f64 {
        match self {
            Place::Steps => record.step as f64,
            Place::Episodes => record.episode as f64,
            Place::Time => record.time_s,
        }
    }

    /// A place with its unit.
    pub(crate) fn shown(self, x: f64) -> String {
        match self {
            Place::Steps => format!("step {x:.0}"),
            Place::Episodes => format!("episode {x:.0}"),
            Place::Time => format!("second {x:.0}"),
        }
    }
}

/// The values at places going up; of those at the same place, the last.
fn rising(values: Series) -> Series {
    let mut kept = Series::with_capacity(values.len());
    for value in values {
        if kept.last().is_some_and(|last| last.0 >= value.0) {
            kept.pop();
        }
        kept.push(value);
    }
    kept
}

/// Sums up the runs on a grid that all have gone through; nothing if there is none. A single one stays as it is.
fn align(runs: &[Series], aggregate: Aggregate) -> Option<Vec<Point>> {
    if let [run] = runs {
        return Some(run.iter().map(|&(x, y)| Point { x, y, interval: None }).collect());
    }
    let places = grid(runs)?;
    let rows: Vec<Vec<f64>> = places.iter().map(|&x| runs.iter().map(|run| at(run, x)).collect()).collect();
    let intervals = intervals(&rows, aggregate)?;
    let point = |((x, mut row), interval): ((f64, Vec<f64>), [f64; 2])| Point {
        x,
        y: aggregate.of(&mut row),
        interval: Some(interval),
    };
    Some(places.into_iter().zip(rows).zip(intervals).map(point).collect())
}

/// Evenly spread places from the latest beginning to the earliest end, as many as the run with most has values there.
fn grid(runs: &[Series]) -> Option<Vec<f64>> {
    let from = runs.iter().filter_map(|run| run.first()).map(|first| first.0).fold(f64::NEG_INFINITY, f64::max);
    let to = runs.iter().filter_map(|run| run.last()).map(|last| last.0).fold(f64::INFINITY, f64::min);
    if runs.is_empty() || from > to {
        return None;
    }
    if from == to {
        return Some(vec![from]);
    }
    let within = |run: &Series| run.iter().filter(|value| (from..=to).contains(&value.0)).count();
    let last = runs.iter().map(within).max().unwrap_or(0).clamp(2, GRID) - 1;
    // The end to the bit, whatever rounding does.
    Some(
        (0..=last)
            .map(|index| if index == last { to } else { from + (to - from) * index as f64 / last as f64 })
            .collect(),
    )
}

/// A run's value at a place within it, linear between its own.
fn at(run: &Series, x: f64) -> f64 {
    let after = run.partition_point(|value| value.0 < x).min(run.len() - 1);
    let (right, above) = run[after];
    if right == x || after == 0 {
        return above;
    }
    let (left, below) = run[after - 1];
    below + (above - below) * (x - left) / (right - left)
}

#[cfg(test)]
mod tests {
    use super::super::fixture::{CONFIG, run};
    use super::*;
    use crate::printer::Format;

    const SCORES: Question = Question { y: Quantity::Score, x: Place::Steps, aggregate: Aggregate::Mean };

    fn curves(question: Question, runs: &[&[(u64, f64)]]) -> Vec<LearningCurve> {
        let runs = runs.iter().enumerate().map(|(seed, scores)| run(&format!("r-{seed}"), CONFIG, scores)).collect();
        let group = Group { name: "r".to_owned(), runs };
        question.curves(&[group], &mut Printer::new(Format::Text))
    }

    fn values(curves: &[LearningCurve]) -> Vec<(f64, f64)> {
        curves[0].points.iter().map(|point| (point.x, point.y)).collect()
    }

    #[test]
    fn runs_meet_on_a_grid_of_what_they_share() {
        // From 20, where the second begins, to 60, where the first ends; four values of the first lie there.
        let first: &[(u64, f64)] = &[(0, 9.0), (20, 0.0), (30, 1.0), (50, 3.0), (60, 4.0)];
        let second: &[(u64, f64)] = &[(20, 2.0), (80, 8.0)];
        let found = curves(SCORES, &[first, second]);
        let third = 40.0 / 3.0;
        let expected = [
            (20.0, 1.0),
            (20.0 + third, (third / 10.0 + 2.0 + third / 10.0) / 2.0),
            (20.0 + 2.0 * third, (2.0 * third / 10.0 + 2.0 + 2.0 * third / 10.0) / 2.0),
            (60.0, 5.0),
        ];
        let close = |a: &(f64, f64), b: &(f64, f64)| (a.0 - b.0).abs() < 1e-9 && (a.1 - b.1).abs() < 1e-9;
        let found_values = values(&found);
        assert!(
            found_values.len() == 4 && found_values.iter().zip(&expected).all(|(a, b)| close(a, b)),
            "{found_values:?}"
        );
        assert_eq!(found[0].points[0].interval, Some([0.0, 2.0]));
        assert_eq!((found[0].points[3].interval, found[0].seeds), (Some([4.0, 6.0]), 2));
    }

    #[test]
    fn a_single_run_is_its_own_curve() {
        let scores: &[(u64, f64)] = &[(1, 2.0), (5, 3.0), (7, 1.0)];
        let found = curves(SCORES, &[scores]);
        assert_eq!(values(&found), [(1.0, 2.0), (5.0, 3.0), (7.0, 1.0)]);
        assert!(found[0].points.iter().all(|point| point.interval.is_none()));
    }

    #[test]
    fn a_run_without_evaluations_is_left_out() {
        let found = curves(SCORES, &[&[(1, 2.0), (5, 3.0)], &[]]);
        assert_eq!((found[0].seeds, values(&found)), (1, vec![(1.0, 2.0), (5.0, 3.0)]));
        assert!(curves(SCORES, &[&[], &[]]).is_empty());
    }

    #[test]
    fn runs_that_share_nothing_have_no_curve() {
        assert!(curves(SCORES, &[&[(0, 1.0), (10, 2.0)], &[(20, 1.0), (30, 1.0)]]).is_empty());
        let touching = curves(SCORES, &[&[(0, 1.0), (20, 2.0)], &[(20, 4.0), (30, 1.0)]]);
        assert_eq!(values(&touching), [(20.0, 3.0)]);
    }

    #[test]
    fn grids_have_an_end_to_the_bit_and_are_not_too_fine() {
        let many: Series = (0..1000).map(|step| (f64::from(step) * 0.1, 0.0)).collect();
        let places = grid(&[many.clone(), many.clone()]).expect("they are the same");
        assert_eq!((places.len(), places[0], places[GRID - 1]), (GRID, 0.0, many[999].0));
        assert!(places.is_sorted());
    }

    #[test]
    fn of_values_at_one_place_the_last_counts() {
        assert_eq!(rising(vec![(1.0, 1.0), (2.0, 2.0), (2.0, 3.0), (4.0, 4.0)]), [(1.0, 1.0), (2.0, 3.0), (4.0, 4.0)]);
    }

    #[test]
    fn places_and_quantities_are_those_of_the_records() {
        let scores: &[(u64, f64)] = &[(100, 2.0)];
        let value = |y, x| values(&curves(Question { y, x, ..SCORES }, &[scores]))[0];
        assert_eq!(value(Quantity::Reward, Place::Episodes), (10.0, 4.0));
        assert_eq!(value(Quantity::Length, Place::Time), (1.0, 10.0));
    }
}
