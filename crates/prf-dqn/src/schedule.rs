//! Values that change as a run goes on.

use crate::config::{EpsilonConfig, PrioritizedConfig, TrainConfig};

/// The probability ε of a random action at a step.
pub fn epsilon(config: &EpsilonConfig, step: u64) -> f32 {
    let progress = (step as f64 / config.decay_steps as f64).min(1.0);
    (f64::from(config.start) + progress * (f64::from(config.end) - f64::from(config.start))) as f32
}

/// Adam's learning rate after `progress` of the run, in [0, 1].
pub fn learning_rate(config: &TrainConfig, progress: f64) -> f64 {
    let last = config.final_learning_rate.unwrap_or(config.learning_rate);
    config.learning_rate + progress.clamp(0.0, 1.0) * (last - config.learning_rate)
}

/// The exponent β of the weights that make up for priorities, after `progress` of the run, in [0, 1].
pub fn beta(config: &PrioritizedConfig, progress: f64) -> f32 {
    let start = f64::from(config.beta_start);
    (start + progress.clamp(0.0, 1.0) * (1.0 - start)) as f32
}

/// How much of the run is done, in [0, 1], by whichever of steps and episodes limits it.
pub fn progress(config: &TrainConfig, steps: u64, episodes: u64) -> f64 {
    let part = |done: u64, limit: Option<u64>| limit.map_or(0.0, |limit| (done as f64 / limit as f64).min(1.0));
    part(steps, config.steps).max(part(episodes, config.episodes))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn epsilon_falls_linearly_and_then_stays() {
        let config = EpsilonConfig { start: 1.0, end: 0.1, decay_steps: 100 };
        let values: Vec<f32> = [0, 50, 100, 1000].into_iter().map(|step| epsilon(&config, step)).collect();
        assert_eq!(values, [1.0, 0.55, 0.1, 0.1]);
    }

    #[test]
    fn beta_rises_linearly_to_1() {
        let config = PrioritizedConfig { alpha: 0.6, beta_start: 0.4 };
        assert_eq!([0.0, 0.5, 1.0, 1.5].map(|progress| beta(&config, progress)), [0.4, 0.7, 1.0, 1.0]);
    }
}
