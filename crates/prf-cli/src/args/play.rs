//! What can be typed after `prf worlds` and `prf play`.

use std::path::PathBuf;

use clap::builder::PossibleValuesParser;
use clap::{Args, ValueEnum};
use prf_envs::registry;

use super::{FORMAT_HELP, MotionOptions, ending_in};
use crate::printer::Format;

pub(crate) const HELP: &str = "\
Keys: the actions' own, listed beside the picture; q or Esc quits, r plays the episode again, n the next one, p pauses.
What is recorded is the last episode in which a step was taken, up to its end or to where you quit.";

#[derive(Debug, Args)]
pub(crate) struct WorldsArgs {
    #[arg(long, value_enum, default_value_t = Format::Text, help = FORMAT_HELP)]
    pub(crate) format: Format,
}

#[derive(Debug, Args)]
#[command(mut_group("MotionOptions", |options| options.requires("motion_goal")))]
pub(crate) struct PlayArgs {
    /// The world (`prf worlds` tells about each)
    #[arg(value_parser = PossibleValuesParser::new(registry::names()))]
    pub(crate) world: String,
    /// Who plays
    #[arg(long, value_enum, default_value_t = PlayerArg::You)]
    pub(crate) player: PlayerArg,
    /// The seed that decides what happens in the episode
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub(crate) seed: u64,
    /// Cut the episode off after this many steps [default: the world's own limit]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    pub(crate) steps: Option<u32>,
    /// Steps a second, on the screen and in the GIF [default: 15, or 4 where the world waits for each action]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=50))]
    pub(crate) fps: Option<u32>,
    #[arg(long, value_enum, default_value_t = Format::Text, help = FORMAT_HELP)]
    pub(crate) format: Format,
    #[command(flatten)]
    pub(crate) recordings: RecordingArgs,
    // Last, because its heading holds for all that follows.
    #[command(flatten)]
    pub(crate) motion: MotionOptions,
}

#[derive(Debug, Args)]
#[command(next_help_heading = "Recordings")]
pub(crate) struct RecordingArgs {
    /// Record the episode as a moving picture
    #[arg(long, value_name = "FILE.gif", value_parser = ending_in("gif"))]
    pub(crate) gif: Option<PathBuf>,
    /// How many times the world's own size the GIF is
    #[arg(long, value_name = "N", default_value_t = 4, requires = "gif", value_parser = clap::value_parser!(u32).range(1..=16))]
    pub(crate) scale: u32,
    /// Record the frames at the world's own size: 0000.png is the start, the others are numbered by their step
    #[arg(long, value_name = "DIR")]
    pub(crate) frames: Option<PathBuf>,
    /// Record the episode's motion template: a goal for --descriptor motion
    #[arg(long, value_name = "FILE.png", value_parser = ending_in("png"))]
    pub(crate) motion_goal: Option<PathBuf>,
    /// Write over recordings that are there already
    #[arg(long)]
    pub(crate) force: bool,
}

impl RecordingArgs {
    /// Whether anything is to be recorded.
    pub(crate) fn is_asked_for(&self) -> bool {
        self.gif.is_some() || self.frames.is_some() || self.motion_goal.is_some()
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum PlayerArg {
    /// You, in this terminal
    You,
    /// The world's own best player
    Oracle,
    /// Takes every action equally often
    Random,
}

impl PlayerArg {
    /// As it is typed.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::You => "you",
            Self::Oracle => "oracle",
            Self::Random => "random",
        }
    }
}
