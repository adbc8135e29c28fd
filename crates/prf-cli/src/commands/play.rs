//! `prf play`: a world played by a person, or by a player that comes with it, and recorded.

use prf_core::{DescriptorKind, MotionParams};
use prf_envs::players::{Oracle, Player, Random};
use prf_envs::{Controls, EnvConfig, Status, registry};
use serde::Serialize;

use super::goal::warn_of;
use crate::ExitStatus;
use crate::args::{PlayArgs, PlayerArg};
use crate::error::{CliError, Result};
use crate::interrupt::Interrupt;
use crate::play::live::{self, Ending};
use crate::play::outputs;
use crate::play::recorder::{GifPlan, Plan, Recorder, Recording};
use crate::play::session::{Episode, Session};
use crate::play::unseen;
use crate::printer::{Format, Printer};
use crate::settings::motion_params;

/// Steps a second where the world goes on by itself, and where it waits for each action.
const REAL_TIME_FPS: u32 = 15;
const TURN_BASED_FPS: u32 = 4;

#[derive(Debug, Serialize)]
struct Report<'a> {
    world: &'a str,
    player: &'static str,
    seed: u64,
    steps: u32,
    score: f32,
    reward: f64,
    ending: &'static str,
}

pub(crate) fn run(args: &PlayArgs, printer: &mut Printer) -> Result<ExitStatus> {
    if args.player == PlayerArg::You && !live::is_there() {
        return Err(CliError::misuse("you can only play in a terminal: got an input or an output that is none")
            .hint("let another player play: --player oracle, or --player random")
            .into());
    }
    let plan = plan(args)?;
    outputs::refuse_occupied(&args.recordings)?;
    let config = EnvConfig::new(&args.world);
    let limit_steps = args.steps.unwrap_or(config.limit_steps);
    let world = registry::make(&EnvConfig { limit_steps, ..config })?;
    let mut session = Session::new(world, Recorder::new(plan), args.seed);

    // Whatever happens, what was recorded until then is not lost.
    let ending = play(args, &mut session);
    let (episode, recording) = session.finish()?;
    let written = write(args, recording, printer);
    let ending = ending?;
    report(args, episode, printer)?;
    written?;
    Ok(if ending == Ending::Interrupted { ExitStatus::Interrupted } else { ExitStatus::Done })
}

fn plan(args: &PlayArgs) -> Result<Plan> {
    let recordings = &args.recordings;
    let gif = GifPlan { scale: recordings.scale as usize, frames_per_second: frames_per_second(args) };
    let motion = motion_params(MotionParams::default(), &args.motion)?;
    Ok(Plan {
        gif: recordings.gif.as_ref().map(|_| gif),
        frames: recordings.frames.is_some(),
        motion: recordings.motion_goal.as_ref().map(|_| motion),
    })
}

fn frames_per_second(args: &PlayArgs) -> u32 {
    let is_real_time = controls(args).pace.is_real_time();
    args.fps.unwrap_or(if is_real_time { REAL_TIME_FPS } else { TURN_BASED_FPS })
}

fn controls(args: &PlayArgs) -> Controls {
    registry::controls(&args.world).expect("only worlds of the registry can be typed")
}

fn play(args: &PlayArgs, session: &mut Session) -> Result<Ending> {
    let interrupt = Interrupt::listen()?;
    let player: Option<Box<dyn Player>> = match args.player {
        PlayerArg::You => None,
        PlayerArg::Oracle => Some(Box::new(Oracle)),
        PlayerArg::Random => Some(Box::new(Random::new())),
    };
    let is_shown = live::is_there() && !args.recordings.is_asked_for() && args.format == Format::Text;
    match player {
        Some(mut player) if !is_shown => {
            unseen::play(session, player.as_mut(), &interrupt)?;
            Ok(if interrupt.came() { Ending::Interrupted } else { Ending::Quit })
        }
        player => live::play(session, player, controls(args), frames_per_second(args), &interrupt),
    }
}

/// Writes what was recorded, and says so.
fn write(args: &PlayArgs, recording: Option<Recording>, printer: &mut Printer) -> Result<()> {
    if !args.recordings.is_asked_for() {
        return Ok(());
    }
    let Some(recording) = recording else {
        printer.note("no step was taken, so nothing was recorded");
        return Ok(());
    };
    // What fails in one place must not keep the others from being written.
    let mut failure = Ok(());
    for written in outputs::write(&recording, &args.recordings) {
        match written {
            Ok(words) => printer.note(words),
            Err(error) if failure.is_ok() => failure = Err(error),
            Err(error) => printer.error(&error),
        }
    }
    if let Some(motion) = recording.motion {
        warn_of(motion, DescriptorKind::Motion, printer);
    }
    failure
}

fn report(args: &PlayArgs, episode: Episode, printer: &mut Printer) -> Result<()> {
    let Episode { seed, steps, score, reward, status, .. } = episode;
    let (world, player) = (args.world.as_str(), args.player.name());
    let ending = match status {
        Status::Running => "stopped",
        Status::Terminated => "terminated",
        Status::Truncated => "truncated",
    };
    if printer.format() == Format::Json {
        return printer.record(&Report { world, player, seed, steps, score, reward, ending });
    }
    printer.line(format!("{world}, seed {seed}, played by {player}"))?;
    printer.line(format!("  score   {score}"))?;
    printer.line(format!("  reward  {reward:.2}"))?;
    printer.line(format!("  steps   {steps}, {ending}"))
}
