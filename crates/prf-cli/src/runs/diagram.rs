//! Learning curves as a diagram.

use super::curves::{LearningCurve, Point, Question};
use super::players::{EPISODES, Players};
use crate::args::{Place, Quantity};
use crate::error::Result;
use crate::plot::axis::Axis;
use crate::plot::curve::{Band, Curve, Diagram, Joined, Level, Shape};
use crate::runs::group::Group;

/// Learning curves, with what is needed to draw them.
pub(crate) struct Picture<'a> {
    pub(crate) question: Question,
    pub(crate) world: &'a str,
    pub(crate) curves: &'a [LearningCurve],
    /// The world's players, if the curves can be compared with them.
    pub(crate) players: Option<Players>,
}

/// The players of a world, if all runs are of this very world.
pub(crate) fn players(groups: &[Group], y: Quantity) -> Result<Option<Players>> {
    let env = &groups[0].runs[0].config.env;
    let same = groups.iter().all(|group| group.runs.iter().all(|run| run.config.env == *env));
    // Of several counts the largest: its episodes begin with those of the others.
    let evaluated = groups.iter().flat_map(|group| &group.runs).map(|run| run.config.evaluation.episodes).max();
    (y.is_score() && same).then(|| Players::of(env, evaluated.unwrap_or(EPISODES))).transpose()
}

impl Picture<'_> {
    /// The diagram as SVG.
    pub(crate) fn svg(&self, shape: Shape) -> Result<String> {
        let last = self.points().map(|point| point.x).fold(0.0, f64::max);
        let unit = Unit::of(self.question.x, last);
        let curves: Vec<Curve> = self.curves.iter().map(|curve| unit.curve(curve)).collect();
        let levels = self.levels();
        let highs = self.points().map(|point| point.interval.map_or(point.y, |[_, high]| high.max(point.y)));
        let lows = self.points().map(|point| point.interval.map_or(point.y, |[low, _]| low.min(point.y)));
        let heights = || levels.iter().map(|level| level.value);
        let low = lows.chain(heights()).fold(f64::INFINITY, f64::min);
        let high = highs.chain(heights()).fold(f64::NEG_INFINITY, f64::max);
        let diagram = Diagram {
            title: format!("{}: {}", self.world, self.question.y.name()),
            subtitle: self.subtitle(),
            x: Axis::spanning(unit.name, 0.0, last / unit.size),
            y: Axis::spanning(self.question.y.name(), low, high),
            curves: &curves,
            levels: &levels,
            joined: Joined::Line,
        };
        diagram.svg(shape)
    }

    fn points(&self) -> impl Iterator<Item = &Point> {
        self.curves.iter().flat_map(|curve| &curve.points)
    }

    fn levels(&self) -> Vec<Level> {
        let Some(Players { oracle, random, .. }) = self.players else { return Vec::new() };
        vec![Level { name: "oracle", value: oracle }, Level { name: "random", value: random }]
    }

    /// What the curves, the bands and the dashed lines are.
    pub(crate) fn subtitle(&self) -> String {
        let mut words = match self.curves.iter().map(|curve| curve.seeds).max() {
            Some(2..) => format!("{} over seeds with its 95% bootstrap interval", self.question.aggregate.name()),
            _ => "one run a curve".to_owned(),
        };
        if let Some(Players { episodes: [_, random], .. }) = self.players {
            words.push_str(&format!("; the oracle in the same episodes, a random player in {random}"));
        }
        words
    }
}

/// What places are counted in, so that numbers stay short.
struct Unit {
    name: &'static str,
    size: f64,
}

impl Unit {
    fn of(x: Place, last: f64) -> Unit {
        let (name, size) = match x {
            Place::Steps if last >= 2e6 => ("steps of training (millions)", 1e6),
            Place::Steps if last >= 1e4 => ("steps of training (thousands)", 1e3),
            Place::Steps => ("steps of training", 1.0),
            Place::Episodes if last >= 1e4 => ("episodes of training (thousands)", 1e3),
            Place::Episodes => ("episodes of training", 1.0),
            Place::Time if last >= 7200.0 => ("time of training (h)", 3600.0),
            Place::Time if last >= 180.0 => ("time of training (min)", 60.0),
            Place::Time => ("time of training (s)", 1.0),
        };
        Unit { name, size }
    }

    fn curve(&self, curve: &LearningCurve) -> Curve {
        let band: Band = curve.points.iter().filter_map(|p| Some((p.x / self.size, p.interval?))).collect();
        Curve {
            name: format!("{} ({})", curve.name, curve.seeds_in_words()),
            points: curve.points.iter().map(|point| Some((point.x / self.size, point.y))).collect(),
            band,
        }
    }
}
