//! The Q-network of Mnih et al. (Nature, 2015) on one picture, plain or dueling (Wang et al., 2016), with all parameters in
//! one flat tensor.

use std::fmt;

use prf_envs::rng::ChaCha8Rng;
use serde::{Deserialize, Serialize};
use tch::{Device, Kind, Tensor, no_grad};

use crate::compute::Compute;
use crate::error::Result;

mod blocks;

/// One convolution: output channels, kernel side, stride.
const CONVOLUTIONS: [(i64, i64, i64); 3] = [(32, 8, 4), (64, 4, 2), (64, 3, 1)];
/// Units of each hidden fully connected layer.
const HIDDEN_UNITS: i64 = 512;
/// Weights of the first convolution, which lie in front of all other parameters.
const FIRST_KERNELS: usize = (CONVOLUTIONS[0].0 * CONVOLUTIONS[0].1 * CONVOLUTIONS[0].1) as usize;
/// Their shape as kernels of blocks.
const BLOCK_KERNELS: [i64; 4] =
    [CONVOLUTIONS[0].0, blocks::CHANNELS as i64, blocks::KERNEL as i64, blocks::KERNEL as i64];

/// What decides the shape of the network.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Architecture {
    /// Height and width of the input, in pixels.
    pub input: [i64; 2],
    /// Number of actions, the width of the output.
    pub actions: i64,
    /// Whether a value and an advantage stream, each with a hidden layer of its own, follow the convolutions, in place of
    /// a single one.
    pub dueling: bool,
}

impl Architecture {
    /// Names and shapes of weights and biases, from the input to the output.
    pub fn parameters(&self) -> Vec<(String, Vec<i64>)> {
        let mut parameters = Vec::new();
        let mut push = |layer: &str, shape: Vec<i64>| {
            let outputs = shape[0];
            parameters.push((format!("{layer}.weight"), shape));
            parameters.push((format!("{layer}.bias"), vec![outputs]));
        };
        let (mut channels, [mut height, mut width]) = (1, self.input);
        for (index, (outputs, kernel, stride)) in CONVOLUTIONS.into_iter().enumerate() {
            push(&format!("conv{}", index + 1), vec![outputs, channels, kernel, kernel]);
            (height, width) = ((height - kernel) / stride + 1, (width - kernel) / stride + 1);
            channels = outputs;
        }
        let features = channels * height * width;
        let streams =
            if self.dueling { vec![("value.", 1), ("advantage.", self.actions)] } else { vec![("", self.actions)] };
        for (stream, outputs) in streams {
            push(&format!("{stream}hidden"), vec![HIDDEN_UNITS, features]);
            push(&format!("{stream}output"), vec![outputs, HIDDEN_UNITS]);
        }
        parameters
    }

    /// The smallest height and width that the convolutions accept, in pixels.
    pub fn smallest_input() -> i64 {
        CONVOLUTIONS.into_iter().rev().fold(1, |side, (_, kernel, stride)| (side - 1) * stride + kernel)
    }
}

impl fmt::Display for Architecture {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let ([height, width], kind) = (self.input, if self.dueling { "dueling " } else { "" });
        write!(f, "a {kind}network for {height}×{width} px and {} actions", self.actions)
    }
}

/// A Q-network: pictures in, one value an action out.
#[derive(Debug)]
pub struct QNetwork {
    architecture: Architecture,
    parameters: Parameters,
    /// Views of the parameters as they are computed with, leaves of the autograd graph.
    leaves: Vec<Tensor>,
}

/// A network's parameters, shape [n].
#[derive(Debug)]
pub struct Parameters {
    /// As they are learned, f32; the first kernels are of blocks.
    pub flat: Tensor,
    /// The same, rounded to the numbers that are computed with, if these are others.
    pub rounded: Option<Tensor>,
}

impl Parameters {
    pub(crate) fn new(values: &[f32], compute: Compute) -> Result<Self> {
        let flat = Tensor::f_from_slice(values)?.f_to_device(compute.device)?;
        let rounded = match compute.kind() {
            Kind::Float => None,
            other => Some(flat.f_to_kind(other)?),
        };
        Ok(Self { flat, rounded })
    }

    /// What is computed with.
    fn computed(&self) -> &Tensor {
        self.rounded.as_ref().unwrap_or(&self.flat)
    }

    fn copy_from(&mut self, other: &Self) -> Result<()> {
        self.flat.f_copy_(&other.flat)?;
        self.round()
    }

    /// Brings `rounded` up to date.
    pub(crate) fn round(&mut self) -> Result<()> {
        if let Some(rounded) = &mut self.rounded {
            rounded.f_copy_(&self.flat)?;
        }
        Ok(())
    }
}

impl QNetwork {
    /// A network whose weights are uniform in ±√(6/fan-in) (He et al., 2015), drawn from `rng`, and whose biases are 0.
    ///
    /// This keeps the scale of the activations from layer to layer, which PyTorch's default, 2.4 times smaller, lets fade.
    pub fn new(architecture: Architecture, compute: Compute, rng: &mut ChaCha8Rng) -> Result<Self> {
        let mut values = Vec::new();
        for (name, shape) in architecture.parameters() {
            let count = shape.iter().product::<i64>();
            let fan_in = shape[1..].iter().product::<i64>();
            let bound = if name.ends_with(".weight") { (6.0 / fan_in as f32).sqrt() } else { 0.0 };
            values.extend((0..count).map(|_| bound * (2.0 * prf_envs::rng::unit_f32(rng) - 1.0)));
        }
        Self::from_flat(architecture, &values, compute)
    }

    /// A network with the given parameters, in the order of [`Architecture::parameters`].
    pub fn from_flat(architecture: Architecture, values: &[f32], compute: Compute) -> Result<Self> {
        let mut values = values.to_vec();
        blocks::of_kernels(&mut values[..FIRST_KERNELS]);
        let parameters = Parameters::new(&values, compute)?;
        let mut leaves = Vec::new();
        let mut offset = 0;
        for (index, (_, shape)) in architecture.parameters().into_iter().enumerate() {
            let count = shape.iter().product::<i64>();
            let shape = if index == 0 { BLOCK_KERNELS.to_vec() } else { shape };
            let part = parameters.computed().f_narrow(0, offset, count)?.f_view(&shape[..])?;
            leaves.push(part.f_detach()?.f_set_requires_grad(true)?);
            offset += count;
        }
        debug_assert_eq!(offset, values.len() as i64);
        Ok(Self { architecture, parameters, leaves })
    }

    /// Q-values of a batch: what [`pictures`](QNetwork::pictures) gives, to values of shape [n, actions], f32.
    ///
    /// A dueling network gives V + A − mean A (equation 9 of Wang et al.).
    pub fn forward(&self, pictures: &Tensor) -> Result<Tensor> {
        let mut x = pictures.shallow_clone();
        let mut leaves = self.leaves.chunks_exact(2);
        for (index, parameters) in (&mut leaves).take(CONVOLUTIONS.len()).enumerate() {
            let [weight, bias] = parameters else { unreachable!("chunks of two") };
            // Of blocks, the first one moves by one.
            let stride = if index == 0 { 1 } else { CONVOLUTIONS[index].2 };
            x = x.f_conv2d(weight, Some(bias), [stride; 2], [0; 2], [1; 2], 1)?.f_relu_()?;
        }
        let features = x.f_flatten(1, -1)?;
        let streams = &self.leaves[CONVOLUTIONS.len() * 2..];
        if !self.architecture.dueling {
            return fully_connected(&features, streams);
        }
        let (value, advantage) = streams.split_at(streams.len() / 2);
        let (value, advantage) = (fully_connected(&features, value)?, fully_connected(&features, advantage)?);
        let mean = advantage.f_mean_dim([1i64].as_slice(), true, Kind::Float)?;
        Ok(advantage.f_add(&value.f_sub(&mean)?)?)
    }

    /// Q-values of `count` pictures of h × w bytes each: count × actions values, row by row, outside the autograd graph.
    pub fn q_values(&self, bytes: &[u8], count: usize) -> Result<Vec<f32>> {
        no_grad(|| tensor_to_vec(&self.forward(&self.pictures(bytes, count)?)?))
    }

    /// `count` pictures of h × w bytes each as the network's input: blocks of 4×4 pixels, in [0, 1], shape
    /// [count, 16, h / 4, w / 4], the channels of a block side by side in memory.
    pub fn pictures(&self, bytes: &[u8], count: usize) -> Result<Tensor> {
        let [height, width] = self.architecture.input;
        let bytes = Tensor::f_from_slice(&blocks::of_pictures(bytes, [height as usize, width as usize]))?;
        let shape = [count as i64, blocks::along(height), blocks::along(width), blocks::CHANNELS as i64];
        let bytes = bytes.f_to_device(self.device())?.f_view(shape)?.f_permute([0, 3, 1, 2])?;
        Ok(bytes.f_to_kind(self.parameters.computed().kind())?.f_mul_scalar_(1.0 / 255.0)?)
    }

    /// Takes over the parameters of another network of the same architecture.
    pub fn copy_from(&mut self, other: &Self) -> Result<()> {
        no_grad(|| self.parameters.copy_from(&other.parameters))
    }

    /// Shape of the network.
    pub fn architecture(&self) -> &Architecture {
        &self.architecture
    }

    /// Where the parameters lie.
    pub fn device(&self) -> Device {
        self.parameters.flat.device()
    }

    /// The leaves to differentiate for, in the order of the flat tensor.
    pub fn leaves(&self) -> &[Tensor] {
        &self.leaves
    }

    /// The parameters, for an optimiser.
    pub fn parameters_mut(&mut self) -> &mut Parameters {
        &mut self.parameters
    }

    /// A copy of the parameters, in the order of [`Architecture::parameters`].
    pub fn to_vec(&self) -> Result<Vec<f32>> {
        let mut values = tensor_to_vec(&self.parameters.flat)?;
        blocks::to_kernels(&mut values[..FIRST_KERNELS]);
        Ok(values)
    }
}

/// What the hidden and the output layer of a stream make of `features`.
fn fully_connected(features: &Tensor, parameters: &[Tensor]) -> Result<Tensor> {
    let [hidden_weight, hidden_bias, output_weight, output_bias] = parameters else {
        unreachable!("weights and biases of two layers")
    };
    let hidden = features.f_linear(hidden_weight, Some(hidden_bias))?.f_relu_()?;
    Ok(hidden.f_linear(output_weight, Some(output_bias))?.f_to_kind(Kind::Float)?)
}

/// Copies a tensor's values to the host.
pub(crate) fn tensor_to_vec(tensor: &Tensor) -> Result<Vec<f32>> {
    let flat = tensor.f_detach()?.f_to_device(Device::Cpu)?.f_to_kind(Kind::Float)?.f_contiguous()?;
    let mut values = vec![0.0; flat.numel()];
    let count = values.len();
    flat.f_copy_data(&mut values, count)?;
    Ok(values)
}
