//! Players to measure a world, or an agent, by: the oracle's score is the ceiling, the random player's the floor.

use crate::rng::{ChaCha8Rng, below, stream};
use crate::{Environment, Error};

/// Chooses actions.
pub trait Player {
    /// Prepares for the episode of `seed`.
    fn begin(&mut self, seed: u64);

    /// The action to take in `world` now.
    fn action(&mut self, world: &dyn Environment) -> usize;
}

/// The world's own best player.
#[derive(Clone, Copy, Debug, Default)]
pub struct Oracle;

impl Player for Oracle {
    fn begin(&mut self, _seed: u64) {}

    fn action(&mut self, world: &dyn Environment) -> usize {
        world.oracle_action()
    }
}

/// Takes every action equally often. What it does in an episode depends on the episode's seed alone.
#[derive(Clone, Debug)]
pub struct Random(ChaCha8Rng);

impl Random {
    /// A random player, to be used by [`play_episode`].
    pub fn new() -> Random {
        Random(Random::stream(0))
    }

    fn stream(seed: u64) -> ChaCha8Rng {
        stream(seed, "random-player", 0)
    }
}

impl Default for Random {
    fn default() -> Self {
        Random::new()
    }
}

impl Player for Random {
    fn begin(&mut self, seed: u64) {
        self.0 = Random::stream(seed);
    }

    fn action(&mut self, world: &dyn Environment) -> usize {
        below(&mut self.0, world.spec().actions.len())
    }
}

/// An episode that was played to its end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Episode {
    /// The score at the end.
    pub score: f32,
    /// Steps taken.
    pub steps: u32,
}

/// Plays the whole episode of `seed`.
///
/// # Errors
/// The player chose an action that does not exist.
pub fn play_episode(world: &mut dyn Environment, player: &mut dyn Player, seed: u64) -> Result<Episode, Error> {
    world.reset(seed);
    player.begin(seed);
    let mut steps = 0;
    loop {
        let step = world.step(player.action(world))?;
        steps += 1;
        if step.status.is_over() {
            return Ok(Episode { score: step.score, steps });
        }
    }
}

/// The mean score of the episodes of `seeds`; NaN if there are none.
///
/// # Errors
/// As [`play_episode`].
pub fn mean_score(
    world: &mut dyn Environment,
    player: &mut dyn Player,
    seeds: impl IntoIterator<Item = u64>,
) -> Result<f64, Error> {
    let (mut sum, mut episodes) = (0.0, 0.0);
    for seed in seeds {
        sum += f64::from(play_episode(world, player, seed)?.score);
        episodes += 1.0;
    }
    Ok(sum / episodes)
}
