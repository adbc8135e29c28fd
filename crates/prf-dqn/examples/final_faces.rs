//! The faces that agents end with: how far each is from the target, and what moved against the neutral face.
//!
//! ```sh
//! cargo run --release -p prf-dqn --example final_faces -- RUN…
//! ```
//!
//! Each RUN is a folder of `prf train` with one of the faces. Its newest network plays one episode greedily (all episodes begin with the
//! neutral face); the table goes to stdout. Distances are in pixels of the 84×84 frame.

use std::error::Error;
use std::path::Path;

use prf_core::{Goal, io};
use prf_dqn::checkpoint::{CheckpointStore, MODEL_FILE, Model};
use prf_dqn::config::RunConfig;
use prf_dqn::learner::greedy_actions;
use prf_dqn::run_dir::RunDir;
use prf_envs::kobian::{Expression, Face, Kobian};
use prf_envs::{Environment, Status, Task};

fn main() -> Result<(), Box<dyn Error>> {
    let runs: Vec<String> = std::env::args().skip(1).collect();
    if runs.is_empty() {
        return Err("expected the folders of runs with a face".into());
    }
    println!(
        "| Run | Rewards | Missing actions | Distance | Brows up | Mouth wider | Mouth opener | Corners up | Actions |"
    );
    println!("|---|---|---|---|---|---|---|---|---|");
    for expression in [Expression::Happy, Expression::Surprise] {
        row(
            &format!("target of {}", expression.name()),
            expression,
            &Played { face: expression.target(), actions: Vec::new(), rewards: Vec::new() },
        );
    }
    for run in &runs {
        let (expression, played) = play(Path::new(run))?;
        row(run, expression, &played);
    }
    Ok(())
}

/// An episode that was played.
struct Played {
    face: Face,
    actions: Vec<&'static str>,
    rewards: Vec<f32>,
}

fn row(name: &str, expression: Expression, Played { face, actions, rewards }: &Played) {
    let rewards: Vec<String> = rewards.iter().map(|reward| format!("{reward:.2}")).collect();
    let (moved, target) = (face.displacement(), expression.target());
    println!(
        "| {name} | {} | {} | {:.2} | {:+.1} | {:+.1} | {:+.1} | {:+.1} | {} |",
        rewards.join(" "),
        face.actions_to(target),
        face.distance_to(target),
        moved.brows_up,
        moved.mouth_wider,
        moved.mouth_opener,
        moved.corners_up,
        actions.join(", "),
    );
}

/// The greedy episode of a run.
fn play(run: &Path) -> Result<(Expression, Played), Box<dyn Error>> {
    let config: RunConfig = toml::from_str(&std::fs::read_to_string(RunDir::at(run).config_path())?)?;
    let expression = Expression::of_world(&config.env.name)
        .ok_or_else(|| format!("{} is a run of {}", run.display(), config.env.name))?;
    let goal = config.reward.goal.as_ref().map(|goal| io::read_frame(run.join(goal))).transpose()?.map(Goal::from);
    let mut task = Task::new(&config.task(), goal.as_ref())?;
    let newest = CheckpointStore::list(run)?.pop().ok_or_else(|| format!("{} has no checkpoint", run.display()))?;
    let network = Model::read(&newest.join(MODEL_FILE))?.network(&config.train.compute(tch::Device::Cpu)?)?;

    let names = task.spec().actions;
    let (mut actions, mut rewards) = (Vec::new(), Vec::new());
    task.reset(0);
    let mut status = Status::Running;
    while status == Status::Running {
        let values = network.q_values(task.observation(), 1)?;
        let action = greedy_actions(&values, names.len()).next().ok_or("the network has no values")?;
        actions.push(names[action]);
        let step = task.step(action)?;
        rewards.push(step.reward);
        status = step.status;
    }
    let mut world = Kobian::new(expression, config.env.limit_steps)?;
    world.load_state(&task.environment().save_state())?;
    Ok((expression, Played { face: world.face().ok_or("no episode")?, actions, rewards }))
}
