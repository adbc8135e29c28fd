//! One update of the network: double DQN targets, Huber loss, Adam.

use std::sync::Arc;

use prf_envs::rng::ChaCha8Rng;
use tch::{Kind, Reduction, Tensor};

use crate::compute::Compute;
use crate::error::Result;
use crate::network::{Architecture, QNetwork, Trace, tensor_to_vec};
use crate::optimizer::Adam;
use crate::replay::Batch;

/// The online network, its slow copy and the optimiser.
#[derive(Debug)]
pub struct Learner {
    pub(crate) online: QNetwork,
    pub(crate) target: QNetwork,
    pub(crate) optimizer: Adam,
    pub(crate) updates: u64,
    settings: LearnerSettings,
    compute: Compute,
}

/// What of the configuration concerns an update.
#[derive(Debug, Clone, Copy)]
pub struct LearnerSettings {
    /// Double DQN.
    pub double: bool,
    /// What rewards are multiplied by.
    pub reward_scale: f64,
    /// Updates between copies to the target network.
    pub target_every_updates: u64,
}

/// A batch of n transitions as tensors.
#[derive(Debug)]
pub struct Inputs {
    /// Pictures, as the network takes them.
    states: Tensor,
    /// Pictures, as the network takes them.
    next_states: Tensor,
    /// Shape [n, 1].
    actions: Tensor,
    /// Scaled, shape [n].
    rewards: Tensor,
    /// Shape [n].
    discounts: Tensor,
    /// Of the losses, shape [n]; absent where all count the same.
    weights: Option<Tensor>,
}

impl Inputs {
    fn share(&self) -> Self {
        Self {
            states: self.states.shallow_clone(),
            next_states: self.next_states.shallow_clone(),
            actions: self.actions.shallow_clone(),
            rewards: self.rewards.shallow_clone(),
            discounts: self.discounts.shallow_clone(),
            weights: self.weights.as_ref().map(Tensor::shallow_clone),
        }
    }
}

impl Learner {
    /// A learner with a newly drawn network.
    pub fn new(
        architecture: Architecture,
        settings: LearnerSettings,
        compute: Compute,
        rng: &mut ChaCha8Rng,
    ) -> Result<Self> {
        let online = QNetwork::new(architecture, &compute, rng)?;
        let values = online.to_vec()?;
        let target = QNetwork::from_flat(online.architecture().clone(), &values, &compute)?;
        let optimizer = Adam::new(values.len(), compute.device())?;
        Ok(Self { online, target, optimizer, updates: 0, settings, compute })
    }

    /// Where and how its networks compute.
    pub fn compute(&self) -> &Compute {
        &self.compute
    }

    /// Learns from a batch by its loss: the mean, weighted by the batch's weights if it has any, of the Huber loss (δ = 1) of
    /// `c·r + γⁿ·Q_target(s′, a′) − Q(s, a)`, with `a′` the best action of the online network (double) or of the target,
    /// and `c` the reward scale.
    ///
    /// From a loss that is infinite or NaN nothing is learned: the network stays as it was.
    ///
    /// # Errors
    /// When libtorch fails, it may be in the middle: the learner is of no more use then.
    pub fn update(&mut self, batch: &Batch, learning_rate: f64) -> Result<Update> {
        let pair = Arc::clone(self.compute.pair());
        pair.work(move || {
            let inputs = self.inputs(batch)?;
            self.learn(&inputs, learning_rate)
        })
    }

    /// A batch as tensors on the learner's device.
    pub fn inputs(&self, batch: &Batch) -> Result<Inputs> {
        let device = self.compute.device();
        let numbers = |values: &[f32]| Tensor::f_from_slice(values)?.f_to_device(device);
        let [of_states, of_next_states] = [self.online.layers(), self.online.layers()];
        let (states, next_states) = self
            .compute
            .pair()
            .join(move || of_states.pictures(&batch.states), move || of_next_states.pictures(&batch.next_states));
        Ok(Inputs {
            states: states?,
            next_states: next_states?,
            actions: Tensor::f_from_slice(&batch.actions)?.f_to_device(device)?.f_unsqueeze(1)?,
            rewards: numbers(&batch.rewards)?.f_mul_scalar(self.settings.reward_scale)?,
            discounts: numbers(&batch.discounts)?,
            weights: if batch.weights.is_empty() { None } else { Some(numbers(&batch.weights)?) },
        })
    }

    /// As [`update`](Learner::update), from what [`inputs`](Learner::inputs) gave.
    pub fn update_from(&mut self, inputs: &Inputs, learning_rate: f64) -> Result<Update> {
        let (pair, inputs) = (Arc::clone(self.compute.pair()), inputs.share());
        pair.work(move || self.learn(&inputs, learning_rate))
    }

    fn learn(&mut self, inputs: &Inputs, learning_rate: f64) -> Result<Update> {
        let pair = Arc::clone(self.compute.pair());
        let (trace, targets) = self.forward(inputs)?;
        let values = trace.values.f_gather(1, &inputs.actions, false)?.f_squeeze_dim(1)?;
        let losses = values.f_smooth_l1_loss(&targets, Reduction::None, 1.0)?;
        let mean_loss = of_weight(losses, inputs.weights.as_ref())?.f_mean(Kind::Float)?;
        let loss = mean_loss.f_double_value(&[])? as f32;
        if loss.is_finite() {
            // The derivative of the Huber loss is the error itself, but not beyond ±1.
            let gradient = values.f_sub(&targets)?.f_clamp_(-1.0, 1.0)?.f_div_scalar_(values.numel() as f64)?;
            let gradient = of_weight(gradient, inputs.weights.as_ref())?.f_unsqueeze(1)?;
            let gradient = trace.values.f_zeros_like()?.f_scatter_(1, &inputs.actions, &gradient)?;
            let (layers, lengths) = (self.online.layers(), self.online.architecture().lengths());
            let parts = self.optimizer.begin(self.online.parameters_mut(), &lengths, learning_rate)?;
            let take = parts.into_iter().map(|part| move |gradients: [Tensor; 2]| part.step(&gradients)).collect();
            layers.backward(trace, &gradient, &pair, take)?;
            self.updates += 1;
            if self.updates.is_multiple_of(self.settings.target_every_updates) {
                self.target.copy_from(&self.online)?;
            }
        }
        Ok(Update { loss, values, targets })
    }

    /// The forward pass to learn from, and the targets of its values.
    fn forward(&self, inputs: &Inputs) -> Result<(Trace, Tensor)> {
        let pair = self.compute.pair();
        let [states, next_states] = [&inputs.states, &inputs.next_states].map(Tensor::shallow_clone);
        let [online, target] = [self.online.layers(), self.target.layers()];
        let (trace, next) = pair.join(move || online.forward(&states), move || target.forward(&next_states));
        let next_values = next?.values;
        let best = if self.settings.double {
            let actions = self.online.values(&inputs.next_states)?.f_argmax(1, true)?;
            next_values.f_gather(1, &actions, false)?.f_squeeze_dim(1)?
        } else {
            next_values.f_amax([1i64], false)?
        };
        Ok((trace?, inputs.rewards.f_addcmul(&inputs.discounts, &best)?))
    }
}

fn of_weight(values: Tensor, weights: Option<&Tensor>) -> Result<Tensor> {
    Ok(match weights {
        None => values,
        Some(weights) => values.f_mul(weights)?,
    })
}

/// What an update found, before it changed anything.
#[derive(Debug)]
pub struct Update {
    /// The batch's loss.
    pub loss: f32,
    values: Tensor,
    targets: Tensor,
}

impl Update {
    /// The values Q(s, a) of the transitions, n.
    pub fn values(&self) -> Result<Vec<f32>> {
        tensor_to_vec(&self.values)
    }

    /// What these values should have been, n.
    pub fn targets(&self) -> Result<Vec<f32>> {
        tensor_to_vec(&self.targets)
    }

    /// By how much the values were too low, n.
    pub fn errors(&self) -> Result<Vec<f32>> {
        tensor_to_vec(&self.targets.f_sub(&self.values)?)
    }
}

/// The action of the highest value of each row; the first of equals.
pub fn greedy_actions(values: &[f32], actions: usize) -> impl Iterator<Item = usize> + '_ {
    values.chunks_exact(actions).map(move |row| {
        let best = |best: usize, at: usize| if row[at] > row[best] { at } else { best };
        (0..actions).fold(0, best)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compute::Precision;
    use crate::network::tests::{by_autograd, distance, flat};
    use prf_envs::rng::{stream, unit_f32};

    fn learner(double: bool, dueling: bool) -> Learner {
        learner_in(double, dueling, Compute::plain())
    }

    fn learner_in(double: bool, dueling: bool, compute: Compute) -> Learner {
        let architecture = Architecture { input: [84, 84], actions: 3, dueling };
        let settings = LearnerSettings { double, reward_scale: 0.5, target_every_updates: 1000 };
        Learner::new(architecture, settings, compute, &mut stream(3, "network", 0)).expect("learner")
    }

    fn batch() -> Batch {
        let mut rng = stream(5, "test", 0);
        let mut pictures = || (0..4 * 84 * 84).map(|_| (unit_f32(&mut rng) * 255.0) as u8).collect::<Vec<u8>>();
        Batch {
            states: pictures(),
            next_states: pictures(),
            actions: vec![0, 1, 2, 1],
            rewards: vec![1.0, -0.5, 0.0, 20.0],
            discounts: vec![0.9, 0.81, 0.0, 0.9],
            ..Batch::default()
        }
    }

    #[test]
    fn loss_is_the_huber_loss_of_the_double_dqn_target() {
        for (double, dueling, weights) in [
            (false, false, vec![]),
            (true, false, vec![]),
            (true, true, vec![]),
            (true, false, vec![1.0, 0.5, 0.25, 0.1]),
        ] {
            let mut learner = learner(double, dueling);
            let batch = Batch { weights: weights.clone(), ..batch() };
            // A target network that differs, so that choosing and valuing the action can be told apart.
            let other =
                QNetwork::new(learner.online.architecture().clone(), &Compute::plain(), &mut stream(9, "network", 0));
            learner.target = other.expect("network");
            let now = learner.online.q_values(&batch.states, 4).expect("values");
            let online = learner.online.q_values(&batch.next_states, 4).expect("values");
            let slow = learner.target.q_values(&batch.next_states, 4).expect("values");
            let chooser = if double { &online } else { &slow };
            let mut expected = 0.0;
            let mut errors = Vec::new();
            for (row, best) in greedy_actions(chooser, 3).enumerate() {
                let target = 0.5 * batch.rewards[row] + batch.discounts[row] * slow[row * 3 + best];
                errors.push(target - now[row * 3 + batch.actions[row] as usize]);
                let error = errors[row].abs();
                let huber = if error < 1.0 { 0.5 * error * error } else { error - 0.5 };
                expected += weights.get(row).unwrap_or(&1.0) * huber / 4.0;
            }
            let update = learner.update(&batch, 1e-4).expect("update");
            assert!((update.loss - expected).abs() < 1e-4, "loss {}, by hand {expected}", update.loss);
            let found = update.errors().expect("errors");
            assert!(found.iter().zip(&errors).all(|(a, b)| (a - b).abs() < 1e-4), "{found:?}, by hand {errors:?}");
        }
    }

    #[test]
    fn the_first_update_moves_by_the_gradient_of_the_loss() {
        for (dueling, weights) in [(false, vec![]), (true, vec![1.0, 0.5, 0.25, 0.1])] {
            let mut learner = learner(true, dueling);
            let batch = Batch { weights: weights.clone(), ..batch() };
            let (values, leaves) = by_autograd(&learner.online, &batch.states);
            let update = learner.update(&batch, 1e-4).expect("update");
            // One of the errors is beyond ±1, where the loss is linear.
            let errors = update.errors().expect("errors");
            assert!(errors.iter().any(|error| error.abs() > 1.0) && errors.iter().any(|error| error.abs() < 1.0));

            let values = values.gather(1, &Tensor::from_slice(&batch.actions).unsqueeze(1), false).squeeze_dim(1);
            let targets = Tensor::from_slice(&update.targets().expect("targets"));
            let losses = values.smooth_l1_loss(&targets, Reduction::None, 1.0);
            let weights = if weights.is_empty() { losses.ones_like() } else { Tensor::from_slice(&weights) };
            let loss = (losses * weights).mean(Kind::Float);
            let expected = flat(&Tensor::run_backward(&[loss], &leaves, false, false));
            // After one step, Adam's first moment is a tenth of the gradient.
            let (first, _, _) = learner.optimizer.to_parts().expect("moments");
            let named = learner.online.architecture().named(&first);
            let found: Vec<f32> = named.iter().map(|moment| moment * 10.0).collect();
            let distance = distance(&found, &expected);
            assert!(distance < 1e-5, "{dueling}: {distance}");
        }
    }

    #[test]
    fn updates_give_the_same_bits_by_one_worker_and_by_two() {
        for (dueling, precision) in [(false, Precision::F32), (true, Precision::Bf16)] {
            let [one, two] = [1, 2].map(|threads| {
                let mut learner = learner_in(true, dueling, Compute::on_cpu(precision, threads));
                learner.settings.target_every_updates = 7;
                let losses: Vec<f32> = (0..20).map(|_| learner.update(&batch(), 1e-3).expect("update").loss).collect();
                (losses, learner.online.to_vec().expect("values"), learner.optimizer.to_parts().expect("moments"))
            });
            assert_eq!(one, two);
        }
    }

    #[test]
    fn a_transition_of_no_weight_teaches_nothing() {
        let (mut whole, mut part) = (learner(true, false), learner(true, false));
        let weighted = Batch { weights: vec![1.0, 1.0, 0.0, 0.0], ..batch() };
        let mut other = Batch { rewards: vec![1.0, -0.5, 9.0, -9.0], ..batch() };
        other.weights.clone_from(&weighted.weights);
        whole.update(&weighted, 1e-3).expect("update");
        part.update(&other, 1e-3).expect("update");
        assert_eq!(whole.online.to_vec().expect("values"), part.online.to_vec().expect("values"));
    }

    #[test]
    fn nothing_is_learned_from_a_loss_that_is_no_number() {
        for reward in [f32::NAN, f32::INFINITY] {
            let mut learner = learner(true, false);
            let before = learner.online.to_vec().expect("values");
            let update = learner.update(&Batch { rewards: vec![reward; 4], ..batch() }, 1e-3).expect("update");
            assert!(!update.loss.is_finite() && update.targets().expect("targets").iter().all(|t| !t.is_finite()));
            assert_eq!((learner.updates, learner.online.to_vec().expect("values")), (0, before));
        }
    }

    #[test]
    fn bf16_learns_nearly_the_same_and_keeps_its_parameters_exact() {
        let mut plain = learner(true, false);
        let mut short = learner_in(true, false, Compute::on_cpu(Precision::Bf16, 0));
        assert_eq!(short.online.to_vec().expect("values"), plain.online.to_vec().expect("values"));
        let (mut first, mut last) = (0.0, [0.0f32; 2]);
        for update in 0..30 {
            last = [&mut plain, &mut short].map(|learner| learner.update(&batch(), 1e-3).expect("update").loss);
            first = if update == 0 { last[0] } else { first };
            if update == 0 {
                assert!((last[1] - last[0]).abs() < 0.02 * last[0], "{last:?}");
            }
        }
        assert!(last.iter().all(|last| *last < 0.7 * first), "{last:?} after {first}");
        // Steps of 1e-3 are lost in bf16; in the parameters that are saved they are not.
        let values = short.online.to_vec().expect("values");
        assert!(values.iter().any(|value| value.to_bits() & 0xffff != 0));
    }

    #[test]
    fn updates_fit_the_batch_and_the_target_follows_when_due() {
        for dueling in [false, true] {
            let mut learner = learner(true, dueling);
            learner.settings.target_every_updates = 30;
            let batch = Batch { discounts: vec![0.0; 4], ..batch() };
            let before = learner.target.to_vec().expect("values");
            let losses: Vec<f32> = (0..29).map(|_| learner.update(&batch, 1e-3).expect("update").loss).collect();
            assert!(losses[28] < 0.5 * losses[0], "the loss went from {} to {}", losses[0], losses[28]);
            assert_eq!(learner.target.to_vec().expect("values"), before);
            learner.update(&batch, 1e-3).expect("update");
            assert_eq!(learner.target.to_vec().expect("values"), learner.online.to_vec().expect("values"));
        }
    }

    #[test]
    fn greedy_takes_the_first_of_the_highest() {
        assert_eq!(greedy_actions(&[0.0, 2.0, 1.0, 5.0, 5.0, 1.0], 3).collect::<Vec<_>>(), [1, 0]);
    }
}
