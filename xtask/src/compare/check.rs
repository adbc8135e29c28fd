//! Whether both sides compute the same.

use std::fs;
use std::path::Path;

use anyhow::{Context, Result, bail, ensure};

use super::cases::Check;

/// # Errors
/// If the values differ by more than the check allows; the first that does is named.
pub fn compare_values(check: Check, ours: &[f32], theirs: &[f32]) -> Result<()> {
    ensure!(!ours.is_empty(), "there are no values");
    ensure!(ours.len() == theirs.len(), "{} values of ours, {} of theirs", ours.len(), theirs.len());
    let differs = |(ours, theirs): (&f32, &f32)| match check {
        Check::Count => false,
        Check::Bits => ours.to_bits() != theirs.to_bits(),
        Check::Within(tolerance) => (ours - theirs).abs() > tolerance || ours.is_nan() || theirs.is_nan(),
    };
    match ours.iter().zip(theirs).position(differs) {
        Some(at) => bail!("value {at} is {} with us and {} there ({check:?})", ours[at], theirs[at]),
        None => Ok(()),
    }
}

/// Little-endian floats.
pub(super) fn read_values(file: &Path) -> Result<Vec<f32>> {
    let bytes = fs::read(file).with_context(|| format!("can't read {}", file.display()))?;
    let (values, rest) = bytes.as_chunks::<4>();
    ensure!(rest.is_empty(), "{} holds no whole number of floats", file.display());
    Ok(values.iter().map(|value| f32::from_le_bytes(*value)).collect())
}
