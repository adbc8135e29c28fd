//! `prf train`: from a config to a trained agent in a run folder.

use std::path::{Path, PathBuf};

use clap::ValueEnum;
use prf_dqn::compute::Precision;
use prf_dqn::estimate::Estimate;
use prf_dqn::record::{Event, Recorder};
use prf_dqn::run_dir::{Manifest, RunDir};
use prf_dqn::trainer::{Ending, Trainer};

use super::learning;
use crate::ExitStatus;
use crate::args::{Device, TrainArgs};
use crate::error::{CliError, Result};
use crate::interrupt::Interrupt;
use crate::live::LiveServer;
use crate::printer::Printer;
use crate::progress::ProgressReporter;
use crate::settings::{LoadedRun, load_run};
use crate::shell::{quoted, shown};

/// Revision of the sources, when prf was built in a git checkout.
const GIT_REVISION: Option<&str> = option_env!("PRF_GIT_REVISION");

pub(crate) fn run(args: &TrainArgs, printer: &mut Printer) -> Result<ExitStatus> {
    let mut loaded = load_run(&args.config, &args.set, args.seed)?;
    if let Some(warning) = &loaded.warning {
        printer.warning(format_args!("the goal's sequence: {warning}"), Some(warning.hint()));
    }
    let device = learning::open_device(args.device)?;
    if args.dry_run {
        loaded.resolve_precision(device);
        return dry_run(&loaded, device, printer);
    }
    let live = serve(args, &loaded, printer)?;
    let (run, loaded) = open_run(args, loaded, device)?;
    let run = run.built_from(GIT_REVISION);
    let resume = resume_command(args, run.path());
    let (ending, trainer) = train(&run, loaded, device, args.resume, live, printer)
        .map_err(|error| learning::explain(error, Some(&resume)))?;
    if ending == Ending::Interrupted {
        printer.note(format!("interrupted; the run is saved, go on with\n  {resume}"));
        return Ok(ExitStatus::Interrupted);
    }
    let score = trainer.last_score().map_or(String::new(), |score| format!(" with a greedy score of {score:.2}"));
    printer.note(learning::time_line(&trainer.time()));
    printer.note(format!("finished{score}; see it play: prf eval {0} --render {0}/play.gif", shown(run.path())));
    printer.line(run.path().display())?;
    Ok(ExitStatus::Done)
}

/// Trains until the run is finished or interrupted.
fn train(
    run: &RunDir,
    loaded: LoadedRun,
    device: tch::Device,
    resumed: bool,
    live: Option<LiveServer>,
    printer: &mut Printer,
) -> Result<(Ending, Trainer)> {
    let seed = loaded.config.seed;
    let mut trainer = Trainer::open(loaded.config, loaded.goal.as_ref(), run, device)?;
    printer.note(format!(
        "seed {seed}, threads {}, replay memory up to {:.2} GB, run folder {}",
        trainer.threads(),
        trainer.replay_bytes() as f64 / 1e9,
        run.path().display()
    ));
    if trainer.steps() > 0 {
        printer.note(format!("going on from step {}", trainer.steps()));
    } else if resumed {
        printer.note("the run has no checkpoint yet: starting from its beginning");
    }
    for loss in trainer.losses() {
        printer.warning(loss, Some("what the run has learned is whole"));
    }
    let manifest = |trainer: &Trainer, finished| Manifest {
        prf_version: env!("CARGO_PKG_VERSION").to_owned(),
        git_revision: GIT_REVISION.map(str::to_owned),
        libtorch_version: prf_dqn::LIBTORCH_VERSION.to_owned(),
        machine: Some(prf_dqn::machine::describe()),
        seed,
        device: format!("{device:?}").to_lowercase(),
        threads: trainer.threads(),
        steps: trainer.steps(),
        finished,
        time: trainer.time(),
    };
    run.write_manifest(&manifest(&trainer, false))?;
    let mut watchers = Watchers { progress: ProgressReporter::new(), live };
    let interrupt = Interrupt::listen()?;
    let ending = trainer.run(&mut watchers, &|| interrupt.came());
    watchers.finish();
    let ending = ending?;
    run.write_manifest(&manifest(&trainer, ending == Ending::Finished))?;
    Ok((ending, trainer))
}

/// Who is told of a run while it goes on.
struct Watchers {
    progress: ProgressReporter,
    live: Option<LiveServer>,
}

impl Watchers {
    fn finish(self) {
        self.progress.finish();
        if let Some(live) = self.live {
            live.stop();
        }
    }
}

impl Recorder for Watchers {
    fn record(&mut self, event: &Event<'_>) -> prf_dqn::Result<()> {
        self.progress.record(event)?;
        self.live.as_mut().map_or(Ok(()), |live| live.record(event))
    }
}

/// Starts to serve, if that is wished for, before anything else is begun.
fn serve(args: &TrainArgs, loaded: &LoadedRun, printer: &mut Printer) -> Result<Option<LiveServer>> {
    let Some(address) = args.live else { return Ok(None) };
    let live = LiveServer::start(address, loaded.goal.as_ref())?;
    printer.note(format!("live in Foxglove: open the connection {}", live.url(address)));
    Ok(Some(live))
}

/// Prints what a run would be: its whole config as TOML, with the costs as comments.
fn dry_run(loaded: &LoadedRun, device: tch::Device, printer: &mut Printer) -> Result<ExitStatus> {
    let estimate = Estimate::of(&loaded.config, loaded.goal.as_ref(), device)
        .map_err(|error| learning::explain(error.into(), None))?;
    printer.line(toml::to_string(&loaded.config)?.trim_end())?;
    let up_to = if loaded.config.train.episodes.is_some() { "at most " } else { "about " };
    printer.line(format!("\n# replay memory: {:.2} GB when full", estimate.replay_bytes as f64 / 1e9))?;
    printer.line(format!("# steps: {up_to}{}", estimate.steps))?;
    printer.line(format!("# time on this machine: {up_to}{}", learning::duration(estimate.seconds)))?;
    Ok(ExitStatus::Done)
}

/// A new run folder, or with `--resume` the one that is there, which then brings its own config and goal.
fn open_run(args: &TrainArgs, mut loaded: LoadedRun, device: tch::Device) -> Result<(RunDir, LoadedRun)> {
    let path = args.out.clone().unwrap_or_else(|| default_folder(&args.config, loaded.config.seed));
    if !args.resume {
        loaded.resolve_precision(device);
        let run = RunDir::create(&path, &loaded.config, loaded.goal.as_ref())
            .map_err(|error| learning::explain(error.into(), None))?;
        return Ok((run, loaded));
    }
    let run = RunDir::at(&path);
    if !run.config_path().is_file() {
        let message = format!("there is no run to resume in {}: it has no config.toml", path.display());
        return Err(CliError::misuse(message)
            .hint("name the run's folder with --out, or start it without --resume")
            .into());
    }
    let mut own = load_run(&run.config_path(), &[], None)?;
    own.resolve_precision(device);
    // A run stays with what it began with, wherever it is resumed.
    if loaded.config.train.precision == Precision::Auto {
        loaded.config.train.precision = own.config.train.precision;
    }
    if loaded.config.without_paths() != own.config.without_paths() {
        let message =
            format!("{} was started with another config or seed than {}", path.display(), args.config.display());
        let hint = format!("resume it as it was: prf train {0}/config.toml --out {0} --resume", shown(&path));
        return Err(CliError::misuse(message).hint(hint).into());
    }
    Ok((run, own))
}

fn default_folder(config: &Path, seed: u64) -> PathBuf {
    let name = config.file_stem().unwrap_or_default().to_string_lossy();
    Path::new("runs").join(format!("{name}-{seed}"))
}

fn resume_command(args: &TrainArgs, run: &Path) -> String {
    let mut command = format!("prf train {} --out {} --resume", shown(&args.config), shown(run));
    if let Some(seed) = args.seed {
        command.push_str(&format!(" --seed {seed}"));
    }
    if let Some(device) = args.device.to_possible_value().filter(|_| args.device != Device::Cpu) {
        command.push_str(&format!(" --device {}", device.get_name()));
    }
    if let Some(address) = args.live {
        command.push_str(&format!(" --live {address}"));
    }
    for set in &args.set {
        command.push_str(&format!(" --set {}", quoted(set)));
    }
    command
}
