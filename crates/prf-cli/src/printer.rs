//! Where words go: results to stdout, everything else to stderr.

use std::fmt;
use std::io::{self, Write};

use clap::ValueEnum;
use serde::Serialize;

use crate::error::{CliError, Result};

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Format {
    /// For people
    Text,
    /// One JSON object a line
    Json,
}

/// The one way out for a command's words.
#[derive(Debug)]
pub(crate) struct Printer {
    format: Format,
}

impl Printer {
    pub(crate) fn new(format: Format) -> Self {
        Self { format }
    }

    pub(crate) fn format(&self) -> Format {
        self.format
    }

    /// A line of result for people.
    pub(crate) fn line(&mut self, line: impl fmt::Display) -> Result<()> {
        self.bytes(format!("{line}\n").as_bytes())
    }

    /// A line of result for programs.
    pub(crate) fn record(&mut self, record: &impl Serialize) -> Result<()> {
        let mut line = serde_json::to_vec(record)?;
        line.push(b'\n');
        self.bytes(&line)
    }

    /// A result as it is.
    pub(crate) fn bytes(&mut self, bytes: &[u8]) -> Result<()> {
        let mut stdout = io::stdout().lock();
        stdout.write_all(bytes).and_then(|()| stdout.flush()).map_err(|error| match error.kind() {
            io::ErrorKind::BrokenPipe => CliError::closed_pipe().into(),
            _ => CliError::failed(format!("cannot write to stdout: {error}")).into(),
        })
    }

    /// Something worth knowing.
    pub(crate) fn note(&mut self, note: impl fmt::Display) {
        to_stderr(&format!("note: {note}\n"));
    }

    /// Something that is probably not as it was meant.
    pub(crate) fn warning(&mut self, warning: impl fmt::Display, hint: Option<&str>) {
        let hint = hint.map_or_else(String::new, |hint| format!("  hint: {hint}\n"));
        to_stderr(&format!("warning: {warning}\n{hint}"));
    }

    /// An error that does not end the command.
    pub(crate) fn error(&mut self, error: &anyhow::Error) {
        to_stderr(&crate::error::render(error));
    }

    /// The same, of a library's error that is still needed.
    pub(crate) fn problem(&mut self, error: &prf_core::Error) {
        to_stderr(&format!("error: {error}\n"));
    }
}

/// With stderr closed there is nobody left to tell, so a failure to write is no failure.
fn to_stderr(text: &str) {
    let _ = io::stderr().lock().write_all(text.as_bytes());
}
