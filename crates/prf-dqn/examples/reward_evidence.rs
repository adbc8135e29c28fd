//! Does the reward order Breakout's states as the bricks cleared do? The evidence behind the defaults of `[reward.hog]`.
//!
//! ```sh
//! cargo run --release -p prf-dqn --example reward_evidence -- RUN/checkpoints/best/model.safetensors
//! ```
//!
//! Frames come from three players: random, the oracle with a limit long enough to clear the wall, and the half-trained
//! network of the given model. Each setting scores the same frames against a black goal; the table goes to stdout.

use std::error::Error;
use std::path::Path;

use prf_core::{
    CellSize, DirectDescriptor, DistanceScale, Frame, HogParams, Norm, RewardParams, TaskDescriptor, spearman,
};
use prf_dqn::checkpoint::Model;
use prf_dqn::compute::{Compute, Precision};
use prf_dqn::evaluate::episode_seeds;
use prf_dqn::learner::greedy_actions;
use prf_envs::players::{Oracle, Player, Random};
use prf_envs::{EnvConfig, RewardConfig, StateConfig, Status, Task, TaskConfig, registry};

/// Limit of the oracle's episodes: long enough to clear the wall.
const LONG: u32 = 20_000;
/// A quarter of the wall, in bricks.
const QUARTER: f64 = 15.0;
/// An almost cleared wall, in bricks cleared.
const ALMOST: f64 = 57.0;

struct State {
    frame: Frame,
    cleared: f64,
}

fn main() -> Result<(), Box<dyn Error>> {
    let model = std::env::args().nth(1).ok_or("usage: reward_evidence MODEL.safetensors (of a half-trained run)")?;
    let random = play(&mut Random::new(), 40, 100, 3)?;
    let oracle = play(&mut Oracle, 4, LONG, 12)?;
    let trained = play_model(Path::new(&model), 30, 4)?;
    println!("Frames: {} random, {} oracle, {} half-trained.\n", random.len(), oracle.len(), trained.len());
    let states: Vec<State> = random.into_iter().chain(oracle).chain(trained).collect();
    println!("| Norm | Block | Cell | D divided by | ρ, all | ρ, k ≤ 15 | F, k = 0 | F, k ≥ 57 |");
    println!("|---|---|---|---|---|---|---|---|");
    for params in settings() {
        row(&states, params)?;
    }
    Ok(())
}

/// Settings a user might try first, the library defaults of the paper's time among them.
fn settings() -> Vec<RewardParams> {
    let mut settings = Vec::new();
    for (norm, block_cells) in
        [(Norm::L1, 3), (Norm::L2Hys, 3), (Norm::L2Hys, 2), (Norm::L2, 2), (Norm::L2, 1), (Norm::None, 1)]
    {
        for fraction in [0.03, 0.05, 0.1] {
            let hog = HogParams { norm, block_cells, cell: CellSize::Fraction(fraction), ..HogParams::default() };
            settings.push(RewardParams { hog, scale: DistanceScale::SqrtBlocks });
            if fraction == 0.03 {
                settings.push(RewardParams { hog, scale: DistanceScale::None });
            }
        }
    }
    settings
}

fn row(states: &[State], params: RewardParams) -> Result<(), Box<dyn Error>> {
    let mut descriptor = DirectDescriptor::new(&Frame::new(84, 84), params)?;
    // The order of D is the order of F turned round, and does not drown when F underflows.
    let scored: Vec<(f64, f64, f64)> = states
        .iter()
        .map(|state| {
            let score = descriptor.observe(state.frame.view()).expect("a direct descriptor takes any frame");
            (state.cleared, -f64::from(score.distance), (-f64::from(score.distance)).exp())
        })
        .collect();
    let rank = |least: f64, most: f64| {
        let within = scored.iter().filter(|(cleared, ..)| (least..=most).contains(cleared));
        let (cleared, closeness): (Vec<f64>, Vec<f64>) =
            within.map(|(cleared, closeness, _)| (*cleared, *closeness)).unzip();
        spearman(&cleared, &closeness).unwrap_or(f64::NAN)
    };
    let mean = |least: f64, most: f64| {
        let rewards: Vec<f64> = scored
            .iter()
            .filter(|(cleared, ..)| (least..=most).contains(cleared))
            .map(|(_, _, reward)| *reward)
            .collect();
        rewards.iter().sum::<f64>() / rewards.len() as f64
    };
    let number = |value: f64| if value < 0.001 { format!("{value:.0e}") } else { format!("{value:.3}") };
    let CellSize::Fraction(cell) = params.hog.cell else { unreachable!("settings use fractions") };
    println!(
        "| {:?} | {}×{} | {cell} h | {} | {:.3} | {:.3} | {} | {} |",
        params.hog.norm,
        params.hog.block_cells,
        params.hog.block_cells,
        if params.scale == DistanceScale::None { "1" } else { "√blocks" },
        rank(0.0, 60.0),
        rank(0.0, QUARTER),
        number(mean(0.0, 0.0)),
        number(mean(ALMOST, 60.0)),
    );
    Ok(())
}

/// Every `every`-th frame of `episodes` episodes.
fn play(player: &mut dyn Player, episodes: usize, limit_steps: u32, every: u32) -> Result<Vec<State>, Box<dyn Error>> {
    let mut world = registry::make(&EnvConfig { limit_steps, ..EnvConfig::new("breakout") })?;
    let mut states = Vec::new();
    for seed in episode_seeds(0, "evidence", episodes) {
        world.reset(seed);
        player.begin(seed);
        for index in 0.. {
            let step = world.step(player.action(world.as_ref()))?;
            if index % every == 0 {
                let mut frame = Frame::new(world.spec().width, world.spec().height);
                world.draw_into(&mut frame);
                states.push(State { frame, cleared: f64::from(step.score) });
            }
            if step.status != Status::Running {
                break;
            }
        }
    }
    Ok(states)
}

/// The same for the greedy policy of a model.
fn play_model(path: &Path, episodes: usize, every: u32) -> Result<Vec<State>, Box<dyn Error>> {
    let network = Model::read(path)?.network(&Compute::new(tch::Device::Cpu, Precision::F32, 0)?)?;
    let config = TaskConfig {
        env: EnvConfig { limit_steps: 1000, ..EnvConfig::new("breakout") },
        reward: RewardConfig::variable(),
        state: StateConfig::default(),
    };
    let mut task = Task::new(&config, None)?;
    let actions = task.spec().actions.len();
    let mut states = Vec::new();
    for seed in episode_seeds(1, "evidence", episodes) {
        task.reset(seed);
        for index in 0.. {
            let values = network.q_values(task.observation(), 1)?;
            let action = greedy_actions(&values, actions).next().unwrap_or(0);
            let step = task.step(action)?;
            if index % every == 0 {
                states.push(State { frame: task.mirror().clone(), cleared: f64::from(step.score) });
            }
            if step.status != Status::Running {
                break;
            }
        }
    }
    Ok(states)
}
