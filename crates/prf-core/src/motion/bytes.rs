//! A motion template's memory as bytes, for a checkpoint. Numbers are little-endian.

use crate::{Error, MotionState};

/// Marks the bytes and the version of their layout.
const TAG: &[u8; 7] = b"motion1";

pub(super) fn write(state: &MotionState) -> Vec<u8> {
    let [height, width] = state.shape.map(|side| side as u64);
    let mut bytes = TAG.to_vec();
    for number in [height, width, state.iterations, state.reference.len() as u64] {
        bytes.extend(number.to_le_bytes());
    }
    bytes.extend(state.tau.to_le_bytes());
    bytes.extend(&state.reference);
    bytes.extend(state.history.iter().flat_map(|mu| mu.to_le_bytes()));
    bytes
}

pub(super) fn read(bytes: &[u8]) -> Result<MotionState, Error> {
    let damaged = || Error::Restore {
        got: format!("{} bytes", bytes.len()),
        expected: "the whole memory of a motion template".to_owned(),
    };
    let mut rest = bytes.strip_prefix(TAG).ok_or_else(damaged)?;
    let mut number = || -> Option<u64> {
        let (number, after) = rest.split_first_chunk()?;
        rest = after;
        Some(u64::from_le_bytes(*number))
    };
    let numbers = [number(), number(), number(), number()];
    let [Some(height), Some(width), Some(iterations), Some(reference_len)] = numbers else { return Err(damaged()) };
    let (tau, rest) = rest.split_first_chunk().ok_or_else(damaged)?;
    let len = usize::try_from(reference_len).map_err(|_| damaged())?;
    let (reference, history) = rest.split_at_checked(len).ok_or_else(damaged)?;
    let (history, left) = history.as_chunks();
    if !left.is_empty() || history.len() as u64 / width.max(1) != height {
        return Err(damaged());
    }
    Ok(MotionState {
        shape: [height as usize, width as usize],
        reference: reference.to_vec(),
        history: history.iter().map(|&mu| f32::from_le_bytes(mu)).collect(),
        iterations,
        tau: f32::from_le_bytes(*tau),
    })
}
