//! Which movement of a face a reward likes best, and how much less it likes others: a beam search over whole episodes, without any learning.
//!
//! ```sh
//! cargo run --release -p prf-dqn --example best_movement -- configs/kobian-surprise-hprf.toml 0.22,l2,3 0.25,l2-hys,2
//! ```
//!
//! After the config come settings to compare with its own: cell (as a part of the height), norm and cells a block. What an episode is worth is the sum
//! of its discounted rewards, the last of which stays for ever. Of the episodes that are left at the end, the table has the best one, and the best of
//! those that raise the brows and of those that don't: where these two are worth the same, the reward can't tell an agent what to do.

use std::error::Error;
use std::path::Path;

use prf_core::{CellSize, Goal, HogParams, io};
use prf_dqn::config::RunConfig;
use prf_envs::kobian::{Displacement, Expression, Kobian};
use prf_envs::{Environment, Task};

const GAMMA: f64 = 0.95;
/// Episodes that are gone on with after each step.
const WIDTH: usize = 250;
/// Brows that are higher than this by the end are raised, lower ones are not, in pixels of the frame.
const RAISED: f32 = 3.0;
const NOT_RAISED: f32 = 1.0;

/// An episode so far.
struct Branch {
    /// The rewards' discounted sum.
    sum: f64,
    /// The same if the last reward stays.
    value: f64,
    reward: f32,
    state: Vec<u8>,
}

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
        "| Cell, norm, block | Worth | Last reward | Brows up | Mouth wider | Mouth opener | Corners up | Brows raised: worth | Not raised |"
    );
    println!("|---|---|---|---|---|---|---|---|---|");
    for hog in std::iter::once(Ok(own)).chain(args.map(|text| setting(own, &text))) {
        config.reward.hog = hog?;
        row(&config, &goal)?;
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

fn row(config: &RunConfig, goal: &Goal) -> Result<(), Box<dyn Error>> {
    let mut task = Task::new(&config.task(), Some(goal))?;
    let branches = search(&mut task)?;
    let mut faces = Vec::new();
    for branch in &branches {
        faces.push((branch.value, displacement(&mut task, branch)?));
    }
    let best_of = |keep: fn(&Displacement) -> bool| {
        let worth = faces.iter().find(|(_, moved)| keep(moved)).map(|(value, _)| *value);
        worth.map_or("–".to_owned(), |worth| format!("{worth:.2}"))
    };
    let (best, moved) = (branches.first().ok_or("no episode")?, &faces[0].1);
    let HogParams { cell, norm, block_cells, .. } = config.reward.hog;
    println!(
        "| {cell:?}, {norm:?}, {block_cells} | {:.2} | {:.2} | {:+.1} | {:+.1} | {:+.1} | {:+.1} | {} | {} |",
        best.value,
        best.reward,
        moved.brows_up,
        moved.mouth_wider,
        moved.mouth_opener,
        moved.corners_up,
        best_of(|moved| moved.brows_up >= RAISED),
        best_of(|moved| moved.brows_up <= NOT_RAISED),
    );
    Ok(())
}

/// The best episodes that were found, the best first.
fn search(task: &mut Task) -> Result<Vec<Branch>, Box<dyn Error>> {
    task.reset(0);
    let mut beam = vec![Branch { sum: 0.0, value: 0.0, reward: 0.0, state: task.save_state() }];
    let &prf_envs::Spec { actions, limit_steps, .. } = task.spec();
    for t in 0..limit_steps {
        let weight = GAMMA.powi(t as i32);
        let mut next = Vec::with_capacity(beam.len() * actions.len());
        for branch in &beam {
            for action in 0..actions.len() {
                task.load_state(&branch.state)?;
                let reward = task.step(action)?.reward;
                let sum = branch.sum + weight * f64::from(reward);
                let value = sum + weight * f64::from(reward) * GAMMA / (1.0 - GAMMA);
                next.push(Branch { sum, value, reward, state: task.save_state() });
            }
        }
        next.sort_by(|a, b| b.value.total_cmp(&a.value));
        next.truncate(WIDTH);
        beam = next;
    }
    Ok(beam)
}

/// What has moved in the face by the end of an episode.
fn displacement(task: &mut Task, branch: &Branch) -> Result<Displacement, Box<dyn Error>> {
    task.load_state(&branch.state)?;
    let &prf_envs::Spec { name, limit_steps, .. } = task.spec();
    let expression = Expression::of_world(name).ok_or("expected a config of a face")?;
    let mut world = Kobian::new(expression, limit_steps)?;
    world.load_state(&task.environment().save_state())?;
    Ok(world.face().ok_or("no episode")?.displacement())
}
