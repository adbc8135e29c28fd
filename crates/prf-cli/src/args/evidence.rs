//! `prf inspect` and `prf tune`: what a reward is judged by.

use std::path::PathBuf;

use clap::Args;

use super::{FORMAT_HELP, RewardArgs, ending_in};
use crate::printer::Format;

pub(super) const HELP: &str = "\
A reward is judged by what is known of frames, whichever there is:
  a world        the [env] of a config: frames of a random, a clumsy and the best player, with their scores
  --scores FILE  a CSV beside the frames, a line for each in their order, or found by a column `frame` (a file's name, or the number
                 from 0 of an animation's or a video's frame): `score`, the higher the better, and `success`, 1 or 0; either may be empty
  --demo         each source of frames is a demonstration that ends at the goal
  the goal alone its things are displaced, taken away, scaled and covered, and noise is added: a good reward falls steadily
                 with displacement, and gives less for an absent thing than for a displaced one
docs/tuning.md explains the figures. Frames that cannot be read are named on stderr and left out: exit code 3.";

#[derive(Debug, Args)]
pub(crate) struct EvidenceArgs {
    /// A config (ending in .toml) with a perceptual reward, or a goal as for `prf score`
    #[arg(value_name = "CONFIG|GOAL")]
    pub(crate) subject: PathBuf,
    /// Frames to judge by: pictures, folders of them, animations, videos
    #[arg(value_name = "FRAME")]
    pub(crate) frames: Vec<PathBuf>,
    /// What is known of the frames: a CSV with the columns score, success or both
    #[arg(long, value_name = "FILE.csv", requires = "frames", conflicts_with = "demo")]
    pub(crate) scores: Option<PathBuf>,
    /// The frames are demonstrations, one a source, that end at the goal
    #[arg(long, requires = "frames")]
    pub(crate) demo: bool,
    /// Judge by nothing but the goal, also where a config names a world
    #[arg(long, conflicts_with = "frames")]
    pub(crate) goal_only: bool,
    /// Frames of at least this score are successes
    #[arg(long, value_name = "SCORE", allow_negative_numbers = true, value_parser = parse_score, conflicts_with_all = ["demo", "goal_only"])]
    pub(crate) success_at: Option<f64>,
    /// Judge by up to this many frames, spread evenly
    #[arg(long, value_name = "N", default_value_t = 1000, value_parser = clap::value_parser!(u32).range(50..=100_000))]
    pub(crate) sample: u32,
    /// The seed of the world's episodes
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub(crate) seed: u64,
    /// Refuse sources of more frames than this
    #[arg(long, value_name = "N", default_value_t = 100_000)]
    pub(crate) max_frames: u64,
    /// Draw the frames of the highest and the lowest rewards side by side
    #[arg(long, value_name = "FILE.png", value_parser = ending_in("png"))]
    pub(crate) picture: Option<PathBuf>,
    #[arg(long, value_enum, default_value_t = Format::Text, help = FORMAT_HELP)]
    pub(crate) format: Format,
}

#[derive(Debug, Args)]
pub(crate) struct InspectArgs {
    #[command(flatten)]
    pub(crate) evidence: EvidenceArgs,
    /// Draw the rewards over what is known of the frames
    #[arg(long, value_name = "FILE.svg", value_parser = ending_in("svg"))]
    pub(crate) plot: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) reward: RewardArgs,
}

#[derive(Debug, Args)]
pub(crate) struct TuneArgs {
    #[command(flatten)]
    pub(crate) evidence: EvidenceArgs,
    /// Window: the picture that the goal was cut out of; windows larger than the goal are tried, too
    #[arg(long, value_name = "FILE.png")]
    pub(crate) screen: Option<PathBuf>,
    /// Write the recommended [reward] to a file, and a new window's picture beside it
    #[arg(long, value_name = "FILE.toml", value_parser = ending_in("toml"))]
    pub(crate) out: Option<PathBuf>,
    /// Write over files that are there already
    #[arg(long, requires = "out")]
    pub(crate) force: bool,
    /// Draw tables of all settings
    #[arg(long, value_name = "FILE.svg", value_parser = ending_in("svg"))]
    pub(crate) plot: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) reward: RewardArgs,
}

fn parse_score(text: &str) -> Result<f64, String> {
    let score = text.parse().ok().filter(|score: &f64| score.is_finite());
    score.ok_or_else(|| "expected a number".to_owned())
}
