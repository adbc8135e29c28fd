//! What a run will cost, found out before it starts.

use std::time::Instant;

use prf_core::Goal;
use prf_envs::Task;
use prf_envs::rng::stream;

use crate::config::RunConfig;
use crate::error::Result;
use crate::learner::Learner;
use crate::replay::Batch;
use crate::trainer::architecture;

/// Calls that are not timed, and those that are.
const UNTIMED: usize = 3;
const TIMED: usize = 9;

/// Memory and time of a run.
#[derive(Debug, Clone, Copy)]
pub struct Estimate {
    /// Replay memory once it is full, in bytes.
    pub replay_bytes: u64,
    /// Steps of the run; for a run limited by episodes the most there can be.
    pub steps: u64,
    /// Time of the whole run without its evaluations, in seconds.
    pub seconds: f64,
}

impl Estimate {
    /// Times a few updates and steps on this machine and reckons up.
    ///
    /// # Errors
    /// When the task cannot be built or libtorch fails.
    pub fn of(config: &RunConfig, goal: Option<&Goal>, device: tch::Device) -> Result<Self> {
        let train = &config.train;
        let mut task = Task::new(&config.task(), goal)?;
        let architecture = architecture(&task, train.dueling)?;
        let frame_len = task.observation().len();
        let compute = train.compute(device)?;
        let mut learner = Learner::new(architecture, train.learner(), compute, &mut stream(0, "estimate", 0))?;

        let count = train.batch_size;
        let batch = Batch {
            states: vec![0; count * frame_len],
            next_states: vec![0; count * frame_len],
            actions: vec![0; count],
            rewards: vec![0.0; count],
            discounts: vec![train.gamma; count],
            ..Batch::default()
        };
        let update_s = seconds_each(|| learner.update(&batch, 1e-4).map(drop))?;
        let states = vec![0; train.environments * frame_len];
        let acting_s = seconds_each(|| learner.online.q_values(&states, train.environments).map(drop))?;
        let step_s = seconds_each(|| {
            task.reset(0);
            Ok(task.step(0).map(drop)?)
        })?;
        let steps =
            train.steps.or(train.episodes.map(|episodes| episodes.saturating_mul(task.spec().limit_steps.into())));
        let steps = steps.unwrap_or(0);
        let seconds_a_step = update_s / train.steps_per_update as f64 + acting_s / train.environments as f64 + step_s;
        Ok(Self { replay_bytes: train.replay_bytes(frame_len), steps, seconds: steps as f64 * seconds_a_step })
    }
}

/// The median time of some calls, after a few that are not counted: the first ones plan and allocate.
fn seconds_each(mut work: impl FnMut() -> Result<()>) -> Result<f64> {
    let mut times = Vec::with_capacity(UNTIMED + TIMED);
    for _ in 0..UNTIMED + TIMED {
        let start = Instant::now();
        work()?;
        times.push(start.elapsed().as_secs_f64());
    }
    let timed = &mut times[UNTIMED..];
    timed.sort_by(f64::total_cmp);
    Ok(timed[TIMED / 2])
}
