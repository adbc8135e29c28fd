//! Asking in turns.

use anyhow::Result;

/// Nanoseconds of a call: for each side, one for each round.
pub type Samples = Vec<Vec<f64>>;

/// How many turns of `turn_ns` make a batch of about `batch_ns`; at least 1.
pub fn turns_for(turn_ns: f64, batch_ns: f64) -> u64 {
    // A float that is too large, or none at all, becomes the nearest number.
    ((batch_ns / turn_ns).round() as u64).clamp(1, 1_000_000)
}

/// Asks side 0, then 1, and so on, then 0 again, `rounds` times: whatever else the machine does then disturbs all alike.
///
/// # Errors
/// The first error of `ask`.
pub fn in_turns(sides: usize, rounds: usize, mut ask: impl FnMut(usize) -> Result<f64>) -> Result<Samples> {
    let mut samples = vec![Vec::with_capacity(rounds); sides];
    for _ in 0..rounds {
        for (side, samples) in samples.iter_mut().enumerate() {
            samples.push(ask(side)?);
        }
    }
    Ok(samples)
}
