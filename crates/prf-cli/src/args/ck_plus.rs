//! `prf goal ck-plus`: a sequence of the Extended Cohn-Kanade data set.

use std::path::PathBuf;

use clap::Args;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use prf_core::io::ck_plus::Emotion;

use super::{FORMAT_HELP, GoalOut, MotionOptions};
use crate::printer::Format;

const HELP: &str = "\
ROOT is the folder of a licence holder: cohn-kanade-images/S005/001/S005_001_00000001.png and so on, and beside it, for --emotion, \
Emotion/S005/001/S005_001_00000011_emotion.txt. The motion options' defaults are the paper's for people. docs/sequences.md has more.";

#[derive(Debug, Args)]
#[command(after_help = HELP)]
pub(crate) struct CkPlusArgs {
    /// The folder that holds cohn-kanade-images and Emotion
    pub(crate) root: PathBuf,
    /// Only sequences with this label
    #[arg(long, value_parser = emotion())]
    pub(crate) emotion: Option<Emotion>,
    /// Only sequences of this subject, such as S005
    #[arg(long)]
    pub(crate) subject: Option<String>,
    /// Only sequences of this session, such as 001
    #[arg(long)]
    pub(crate) session: Option<String>,
    /// Print the sequences that fit, and make nothing
    #[arg(long, conflicts_with_all = ["out", "force", "skip_damaged"])]
    pub(crate) list: bool,
    #[command(flatten)]
    pub(crate) out: GoalOut,
    /// Leave out frames that cannot be read: exit code 3
    #[arg(long)]
    pub(crate) skip_damaged: bool,
    #[arg(long, value_enum, default_value_t = Format::Text, help = FORMAT_HELP)]
    pub(crate) format: Format,
    #[command(flatten)]
    pub(crate) motion: MotionOptions,
}

fn emotion() -> impl TypedValueParser<Value = Emotion> {
    PossibleValuesParser::new(Emotion::ALL.map(Emotion::name)).map(|name| {
        let known = Emotion::ALL.into_iter().find(|emotion| emotion.name() == name);
        known.expect("no other value is possible")
    })
}
