//! What can be typed after `prf plot`, `prf report` and `prf runs`.

use std::path::PathBuf;

use clap::builder::{PathBufValueParser, TypedValueParser};
use clap::{Args, ValueEnum};

use super::{FORMAT_HELP, ending_in};
use crate::printer::Format;

pub(super) const PLOT_HELP: &str = "\
Runs whose configs differ by nothing but the seed are one curve: their interquartile mean or mean on a common grid, from where the last of
them begins to where the first of them ends, with 95% intervals by bootstrapping over the seeds. A single run is drawn as it is.
Dashed lines are the mean scores of the world's best player (the oracle) in the episodes of the evaluations, and of a random one in 100.
Records that cannot be read are named on stderr and left out: exit code 3.";

pub(super) const REPORT_HELP: &str = "\
The page needs no network, no scripts and no other file. Its claims are checked from the runs' records, and one that does not hold is shown
as such. The agent plays the first episode of `prf eval`.";

#[derive(Debug, Args)]
pub(crate) struct PlotArgs {
    /// Folders of runs, of one world
    #[arg(required = true, value_name = "RUN")]
    pub(crate) runs: Vec<PathBuf>,
    /// The picture to write, .svg or .png [default: curves.svg; none with --format json]
    #[arg(long, short, value_name = "FILE", value_parser = svg_or_png())]
    pub(crate) out: Option<PathBuf>,
    /// What the curves show
    #[arg(long, value_enum, default_value_t = Quantity::Score)]
    pub(crate) y: Quantity,
    /// What they show it over
    #[arg(long, value_enum, default_value_t = Place::Steps)]
    pub(crate) x: Place,
    /// What several seeds come to
    #[arg(long, value_enum, default_value_t = Aggregate::Iqm)]
    pub(crate) aggregate: Aggregate,
    #[arg(long, value_enum, default_value_t = Format::Text, help = FORMAT_HELP)]
    pub(crate) format: Format,
}

#[derive(Debug, Args)]
pub(crate) struct ReportArgs {
    /// Folders of runs, of one world
    #[arg(required = true, value_name = "RUN")]
    pub(crate) runs: Vec<PathBuf>,
    /// The page to write
    #[arg(long, short, value_name = "FILE.html", default_value = "report.html", value_parser = ending_in("html"))]
    pub(crate) out: PathBuf,
}

#[derive(Debug, Args)]
pub(crate) struct RunsArgs {
    /// The folder to look into, with all that are in it
    #[arg(value_name = "DIR", default_value = "runs")]
    pub(crate) folder: PathBuf,
    #[arg(long, value_enum, default_value_t = Format::Text, help = FORMAT_HELP)]
    pub(crate) format: Format,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Quantity {
    /// Mean score of the greedy evaluations
    Score,
    /// Mean sum of rewards of the greedy evaluations
    Reward,
    /// Mean length of the greedy evaluations' episodes
    Length,
    /// Mean score of the training episodes
    TrainScore,
    /// Mean sum of rewards of the training episodes
    TrainReward,
    /// Mean loss of the updates
    Loss,
    /// Exploration ε
    Epsilon,
    /// Training steps a second
    Speed,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Place {
    /// Steps of training, over all environments
    Steps,
    /// Finished training episodes
    Episodes,
    /// Time of training, without interruptions
    Time,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Aggregate {
    /// Interquartile mean: of the middle half of the runs; of up to three runs, all
    Iqm,
    /// Arithmetic mean
    Mean,
}

fn svg_or_png() -> impl TypedValueParser<Value = PathBuf> {
    PathBufValueParser::new().try_map(|path: PathBuf| {
        let known = |ending: &std::ffi::OsStr| ["svg", "png"].iter().any(|known| ending.eq_ignore_ascii_case(known));
        if path.extension().is_some_and(known) { Ok(path) } else { Err("expected a name that ends in .svg or .png") }
    })
}
