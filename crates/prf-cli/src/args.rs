//! What can be typed after `prf`: clap's types and nothing else.

use std::net::{SocketAddr, ToSocketAddrs};
use std::path::PathBuf;

use clap::builder::{PathBufValueParser, TypedValueParser};
use clap::{Args, Parser, Subcommand, ValueEnum};
use clap_complete::Shell;
use prf_core::{DescriptorKind, DistanceScale, MatchMethod, Norm, Rect};

use crate::commands::init::Preset;
use crate::printer::Format;

pub(crate) use self::ck_plus::CkPlusArgs;
pub(crate) use self::evidence::{EvidenceArgs, InspectArgs, TuneArgs};
pub(crate) use self::play::{PlayArgs, PlayerArg, RecordingArgs, WorldsArgs};
#[cfg(feature = "train")]
pub(crate) use self::runs::{Aggregate, Place, Quantity};
pub(crate) use self::runs::{PlotArgs, ReportArgs, RunsArgs};

mod ck_plus;
mod evidence;
mod play;
mod runs;

const EXIT_CODES: &str = "\
Exit codes: 0 done, 1 failed, 2 wrong arguments or config, 3 finished but some input was lost, \
130 interrupted with what was done saved.";

const SCORE_EXIT_CODES: &str = "\
Pictures that cannot be read are named on stderr and left out: exit code 3 if others could be scored, \
1 if none could or if the goal itself cannot be read.";

/// Show an agent a picture of the finished task; it learns to get there.
#[derive(Debug, Parser)]
#[command(name = "prf", version, after_help = EXIT_CODES)]
pub(crate) struct Cli {
    #[command(subcommand)]
    pub(crate) command: Command,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Train an agent as a config file says
    Train(TrainArgs),
    /// Play episodes with the greedy policy of a run or a checkpoint
    Eval(EvalArgs),
    /// List the runs in a folder: how far each has come, how good it is, and how to go on with it
    Runs(RunsArgs),
    /// Draw the learning curves of runs and seeds, with 95% intervals
    #[command(after_help = runs::PLOT_HELP)]
    Plot(PlotArgs),
    /// Write one page about runs: claims, curves, the agent playing, and what the reward ranks best and worst
    #[command(after_help = runs::REPORT_HELP)]
    Report(ReportArgs),
    /// Score pictures, animations or videos against a goal
    #[command(after_help = SCORE_EXIT_CODES)]
    Score(ScoreArgs),
    /// Make a goal: a part of a picture, a picture with something put into it, or the template of a movement
    #[command(subcommand_required = true, arg_required_else_help = true)]
    Goal(GoalArgs),
    /// Is this reward any good? Best and worst frames, rank correlation, spread
    #[command(after_help = evidence::HELP)]
    Inspect(InspectArgs),
    /// Which window, cells and norm make the reward good; writes a [reward] for `prf train` and `prf score`
    #[command(after_help = evidence::HELP)]
    Tune(TuneArgs),
    /// Write a config file to start from, with its goal picture
    Init(InitArgs),
    /// List the worlds: their actions, sizes, limits, and what the best and a random player score
    Worlds(WorldsArgs),
    /// Play a world in the terminal, or watch a player; record a GIF, frames, or the goal of a movement
    #[command(after_help = play::HELP)]
    Play(PlayArgs),
    /// Print a completion script for a shell
    Completions(CompletionsArgs),
}

impl Command {
    /// How this command's results are to be written to stdout.
    pub(crate) fn format(&self) -> Format {
        match self {
            Self::Eval(args) => args.format,
            Self::Score(args) => args.format,
            Self::Inspect(args) => args.evidence.format,
            Self::Tune(args) => args.evidence.format,
            Self::Goal(GoalArgs { command: GoalCommand::CkPlus(args) }) => args.format,
            Self::Worlds(args) => args.format,
            Self::Play(args) => args.format,
            Self::Runs(args) => args.format,
            Self::Plot(args) => args.format,
            Self::Train(_) | Self::Report(_) | Self::Goal(_) | Self::Init(_) | Self::Completions(_) => Format::Text,
        }
    }
}

#[derive(Debug, Args)]
pub(crate) struct TrainArgs {
    /// The config file (`prf init breakout` writes one)
    pub(crate) config: PathBuf,
    /// The run's folder [default: runs/<config>-<seed>]
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    /// The seed everything random derives from, instead of the config's
    #[arg(long, value_name = "N")]
    pub(crate) seed: Option<u64>,
    /// What computes the network
    #[arg(long, value_enum, default_value_t = Device::Cpu)]
    pub(crate) device: Device,
    /// Change one key of the config, as in `--set train.steps=1000`; paths are relative to the
    /// current folder
    #[arg(long, value_name = "KEY.PATH=VALUE")]
    pub(crate) set: Vec<String>,
    /// Go on with the run in the folder
    #[arg(long)]
    pub(crate) resume: bool,
    /// Serve what is recorded to Foxglove while the run goes on
    #[arg(
        long,
        value_name = "HOST:PORT",
        num_args = 0..=1,
        default_missing_value = "127.0.0.1:8765",
        value_parser = parse_address
    )]
    pub(crate) live: Option<SocketAddr>,
    /// Print the complete config, the memory and the time it needs, and start nothing
    #[arg(long)]
    pub(crate) dry_run: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Device {
    Cpu,
    /// An NVIDIA GPU
    Cuda,
    /// The GPU of an Apple computer
    Mps,
}

#[derive(Debug, Args)]
pub(crate) struct EvalArgs {
    /// The run's folder, or one of its checkpoints
    pub(crate) run: PathBuf,
    /// How many episodes to play
    #[arg(long, value_name = "N", default_value_t = 100, value_parser = clap::value_parser!(u32).range(1..))]
    pub(crate) episodes: u32,
    /// The seed of the episodes [default: 0]; none of them is trained or evaluated on during a run
    #[arg(long, value_name = "N")]
    pub(crate) seed: Option<u64>,
    /// What computes the network
    #[arg(long, value_enum, default_value_t = Device::Cpu)]
    pub(crate) device: Device,
    /// Draw the first episode into a moving picture
    #[arg(long, value_name = "FILE.gif")]
    pub(crate) render: Option<PathBuf>,
    #[arg(long, value_enum, default_value_t = Format::Text, help = FORMAT_HELP)]
    pub(crate) format: Format,
}

const FORMAT_HELP: &str = "How results are written: for people, or one JSON object a line";

#[derive(Debug, Args)]
pub(crate) struct ScoreArgs {
    /// A picture of the finished task, of a part of it (--descriptor window), or a sequence that shows
    /// the movement (--descriptor motion)
    pub(crate) goal: PathBuf,
    /// What to score: pictures, folders of them, animations, videos
    #[arg(required = true, value_name = "FRAME")]
    pub(crate) frames: Vec<PathBuf>,
    /// Draw what was compared and what differs; of several frames, the last
    #[arg(long, value_name = "FILE.png")]
    pub(crate) explain: Option<PathBuf>,
    /// Draw the reward over frames, or over time where all frames have one; unreadable frames are gaps
    #[arg(long, value_name = "FILE.svg", value_parser = ending_in("svg"))]
    pub(crate) plot: Option<PathBuf>,
    /// Refuse sources of more frames than this
    #[arg(long, value_name = "N", default_value_t = 100_000)]
    pub(crate) max_frames: u64,
    #[arg(long, value_enum, default_value_t = Format::Text, help = FORMAT_HELP)]
    pub(crate) format: Format,
    // Last, because its heading holds for all that follows.
    #[command(flatten)]
    pub(crate) reward: RewardArgs,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum DescriptorArg {
    /// The whole frame with the whole goal
    Direct,
    /// The part of the frame that matches the goal best with the goal
    Window,
    /// What has moved in the frames so far with what moves in the goal
    Motion,
}

impl From<DescriptorArg> for DescriptorKind {
    fn from(descriptor: DescriptorArg) -> Self {
        match descriptor {
            DescriptorArg::Direct => Self::Direct,
            DescriptorArg::Window => Self::Window,
            DescriptorArg::Motion => Self::Motion,
        }
    }
}

#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum MethodArg {
    /// Normalised correlation
    CcorrNormed,
    /// Normalised correlation of what differs from the mean
    CcoeffNormed,
}

impl From<MethodArg> for MatchMethod {
    fn from(method: MethodArg) -> Self {
        match method {
            MethodArg::CcorrNormed => Self::CcorrNormed,
            MethodArg::CcoeffNormed => Self::CcoeffNormed,
        }
    }
}

#[derive(Clone, Debug, Args)]
#[command(next_help_heading = "Reward options")]
pub(crate) struct RewardArgs {
    /// Take the reward's settings from a config file's [reward]; the options below change single ones
    #[arg(long, value_name = "FILE")]
    pub(crate) config: Option<PathBuf>,
    /// How frame and goal are compared [default: direct]
    #[arg(long, value_enum)]
    pub(crate) descriptor: Option<DescriptorArg>,
    /// Side of a HOG cell, as a fraction of the cropped picture's height [default: 0.03; window 0.1, motion 0.05]
    #[arg(long, value_name = "FRACTION", conflicts_with = "cell_px", allow_negative_numbers = true)]
    pub(crate) cell: Option<f32>,
    /// Side of a HOG cell, in pixels
    #[arg(long, value_name = "PX")]
    pub(crate) cell_px: Option<usize>,
    /// Number of edge directions told apart [default: 9]
    #[arg(long, value_name = "N")]
    pub(crate) orientations: Option<usize>,
    /// Tell an edge from dark to light from one from light to dark
    #[arg(long, value_name = "BOOL", num_args = 0..=1, require_equals = true, default_missing_value = "true")]
    pub(crate) signed: Option<bool>,
    /// Cells a side of the blocks that are normalised together [default: 1]
    #[arg(long, value_name = "N")]
    pub(crate) block_cells: Option<usize>,
    /// How a block is normalised [default: l2]
    #[arg(long, value_enum)]
    pub(crate) norm: Option<NormArg>,
    /// What the distance is divided by before exp(-D) [default: sqrt-blocks]
    #[arg(long, value_enum)]
    pub(crate) scale: Option<ScaleArg>,
    /// Window: what makes a part of the frame the best match [default: ccorr-normed]
    #[arg(long, value_enum)]
    pub(crate) method: Option<MethodArg>,
    /// Window: a picture of the goal's size, black where the goal does not count
    #[arg(long, value_name = "FILE")]
    pub(crate) mask: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) motion: MotionOptions,
}

#[derive(Clone, Debug, Args)]
#[command(next_help_heading = "Motion options")]
pub(crate) struct MotionOptions {
    /// A pixel that changes by more than this has moved, 0 to 254 [default: 30]
    #[arg(long, value_name = "LEVEL")]
    pub(crate) threshold: Option<u8>,
    /// The time τ of the first movement [default: 0.1]
    #[arg(long, value_name = "TAU", allow_negative_numbers = true)]
    pub(crate) tau_start: Option<f64>,
    /// How much τ grows with each frame; the paper takes 0.3 for people, 0.4 for robots [default: 0.4; goal ck-plus 0.3]
    #[arg(long, value_name = "TAU", allow_negative_numbers = true)]
    pub(crate) tau_step: Option<f64>,
    /// Movement is forgotten after (t + 1) / DIVISOR; the paper takes 4 for people, 3 for robots [default: 3; goal ck-plus 4]
    #[arg(long, value_name = "DIVISOR", allow_negative_numbers = true, conflicts_with = "duration")]
    pub(crate) delta_divisor: Option<f64>,
    /// Movement is forgotten after this much of τ
    #[arg(long, value_name = "TAU", allow_negative_numbers = true)]
    pub(crate) duration: Option<f64>,
    /// Pass over frames in which nothing has moved, so that pauses don't count
    #[arg(long, value_name = "BOOL", num_args = 0..=1, require_equals = true, default_missing_value = "true")]
    pub(crate) skip_still: Option<bool>,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum NormArg {
    None,
    L1,
    L1Sqrt,
    L2,
    /// L2, clipped at 0.2, and L2 again
    L2Hys,
}

impl From<NormArg> for Norm {
    fn from(norm: NormArg) -> Self {
        match norm {
            NormArg::None => Self::None,
            NormArg::L1 => Self::L1,
            NormArg::L1Sqrt => Self::L1Sqrt,
            NormArg::L2 => Self::L2,
            NormArg::L2Hys => Self::L2Hys,
        }
    }
}

#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum ScaleArg {
    /// 1: the paper's own formula
    None,
    /// The square root of the number of blocks
    SqrtBlocks,
    /// The square root of the number of HOG values
    SqrtFeatures,
}

impl From<ScaleArg> for DistanceScale {
    fn from(scale: ScaleArg) -> Self {
        match scale {
            ScaleArg::None => Self::None,
            ScaleArg::SqrtBlocks => Self::SqrtBlocks,
            ScaleArg::SqrtFeatures => Self::SqrtFeatures,
        }
    }
}

#[derive(Debug, Args)]
pub(crate) struct GoalArgs {
    #[command(subcommand)]
    pub(crate) command: GoalCommand,
}

#[derive(Debug, Subcommand)]
pub(crate) enum GoalCommand {
    /// Cut a part out of a picture
    Crop(CropArgs),
    /// Put a cut-out into a picture
    Paste(PasteArgs),
    /// Make the motion template of a folder of pictures, an animation or a video
    Motion(MotionArgs),
    /// Make the motion template of a face out of the Extended Cohn-Kanade data set (CK+)
    CkPlus(CkPlusArgs),
}

#[derive(Debug, Args)]
pub(crate) struct CropArgs {
    /// The picture, such as a screenshot
    pub(crate) picture: PathBuf,
    /// The part: left column, top row, width and height in pixels
    #[arg(long, value_name = "X,Y,WIDTH,HEIGHT", value_parser = parse_rect)]
    pub(crate) rect: Rect,
    #[command(flatten)]
    pub(crate) out: GoalOut,
}

#[derive(Debug, Args)]
pub(crate) struct PasteArgs {
    /// The picture, such as a screenshot
    pub(crate) picture: PathBuf,
    /// What to put into it; where it is transparent, the picture stays
    pub(crate) cut_out: PathBuf,
    /// Where the cut-out's left column and top row come to lie, in pixels
    #[arg(long, value_name = "X,Y", value_parser = parse_point)]
    pub(crate) at: [usize; 2],
    /// Cut this part out of the result: left column, top row, width and height
    #[arg(long, value_name = "X,Y,WIDTH,HEIGHT", value_parser = parse_rect)]
    pub(crate) crop: Option<Rect>,
    #[command(flatten)]
    pub(crate) out: GoalOut,
}

#[derive(Debug, Args)]
pub(crate) struct MotionArgs {
    /// The sequence: a folder of pictures, an animation or a video
    pub(crate) sequence: PathBuf,
    #[command(flatten)]
    pub(crate) out: GoalOut,
    /// Leave out frames that cannot be read: exit code 3
    #[arg(long)]
    pub(crate) skip_damaged: bool,
    #[command(flatten)]
    pub(crate) motion: MotionOptions,
}

#[derive(Debug, Args)]
pub(crate) struct GoalOut {
    /// The file to write, a PNG
    #[arg(long, value_name = "FILE.png", default_value = "goal.png")]
    pub(crate) out: PathBuf,
    /// Write over a file that is there already
    #[arg(long)]
    pub(crate) force: bool,
}

/// Programs go by the name's ending, so a file under another one would not open.
fn ending_in(expected: &'static str) -> impl TypedValueParser<Value = PathBuf> {
    PathBufValueParser::new().try_map(move |path: PathBuf| {
        let is_such = path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case(expected));
        if is_such { Ok(path) } else { Err(format!("expected a name that ends in .{expected}")) }
    })
}

fn parse_numbers<const N: usize>(text: &str, expected: &str) -> Result<[usize; N], String> {
    let numbers: Result<Vec<usize>, _> = text.split(',').map(|part| part.trim().parse()).collect();
    let numbers = numbers.ok().and_then(|numbers| numbers.try_into().ok());
    numbers.ok_or_else(|| format!("expected {expected}, as whole numbers of pixels"))
}

fn parse_point(text: &str) -> Result<[usize; 2], String> {
    parse_numbers(text, "X,Y")
}

fn parse_rect(text: &str) -> Result<Rect, String> {
    let [x, y, width, height] = parse_numbers(text, "X,Y,WIDTH,HEIGHT")?;
    if width == 0 || height == 0 {
        return Err("expected a width and a height of at least 1".to_owned());
    }
    Ok(Rect { x, y, width, height })
}

fn parse_address(text: &str) -> Result<SocketAddr, String> {
    let address = text.to_socket_addrs().ok().and_then(|mut found| found.next());
    address.ok_or_else(|| "expected a host of this machine and a port, as in 127.0.0.1:8765".to_owned())
}

#[derive(Debug, Args)]
pub(crate) struct InitArgs {
    /// Which config to write
    pub(crate) preset: Preset,
    /// The file to write (ending in .toml) or a folder for it [default: the current folder]
    #[arg(long, value_name = "PATH")]
    pub(crate) out: Option<PathBuf>,
    /// Write over files that are there already
    #[arg(long)]
    pub(crate) force: bool,
}

#[derive(Debug, Args)]
pub(crate) struct CompletionsArgs {
    /// The shell to complete for
    pub(crate) shell: Shell,
}
