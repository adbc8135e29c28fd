//! How far a reward of motion leads a face by itself: the player that tries out everything a few steps ahead and takes the best.
//!
//! ```sh
//! cargo run --release -p prf-dqn --example look_ahead -- configs/kobian-happy-kprf.toml 0.2,l2,1 0.1,l2,1
//! ```
//!
//! After the config come settings to compare with its own: cell (as a part of the height), norm and cells a block. A reward by which one has to look
//! far ahead is one that an agent hardly learns from, however well it orders faces. The table goes to stdout, a row for each setting and depth.

use std::error::Error;
use std::path::Path;

use prf_core::{CellSize, Goal, HogParams, io};
use prf_dqn::config::RunConfig;
use prf_envs::kobian::{Expression, Kobian};
use prf_envs::{Environment, Task};

/// What a reward is worth one step later; what is reached in the end stays for ever.
const GAMMA: f64 = 0.95;

fn main() -> Result<(), Box<dyn Error>> {
    let mut args = std::env::args().skip(1);
    let path = args.next().ok_or("expected a config of a face, and settings such as 0.1,l2,1")?;
    let mut config: RunConfig = toml::from_str(&std::fs::read_to_string(&path)?)?;
    let motion = config.reward.motion.ok_or("expected a config with the motion descriptor")?;
    let goal = config.reward.goal.as_deref().ok_or("expected a goal")?;
    let goal = Path::new(&path).parent().unwrap_or(Path::new("")).join(goal);
    let goal = Goal::from(io::read_motion(&goal, motion, false)?.template);
    let own = config.reward.hog;
    println!(
        "| Cell, norm, block | Steps ahead | Last reward | Missing | Brows up | Mouth wider | Mouth opener | Corners up |"
    );
    println!("|---|---|---|---|---|---|---|---|");
    for hog in std::iter::once(Ok(own)).chain(args.map(|text| setting(own, &text))) {
        config.reward.hog = hog?;
        for depth in 1..=3 {
            row(&config, &goal, depth)?;
        }
    }
    Ok(())
}

/// `own` settings with those that a text such as `0.1,l2,1` names.
fn setting(own: HogParams, text: &str) -> Result<HogParams, Box<dyn Error>> {
    let [cell, norm, block_cells] = text.split(',').collect::<Vec<_>>()[..] else {
        return Err(format!("{text}: expected cell, norm and block, such as 0.1,l2,1").into());
    };
    let norm = serde_json::from_value(norm.into())?;
    Ok(HogParams { cell: CellSize::Fraction(cell.parse()?), norm, block_cells: block_cells.parse()?, ..own })
}

fn row(config: &RunConfig, goal: &Goal, depth: usize) -> Result<(), Box<dyn Error>> {
    let mut task = Task::new(&config.task(), Some(goal))?;
    task.reset(0);
    let mut last = 0.0;
    for _ in 0..config.env.limit_steps {
        let (_, action) = best(&mut task, depth)?;
        last = task.step(action)?.reward;
    }
    let expression = Expression::of_world(&config.env.name).ok_or("expected a config of a face")?;
    let mut world = Kobian::new(expression, config.env.limit_steps)?;
    world.load_state(&task.environment().save_state())?;
    let face = world.face().ok_or("no episode")?;
    let (moved, HogParams { cell, norm, block_cells, .. }) = (face.displacement(), config.reward.hog);
    println!(
        "| {cell:?}, {norm:?}, {block_cells} | {depth} | {last:.2} | {} | {:+.1} | {:+.1} | {:+.1} | {:+.1} |",
        face.actions_to(expression.target()),
        moved.brows_up,
        moved.mouth_wider,
        moved.mouth_opener,
        moved.corners_up,
    );
    Ok(())
}

/// The best value within `depth` steps, and the action that leads there; the task is left as it was.
fn best(task: &mut Task, depth: usize) -> Result<(f64, usize), Box<dyn Error>> {
    let state = task.save_state();
    let mut best = (f64::NEG_INFINITY, 0);
    for action in 0..task.spec().actions.len() {
        let step = task.step(action)?;
        let reward = f64::from(step.reward);
        let value = if depth == 1 || step.status.is_over() {
            reward / (1.0 - GAMMA)
        } else {
            reward + GAMMA * self::best(task, depth - 1)?.0
        };
        task.load_state(&state)?;
        if value > best.0 + 1e-9 {
            best = (value, action);
        }
    }
    Ok(best)
}
