//! `prf completions`: a completion script for a shell.

use clap::CommandFactory as _;

use crate::ExitStatus;
use crate::args::{Cli, CompletionsArgs};
use crate::error::Result;
use crate::printer::Printer;

pub(crate) fn run(args: &CompletionsArgs, printer: &mut Printer) -> Result<ExitStatus> {
    // Written to memory first: the generator panics when its output cannot be written.
    let mut script = Vec::new();
    clap_complete::generate(args.shell, &mut Cli::command(), "prf", &mut script);
    printer.bytes(&script)?;
    Ok(ExitStatus::Done)
}
