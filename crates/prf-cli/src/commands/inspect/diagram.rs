//! The rewards over what is known of the frames, as a diagram.

use prf_core::{Alteration, Altered, Evidence, Judgement};

use crate::error::Result;
use crate::evidence::{Kind, Known, words};
use crate::plot::axis::Axis;
use crate::plot::curve::{Band, Curve, Diagram, Joined, Shape};

/// The diagram of the rewards of these distances.
pub(super) fn svg(
    headline: &str,
    known: &Known,
    evidence: &Evidence<'_>,
    judgement: &Judgement,
    distances: &[f32],
) -> Result<String> {
    let rewards: Vec<f64> = distances.iter().map(|distance| f64::from((-distance).exp())).collect();
    let (curves, joined) = match known.kind {
        Kind::World(_) | Kind::Scores => (by_score(known, &rewards), Joined::Dots),
        Kind::Demonstrations(_) => (by_time(known, &rewards), Joined::Line),
        Kind::Goal => (by_displacement(&evidence.alterations().collect::<Vec<_>>(), &rewards), Joined::Line),
    };
    let points = || curves.iter().flat_map(|curve| curve.points.iter().flatten());
    let (least_x, last_x) = bounds(points().map(|point| point.0));
    let (least, largest) = bounds(points().map(|point| point.1));
    let diagram = Diagram {
        title: headline.to_owned(),
        subtitle: format!("{}; {}", words::evidence(known, evidence.len()), words::verdict(judgement)),
        x: match known.kind {
            Kind::World(_) | Kind::Scores => Axis::scores(least_x, last_x),
            Kind::Demonstrations(_) => Axis::frames(last_x),
            Kind::Goal => Axis::pixels(last_x),
        },
        y: Axis::rewards(least, largest),
        curves: &curves,
        levels: &[],
        joined,
    };
    diagram.svg(Shape::Titled)
}

fn bounds(values: impl Iterator<Item = f64> + Clone) -> (f64, f64) {
    (values.clone().fold(f64::INFINITY, f64::min), values.fold(f64::NEG_INFINITY, f64::max))
}

/// A dot for each frame, at its score; where there are no scores, failures at 0 and successes at 1.
fn by_score(known: &Known, rewards: &[f64]) -> Vec<Curve> {
    let labels = known.footage.labels();
    let series = |name: &str, success: Option<bool>| {
        let of_kind = labels.iter().zip(rewards).filter(|(label, _)| label.success == success);
        let has_scores = labels.iter().any(|label| label.score.is_some());
        let points = of_kind.filter_map(|(label, &reward)| {
            let success = label.success.map(|success| f64::from(u8::from(success)));
            Some(Some((if has_scores { label.score? } else { success? }, reward)))
        });
        Curve { name: name.to_owned(), points: points.collect(), band: Band::new() }
    };
    let curves = [series("frames", None), series("not a success", Some(false)), series("success", Some(true))];
    curves.into_iter().filter(|curve| !curve.points.is_empty()).collect()
}

/// A curve for each demonstration.
fn by_time(known: &Known, rewards: &[f64]) -> Vec<Curve> {
    let (indices, starts) = (known.footage.indices(), known.footage.starts());
    let ends = starts.iter().skip(1).copied().chain([rewards.len()]);
    let curve = |(number, (&start, end)): (usize, (&usize, usize))| {
        let first = indices.get(start).copied().unwrap_or(0);
        let points = (start..end).map(|at| Some(((indices[at] - first) as f64, rewards[at]))).collect();
        Curve { name: format!("demonstration {}", number + 1), points, band: Band::new() }
    };
    let curves = starts.iter().zip(ends).enumerate().map(curve);
    curves.filter(|curve| !curve.points.is_empty()).collect()
}

/// For each thing in the goal, the mean reward over how far it is displaced, and the reward without it.
fn by_displacement(altered: &[Altered<'_>], rewards: &[f64]) -> Vec<Curve> {
    let things = altered.iter().map(|altered| altered.thing + 1).max().unwrap_or(0);
    let of = |thing: usize, alteration: Alteration| {
        let pairs = altered.iter().zip(rewards);
        pairs.filter(move |(altered, _)| altered.thing == thing && altered.alteration == alteration)
    };
    let mut curves = Vec::new();
    for thing in 0..things {
        let farthest = of(thing, Alteration::Displaced).map(|(altered, _)| altered.level).max().unwrap_or(1);
        let mean = |level: usize| {
            let rewards: Vec<f64> =
                of(thing, Alteration::Displaced).filter(|(a, _)| a.level == level).map(|(_, &reward)| reward).collect();
            (level as f64, rewards.iter().sum::<f64>() / rewards.len() as f64)
        };
        let displaced = std::iter::once((0.0, 1.0)).chain((1..=farthest).map(mean)).map(Some).collect();
        curves.push(Curve { name: format!("thing {} displaced", thing + 1), points: displaced, band: Band::new() });
        let absent = of(thing, Alteration::Absent).flat_map(|(_, &reward)| [(0.0, reward), (farthest as f64, reward)]);
        curves.push(Curve {
            name: format!("thing {} absent", thing + 1),
            points: absent.map(Some).collect(),
            band: Band::new(),
        });
    }
    curves
}
