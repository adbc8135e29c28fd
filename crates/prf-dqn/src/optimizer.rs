//! Adam (Kingma and Ba, 2014) over a network's flat parameters, with its moments in the open so that they can be saved.

use std::marker::PhantomData;

use tch::{Device, Kind, Tensor};

use crate::error::Result;
use crate::network::{Parameters, tensor_to_vec};

mod fused;

const BETA1: f64 = 0.9;
const BETA2: f64 = 0.999;
const EPSILON: f64 = 1e-8;

/// Adam's state: both moments, as flat as the parameters, and the number of steps taken.
#[derive(Debug)]
pub struct Adam {
    first: Tensor,
    second: Tensor,
    steps: u64,
}

/// The numbers of one step that are the same for every parameter.
#[derive(Debug, Clone, Copy)]
struct StepSize {
    /// Learning rate divided by the first moment's bias correction.
    rate: f64,
    /// √ of the second moment's bias correction.
    second_correction: f64,
}

impl Adam {
    /// Adam that has taken no step, for `count` parameters.
    pub fn new(count: usize, device: Device) -> Result<Self> {
        let zeros = || Tensor::f_zeros([count as i64], (Kind::Float, device));
        Ok(Self { first: zeros()?, second: zeros()?, steps: 0 })
    }

    /// Adam that goes on from saved moments.
    pub fn restore(first: &[f32], second: &[f32], steps: u64, device: Device) -> Result<Self> {
        let load = |values| Tensor::f_from_slice(values)?.f_to_device(device);
        Ok(Self { first: load(first)?, second: load(second)?, steps })
    }

    /// First moments, second moments and the number of steps taken.
    pub fn to_parts(&self) -> Result<(Vec<f32>, Vec<f32>, u64)> {
        Ok((tensor_to_vec(&self.first)?, tensor_to_vec(&self.second)?, self.steps))
    }

    /// Begins one step, which is taken part by part: `lengths` numbers of the parameters each, in their order.
    ///
    /// While there are parts, nothing else may change the parameters, and nothing may read those whose part takes its step.
    pub(crate) fn begin<'a>(
        &'a mut self,
        parameters: &'a mut Parameters,
        lengths: &[i64],
        learning_rate: f64,
    ) -> Result<Vec<Part<'a>>> {
        self.steps += 1;
        let size = StepSize {
            rate: learning_rate / (1.0 - BETA1.powf(self.steps as f64)),
            second_correction: (1.0 - BETA2.powf(self.steps as f64)).sqrt(),
        };
        let mut start = 0;
        let parts = lengths.iter().map(|&length| {
            let part = |whole: &Tensor| whole.f_narrow(0, start, length);
            let parameters = Parameters {
                flat: part(&parameters.flat)?,
                rounded: parameters.rounded.as_ref().map(part).transpose()?,
            };
            let (first, second) = (part(&self.first)?, part(&self.second)?);
            let part = Part { parameters, first, second, size, whole: PhantomData };
            start += length;
            Ok(part)
        });
        parts.collect()
    }
}

/// Some of the parameters and their moments, as handles to where they lie, in a step that has begun.
#[derive(Debug)]
pub(crate) struct Part<'a> {
    parameters: Parameters,
    first: Tensor,
    second: Tensor,
    size: StepSize,
    whole: PhantomData<(&'a mut Adam, &'a mut Parameters)>,
}

impl Part<'_> {
    /// Moves the parameters against `gradients`, which together have as many elements in the same order.
    pub(crate) fn step(mut self, gradients: &[Tensor]) -> Result<()> {
        if self.parameters.flat.device() == Device::Cpu {
            fused::step(&mut self.parameters, &mut self.first, &mut self.second, gradients, self.size)
        } else {
            self.step_by_tensors(gradients)
        }
    }

    fn step_by_tensors(&mut self, gradients: &[Tensor]) -> Result<()> {
        let flat: Vec<Tensor> = gradients.iter().map(|gradient| gradient.f_flatten(0, -1)).collect::<Result<_, _>>()?;
        let gradient = Tensor::f_cat(&flat, 0)?.f_to_kind(Kind::Float)?;
        let _ = self.first.f_lerp_(&gradient, 1.0 - BETA1)?;
        let _ = self.second.f_mul_scalar_(BETA2)?.f_addcmul_(&gradient, &(&gradient * (1.0 - BETA2)))?;
        let denominator = self.second.f_sqrt()?.f_div_scalar_(self.size.second_correction)?.f_add_scalar_(EPSILON)?;
        let _ = self.parameters.flat.f_sub_(&(self.first.f_div(&denominator)?.f_mul_scalar_(self.size.rate)?))?;
        self.parameters.round()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compute::{Compute, Precision};

    fn parameters_after(steps: &[(Vec<f32>, f64)], fused: bool) -> (Vec<f32>, Adam) {
        let (parameters, adam) = computed_after(steps, fused, &Compute::plain());
        assert!(parameters.rounded.is_none());
        (tensor_to_vec(&parameters.flat).expect("values"), adam)
    }

    fn computed_after(steps: &[(Vec<f32>, f64)], fused: bool, compute: &Compute) -> (Parameters, Adam) {
        let count = steps[0].0.len();
        let mut parameters = Parameters::new(&vec![1.0f32; count], compute).expect("parameters");
        let mut adam = Adam::new(count, Device::Cpu).expect("adam");
        for (gradient, rate) in steps {
            let (head, tail) = gradient.split_at(count / 3);
            let parts = [head, tail].map(|part| Tensor::from_slice(part).to_kind(compute.kind()));
            let lengths = [count as i64];
            let mut part = adam.begin(&mut parameters, &lengths, *rate).expect("begin").pop().expect("a part");
            let step = if fused { part.step(&parts) } else { part.step_by_tensors(&parts) };
            step.expect("step");
        }
        (parameters, adam)
    }

    fn gradients(count: usize, seed: u64) -> Vec<f32> {
        let mut rng = prf_envs::rng::stream(seed, "test-gradient", 0);
        (0..count).map(|_| prf_envs::rng::unit_f32(&mut rng) - 0.5).collect()
    }

    #[test]
    fn first_step_moves_every_parameter_by_the_rate_against_its_gradient() {
        // m̂ = g and v̂ = g², so the step is rate · g / (|g| + ε).
        let (values, _) = parameters_after(&[(vec![0.5, -2.0, 1e-3], 0.01)], true);
        for (value, expected) in values.iter().zip([0.99, 1.01, 0.99]) {
            assert!((value - expected).abs() < 1e-6, "{value} should be {expected}");
        }
    }

    #[test]
    fn second_step_equals_the_hand_computed_one() {
        // g₁ = 1, g₂ = −1: m = 0.9·0.1 − 0.1 = −0.01, v = 0.999·0.001 + 0.001 = 0.001999,
        // m̂ = −0.01/0.19, v̂ = 0.001999/0.001999 = 1; θ = 1 − 0.1 + 0.1·0.01/0.19.
        let (values, adam) = parameters_after(&[(vec![1.0; 3], 0.1), (vec![-1.0; 3], 0.1)], true);
        let expected = 0.9 + 0.1 * 0.01 / 0.19;
        assert!(values.iter().all(|value| (value - expected).abs() < 1e-6), "{values:?} should be {expected}");
        assert_eq!(adam.steps, 2);
    }

    #[test]
    fn fused_step_agrees_with_tensor_operations() {
        // Large enough that several threads share the work, and no multiple of anything.
        let count = 300_007;
        let steps: Vec<_> = (0..5).map(|step| (gradients(count, step), 1e-3)).collect();
        let (fused, _) = parameters_after(&steps, true);
        let (plain, _) = parameters_after(&steps, false);
        let worst = fused.iter().zip(&plain).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
        assert!(worst < 1e-6, "largest difference {worst}");
    }

    #[test]
    fn rounded_gradients_move_parameters_that_are_rounded_as_libtorch_does() {
        let steps: Vec<_> = (0..5).map(|step| (gradients(300_007, step), 1e-3)).collect();
        let compute = Compute::on_cpu(Precision::Bf16, 0);
        let [fused, plain] = [true, false].map(|fused| computed_after(&steps, fused, &compute).0);
        let worst = (&fused.flat - &plain.flat).abs().max().double_value(&[]);
        assert!(worst < 1e-6, "largest difference {worst}");
        let rounded = fused.rounded.expect("bf16");
        assert_eq!(rounded.kind(), Kind::BFloat16);
        assert_eq!(rounded, fused.flat.to_kind(Kind::BFloat16));
        assert_ne!(rounded.to_kind(Kind::Float), fused.flat);
    }

    #[test]
    fn moments_without_gradients_come_to_rest() {
        let steps = std::iter::once(1.0).chain(std::iter::repeat_n(0.0, 80_000));
        let steps: Vec<_> = steps.map(|gradient| (vec![gradient; 3], 1e-3)).collect();
        let (_, adam) = parameters_after(&steps, true);
        let (first, second, _) = adam.to_parts().expect("parts");
        assert_eq!((first, second), (vec![0.0; 3], vec![0.0; 3]));
    }

    #[test]
    fn restored_moments_continue_to_the_same_bits() {
        let steps: Vec<_> = (0..4).map(|step| (gradients(1000, step), 1e-3)).collect();
        let (whole, _) = parameters_after(&steps, true);
        let (half, adam) = parameters_after(&steps[..2], true);
        let (first, second, count) = adam.to_parts().expect("parts");
        let mut adam = Adam::restore(&first, &second, count, Device::Cpu).expect("restore");
        let mut parameters = Parameters::new(&half, &Compute::plain()).expect("parameters");
        for (gradient, rate) in &steps[2..] {
            // In two parts, which are taken in any order.
            let (head, tail) = gradient.split_at(400);
            let parts = adam.begin(&mut parameters, &[400, 600], *rate).expect("begin");
            for (part, gradient) in parts.into_iter().zip([head, tail]).rev() {
                part.step(&[Tensor::from_slice(gradient)]).expect("step");
            }
        }
        assert_eq!(tensor_to_vec(&parameters.flat).expect("values"), whole);
    }
}
