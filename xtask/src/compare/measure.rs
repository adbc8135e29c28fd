//! Asking in turns.

use anyhow::Result;

/// What one answer should take at least: long enough for the clock, short enough that a process which has just woken up
/// is seldom interrupted before its end.
const BATCH_NS: f64 = 2e6;
/// What all answers of one side should take together.
const SIDE_NS: f64 = 1e9;
const ROUNDS: [f64; 2] = [21.0, 101.0];

/// How two sides are measured. Both work equally long at a time: whoever works longer is interrupted more often, and
/// would look slower than it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Plan {
    /// For each side, the turns of a batch.
    pub turns: [u64; 2],
    /// How often both are asked.
    pub rounds: usize,
}

impl Plan {
    /// From the nanoseconds of one turn of each.
    pub fn new(turn_ns: [f64; 2]) -> Plan {
        let batch = BATCH_NS.max(turn_ns[0]).max(turn_ns[1]);
        Plan {
            // A float that is too large, or none at all, becomes the nearest number.
            turns: turn_ns.map(|ns| ((batch / ns).round() as u64).clamp(1, 1_000_000)),
            rounds: (SIDE_NS / batch).clamp(ROUNDS[0], ROUNDS[1]) as usize,
        }
    }
}

/// Asks side 0, then 1, then 1 and 0, `rounds` times, for the nanoseconds of a call: whatever else the machine does then
/// disturbs both alike, and neither is always the first of a pair.
///
/// # Errors
/// The first error of `ask`.
pub fn in_turns(rounds: usize, mut ask: impl FnMut(usize) -> Result<f64>) -> Result<[Vec<f64>; 2]> {
    let mut samples = [Vec::with_capacity(rounds), Vec::with_capacity(rounds)];
    for round in 0..rounds {
        for side in if round % 2 == 0 { [0, 1] } else { [1, 0] } {
            samples[side].push(ask(side)?);
        }
    }
    Ok(samples)
}
