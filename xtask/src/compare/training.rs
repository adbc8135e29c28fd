//! `cargo xtask compare training`.

use std::collections::BTreeMap;
use std::fmt::Write;
use std::fs;
use std::path::Path;

use anyhow::{Context, Result, ensure};

use super::document::replace_section;
use super::measure::in_turns;
use super::statistics::{Ratio, median};
use super::table::{Row, missed, table};
use super::worker::Worker;
use super::{machine, setup};

const DOCUMENT: &str = "docs/results/training-speed.md";
/// What both sides train.
const CONFIG: &str = "tests/compare/training.toml";
/// How often both sides of a pair are asked.
const ROUNDS: usize = 15;
/// Steps of an environment for an update, in [`CONFIG`].
const STEPS_PER_UPDATE: u64 = 4;
/// Updates of a turn: about a quarter of a second.
const UPDATES: u64 = 16;

pub(super) fn run(root: &Path) -> Result<()> {
    let document = root.join(DOCUMENT);
    let text = fs::read_to_string(&document).with_context(|| format!("can't read {DOCUMENT}"))?;
    // Told before the minutes of measuring, not after.
    replace_section(&text, "").with_context(|| format!("{DOCUMENT} can't take the tables"))?;

    let (prf, peers) = setup::training(root, &root.join(CONFIG))?;
    let mut sides = Sides {
        prf: Worker::start("the worker of prf-dqn", prf)?,
        peers: Worker::start("tests/compare/training_worker.py", peers)?,
    };
    let precision = if machine::multiplies_bf16() { "bf16" } else { "f32" };
    let rows = pairs(precision).iter().map(|pair| sides.measure(pair)).collect::<Result<Vec<_>>>()?;
    let growth = sides.growth(precision)?;
    let section = section(&sides.versions(), &rows, &growth);
    fs::write(&document, replace_section(&text, &section)?).with_context(|| format!("can't write {DOCUMENT}"))?;
    println!("{section}\nwritten to {DOCUMENT}");
    Ok(())
}

/// One side's work: a case and a side of its worker, and the turns to ask for at a time.
#[derive(Clone, Debug)]
struct Work {
    case: String,
    side: &'static str,
    turns: u64,
}

/// Our work beside a peer's, or beside other work of ours.
struct Pair {
    group: &'static str,
    title: String,
    ours: Work,
    peer: &'static str,
    theirs: Work,
    target: Option<f64>,
}

fn ours(case: String, turns: u64) -> Work {
    Work { case, side: "prf", turns }
}

fn pairs(precision: &str) -> Vec<Pair> {
    let steps = UPDATES * STEPS_PER_UPDATE;
    let train = |precision: &str, environments: u64, target| Pair {
        group: "Training",
        title: format!("a step of an environment, {environments} at once, {precision}"),
        ours: ours(format!("train-{precision}-{environments}"), steps),
        peer: "Stable-Baselines3",
        theirs: Work { case: "train".to_owned(), side: "sb3", turns: steps },
        target,
    };
    let update = |precision: &str, peer, side, target| Pair {
        group: "Bare loop",
        title: format!("target forward, forward, backward, Adam; {precision}"),
        ours: ours(format!("bare-{precision}-84"), UPDATES),
        peer,
        theirs: Work { case: "bare".to_owned(), side, turns: UPDATES },
        target,
    };
    let sample = |steps: u64| Pair {
        group: "Replay",
        title: format!("a batch of 32 out of {steps} steps, beside an update"),
        ours: ours(format!("sample-{steps}"), 2_000),
        peer: "bare loop",
        theirs: ours(format!("bare-{precision}-84"), UPDATES),
        target: Some(50.0),
    };
    let mut pairs = vec![train(precision, 16, Some(3.0)), train(precision, 1, None)];
    if precision != "f32" {
        pairs.push(train("f32", 16, None));
    }
    pairs.push(update(precision, "PyTorch, plain Adam", "torch-plain", Some(1.0)));
    pairs.push(update(precision, "PyTorch, fused Adam", "torch-fused", Some(1.0)));
    pairs.push(update(precision, "PyTorch, fused, channels last", "torch-fused+channels_last", Some(1.0)));
    pairs.push(update(precision, "PyTorch, fused, bf16", "torch-fused+bf16", Some(1.0)));
    pairs.push(update(precision, "PyTorch, all three", "torch-fused+channels_last+bf16", Some(1.0)));
    if precision != "f32" {
        pairs.push(update("f32", "PyTorch, fused, channels last", "torch-fused+channels_last", None));
    }
    pairs.push(Pair {
        group: "Trainer",
        title: "an update, with acting, worlds, rewards and replay, beside the bare loop".to_owned(),
        ours: ours(format!("update-{precision}-16"), UPDATES),
        peer: "bare loop",
        theirs: ours(format!("bare-{precision}-84"), UPDATES),
        target: Some(0.85),
    });
    pairs.extend([100_000, 1_000_000].map(sample));
    pairs
}

/// Both workers; only one of them works at any time.
struct Sides {
    prf: Worker,
    peers: Worker,
}

impl Sides {
    fn versions(&self) -> BTreeMap<String, String> {
        let both = self.prf.versions().iter().chain(self.peers.versions());
        both.map(|(name, version)| (name.clone(), version.clone())).collect()
    }

    fn measure(&mut self, pair: &Pair) -> Result<Row> {
        eprintln!("{}: {}, beside {}", pair.group, pair.title, pair.peer);
        let works = [&pair.ours, &pair.theirs];
        // The first turn plans and allocates.
        for work in works {
            self.ask(work)?;
        }
        let [ours, theirs] = in_turns(ROUNDS, |side| self.ask(works[side]))?;
        Ok(Row {
            group: pair.group.to_owned(),
            title: pair.title.clone(),
            peer: pair.peer.to_owned(),
            ours_ns: median(&ours),
            theirs_ns: median(&theirs),
            ratio: Ratio::of(&ours, &theirs),
            target: pair.target,
        })
    }

    /// What a table says of how the cost grows: lines of Markdown.
    fn growth(&mut self, precision: &str) -> Result<String> {
        let mut text = String::from("### How the cost grows\n\n| | | |\n|---|---|---|\n");
        for environments in [1, 4, 16, 64] {
            let ns = self.median_of(&ours(format!("train-{precision}-{environments}"), UPDATES * STEPS_PER_UPDATE))?;
            let _ = writeln!(text, "| Environments | {environments} | {:.0} steps/s |", 1e9 / ns);
        }
        for steps in [10_000, 100_000, 1_000_000] {
            let ns = self.median_of(&ours(format!("sample-{steps}"), 2_000))?;
            let _ = writeln!(text, "| Replay, steps | {steps} | {:.0} µs a batch of 32 |", ns / 1e3);
        }
        for side in [48, 84, 128, 168] {
            let ns = self.median_of(&ours(format!("bare-{precision}-{side}"), UPDATES))?;
            let _ = writeln!(text, "| Frame, pixels | {side}×{side} | {:.1} ms an update |", ns / 1e6);
        }
        Ok(text)
    }

    fn median_of(&mut self, work: &Work) -> Result<f64> {
        eprintln!("{}", work.case);
        self.ask(work)?;
        let times = (0..ROUNDS).map(|_| self.ask(work)).collect::<Result<Vec<_>>>()?;
        Ok(median(&times))
    }

    /// Nanoseconds of a call.
    fn ask(&mut self, work: &Work) -> Result<f64> {
        let worker = if work.side == "prf" { &mut self.prf } else { &mut self.peers };
        let (calls, ns) = worker.time(&work.case, work.side, work.turns)?;
        ensure!(calls > 0, "the worker made no calls for {}", work.case);
        Ok(ns as f64 / calls as f64)
    }
}

fn section(versions: &BTreeMap<String, String>, rows: &[Row], growth: &str) -> String {
    let versions = versions.iter().map(|(name, version)| format!("{name} {version}")).chain(machine::compiler());
    let rates = rows.first().map_or(String::new(), |row| {
        let [ours, theirs] = [row.ours_ns, row.theirs_ns].map(|ns| 1e9 / ns);
        format!("Agent steps a second: prf {ours:.0}, Stable-Baselines3 {theirs:.0}.\n\n")
    });
    format!(
        "Machine: {}. Versions: {}.\n\n{rates}{}\n\n{}\n{growth}",
        machine::describe(),
        versions.collect::<Vec<_>>().join(", "),
        missed(rows),
        table(rows)
    )
}
