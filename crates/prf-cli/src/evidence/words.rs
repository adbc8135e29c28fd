//! Judgements in words and in JSON.

use prf_core::{
    Alteration, Altered, CellSize, Figure, HogParams, Judgement, Norm, Rect, RewardParams, Rewards, Verdict,
};
use prf_envs::RewardConfig;
use serde::Serialize;
use serde_json::{Map, Value};

use super::{Kind, Known};
use crate::error::Result;

/// What the judgement rests on.
pub(crate) fn evidence(known: &Known, judged: usize) -> String {
    match &known.kind {
        Kind::World(name) => format!("{judged} frames of {name}, played at random, clumsily and at its best"),
        Kind::Scores => format!("{judged} of {} frames with scores", known.footage.shown()),
        Kind::Demonstrations(1) => format!("{judged} of {} frames of a demonstration", known.footage.shown()),
        Kind::Demonstrations(n) => format!("{judged} of {} frames of {n} demonstrations", known.footage.shown()),
        Kind::Goal => format!("the goal alone, altered in {judged} ways"),
    }
}

/// The settings, in the terms of docs/reward.md.
pub(crate) fn settings(params: &RewardParams, cell_px: usize) -> String {
    let HogParams { cell, block_cells, norm, .. } = params.hog;
    format!("{}, {block_cells}x{block_cells} blocks, cells of {} ({cell_px} px)", norm_name(norm), cell_name(cell))
}

pub(crate) fn cell_name(cell: CellSize) -> String {
    match cell {
        CellSize::Fraction(fraction) => format!("{fraction} h"),
        CellSize::Px(px) => format!("{px} px"),
    }
}

pub(crate) fn norm_name(norm: Norm) -> &'static str {
    match norm {
        Norm::None => "none",
        Norm::L1 => "l1",
        Norm::L1Sqrt => "l1-sqrt",
        Norm::L2 => "l2",
        Norm::L2Hys => "l2-hys",
    }
}

pub(crate) fn verdict_name(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Good => "good",
        Verdict::Weak => "weak",
        Verdict::Misleading => "misleading",
        Verdict::Blind => "blind",
    }
}

/// A line for each figure.
pub(crate) fn figures(judgement: &Judgement) -> Vec<String> {
    let line = |figure: &Figure| {
        let value = figure.value.map_or("none".to_owned(), |value| format!("{value:.3}"));
        let needed = figure.kind.needed().map_or(String::new(), |needed| format!("   good from {needed}"));
        format!("{:<42} {value:>6}{needed}", figure.kind.name())
    };
    judgement.figures.iter().map(line).collect()
}

/// How the rewards spread, and how many are saturated.
pub(crate) fn rewards(rewards: Rewards) -> String {
    let Rewards { least, low, median, high, largest, next_to_one, next_to_nothing } = rewards;
    let [least, low, median, high, largest] = [least, low, median, high, largest].map(short);
    let saturated: Vec<String> = [(next_to_one, "above 0.99"), (next_to_nothing, "below 1e-6")]
        .iter()
        .filter(|(share, _)| *share > 0.0)
        .map(|(share, words)| format!("; {:.1} % {words}", 100.0 * share))
        .collect();
    format!(
        "{least} at least, {low} to {high} for eight tenths, {median} in the middle, {largest} at most{}",
        saturated.concat()
    )
}

/// Three decimals, or the first digits of a very small number.
fn short(value: f32) -> String {
    if value != 0.0 && value < 1e-3 { format!("{value:.1e}") } else { format!("{value:.3}") }
}

/// The verdict with its reason.
pub(crate) fn verdict(judgement: &Judgement) -> String {
    let name = verdict_name(judgement.verdict);
    let reason = match judgement.verdict {
        Verdict::Good => "the reward orders the frames as the task does".to_owned(),
        Verdict::Weak => weakness(judgement),
        Verdict::Misleading => format!("the reward punishes progress ({})", weakest(judgement)),
        Verdict::Blind => format!(
            "rewards from {} to {} tell an agent nothing",
            short(judgement.rewards.least),
            short(judgement.rewards.largest)
        ),
    };
    format!("{name}: {reason}")
}

fn weakness(judgement: &Judgement) -> String {
    if judgement.rewards.are_narrow() {
        let spread = judgement.rewards.spread();
        return format!("most rewards lie within {spread:.4} of each other, so an agent sees little of their order");
    }
    weakest(judgement)
}

/// The figure that decides.
fn weakest(judgement: &Judgement) -> String {
    let deciding = judgement.figures.iter().filter(|figure| figure.kind.needed().is_some());
    match deciding.min_by(|a, b| a.strength().total_cmp(&b.strength())) {
        Some(Figure { kind, value: Some(value) }) => format!("{}: {value:.2}", kind.name()),
        Some(Figure { kind, value: None }) => format!("{}: none, as all rewards are the same", kind.name()),
        None => "nothing in the goal can be moved, so nothing tells what order is right".to_owned(),
    }
}

/// What was done to a goal.
pub(crate) fn altered(altered: &Altered<'_>) -> String {
    let Altered { alteration, thing, level, .. } = altered;
    let thing = thing + 1;
    match alteration {
        Alteration::Displaced => format!("thing {thing} {level} px off"),
        Alteration::Absent => format!("thing {thing} absent"),
        Alteration::Scaled => format!("thing {thing} sized {level}"),
        Alteration::Occluded => format!("thing {thing} hidden {level}/4"),
        Alteration::Noisy => format!("noise {level}"),
    }
}

/// A judgement for programs: every figure has a key of its own.
#[derive(Serialize)]
pub(crate) struct Record {
    evidence: &'static str,
    frames: usize,
    #[serde(skip_serializing_if = "Option::is_none")]
    window: Option<Window>,
    hog: HogParams,
    cell_px: usize,
    #[serde(flatten)]
    figures: Map<String, Value>,
    quality: f64,
    verdict: &'static str,
    reward: Spread,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) recommended: Option<bool>,
}

/// Where a window lies in the goal, or in the screen that the goal was cut out of.
#[derive(Serialize)]
struct Window {
    x: usize,
    y: usize,
    width: usize,
    height: usize,
}

#[derive(Serialize)]
struct Spread {
    least: f32,
    low: f32,
    median: f32,
    high: f32,
    largest: f32,
    next_to_one: f32,
    next_to_nothing: f32,
}

impl Record {
    pub(crate) fn new(known: &Known, frames: usize, window: Option<Rect>, judgement: &Judgement) -> Record {
        let Rewards { least, low, median, high, largest, next_to_one, next_to_nothing } = judgement.rewards;
        let value = |figure: &Figure| (figure.kind.key().to_owned(), Value::from(figure.value));
        Record {
            evidence: match known.kind {
                Kind::World(_) => "world",
                Kind::Scores => "scores",
                Kind::Demonstrations(_) => "demonstration",
                Kind::Goal => "goal",
            },
            frames,
            window: window.map(|Rect { x, y, width, height }| Window { x, y, width, height }),
            hog: judgement.params.hog,
            cell_px: judgement.cell_px,
            figures: judgement.figures.iter().map(value).collect(),
            quality: judgement.quality,
            verdict: verdict_name(judgement.verdict),
            reward: Spread { least, low, median, high, largest, next_to_one, next_to_nothing },
            recommended: None,
        }
    }
}

/// `[reward]` as `prf train` and `prf score` take it.
pub(crate) fn snippet(reward: &RewardConfig) -> Result<String> {
    #[derive(Serialize)]
    struct Table<'a> {
        reward: &'a RewardConfig,
    }
    Ok(folded(&toml::to_string(&Table { reward })?))
}

/// A table of a single key, such as `[reward.hog.cell]`, as a value of the table before it.
fn folded(toml: &str) -> String {
    let mut lines: Vec<String> = Vec::new();
    let mut rest = toml.lines().peekable();
    while let Some(line) = rest.next() {
        let name = line.strip_prefix('[').and_then(|line| line.strip_suffix(']'));
        match name.and_then(|name| name.rsplit_once('.')) {
            Some((table, key)) if table.contains('.') => {
                let value = rest.next().unwrap_or_default();
                if lines.last().is_some_and(String::is_empty) {
                    lines.pop();
                }
                lines.push(format!("{key} = {{ {value} }}"));
            }
            _ => lines.push(line.to_owned()),
        }
    }
    lines.join("\n") + "\n"
}

#[cfg(test)]
mod tests {
    use super::*;
    use prf_core::DescriptorKind;

    #[test]
    fn a_snippet_is_read_back_as_it_was() {
        #[derive(serde::Deserialize)]
        struct Table {
            reward: RewardConfig,
        }
        for kind in [DescriptorKind::Direct, DescriptorKind::Window, DescriptorKind::Motion] {
            let mut reward = RewardConfig::perceptual("a b.png").with_descriptor(kind);
            reward.hog.cell = CellSize::Fraction(0.075);
            reward.hog.norm = Norm::L1Sqrt;
            let text = snippet(&reward).expect("plain values");
            assert!(text.contains("\nnorm = \"l1-sqrt\"\n") && text.contains("cell = { fraction = 0.075 }"), "{text}");
            let read: Table = toml::from_str(&text).expect("what was written");
            assert_eq!(read.reward, reward, "{text}");
        }
    }
}
