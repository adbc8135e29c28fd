//! Our side of `cargo xtask compare perception`, which starts it and `tests/compare/perception_worker.py` and asks them in turn.
//!
//! Takes a folder with `cases.json` and the pictures, and speaks the protocol that the Python file describes.

use std::error::Error;
use std::fs;
use std::hint::black_box;
use std::io::{self, BufRead, Write};
use std::path::Path;
use std::time::Instant;

use prf_core::Frame;
use serde_json::{Value, json};

mod case;
mod job;

use case::Case;
use job::Job;

type Result<T> = std::result::Result<T, Box<dyn Error>>;

fn main() -> Result<()> {
    let folder = std::env::args_os().nth(1).ok_or("usage: perception_worker FOLDER")?;
    let folder = Path::new(&folder);
    let cases: Vec<Case> = serde_json::from_str(&fs::read_to_string(folder.join("cases.json"))?)?;
    say(&json!({ "versions": { "prf-core": env!("CARGO_PKG_VERSION") } }))?;
    let mut kept: Option<(String, Running)> = None;
    for line in io::stdin().lock().lines() {
        let line = line?;
        let words: Vec<&str> = line.splitn(4, ' ').collect();
        let [command, name, _, argument] = words[..] else { return Err(format!("not understood: {line}").into()) };
        let start = || Running::start(folder, &cases, name);
        say(&match command {
            "result" => start()?.write_result(argument)?,
            _ => keep(&mut kept, name, start)?.time_turns(argument.parse()?)?,
        })?;
    }
    Ok(())
}

/// The one that was asked for last, or a new one.
fn keep<'a>(
    kept: &'a mut Option<(String, Running)>,
    name: &str,
    start: impl FnOnce() -> Result<Running>,
) -> Result<&'a mut Running> {
    if kept.as_ref().is_none_or(|(last, _)| last != name) {
        let mut running = start()?;
        // So that memory and caches are those of a long run.
        running.turn()?;
        *kept = Some((name.to_owned(), running));
    }
    Ok(kept.as_mut().map(|(_, running)| running).ok_or("nothing is kept")?)
}

/// A case with its pictures.
struct Running {
    frames: Vec<Frame>,
    job: Box<dyn Job>,
}

impl Running {
    fn start(folder: &Path, cases: &[Case], name: &str) -> Result<Running> {
        let case = cases.iter().find(|case| case.name == name).ok_or_else(|| format!("no case {name}"))?;
        Ok(Running { frames: case.frames.read(folder)?, job: job::make(case, folder)? })
    }

    /// One call for each picture.
    fn turn(&mut self) -> Result<()> {
        for frame in &self.frames {
            self.job.call(black_box(frame.view()))?;
        }
        Ok(())
    }

    fn time_turns(&mut self, turns: usize) -> Result<Value> {
        let start = Instant::now();
        for _ in 0..turns {
            self.turn()?;
        }
        let nanoseconds = u64::try_from(start.elapsed().as_nanos())?;
        Ok(json!({ "calls": turns * self.frames.len(), "ns": nanoseconds }))
    }

    fn write_result(&mut self, file: &str) -> Result<Value> {
        let mut values = Vec::new();
        for frame in &self.frames {
            self.job.call(frame.view())?;
            self.job.output(frame.view(), &mut values);
        }
        let bytes: Vec<u8> = values.iter().flat_map(|value| value.to_le_bytes()).collect();
        fs::write(file, bytes)?;
        Ok(json!({ "values": values.len() }))
    }
}

fn say(answer: &Value) -> Result<()> {
    let mut out = io::stdout().lock();
    writeln!(out, "{answer}")?;
    Ok(out.flush()?)
}
