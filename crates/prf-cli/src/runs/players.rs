//! The best and a random player, to compare runs with.

use prf_dqn::evaluate::episode_seeds;
use prf_envs::players::{Oracle, Random, mean_score};
use prf_envs::{EnvConfig, registry};

use crate::error::Result;

/// The fewest episodes of the random player.
pub(crate) const EPISODES: usize = 100;

/// Mean scores of the players that come with a world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Players {
    pub(crate) oracle: f64,
    pub(crate) random: f64,
    /// How many episodes each played.
    pub(crate) episodes: [usize; 2],
}

impl Players {
    /// The oracle in the very episodes of the runs' evaluations, so that no agent gets more out of them, and a random player in
    /// enough of the same kind.
    pub(crate) fn of(env: &EnvConfig, evaluated: usize) -> Result<Players> {
        let mut world = registry::make(env)?;
        let seeds = episode_seeds(0, "evaluation", evaluated.max(EPISODES));
        Ok(Players {
            oracle: mean_score(world.as_mut(), &mut Oracle, seeds[..evaluated].iter().copied())?,
            random: mean_score(world.as_mut(), &mut Random::new(), seeds.iter().copied())?,
            episodes: [evaluated, seeds.len()],
        })
    }

    /// How much of the way from the random player to the best `score` is: 0 to 1, or beyond.
    pub(crate) fn share(&self, score: f64) -> f64 {
        (score - self.random) / (self.oracle - self.random)
    }
}
