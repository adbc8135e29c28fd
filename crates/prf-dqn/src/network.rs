//! The Q-network of Mnih et al. (Nature, 2015) on one picture, plain or dueling (Wang et al., 2016), with all parameters in
//! one flat tensor.

use prf_envs::rng::ChaCha8Rng;
use tch::{Device, Kind, Tensor};

use crate::compute::Compute;
use crate::error::{Error, Result};

mod backward;
mod blocks;
mod columns;
mod layers;
mod shape;
#[cfg(test)]
pub(crate) mod tests;

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
pub(crate) struct Parameters {
    /// As they are learned, f32.
    pub flat: Tensor,
    /// The same, rounded to the numbers that are computed with, if these are others.
    pub rounded: Option<Tensor>,
}

impl Parameters {
    pub(crate) fn new(values: &[f32], compute: &Compute) -> Result<Self> {
        let flat = Tensor::f_from_slice(values)?.f_to_device(compute.device())?;
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
    ///
    /// # Panics
    /// When these are not as many as the architecture has.
    pub fn from_flat(architecture: Architecture, values: &[f32], compute: &Compute) -> Result<Self> {
        let count: i64 = architecture.lengths().iter().sum();
        assert_eq!(values.len() as i64, count, "the parameters of {architecture} are others");
        let parameters = Parameters::new(&architecture.ordered(values), compute)?;
        let layers = Layers::over(parameters.computed(), &architecture)?;
        Ok(Self { architecture, compute: compute.clone(), parameters, layers })
    }

    /// Q-values of `count` pictures of h × w bytes each: count × actions values, row by row.
    ///
    /// # Panics
    /// When there are more bytes, or fewer.
    pub fn q_values(&self, bytes: &[u8], count: usize) -> Result<Vec<f32>> {
        let [height, width] = self.architecture.input;
        let each = (height * width) as usize;
        assert_eq!(bytes.len(), count * each, "{count} pictures of {height}×{width} px have other bytes");
        let left = self.left(count) * each;
        let (left, right) = bytes.split_at(left);
        let [of_left, of_right] = [self.layers(), self.layers()];
        let q_values = |layers: &Layers, bytes: &[u8]| match bytes {
            [] => Ok(Vec::new()),
            bytes => tensor_to_vec(&layers.forward(&layers.pictures(bytes)?)?.values),
        };
        let both = self.compute.pair().join(move || q_values(&of_left, left), move || q_values(&of_right, right));
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
        let both = self.compute.pair().join(move || values(&of_left, &left), move || values(&of_right, &right));
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
        self.parameters.copy_from(&other.parameters)
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
    pub(crate) fn parameters_mut(&mut self) -> &mut Parameters {
        &mut self.parameters
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
