//! The greedy policy, played to the end of each episode.

use prf_envs::{Status, Task, TaskStep};
use serde::{Deserialize, Serialize};

use crate::error::Result;
use crate::learner::greedy_actions;

/// What one episode came to.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct Episode {
    /// The world's own score at the end.
    pub score: f32,
    /// Sum of the rewards of the configured source.
    pub reward: f64,
    /// Steps played.
    pub steps: u32,
}

impl Episode {
    /// Counts a step.
    pub(crate) fn add(&mut self, step: &TaskStep) {
        self.score = step.score;
        self.reward += f64::from(step.reward);
        self.steps += 1;
    }
}

/// Mean and sample standard deviation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spread {
    /// Arithmetic mean.
    pub mean: f64,
    /// Sample standard deviation; 0 for fewer than two values.
    pub std: f64,
}

impl Spread {
    /// Of the given values; zero for none.
    pub fn of(values: impl ExactSizeIterator<Item = f64> + Clone) -> Self {
        let count = values.len() as f64;
        if count == 0.0 {
            return Self { mean: 0.0, std: 0.0 };
        }
        let mean = values.clone().sum::<f64>() / count;
        let squares: f64 = values.map(|value| (value - mean).powi(2)).sum();
        Self { mean, std: if count > 1.0 { (squares / (count - 1.0)).sqrt() } else { 0.0 } }
    }
}

/// Plays one episode for each seed, all at once, taking the action of the highest value.
///
/// `q_values` gives the values of a batch of states; `tasks` are at least as many as `seeds`; `taken` is told each episode's index
/// and the action taken in it, one after another.
pub fn play_greedily(
    tasks: &mut [Task],
    seeds: &[u64],
    q_values: impl Fn(&[u8], usize) -> Result<Vec<f32>>,
    taken: &mut dyn FnMut(usize, usize),
) -> Result<Vec<Episode>> {
    let mut episodes = vec![Episode::default(); seeds.len()];
    for (task, &seed) in tasks.iter_mut().zip(seeds) {
        task.reset(seed);
    }
    let mut running: Vec<usize> = (0..seeds.len()).collect();
    let mut states = Vec::new();
    while !running.is_empty() {
        states.clear();
        running.iter().for_each(|&index| states.extend_from_slice(tasks[index].observation()));
        let values = q_values(&states, running.len())?;
        let actions = greedy_actions(&values, values.len() / running.len());
        let mut still = Vec::with_capacity(running.len());
        for (&index, action) in running.iter().zip(actions) {
            let step = tasks[index].step(action)?;
            taken(index, action);
            let episode = &mut episodes[index];
            episode.add(&step);
            if step.status == Status::Running {
                still.push(index);
            }
        }
        running = still;
    }
    Ok(episodes)
}

/// Seeds of `count` episodes, the same for every run: the stream `purpose` of `seed`.
pub fn episode_seeds(seed: u64, purpose: &str, count: usize) -> Vec<u64> {
    use rand_core::Rng;
    let mut rng = prf_envs::rng::stream(seed, purpose, 0);
    (0..count).map(|_| rng.next_u64()).collect()
}
