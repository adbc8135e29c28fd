//! `cargo xtask compare perception`.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, ensure};

use super::cases::{Case, Peer, perception_cases};
use super::check::{compare_values, read_values};
use super::document::replace_section;
use super::measure::{Plan, in_turns};
use super::statistics::{Ratio, median};
use super::table::{Row, missed, table};
use super::worker::Worker;
use super::{machine, setup};
use crate::venv::target;

const DOCUMENT: &str = "docs/results/perception.md";

pub(super) fn run(root: &Path) -> Result<()> {
    let document = root.join(DOCUMENT);
    let text = fs::read_to_string(&document).with_context(|| format!("can't read {DOCUMENT}"))?;
    // Told before the minutes of measuring, not after.
    replace_section(&text, "").with_context(|| format!("{DOCUMENT} can't take the tables"))?;

    let folder = target(root).join("compare").join("perception");
    let (cases, gallery) = perception_cases();
    gallery.write(&folder, &cases)?;
    let (mut peers, mut prf) = (setup::peers(root)?, setup::prf(root)?);
    for command in [&mut prf, &mut peers] {
        setup::hold_to_one_thread(command.arg(&folder));
    }
    let mut sides = Sides {
        prf: Worker::start("the worker of prf-core", prf)?,
        peers: Worker::start("tests/compare/perception_worker.py", peers)?,
        folder,
    };
    for case in &cases {
        sides.check(case)?;
    }
    println!("both sides agree on all {} cases", cases.len());

    let rows = cases.iter().map(|case| sides.measure(case)).collect::<Result<Vec<_>>>()?;
    let rows: Vec<Row> = rows.into_iter().flatten().collect();
    let section = section(&sides.versions(), &rows);
    fs::write(&document, replace_section(&text, &section)?).with_context(|| format!("can't write {DOCUMENT}"))?;
    println!("{section}\nwritten to {DOCUMENT}");
    Ok(())
}

/// All that is written by this program: the machine, what was missed, and a table for each kind of work.
fn section(versions: &BTreeMap<String, String>, rows: &[Row]) -> String {
    let versions = versions.iter().map(|(name, version)| format!("{name} {version}")).chain(machine::compiler());
    format!(
        "Machine: {}; one thread each side. Versions: {}.\n\n{}\n\n{}",
        machine::describe(),
        versions.collect::<Vec<_>>().join(", "),
        missed(rows),
        table(rows)
    )
}

/// Both workers; only one of them works at any time.
struct Sides {
    prf: Worker,
    peers: Worker,
    folder: PathBuf,
}

impl Sides {
    fn versions(&self) -> BTreeMap<String, String> {
        let both = self.prf.versions().iter().chain(self.peers.versions());
        both.map(|(name, version)| (name.clone(), version.clone())).collect()
    }

    /// # Errors
    /// If our results are not the peers'.
    fn check(&mut self, case: &Case) -> Result<()> {
        let [ours, theirs] = ["prf", "peer"].map(|side| self.folder.join(format!("result-{side}.f32")));
        self.prf.write_result(&case.name, "prf", &ours)?;
        let ours = read_values(&ours)?;
        for Peer { side, check, .. } in &case.peers {
            self.peers.write_result(&case.name, side, &theirs)?;
            compare_values(*check, &ours, &read_values(&theirs)?)
                .with_context(|| format!("prf and {side} don't agree on {}", case.name))?;
        }
        Ok(())
    }

    fn measure(&mut self, case: &Case) -> Result<Vec<Row>> {
        eprintln!("{}", case.name);
        case.peers.iter().map(|peer| self.measure_beside(case, peer)).collect()
    }

    fn measure_beside(&mut self, case: &Case, peer: &Peer) -> Result<Row> {
        let names = ["prf", peer.side];
        let first = [self.ask(case, names[0], 1)?.0, self.ask(case, names[1], 1)?.0];
        let plan = Plan::new(first);
        let [ours, theirs] = in_turns(plan.rounds, |side| Ok(self.ask(case, names[side], plan.turns[side])?.1))?;
        Ok(Row {
            group: case.group.to_owned(),
            title: case.title.clone(),
            peer: peer.title.to_owned(),
            ours_ns: median(&ours),
            theirs_ns: median(&theirs),
            ratio: Ratio::of(&ours, &theirs),
            target: peer.target,
        })
    }

    /// Nanoseconds of a turn, and of a call.
    fn ask(&mut self, case: &Case, side: &str, turns: u64) -> Result<(f64, f64)> {
        let worker = if side == "prf" { &mut self.prf } else { &mut self.peers };
        let (calls, ns) = worker.time(&case.name, side, turns)?;
        ensure!(calls > 0, "the worker made no calls for {}", case.name);
        Ok((ns as f64 / turns as f64, ns as f64 / calls as f64))
    }
}
