//! A child process that works when it is asked: one line in, one line of JSON out.

use std::collections::BTreeMap;
use std::io::{BufRead, BufReader, Write};
use std::path::Path;
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};

use anyhow::{Context, Result, ensure};
use serde_json::Value;

/// One worker, until it is dropped.
pub(super) struct Worker {
    name: &'static str,
    child: Child,
    /// `None` once it is told to end.
    input: Option<ChildStdin>,
    output: BufReader<ChildStdout>,
    versions: BTreeMap<String, String>,
}

impl Worker {
    /// Starts it.
    pub(super) fn start(name: &'static str, mut command: Command) -> Result<Worker> {
        command.stdin(Stdio::piped()).stdout(Stdio::piped());
        let mut child = command.spawn().with_context(|| format!("can't start {name}"))?;
        let input = child.stdin.take();
        let output = BufReader::new(child.stdout.take().context("a worker without output")?);
        let mut worker = Worker { name, child, input, output, versions: BTreeMap::new() };
        match worker.read()? {
            Answer::Versions(versions) => worker.versions = versions,
            other => return Err(worker.unexpected(&other)),
        }
        Ok(worker)
    }

    /// Of what it uses, by name.
    pub(super) fn versions(&self) -> &BTreeMap<String, String> {
        &self.versions
    }

    /// Calls made in so many turns, and their nanoseconds.
    pub(super) fn time(&mut self, case: &str, side: &str, turns: u64) -> Result<(u64, u64)> {
        match self.ask(&format!("time {case} {side} {turns}"))? {
            Answer::Time { calls, ns } => Ok((calls, ns)),
            other => Err(self.unexpected(&other)),
        }
    }

    /// Has the results of one turn written to a file.
    pub(super) fn write_result(&mut self, case: &str, side: &str, file: &Path) -> Result<()> {
        match self.ask(&format!("result {case} {side} {}", file.display()))? {
            Answer::Result { .. } => Ok(()),
            other => Err(self.unexpected(&other)),
        }
    }

    fn ask(&mut self, line: &str) -> Result<Answer> {
        let input = self.input.as_mut().context("a worker without input")?;
        // One that died can't read; what it wrote, or didn't, says more.
        let _ = writeln!(input, "{line}").and_then(|()| input.flush());
        self.read().with_context(|| format!("asked `{line}`"))
    }

    fn read(&mut self) -> Result<Answer> {
        let mut line = String::new();
        let read = self.output.read_line(&mut line)?;
        ensure!(read > 0, "{} ended; its last words are above", self.name);
        parse_answer(&line).with_context(|| format!("{} said {line:?}", self.name))
    }

    fn unexpected(&self, answer: &Answer) -> anyhow::Error {
        anyhow::anyhow!("{} gave an answer to another question: {answer:?}", self.name)
    }
}

impl Drop for Worker {
    fn drop(&mut self) {
        // It ends with its input.
        self.input = None;
        let _ = self.child.wait();
    }
}

/// What a worker may say.
#[derive(Debug, PartialEq)]
pub enum Answer {
    /// At the start: what it uses.
    Versions(BTreeMap<String, String>),
    /// To `time`.
    Time {
        /// Calls made.
        calls: u64,
        /// Nanoseconds they took, all together.
        ns: u64,
    },
    /// To `result`.
    Result {
        /// Floats written.
        values: u64,
    },
}

/// # Errors
/// If the line is no answer.
pub fn parse_answer(line: &str) -> Result<Answer> {
    let value: Value = serde_json::from_str(line).context("not JSON")?;
    if let Some(versions) = value["versions"].as_object() {
        let text = |value: &Value| value.as_str().unwrap_or("?").to_owned();
        return Ok(Answer::Versions(versions.iter().map(|(name, value)| (name.clone(), text(value))).collect()));
    }
    let number = |key: &str| value[key].as_u64();
    match (number("calls"), number("ns"), number("values")) {
        (Some(calls), Some(ns), None) => Ok(Answer::Time { calls, ns }),
        (None, None, Some(values)) => Ok(Answer::Result { values }),
        _ => anyhow::bail!("expected `versions`, `calls` and `ns`, or `values`"),
    }
}
