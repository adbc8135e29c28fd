//! The Q-network of Mnih et al. (Nature, 2015) on one picture, plain or dueling (Wang et al., 2016), with all parameters in
//! one flat tensor.

use prf_envs::rng::ChaCha8Rng;
use tch::{Device, Kind, Tensor, no_grad};

use crate::compute::Compute;
use crate::error::{Error, Result};

mod backward;
mod blocks;
mod columns;
mod layers;
mod shape;

pub(crate) use layers::{Layers, Trace};
pub use shape::Architecture;

/// A Q-network: pictures in, one value an action out.
#[derive(Debug)]
pub struct QNetwork {
    architecture: Architecture,
    compute: Compute,
    parameters: Parameters,
    layers: Layers,
}

/// A network's parameters, shape [n], in the order in which they are computed with.
#[derive(Debug)]
pub struct Parameters {
    /// As they are learned, f32.
    pub flat: Tensor,
    /// The same, rounded to the numbers that are computed with, if these are others.
    pub rounded: Option<Tensor>,
}

impl Parameters {
    pub(crate) fn new(values: &[f32], compute: &Compute) -> Result<Self> {
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
    pub fn new(architecture: Architecture, compute: &Compute, rng: &mut ChaCha8Rng) -> Result<Self> {
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
    pub fn from_flat(architecture: Architecture, values: &[f32], compute: &Compute) -> Result<Self> {
        let parameters = Parameters::new(&architecture.ordered(values), compute)?;
        let layers = Layers::over(parameters.computed(), &architecture)?;
        Ok(Self { architecture, compute: compute.clone(), parameters, layers })
    }

    /// Q-values of `count` pictures of h × w bytes each: count × actions values, row by row.
    pub fn q_values(&self, bytes: &[u8], count: usize) -> Result<Vec<f32>> {
        let [height, width] = self.architecture.input;
        let left = self.left(count) * (height * width) as usize;
        let (left, right) = bytes.split_at(left);
        let [of_left, of_right] = [self.layers(), self.layers()];
        let q_values = |layers: &Layers, bytes: &[u8]| match bytes {
            [] => Ok(Vec::new()),
            bytes => tensor_to_vec(&layers.forward(&layers.pictures(bytes)?)?.values),
        };
        let both = self.compute.pair.join(move || q_values(&of_left, left), move || q_values(&of_right, right));
        Ok([both.0?, both.1?].concat())
    }

    /// Q-values of [`pictures`](Layers::pictures), shape [n, actions], f32.
    pub(crate) fn values(&self, pictures: &Tensor) -> Result<Tensor> {
        let rows = pictures.size()[0];
        let of_each = self.layers.rows() as i64;
        let left = self.left((rows / of_each) as usize) as i64 * of_each;
        if left == 0 {
            return Ok(self.layers.forward(pictures)?.values);
        }
        let [of_left, of_right] = [self.layers(), self.layers()];
        let (left, right) = (pictures.f_narrow(0, 0, left)?, pictures.f_narrow(0, left, rows - left)?);
        let values = |layers: &Layers, part: &Tensor| Ok::<_, Error>(layers.forward(part)?.values);
        let both = self.compute.pair.join(move || values(&of_left, &left), move || values(&of_right, &right));
        Ok(Tensor::f_cat(&[both.0?, both.1?], 0)?)
    }

    /// How many of so many pictures one of both workers looks at. A GPU isn't quicker at the half of them.
    fn left(&self, count: usize) -> usize {
        if self.device() == Device::Cpu { count / 2 } else { 0 }
    }

    /// Handles to the layers, for another thread.
    pub(crate) fn layers(&self) -> Layers {
        self.layers.share()
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

    /// The parameters, for an optimiser.
    pub(crate) fn parameters(&self) -> &Parameters {
        &self.parameters
    }

    /// A copy of the parameters, in the order of [`Architecture::parameters`].
    pub fn to_vec(&self) -> Result<Vec<f32>> {
        Ok(self.architecture.named(&tensor_to_vec(&self.parameters.flat)?))
    }
}

/// Copies a tensor's values to the host.
pub(crate) fn tensor_to_vec(tensor: &Tensor) -> Result<Vec<f32>> {
    let flat = tensor.f_detach()?.f_to_device(Device::Cpu)?.f_to_kind(Kind::Float)?.f_contiguous()?;
    let mut values = vec![0.0; flat.numel()];
    let count = values.len();
    flat.f_copy_data(&mut values, count)?;
    Ok(values)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compute::Precision;
    use prf_envs::rng::{stream, unit_f32};
    use tch::Reduction;

    #[test]
    fn the_values_of_a_dueling_network_are_v_plus_a_minus_its_mean() {
        let architecture = Architecture { input: [36, 36], actions: 2, dueling: true };
        let shapes = architecture.parameters();
        let mut values: Vec<f32> =
            shapes.iter().flat_map(|(_, shape)| vec![0.0; shape.iter().product::<i64>() as usize]).collect();
        // Every hidden unit is 1, whatever the picture: the value is 512 · 0.01 + 0.5, the advantages are 512 · 0.02 + 1 and 3.
        let mut rest = values.as_mut_slice();
        for (name, shape) in &shapes {
            let (layer, tail) = rest.split_at_mut(shape.iter().product::<i64>() as usize);
            match name.as_str() {
                "value.hidden.bias" | "advantage.hidden.bias" => layer.fill(1.0),
                "value.output.weight" => layer.fill(0.01),
                "value.output.bias" => layer.fill(0.5),
                "advantage.output.weight" => layer[..512].fill(0.02),
                "advantage.output.bias" => layer.copy_from_slice(&[1.0, 3.0]),
                _ => {}
            }
            rest = tail;
        }
        let network = QNetwork::from_flat(architecture, &values, &Compute::plain()).expect("network");
        let found = network.q_values(&[7; 36 * 36], 1).expect("values");
        let (value, advantages) = (5.62, [11.24, 3.0]);
        for (found, advantage) in found.iter().zip(advantages) {
            let expected = value + advantage - (11.24 + 3.0) / 2.0;
            assert!((found - expected).abs() < 1e-4, "{found} should be {expected}");
        }
    }

    fn network(dueling: bool, compute: &Compute) -> QNetwork {
        // No stride fits the height, nor the width.
        let architecture = Architecture { input: [47, 54], actions: 3, dueling };
        let mut network = QNetwork::new(architecture, compute, &mut stream(3, "network", 0)).expect("network");
        // Biases that are not all 0.
        let mut values = network.to_vec().expect("values");
        let mut rng = stream(4, "biases", 0);
        values.iter_mut().filter(|value| **value == 0.0).for_each(|value| *value = 0.1 * unit_f32(&mut rng) - 0.05);
        network = QNetwork::from_flat(network.architecture, &values, compute).expect("network");
        network
    }

    fn pictures(count: usize) -> Vec<u8> {
        let mut rng = stream(5, "pictures", 0);
        (0..count * 47 * 54).map(|_| (unit_f32(&mut rng) * 255.0) as u8).collect()
    }

    fn gradients(layers: &Layers, trace: Trace, values: &Tensor, compute: &Compute) -> Vec<Tensor> {
        let (send, receive) = std::sync::mpsc::channel();
        let count = layers.convolutions.len() + 2 * layers.streams.len();
        let take = (0..count).map(|index| {
            let send = send.clone();
            move |found| Ok(send.send((index, found)).expect("it is received"))
        });
        layers.backward(trace, values, &compute.pair, take.collect()).expect("backward");
        drop(send);
        let mut found: Vec<(usize, [Tensor; 2])> = receive.into_iter().collect();
        found.sort_by_key(|(index, _)| *index);
        found.into_iter().flat_map(|(_, found)| found).collect()
    }

    /// The network as libtorch's own layers have it, whose gradients its autograd finds.
    fn by_autograd(network: &QNetwork, bytes: &[u8]) -> (Tensor, Vec<Tensor>) {
        let flat = network.to_vec().expect("values");
        let mut rest = flat.as_slice();
        let leaves: Vec<Tensor> = network
            .architecture
            .parameters()
            .into_iter()
            .map(|(_, shape)| {
                let (head, tail) = rest.split_at(shape.iter().product::<i64>() as usize);
                rest = tail;
                Tensor::from_slice(head).view(&shape[..]).set_requires_grad(true)
            })
            .collect();
        let mut x = Tensor::from_slice(bytes).view([-1, 1, 47, 54]).to_kind(Kind::Float) / 255.0;
        for (layer, stride) in [4, 2, 1].into_iter().enumerate() {
            x = x.conv2d(&leaves[2 * layer], Some(&leaves[2 * layer + 1]), [stride; 2], [0, 0], [1, 1], 1).relu();
        }
        let x = x.flatten(1, -1);
        let streams: Vec<Tensor> = leaves[6..]
            .chunks_exact(4)
            .map(|layer| x.linear(&layer[0], Some(&layer[1])).relu().linear(&layer[2], Some(&layer[3])))
            .collect();
        let values = match &streams[..] {
            [value, advantage] => value + advantage - advantage.mean_dim([1i64].as_slice(), true, Kind::Float),
            _ => streams[0].shallow_clone(),
        };
        (values, leaves)
    }

    #[test]
    fn values_and_gradients_are_those_of_libtorch_and_its_autograd() {
        for (dueling, precision, tolerance) in
            [(false, Precision::F32, 1e-5), (true, Precision::F32, 1e-5), (true, Precision::Bf16, 0.1)]
        {
            let compute = Compute { precision, ..Compute::plain() };
            let (network, count) = (network(dueling, &compute), 5);
            let bytes = pictures(count);
            let (expected, leaves) = by_autograd(&network, &bytes);
            let layers = network.layers();
            let trace = layers.forward(&layers.pictures(&bytes).expect("pictures")).expect("forward");
            let close = |name: &str, found: &Tensor, expected: &Tensor| {
                assert_eq!(found.size(), expected.size(), "{name}");
                let difference = (found - expected).norm().double_value(&[]) / expected.norm().double_value(&[]);
                assert!(difference < tolerance, "{name} of {dueling} {precision:?}: {difference}");
            };
            close("values", &trace.values, &expected);
            let in_parts = network.q_values(&bytes, count).expect("values");
            close("values in parts", &Tensor::from_slice(&in_parts).view_as(&expected), &expected);

            let wanted = Tensor::from_slice(&[0.3f32, -2.0, 1.0]).expand([count as i64, 3], false);
            let gradient = (&trace.values - &wanted) * 2.0;
            let expected = Tensor::run_backward(&[expected.mse_loss(&wanted, Reduction::Sum)], &leaves, false, false);
            let found = gradients(&layers, trace, &gradient, &compute);
            assert_eq!(found.len(), expected.len());
            let flat = |tensors: &[Tensor]| {
                let flat: Vec<Tensor> = tensors.iter().map(|tensor| tensor.flatten(0, -1)).collect();
                tensor_to_vec(&Tensor::cat(&flat, 0)).expect("values")
            };
            let mut found = Tensor::from_slice(&network.architecture.named(&flat(&found)));
            for ((name, shape), expected) in network.architecture.parameters().into_iter().zip(&expected) {
                let count = shape.iter().product::<i64>();
                close(&name, &found.narrow(0, 0, count).view(&shape[..]), expected);
                found = found.narrow(0, count, found.numel() as i64 - count);
            }
        }
    }

    #[test]
    fn one_worker_finds_the_same_bits_as_two() {
        let [one, two] = [1, 2].map(|threads| {
            let compute = Compute::new(Device::Cpu, Precision::F32, threads).expect("threads");
            let network = network(true, &compute);
            let bytes = pictures(6);
            let layers = network.layers();
            let trace = layers.forward(&layers.pictures(&bytes).expect("pictures")).expect("forward");
            let gradient = trace.values.shallow_clone();
            let gradients: Vec<Vec<f32>> = gradients(&layers, trace, &gradient, &compute)
                .iter()
                .map(|found| tensor_to_vec(found).expect("values"))
                .collect();
            (network.q_values(&bytes, 6).expect("values"), gradients)
        });
        assert_eq!(one, two);
    }
}
