//! How far a download is, on standard error.

use std::fs;
use std::io::{IsTerminal, Write, stderr};
use std::path::Path;

/// Shows how much of a file has come: one changing line on a terminal, else a line a quarter.
pub(super) struct Progress<'a> {
    name: &'a str,
    total: u64,
    terminal: bool,
    quarters: u64,
}

impl<'a> Progress<'a> {
    pub(super) fn new(name: &'a str, total: u64) -> Progress<'a> {
        let terminal = stderr().is_terminal();
        Progress { name, total, terminal, quarters: 0 }
    }

    /// To be called every so often with the bytes that have come.
    pub(super) fn update(&mut self, bytes: u64) {
        // pip keeps other things beside the file: no more than all of it is ever shown.
        let bytes = bytes.min(self.total);
        let quarters = bytes * 4 / self.total.max(1);
        if self.terminal {
            eprint!("\r{}\x1b[K", self.line(bytes));
            // Progress that can't be shown is no reason to stop.
            let _ = stderr().flush();
        } else if quarters > self.quarters {
            self.quarters = quarters;
            eprintln!("{}", self.line(bytes));
        }
    }

    /// Shows the end, if there was a good one, and leaves the changing line.
    pub(super) fn finish(&mut self, success: bool) {
        if success {
            self.update(self.total);
        }
        if self.terminal {
            eprintln!();
        }
    }

    fn line(&self, bytes: u64) -> String {
        let megabyte = 1_000_000;
        format!("fetching {}: {} of {} MB", self.name, bytes / megabyte, self.total / megabyte)
    }
}

/// Bytes of all files under `folder`; what vanishes meanwhile counts nothing.
pub(super) fn bytes_under(folder: &Path) -> u64 {
    let Ok(entries) = fs::read_dir(folder) else { return 0 };
    entries
        .filter_map(Result::ok)
        .map(|entry| match entry.metadata() {
            Ok(metadata) if metadata.is_dir() => bytes_under(&entry.path()),
            Ok(metadata) => metadata.len(),
            Err(_) => 0,
        })
        .sum()
}
