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
    for line in io::stdin().lock().lines() {
        say(&answer(folder, &cases, &line?)?)?;
    }
    Ok(())
}

fn answer(folder: &Path, cases: &[Case], line: &str) -> Result<Value> {
    let words: Vec<&str> = line.splitn(4, ' ').collect();
    let [command, name, _, argument] = words[..] else { return Err(format!("not understood: {line}").into()) };
    let case = cases.iter().find(|case| case.name == name).ok_or_else(|| format!("no case {name}"))?;
    let frames = case.frames.read(folder)?;
    let mut job = job::make(case, folder)?;
    match command {
        "time" => time_turns(job.as_mut(), &frames, argument.parse()?),
        "result" => write_result(job.as_mut(), &frames, argument),
        _ => Err(format!("not understood: {line}").into()),
    }
}

fn time_turns(job: &mut dyn Job, frames: &[Frame], turns: usize) -> Result<Value> {
    // Before, so that memory and caches are those of a long run.
    turn(job, frames)?;
    let start = Instant::now();
    for _ in 0..turns {
        turn(job, frames)?;
    }
    let nanoseconds = u64::try_from(start.elapsed().as_nanos())?;
    Ok(json!({ "calls": turns * frames.len(), "ns": nanoseconds }))
}

/// One call for each picture.
fn turn(job: &mut dyn Job, frames: &[Frame]) -> Result<()> {
    for frame in frames {
        job.call(black_box(frame.view()))?;
    }
    Ok(())
}

fn write_result(job: &mut dyn Job, frames: &[Frame], file: &str) -> Result<Value> {
    let mut values = Vec::new();
    for frame in frames {
        job.call(frame.view())?;
        job.output(frame.view(), &mut values);
    }
    let bytes: Vec<u8> = values.iter().flat_map(|value| value.to_le_bytes()).collect();
    fs::write(file, bytes)?;
    Ok(json!({ "values": values.len() }))
}

fn say(answer: &Value) -> Result<()> {
    let mut out = io::stdout().lock();
    writeln!(out, "{answer}")?;
    Ok(out.flush()?)
}
