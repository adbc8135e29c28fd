//! What is told and kept of the moment at which learning diverges.

use std::fmt;
use std::path::PathBuf;

use safetensors::{Dtype, SafeTensorError};
use serde::Serialize;

use super::Trainer;
use crate::checkpoint::{bytes_of, view};
use crate::error::{Error, Result};
use crate::files::write_synced;
use crate::learner::Update;
use crate::replay::Batch;

/// An update whose loss was infinite or NaN, and from which nothing was learned.
#[derive(Debug, Clone, Serialize)]
pub struct Divergence {
    /// Steps before, over all environments.
    pub step: u64,
    /// Updates before.
    pub update: u64,
    /// The loss in words, since JSON has none for it.
    pub loss: String,
    /// The batch's rewards, not yet scaled.
    pub rewards: Figures,
    /// What the values should have been.
    pub targets: Figures,
    /// The values of the batch's transitions.
    pub values: Figures,
    /// The network's parameters.
    pub parameters: Figures,
}

/// Numbers, summed up.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Figures {
    /// How many there are.
    pub count: usize,
    /// How many of them are infinite or NaN. The others are what follows speaks of.
    pub not_finite: usize,
    /// The least; absent when none is finite.
    pub min: Option<f32>,
    /// The arithmetic mean.
    pub mean: Option<f64>,
    /// The greatest.
    pub max: Option<f32>,
}

impl Figures {
    /// Of the given numbers.
    pub fn of(numbers: &[f32]) -> Self {
        let finite = || numbers.iter().copied().filter(|number| number.is_finite());
        let count = finite().count();
        Self {
            count: numbers.len(),
            not_finite: numbers.len() - count,
            min: finite().reduce(f32::min),
            mean: (count > 0).then(|| finite().map(f64::from).sum::<f64>() / count as f64),
            max: finite().reduce(f32::max),
        }
    }
}

impl fmt::Display for Figures {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let (Some(min), Some(mean), Some(max)) = (self.min, self.mean, self.max) {
            write!(f, "from {min:.3e} to {max:.3e} (mean {mean:.3e})")?;
            f.write_str(if self.not_finite > 0 { ", " } else { "" })?;
        }
        if self.not_finite > 0 {
            write!(f, "{} of {} infinite or NaN", self.not_finite, self.count)?;
        }
        Ok(())
    }
}

impl fmt::Display for Divergence {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { step, update, loss, rewards, targets, values, parameters } = self;
        write!(
            f,
            "learning diverged at step {step}: the loss of update {update} is {loss}, with rewards {rewards}, targets \
             {targets}, values {values} and parameters {parameters}"
        )
    }
}

impl Trainer {
    /// The error of a loss that is no number. The network, the batch and the figures are saved, if they can be, for somebody to
    /// look at.
    pub(super) fn diverged(&mut self, update: &Update) -> Result<Error> {
        let (values, targets) = (update.values()?, update.targets()?);
        let divergence = Divergence {
            step: self.counters.steps,
            update: self.learner.updates,
            loss: update.loss.to_string(),
            rewards: Figures::of(&self.batch.rewards),
            targets: Figures::of(&targets),
            values: Figures::of(&values),
            parameters: Figures::of(&self.learner.online.to_vec()?),
        };
        // The divergence is the error to tell, even where it can't be saved.
        let saved = self.save_diverged(&divergence, &values, &targets).map_err(Box::new);
        Ok(Error::Diverged { divergence: Box::new(divergence), saved })
    }

    fn save_diverged(&mut self, divergence: &Divergence, values: &[f32], targets: &[f32]) -> Result<PathBuf> {
        let records = self.records.mark(false)?;
        let checkpoint = self.checkpoint(&self.retention, records)?;
        let [height, width] = self.learner.online.architecture().input.map(|side| side as usize);
        let batch = batch_bytes(&self.batch, [height, width], values, targets)
            .expect("names are distinct and sizes consistent");
        let report = serde_json::to_vec_pretty(divergence).expect("figures are plain numbers");
        self.checkpoints.write_diverged(|dir| {
            checkpoint.write(dir)?;
            for (name, bytes) in [("batch.safetensors", &batch), ("report.json", &report)] {
                write_synced(&dir.join(name), bytes).map_err(Error::io("write", dir.join(name)))?;
            }
            Ok(())
        })
    }
}

/// The transitions of a batch, with their values and targets, as a safetensors file.
fn batch_bytes(
    batch: &Batch,
    [height, width]: [usize; 2],
    values: &[f32],
    targets: &[f32],
) -> Result<Vec<u8>, SafeTensorError> {
    let n = batch.len();
    let actions: Vec<u8> = batch.actions.iter().flat_map(|action| action.to_le_bytes()).collect();
    let numbers = [
        ("rewards", batch.rewards.as_slice()),
        ("discounts", &batch.discounts),
        ("weights", &batch.weights),
        ("values", values),
        ("targets", targets),
    ];
    let numbers = numbers.map(|(name, numbers)| (name, numbers.len(), bytes_of(numbers)));
    let mut tensors = vec![
        ("states", view(Dtype::U8, vec![n, height, width], &batch.states)),
        ("next_states", view(Dtype::U8, vec![n, height, width], &batch.next_states)),
        ("actions", view(Dtype::I64, vec![n], &actions)),
    ];
    tensors.extend(numbers.iter().map(|(name, count, bytes)| (*name, view(Dtype::F32, vec![*count], bytes))));
    safetensors::serialize(tensors, None)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn figures_are_of_the_finite_numbers_and_count_the_others() {
        let figures = Figures::of(&[2.0, f32::NAN, -1.0, f32::NEG_INFINITY, 5.0]);
        let expected = Figures { count: 5, not_finite: 2, min: Some(-1.0), mean: Some(2.0), max: Some(5.0) };
        assert_eq!(figures, expected);
        assert_eq!(figures.to_string(), "from -1.000e0 to 5.000e0 (mean 2.000e0), 2 of 5 infinite or NaN");
        assert_eq!(Figures::of(&[f32::NAN; 3]).to_string(), "3 of 3 infinite or NaN");
        assert_eq!(Figures::of(&[0.5]).to_string(), "from 5.000e-1 to 5.000e-1 (mean 5.000e-1)");
    }
}
