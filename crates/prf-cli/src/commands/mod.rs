//! The commands, one file each.

use crate::ExitStatus;
use crate::args::Command;
use crate::error::Result;
use crate::printer::Printer;

mod completions;
#[cfg(feature = "train")]
mod eval;
mod goal;
pub(crate) mod init;
mod inspect;
#[cfg(feature = "train")]
pub(crate) mod learning;
mod play;
#[cfg(feature = "train")]
mod plot;
#[cfg(feature = "train")]
mod report;
#[cfg(feature = "train")]
mod runs;
mod score;
#[cfg(feature = "train")]
mod train;
mod tune;
mod worlds;

/// Does what the command line asks for.
pub(crate) fn run(command: Command, printer: &mut Printer) -> Result<ExitStatus> {
    match command {
        #[cfg(feature = "train")]
        Command::Train(args) => train::run(&args, printer),
        #[cfg(feature = "train")]
        Command::Eval(args) => eval::run(&args, printer),
        #[cfg(feature = "train")]
        Command::Runs(args) => runs::run(&args, printer),
        #[cfg(feature = "train")]
        Command::Plot(args) => plot::run(&args, printer),
        #[cfg(feature = "train")]
        Command::Report(args) => report::run(&args, printer),
        #[cfg(not(feature = "train"))]
        Command::Train(_) | Command::Eval(_) | Command::Runs(_) | Command::Plot(_) | Command::Report(_) => {
            Err(without_training())
        }
        Command::Score(args) => score::run(&args, printer),
        Command::Goal(args) => goal::run(&args, printer),
        Command::Inspect(args) => inspect::run(&args, printer),
        Command::Tune(args) => tune::run(&args, printer),
        Command::Init(args) => init::run(&args, printer),
        Command::Worlds(_) => worlds::run(printer),
        Command::Play(args) => play::run(&args, printer),
        Command::Completions(args) => completions::run(&args, printer),
    }
}

#[cfg(not(feature = "train"))]
fn without_training() -> anyhow::Error {
    crate::error::CliError::failed("this prf was built without training, as the Python package's is")
        .hint(
            "for `train`, `eval`, `runs`, `plot` and `report`, install the command with `cargo xtask setup && cargo install --path \
             crates/prf-cli` in a clone of PRF's repository",
        )
        .into()
}
