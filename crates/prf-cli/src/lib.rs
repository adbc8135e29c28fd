//! The command `prf` as a function: what its program and the Python package run.

use std::ffi::OsString;

use clap::Parser as _;

use crate::args::Cli;
use crate::error::Kind;
use crate::printer::Printer;

mod args;
mod commands;
mod error;
mod evidence;
mod files;
mod gif;
mod interrupt;
#[cfg(feature = "train")]
mod live;
mod play;
mod plot;
mod printer;
#[cfg(feature = "train")]
mod progress;
#[cfg(feature = "train")]
mod report;
#[cfg(feature = "train")]
mod runs;
mod settings;
#[cfg(feature = "train")]
mod shell;

/// How a command ended that did what it could.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum ExitStatus {
    /// All of it was done.
    Done,
    /// It was done, but without some damaged input.
    FinishedWithLoss,
    /// It was stopped by the user, and what was done so far is saved.
    Interrupted,
}

impl ExitStatus {
    fn code(self) -> u8 {
        match self {
            Self::Done => 0,
            Self::FinishedWithLoss => 3,
            Self::Interrupted => 130,
        }
    }
}

/// Runs `args`, of which the first is what the program is called in its own help, on this process's standard streams,
/// and returns the exit code: 0 done, 1 failed, 2 misuse, 3 finished with loss, 130 interrupted.
///
/// Some commands take over the process's signals and do not give them back, so this is to be the last that it does.
pub fn run(args: impl IntoIterator<Item = OsString>) -> u8 {
    let cli = match Cli::try_parse_from(args) {
        Ok(cli) => cli,
        Err(error) => return show_usage(&error),
    };
    let mut printer = Printer::new(cli.command.format());
    match commands::run(cli.command, &mut printer) {
        Ok(status) => status.code(),
        Err(error) => match error::kind(&error) {
            Kind::ClosedPipe => 0,
            kind => {
                printer.error(&error);
                if kind == Kind::Misuse { 2 } else { 1 }
            }
        },
    }
}

/// Help and version end with 0, misuse with 2.
fn show_usage(error: &clap::Error) -> u8 {
    // A closed pipe is no reason to complain about help that nobody reads.
    let _ = error.print();
    if error.use_stderr() { 2 } else { 0 }
}
