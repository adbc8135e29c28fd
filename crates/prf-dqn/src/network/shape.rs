//! The shape of the network: what decides it, its layers, and the order of its parameters.

use std::fmt;

use serde::{Deserialize, Serialize};

use super::blocks;

/// One convolution: output channels, kernel side, stride.
const CONVOLUTIONS: [(usize, usize, usize); 3] = [(32, 8, 4), (64, 4, 2), (64, 3, 1)];
/// Units of each hidden fully connected layer.
const HIDDEN_UNITS: i64 = 512;

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

/// A convolution as it is computed, and the pictures it goes over.
#[derive(Debug, Clone, Copy)]
pub(super) struct Convolution {
    /// Channels of what goes in.
    pub(super) inputs: usize,
    /// Channels of what comes out.
    pub(super) outputs: usize,
    /// Side of the kernel.
    pub(super) kernel: usize,
    /// By how much it moves.
    pub(super) stride: usize,
    /// Height and width of what goes in.
    pub(super) from: [usize; 2],
    /// Height and width of what comes out.
    pub(super) to: [usize; 2],
}

impl Convolution {
    /// Numbers that go into one number that comes out.
    pub(super) fn reach(&self) -> usize {
        self.kernel * self.kernel * self.inputs
    }

    /// Places of one picture that comes out.
    pub(super) fn places(&self) -> usize {
        self.to[0] * self.to[1]
    }
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
        let mut inputs = 1;
        for (index, (outputs, kernel, _)) in CONVOLUTIONS.into_iter().enumerate() {
            push(&format!("conv{}", index + 1), [outputs, inputs, kernel, kernel].map(|side| side as i64).to_vec());
            inputs = outputs;
        }
        let features = self.convolutions().last().map_or(0, |layer| layer.outputs * layer.places());
        for (stream, outputs) in self.streams() {
            push(&format!("{stream}hidden"), vec![HIDDEN_UNITS, features as i64]);
            push(&format!("{stream}output"), vec![outputs, HIDDEN_UNITS]);
        }
        parameters
    }

    /// How many parameters each layer has, from the input to the output.
    pub(crate) fn lengths(&self) -> Vec<i64> {
        let count = |shape: &(String, Vec<i64>)| shape.1.iter().product::<i64>();
        self.parameters().chunks_exact(2).map(|layer| layer.iter().map(count).sum()).collect()
    }

    /// The convolutions, from the input on; the first one goes over blocks of pixels.
    pub(super) fn convolutions(&self) -> Vec<Convolution> {
        let mut from = self.input.map(|side| side as usize / blocks::BLOCK);
        let mut inputs = blocks::CHANNELS;
        let layers = CONVOLUTIONS.into_iter().enumerate().map(|(index, (outputs, mut kernel, mut stride))| {
            if index == 0 {
                (kernel, stride) = (kernel / blocks::BLOCK, stride / blocks::BLOCK);
            }
            let to = from.map(|side| (side - kernel) / stride + 1);
            let layer = Convolution { inputs, outputs, kernel, stride, from, to };
            (from, inputs) = (to, outputs);
            layer
        });
        layers.collect()
    }

    /// What the layers after the convolutions are called, and their numbers of outputs.
    pub(super) fn streams(&self) -> Vec<(&'static str, i64)> {
        if self.dueling { vec![("value.", 1), ("advantage.", self.actions)] } else { vec![("", self.actions)] }
    }

    /// The smallest height and width that the convolutions accept, in pixels.
    pub fn smallest_input() -> i64 {
        CONVOLUTIONS.into_iter().rev().fold(1, |side, (_, kernel, stride)| (side - 1) * stride + kernel) as i64
    }

    /// Parameters in the order in which they have names, in the order in which they are computed with: the numbers of a place,
    /// of all channels, lie side by side in a picture, and so do their weights.
    pub(super) fn ordered(&self, values: &[f32]) -> Vec<f32> {
        self.reordered(values, |from, to, weights, ordered| ordered[to] = weights[from])
    }

    /// What [`ordered`](Architecture::ordered) does, undone.
    pub(crate) fn named(&self, values: &[f32]) -> Vec<f32> {
        self.reordered(values, |from, to, ordered, weights| weights[from] = ordered[to])
    }

    /// Assigns each weight of an output, between where it lies by its name and where it lies when it is computed with.
    fn reordered(&self, values: &[f32], assign: impl Fn(usize, usize, &[f32], &mut [f32])) -> Vec<f32> {
        let convolutions = self.convolutions();
        let features = convolutions.last().map_or((1, 1), |layer| (layer.outputs, layer.places()));
        let mut reordered = values.to_vec();
        let mut start = 0;
        for (index, (name, shape)) in self.parameters().into_iter().enumerate() {
            let count = shape.iter().product::<i64>() as usize;
            let kernel = shape.last().map_or(1, |side| *side as usize);
            let (channels, places) = match index / 2 {
                _ if !name.ends_with(".weight") => (1, 1),
                0 => (1, kernel * kernel),
                layer if layer < convolutions.len() => (convolutions[layer].inputs, kernel * kernel),
                _ if name.ends_with("hidden.weight") => features,
                _ => (1, 1),
            };
            for output in (start..start + count).step_by(channels * places) {
                for (channel, place) in (0..channels).flat_map(|channel| (0..places).map(move |place| (channel, place)))
                {
                    let to = match index {
                        0 => blocks::place(kernel, [place / kernel, place % kernel]),
                        _ => place * channels + channel,
                    };
                    assign(output + channel * places + place, output + to, values, &mut reordered);
                }
            }
            start += count;
        }
        reordered
    }
}

impl fmt::Display for Architecture {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let ([height, width], kind) = (self.input, if self.dueling { "dueling " } else { "" });
        write!(f, "a {kind}network for {height}×{width} px and {} actions", self.actions)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn count(architecture: &Architecture) -> i64 {
        architecture.parameters().iter().map(|(_, shape)| shape.iter().product::<i64>()).sum()
    }

    #[test]
    fn parameters_are_those_of_the_published_network() {
        let architecture = Architecture { input: [84, 84], actions: 3, dueling: false };
        // 32·(8·8+1) + 64·(32·16+1) + 64·(64·9+1) + 512·(3136+1) + 3·(512+1)
        assert_eq!(count(&architecture), 2_080 + 32_832 + 36_928 + 1_606_144 + 1_539);
        assert_eq!(Architecture::smallest_input(), 36);
    }

    #[test]
    fn a_dueling_network_has_two_streams_of_512() {
        let architecture = Architecture { input: [84, 84], actions: 3, dueling: true };
        // The same convolutions, then twice 512·(3136+1), with 1·(512+1) for the value and 3·(512+1) for the advantages.
        assert_eq!(count(&architecture), 2_080 + 32_832 + 36_928 + 2 * 1_606_144 + 513 + 1_539);
    }

    #[test]
    fn the_weights_of_a_place_come_to_lie_side_by_side() {
        let architecture = Architecture { input: [36, 44], actions: 3, dueling: true };
        let values: Vec<f32> = (0..count(&architecture)).map(|at| at as f32).collect();
        let ordered = architecture.ordered(&values);
        // The first row of the first block of the first kernel of 8×8 pixels, and its second.
        assert_eq!(ordered[..8], [0.0, 1.0, 2.0, 3.0, 8.0, 9.0, 10.0, 11.0]);
        // After 32 of them and as many biases, a kernel of 4×4 places and 32 channels: its first place first.
        assert_eq!(ordered[2_048..2_080], values[2_048..2_080]);
        assert_eq!(
            ordered[2_080..2_080 + 34],
            *(0..34).map(|at| (2_080 + at % 32 * 16 + at / 32) as f32).collect::<Vec<_>>()
        );
        assert_eq!(architecture.named(&ordered), values);
    }
}
