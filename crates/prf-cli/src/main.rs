//! `prf`: train, evaluate and score rewards from pictures.

use std::process::ExitCode;

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
mod play;
mod plot;
mod printer;
#[cfg(feature = "train")]
mod progress;
mod settings;

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

impl From<ExitStatus> for ExitCode {
    fn from(status: ExitStatus) -> Self {
        Self::from(match status {
            ExitStatus::Done => 0,
            ExitStatus::FinishedWithLoss => 3,
            ExitStatus::Interrupted => 130,
        })
    }
}

fn main() -> ExitCode {
    let cli = match Cli::try_parse() {
        Ok(cli) => cli,
        Err(error) => return show_usage(&error),
    };
    let mut printer = Printer::new(cli.command.format());
    match commands::run(cli.command, &mut printer) {
        Ok(status) => status.into(),
        Err(error) => match error::kind(&error) {
            Kind::ClosedPipe => ExitCode::SUCCESS,
            kind => {
                printer.error(&error);
                ExitCode::from(if kind == Kind::Misuse { 2 } else { 1 })
            }
        },
    }
}

/// Help and version end with 0, misuse with 2.
fn show_usage(error: &clap::Error) -> ExitCode {
    // A closed pipe is no reason to complain about help that nobody reads.
    let _ = error.print();
    ExitCode::from(if error.use_stderr() { 2 } else { 0 })
}
