//! The network's layers and what they make of pictures.

use tch::{Kind, Tensor};

use super::blocks;
use super::shape::{Architecture, Convolution};
use crate::error::Result;

/// A product of matrices and a sum: weights of shape [outputs, inputs], biases of shape [outputs].
#[derive(Debug)]
pub(super) struct Dense {
    pub(super) weight: Tensor,
    pub(super) bias: Tensor,
}

/// Weights and biases by layers, as handles to where the parameters lie.
#[derive(Debug)]
pub(crate) struct Layers {
    /// Height and width of the input, in pixels.
    input: [usize; 2],
    pub(super) convolutions: Vec<(Convolution, Dense)>,
    /// A hidden and an output layer each; of two, the first is the value's and the second the advantages'.
    pub(super) streams: Vec<[Dense; 2]>,
}

/// What a forward pass found on its way.
#[derive(Debug)]
pub(crate) struct Trace {
    /// What went into each convolution and what came out of the last, shape [count · height · width, channels].
    pub(super) pictures: Vec<Tensor>,
    /// What came out of each hidden layer, shape [count, units].
    pub(super) hidden: Vec<Tensor>,
    /// Shape [count, actions], f32.
    pub(crate) values: Tensor,
}

impl Dense {
    pub(super) fn share(&self) -> Self {
        Self { weight: self.weight.shallow_clone(), bias: self.bias.shallow_clone() }
    }

    fn forward(&self, inputs: &Tensor) -> Result<Tensor> {
        Ok(inputs.f_linear(&self.weight, Some(&self.bias))?)
    }

    /// The pictures that the convolution `layer` makes of others.
    fn convolve(&self, pictures: &Tensor, layer: &Convolution) -> Result<Tensor> {
        let pictures = channels_first(pictures, layer.from, layer.inputs)?;
        let kernels = channels_first(&self.weight, [layer.kernel; 2], layer.inputs)?;
        let stride = [layer.stride as i64; 2];
        channels_last(&pictures.f_conv2d(&kernels, Some(&self.bias), stride, [0; 2], [1; 2], 1)?, layer.outputs)
    }
}

/// Pictures or kernels in the order that libtorch names, [count, channels, height, width], where they lie.
pub(super) fn channels_first(rows: &Tensor, [height, width]: [usize; 2], channels: usize) -> Result<Tensor> {
    Ok(rows.f_view([-1, height as i64, width as i64, channels as i64])?.f_permute([0, 3, 1, 2])?)
}

/// What [`channels_first`] does, undone.
pub(super) fn channels_last(pictures: &Tensor, channels: usize) -> Result<Tensor> {
    // Where libtorch gave them channels first, this copies them.
    Ok(pictures.f_permute([0, 2, 3, 1])?.f_contiguous()?.f_view([-1, channels as i64])?)
}

pub(super) fn mean(values: &Tensor) -> Result<Tensor> {
    Ok(values.f_mean_dim([1i64].as_slice(), true, Kind::Float)?)
}

impl Layers {
    /// Layers over `parameters`, shape [n], in the order in which they are computed with.
    pub(super) fn over(parameters: &Tensor, architecture: &Architecture) -> Result<Self> {
        let mut offset = 0;
        let mut next = |outputs: i64, inputs: i64| -> Result<Dense> {
            let weight = parameters.f_narrow(0, offset, outputs * inputs)?.f_view([outputs, inputs])?;
            let bias = parameters.f_narrow(0, offset + outputs * inputs, outputs)?;
            offset += outputs * inputs + outputs;
            Ok(Dense { weight, bias })
        };
        let convolutions = architecture
            .convolutions()
            .into_iter()
            .map(|layer| Ok((layer, next(layer.outputs as i64, layer.reach() as i64)?)))
            .collect::<Result<Vec<_>>>()?;
        let shapes = architecture.parameters();
        let streams = shapes[2 * convolutions.len()..]
            .chunks_exact(4)
            .map(|stream| {
                let mut layer = |weight: &[i64]| next(weight[0], weight[1]);
                Ok([layer(&stream[0].1)?, layer(&stream[2].1)?])
            })
            .collect::<Result<Vec<_>>>()?;
        debug_assert_eq!(offset, parameters.numel() as i64);
        Ok(Self { input: architecture.input.map(|side| side as usize), convolutions, streams })
    }

    /// Other handles to the same parameters, for another thread.
    pub(crate) fn share(&self) -> Self {
        Self {
            input: self.input,
            convolutions: self.convolutions.iter().map(|(layer, dense)| (*layer, dense.share())).collect(),
            streams: self.streams.iter().map(|stream| stream.each_ref().map(Dense::share)).collect(),
        }
    }

    /// Pictures of h × w bytes each as the network's input: [`blocks`], in [0, 1].
    pub(crate) fn pictures(&self, bytes: &[u8]) -> Result<Tensor> {
        let (layer, Dense { weight, .. }) = &self.convolutions[0];
        let bytes = Tensor::f_from_slice(&blocks::of_pictures(bytes, self.input))?.f_view([-1, layer.inputs as i64])?;
        Ok(bytes.f_to_device(weight.device())?.f_to_kind(weight.kind())?.f_mul_scalar_(1.0 / 255.0)?)
    }

    /// Rows of [`pictures`](Layers::pictures) for each picture.
    pub(crate) fn rows(&self) -> usize {
        self.convolutions[0].0.from.iter().product()
    }

    /// What the network makes of [`pictures`](Layers::pictures).
    ///
    /// A dueling network gives V + A − mean A (equation 9 of Wang et al.).
    pub(crate) fn forward(&self, pictures: &Tensor) -> Result<Trace> {
        let count = pictures.size()[0] as usize / self.rows();
        let mut found = vec![pictures.shallow_clone()];
        for (layer, dense) in &self.convolutions {
            let last = found.last().expect("the input is there");
            found.push(dense.convolve(last, layer)?.f_relu_()?);
        }
        let features = found.last().expect("there are convolutions").f_view([count as i64, -1])?;
        let hidden = self.streams.iter().map(|[hidden, _]| Ok(hidden.forward(&features)?.f_relu_()?));
        let hidden = hidden.collect::<Result<Vec<_>>>()?;
        let outputs = self.streams.iter().zip(&hidden);
        let outputs = outputs.map(|([_, output], hidden)| Ok(output.forward(hidden)?.f_to_kind(Kind::Float)?));
        let outputs = outputs.collect::<Result<Vec<_>>>()?;
        let values = match outputs.as_slice() {
            [values] => values.shallow_clone(),
            [value, advantage] => advantage.f_add(&value.f_sub(&mean(advantage)?)?)?,
            _ => unreachable!("one stream, or two"),
        };
        Ok(Trace { pictures: found, hidden, values })
    }
}
