//! The ceiling and the floor of a world: mean scores of its oracle and of a random player over 1,000 seeds.
//! `cargo run --release -p prf-envs --example score_players -- breakout`

use prf_envs::players::{Oracle, Player, Random, play_episode};
use prf_envs::{EnvConfig, Error, registry};

const EPISODES: u64 = 1_000;

fn main() -> Result<(), Error> {
    let name = std::env::args().nth(1).unwrap_or_else(|| "breakout".to_owned());
    let usual = EnvConfig::new(&name);
    let endless = EnvConfig { limit_steps: 100_000, ..usual.clone() };
    report("oracle", &usual, &mut Oracle)?;
    report("random", &usual, &mut Random::new())?;
    report("oracle", &endless, &mut Oracle)
}

fn report(player_name: &str, config: &EnvConfig, player: &mut dyn Player) -> Result<(), Error> {
    let mut world = registry::make(config)?;
    let (mut scores, mut steps) = (Vec::new(), Vec::new());
    for seed in 0..EPISODES {
        let episode = play_episode(world.as_mut(), player, seed)?;
        scores.push(f64::from(episode.score));
        steps.push(f64::from(episode.steps));
    }
    let limit = config.limit_steps;
    println!("{player_name}, at most {limit} steps: score {}; steps {}", summary(&scores), summary(&steps));
    Ok(())
}

fn summary(values: &[f64]) -> String {
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    let least = values.iter().copied().fold(f64::INFINITY, f64::min);
    let most = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    format!("{mean:.3} ({least} to {most})")
}
