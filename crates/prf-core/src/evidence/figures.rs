//! The figures that say how well a reward orders frames.

use super::Label;
use super::probes::{Alteration, Probe};
use crate::{auc, spearman};

/// Fewer frames have no order worth a figure.
pub(super) const LEAST_FRAMES: usize = 3;
/// The lowest part of the scores' range, where an agent begins and long stays.
const EARLY: f64 = 0.25;
/// Fewer frames in there say too little.
const LEAST_EARLY: usize = 10;

/// What a figure measures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum FigureKind {
    /// Spearman's rank correlation of reward and score.
    Rank,
    /// The same among the frames in the lowest quarter of the scores' range.
    EarlyRank,
    /// The probability that a frame of success gets more than another (AUC).
    Success,
    /// The rank correlation of reward and time in a demonstration (value-order correlation), the mean of all.
    ValueOrder,
    /// The rank correlation of the reward with how near a thing is to its place, the mean over things and directions.
    Displacement,
    /// The probability that a thing that is displaced gets more than one that is absent, the mean over things.
    Absence,
    /// The rank correlation of the reward with how near a thing is to its size, the mean.
    Scaling,
    /// The rank correlation of the reward with how much of a thing is seen, the mean.
    Occlusion,
    /// The rank correlation of the reward with the absence of noise.
    Noise,
}

impl FigureKind {
    /// Its name in tables.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            FigureKind::Rank => "rank correlation with the score",
            FigureKind::EarlyRank => "the same in the lowest quarter of scores",
            FigureKind::Success => "AUC of success",
            FigureKind::ValueOrder => "rank correlation with time",
            FigureKind::Displacement => "falls with displacement",
            FigureKind::Absence => "AUC of displaced over absent",
            FigureKind::Scaling => "falls with a wrong size",
            FigureKind::Occlusion => "falls with occlusion",
            FigureKind::Noise => "falls with noise",
        }
    }

    /// Its key in JSON.
    #[must_use]
    pub fn key(self) -> &'static str {
        match self {
            FigureKind::Rank => "rank_correlation",
            FigureKind::EarlyRank => "early_rank_correlation",
            FigureKind::Success => "success_auc",
            FigureKind::ValueOrder => "value_order_correlation",
            FigureKind::Displacement => "displacement_correlation",
            FigureKind::Absence => "absence_auc",
            FigureKind::Scaling => "scaling_correlation",
            FigureKind::Occlusion => "occlusion_correlation",
            FigureKind::Noise => "noise_correlation",
        }
    }

    /// What a good reward reaches; `None` for figures that are told and don't decide.
    #[must_use]
    pub fn needed(self) -> Option<f64> {
        match self {
            FigureKind::Rank | FigureKind::ValueOrder | FigureKind::Displacement => Some(0.8),
            FigureKind::Success | FigureKind::Absence => Some(0.9),
            FigureKind::EarlyRank | FigureKind::Scaling | FigureKind::Occlusion | FigureKind::Noise => None,
        }
    }

    fn is_auc(self) -> bool {
        matches!(self, FigureKind::Success | FigureKind::Absence)
    }
}

/// One figure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Figure {
    /// What it measures.
    pub kind: FigureKind,
    /// A correlation in [−1, 1] or an AUC in [0, 1]; `None` where all rewards are the same.
    pub value: Option<f64>,
}

impl Figure {
    /// From −1, always wrong, over 0, which tells nothing, to 1, always right.
    #[must_use]
    pub fn strength(&self) -> f64 {
        match self.value {
            None => 0.0,
            Some(area) if self.kind.is_auc() => 2.0 * area - 1.0,
            Some(correlation) => correlation,
        }
    }
}

pub(super) fn of_scores(closeness: &[f64], labels: &[Label]) -> Vec<Figure> {
    let pairs = closeness.iter().zip(labels);
    let (scores, near): (Vec<f64>, Vec<f64>) =
        pairs.clone().filter_map(|(&near, label)| Some((label.score?, near))).unzip();
    let (success, of_success): (Vec<bool>, Vec<f64>) =
        pairs.filter_map(|(&near, label)| Some((label.success?, near))).unzip();
    let mut figures = Vec::new();
    if has_two(&scores) {
        figures.push(Figure { kind: FigureKind::Rank, value: spearman(&scores, &near) });
        let (scores, near) = early(&scores, &near);
        if scores.len() >= LEAST_EARLY && has_two(&scores) {
            figures.push(Figure { kind: FigureKind::EarlyRank, value: spearman(&scores, &near) });
        }
    }
    if success.contains(&true) && success.contains(&false) {
        figures.push(Figure { kind: FigureKind::Success, value: auc(&of_success, &success) });
    }
    figures
}

fn has_two(values: &[f64]) -> bool {
    values.iter().any(|value| value != &values[0])
}

/// The frames in the lowest part of the scores' range.
fn early(scores: &[f64], near: &[f64]) -> (Vec<f64>, Vec<f64>) {
    let least = scores.iter().copied().fold(f64::INFINITY, f64::min);
    let most = scores.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let border = least + EARLY * (most - least);
    scores.iter().copied().zip(near.iter().copied()).filter(|&(score, _)| score <= border).unzip()
}

pub(super) fn of_demonstrations(closeness: &[f64], starts: &[usize]) -> Vec<Figure> {
    let ends = starts.iter().skip(1).copied().chain([closeness.len()]);
    let demonstrations = starts.iter().zip(ends).map(|(&start, end)| &closeness[start..end]);
    let orders = demonstrations.filter(|near| near.len() >= LEAST_FRAMES).map(|near| {
        let times: Vec<f64> = (0..near.len()).map(|time| time as f64).collect();
        spearman(&times, near)
    });
    vec![Figure { kind: FigureKind::ValueOrder, value: mean(orders) }]
}

pub(super) fn of_alterations(closeness: &[f64], probes: &[Probe]) -> Vec<Figure> {
    let falls = |alteration| {
        let altered: Vec<_> =
            probes.iter().zip(closeness).filter(|(probe, _)| probe.alteration == alteration).collect();
        let series = altered.chunk_by(|a, b| a.0.series == b.0.series).filter(|series| series.len() >= LEAST_FRAMES);
        mean(series.map(|series| {
            // The goal itself comes first: nothing is altered, and the distance is 0.
            let levels: Vec<f64> = std::iter::once(0.0).chain(series.iter().map(|(p, _)| -(p.level as f64))).collect();
            let near: Vec<f64> = std::iter::once(0.0).chain(series.iter().map(|(_, near)| **near)).collect();
            spearman(&levels, &near)
        }))
    };
    let figures = [
        (FigureKind::Displacement, falls(Alteration::Displaced)),
        (FigureKind::Absence, absence(closeness, probes)),
        (FigureKind::Scaling, falls(Alteration::Scaled)),
        (FigureKind::Occlusion, falls(Alteration::Occluded)),
        (FigureKind::Noise, falls(Alteration::Noisy)),
    ];
    let known = figures.into_iter().filter(|(_, value)| value.is_some());
    known.map(|(kind, value)| Figure { kind, value }).collect()
}

/// The mean over those things that can be displaced.
fn absence(closeness: &[f64], probes: &[Probe]) -> Option<f64> {
    let objects = probes.iter().map(|probe| probe.object + 1).max()?;
    let areas = (0..objects).filter_map(|object| {
        let of_object = probes.iter().zip(closeness).filter(|(probe, _)| probe.object == object);
        let (displaced, near): (Vec<bool>, Vec<f64>) = of_object
            .filter(|(probe, _)| matches!(probe.alteration, Alteration::Displaced | Alteration::Absent))
            .map(|(probe, &near)| (probe.alteration == Alteration::Displaced, near))
            .unzip();
        auc(&near, &displaced)
    });
    mean(areas.map(Some))
}

/// Where a correlation is missing the reward told nothing, which counts as 0; of no value there is no mean.
fn mean(values: impl Iterator<Item = Option<f64>>) -> Option<f64> {
    let values: Vec<f64> = values.map(|value| value.unwrap_or(0.0)).collect();
    (!values.is_empty()).then(|| values.iter().sum::<f64>() / values.len() as f64)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Frame;

    fn label(score: f64, success: bool) -> Label {
        Label { score: Some(score), success: Some(success) }
    }

    fn close(value: Option<f64>, expected: f64) -> bool {
        value.is_some_and(|value| (value - expected).abs() < 1e-12)
    }

    #[test]
    fn scores_give_correlations_and_an_area() {
        let labels = [
            label(0.0, false),
            label(1.0, false),
            label(2.0, false),
            label(9.0, true),
            Label::default(),
            label(10.0, true),
        ];
        let figures = of_scores(&[-5.0, -6.0, -7.0, -2.0, 99.0, -1.0], &labels);
        let values: Vec<_> = figures.iter().map(|figure| (figure.kind, figure.value)).collect();
        // Ranks 0 1 2 3 4 against 2 1 0 3 4: 1 − 6·8/(5·24) = 0.6
        assert!(values[0].0 == FigureKind::Rank && close(values[0].1, 0.6), "{values:?}");
        assert_eq!(values[1..], [(FigureKind::Success, Some(1.0))]);
        assert_eq!(of_scores(&[0.0, 1.0], &[label(3.0, false), label(3.0, false)]), []);
    }

    #[test]
    fn where_an_agent_begins_has_a_figure_of_its_own() {
        // Right but for the lowest quarter, 0 to 10 of 0 to 40.
        let labels: Vec<Label> = (0..=40).map(|score| label(f64::from(score), false)).collect();
        let near: Vec<f64> = (0..=40).map(|i| f64::from(if i <= 10 { 10 - i } else { i })).collect();
        let figures = of_scores(&near, &labels);
        assert_eq!(figures[1], Figure { kind: FigureKind::EarlyRank, value: Some(-1.0) });
        // Σ d² = 2 (10² + 8² + 6² + 4² + 2²) = 440, so 1 − 6·440/(41·1680).
        assert!(close(figures[0].value, 1.0 - 2640.0 / 68880.0), "{figures:?}");
    }

    #[test]
    fn demonstrations_are_taken_one_by_one() {
        let figures = of_demonstrations(&[-3.0, -2.0, -1.0, -1.0, -2.0, -3.0, -4.0, -1.0], &[0, 3, 7]);
        assert_eq!(figures, [Figure { kind: FigureKind::ValueOrder, value: Some(0.0) }]);
    }

    fn probe(alteration: Alteration, series: usize, level: usize) -> Probe {
        Probe { alteration, object: 0, series, level, frame: Frame::new(1, 1) }
    }

    #[test]
    fn an_absent_thing_that_pays_more_than_a_displaced_one_is_found() {
        let probes = [
            probe(Alteration::Displaced, 0, 1),
            probe(Alteration::Displaced, 0, 2),
            probe(Alteration::Displaced, 0, 3),
            probe(Alteration::Absent, 1, 1),
        ];
        let values = |closeness: &[f64]| {
            let figures = of_alterations(closeness, &probes);
            (figures[0].value, figures[1].value)
        };
        assert_eq!(values(&[-1.0, -2.0, -3.0, -4.0]), (Some(1.0), Some(1.0)));
        let (falls, above) = values(&[-2.0, -2.5, -3.0, -2.2]);
        assert!(
            falls == Some(1.0) && above.is_some_and(|area| (area - 1.0 / 3.0).abs() < 1e-12),
            "{falls:?} {above:?}"
        );
        assert_eq!(values(&[0.0, 0.0, 0.0, 0.0]), (Some(0.0), Some(0.5)));
    }

    #[test]
    fn a_thing_that_cannot_be_displaced_has_no_say() {
        let stuck = Probe { object: 1, ..probe(Alteration::Absent, 2, 1) };
        let probes = [
            probe(Alteration::Displaced, 0, 1),
            probe(Alteration::Displaced, 0, 2),
            probe(Alteration::Displaced, 0, 3),
            probe(Alteration::Absent, 1, 1),
            stuck.clone(),
        ];
        let figures = of_alterations(&[-1.0, -2.0, -3.0, -4.0, -0.1], &probes);
        assert_eq!(figures[1], Figure { kind: FigureKind::Absence, value: Some(1.0) });
        assert_eq!(of_alterations(&[-0.1], &[stuck]), []);
    }

    #[test]
    fn strengths_have_one_scale() {
        let figure = |kind, value| Figure { kind, value }.strength();
        assert_eq!(figure(FigureKind::Rank, Some(0.5)), 0.5);
        assert_eq!(figure(FigureKind::Success, Some(0.5)), 0.0);
        assert_eq!(figure(FigureKind::Absence, Some(1.0)), 1.0);
        assert_eq!(figure(FigureKind::Rank, None), 0.0);
    }
}
