//! `prf eval`: the greedy policy of a run, measured against the best and the worst player there is.

use std::path::{Path, PathBuf};

use prf_core::Frame;
use prf_dqn::checkpoint::{CheckpointStore, MODEL_FILE};
use prf_dqn::evaluate::{Episode, Spread, episode_seeds, play_greedily};
use prf_dqn::files::write_whole;
use prf_dqn::learner::greedy_actions;
use prf_dqn::network::QNetwork;
use prf_dqn::run_dir::RunDir;
use prf_envs::players::{Oracle, Random, mean_score};
use prf_envs::{Status, Task, registry};
use serde::Serialize;

use super::learning;
use crate::ExitStatus;
use crate::args::EvalArgs;
use crate::error::{CliError, Result};
use crate::gif::GreyGif;
use crate::printer::{Format, Printer};
use crate::settings::{LoadedRun, load_run};

/// Episodes stepped together.
const TOGETHER: usize = 64;
/// Side of a pixel of the world in a rendered picture.
const RENDER_SCALE: usize = 4;
/// Frames a second in a rendered picture.
const RENDER_FPS: u32 = 15;

#[derive(Debug, Serialize)]
struct Report {
    model: String,
    episodes: usize,
    seed: u64,
    mean_score: f64,
    std_score: f64,
    mean_reward: f64,
    mean_steps: f64,
    oracle_score: f64,
    random_score: f64,
}

pub(crate) fn run(args: &EvalArgs, printer: &mut Printer) -> Result<ExitStatus> {
    let (run, model_path) = find_model(&args.run)?;
    let loaded = load_run(&run.config_path(), &[], None)?;
    let device = learning::open_device(args.device)?;
    let network = learning::load_network(&loaded, &model_path, device)?;

    let seed = args.seed.unwrap_or(0);
    let seeds = episode_seeds(seed, "eval", args.episodes as usize);
    let episodes = measure(&network, &loaded, &seeds)?;
    let mut world = registry::make(&loaded.config.env)?;
    let score = Spread::of(episodes.iter().map(|episode| f64::from(episode.score)));
    let report = Report {
        model: model_path.display().to_string(),
        episodes: episodes.len(),
        seed,
        mean_score: score.mean,
        std_score: score.std,
        mean_reward: Spread::of(episodes.iter().map(|episode| episode.reward)).mean,
        mean_steps: Spread::of(episodes.iter().map(|episode| f64::from(episode.steps))).mean,
        oracle_score: mean_score(world.as_mut(), &mut Oracle, seeds.iter().copied())?,
        random_score: mean_score(world.as_mut(), &mut Random::new(), seeds.iter().copied())?,
    };
    print(&report, printer)?;
    if let Some(path) = &args.render {
        render(&network, &loaded, seeds[0], path)?;
        printer.note(format!("drew the first episode into {}", path.display()));
    }
    Ok(ExitStatus::Done)
}

/// The run folder and the model file that `path` (a run, one of its checkpoints or a model file) stands for.
fn find_model(path: &Path) -> Result<(RunDir, PathBuf)> {
    let model = if path.is_file() {
        path.to_owned()
    } else if path.join(MODEL_FILE).is_file() {
        path.join(MODEL_FILE)
    } else if let Some(newest) = CheckpointStore::list(path)?.pop() {
        newest.join(MODEL_FILE)
    } else {
        let message = format!("there is no run with a checkpoint in {}", path.display());
        return Err(CliError::misuse(message)
            .hint("name the folder that `prf train` printed, or one of its checkpoints")
            .into());
    };
    let model = std::fs::canonicalize(&model).unwrap_or(model);
    let run = model.ancestors().skip(1).find(|folder| folder.join("config.toml").is_file());
    let run = run.ok_or_else(|| {
        CliError::misuse(format!("no folder above {} has the run's config.toml", model.display()))
            .hint("leave the checkpoint in its run's folder")
    })?;
    Ok((RunDir::at(run), model))
}

/// Plays every episode to its end, some at a time.
fn measure(network: &QNetwork, loaded: &LoadedRun, seeds: &[u64]) -> prf_dqn::Result<Vec<Episode>> {
    let task = loaded.config.task();
    let make = || Ok(Task::new(&task, loaded.goal.as_ref())?);
    let mut tasks = (0..seeds.len().min(TOGETHER)).map(|_| make()).collect::<prf_dqn::Result<Vec<_>>>()?;
    let mut episodes = Vec::with_capacity(seeds.len());
    for seeds in seeds.chunks(TOGETHER) {
        episodes.extend(play_greedily(
            &mut tasks,
            seeds,
            |states, count| network.q_values(states, count),
            &mut |_, _| {},
        )?);
    }
    Ok(episodes)
}

/// Plays one episode into an animated GIF.
fn render(network: &QNetwork, loaded: &LoadedRun, seed: u64, path: &Path) -> Result<()> {
    let mut task = Task::new(&loaded.config.task(), loaded.goal.as_ref())?;
    let actions = task.spec().actions.len();
    let (width, height) = (task.spec().width * RENDER_SCALE, task.spec().height * RENDER_SCALE);
    let mut frame = Frame::new(width, height);
    let mut gif = GreyGif::new(width, height, RENDER_FPS)?;
    task.reset(seed);
    let mut status = Status::Running;
    loop {
        task.environment().draw_into(&mut frame);
        gif.add(frame.view())?;
        if status.is_over() {
            break;
        }
        let values = network.q_values(task.observation(), 1)?;
        for action in greedy_actions(&values, actions) {
            status = task.step(action)?.status;
        }
    }
    write_whole(path, &gif.finish()?).map_err(|error| learning::explain(error.into(), None))
}

fn print(report: &Report, printer: &mut Printer) -> Result<()> {
    if printer.format() == Format::Json {
        return printer.record(report);
    }
    let Report { episodes, mean_score, std_score, mean_reward, mean_steps, oracle_score, random_score, .. } = report;
    printer.line(format!("{episodes} episodes of {}", report.model))?;
    printer.line(format!("  score   {mean_score:.2} ± {std_score:.2}"))?;
    printer.line(format!("  oracle  {oracle_score:.2}"))?;
    printer.line(format!("  random  {random_score:.2}"))?;
    printer.line(format!("  reward  {mean_reward:.2} an episode of {mean_steps:.1} steps"))
}
