//! `model.safetensors`: a network's parameters by name, enough to play with.

use std::fs;
use std::path::Path;

use safetensors::{Dtype, SafeTensors};

use super::{Origin, bytes_of, floats_of, view};
use crate::compute::Compute;
use crate::error::{Error, Result};
use crate::files::write_whole;
use crate::network::{Architecture, QNetwork};

/// A network's shape and parameters.
#[derive(Debug, Clone, PartialEq)]
pub struct Model {
    /// The shape.
    pub architecture: Architecture,
    /// The parameters, in the order of [`Architecture::parameters`].
    pub values: Vec<f32>,
}

impl Model {
    /// The model of a network.
    pub fn of(network: &QNetwork) -> Result<Self> {
        Ok(Self { architecture: network.architecture().clone(), values: network.to_vec()? })
    }

    /// The network of this model.
    pub fn network(&self, compute: &Compute) -> Result<QNetwork> {
        QNetwork::from_flat(self.architecture.clone(), &self.values, compute)
    }

    /// Writes the file whole or, on an error, not at all.
    pub fn write(&self, path: &Path) -> Result<()> {
        write_whole(path, &self.to_bytes())
    }

    fn to_bytes(&self) -> Vec<u8> {
        let bytes = bytes_of(&self.values);
        let mut rest = bytes.as_slice();
        let mut tensors = Vec::new();
        for (name, shape) in self.architecture.parameters() {
            let shape: Vec<usize> = shape.into_iter().map(|side| side as usize).collect();
            let (head, tail) = rest.split_at(4 * shape.iter().product::<usize>());
            tensors.push((name, view(Dtype::F32, shape, head)));
            rest = tail;
        }
        let metadata = Origin::ours(&self.architecture).metadata();
        safetensors::serialize(tensors, Some(metadata)).expect("names are distinct and sizes consistent")
    }

    /// Reads a model file.
    ///
    /// # Errors
    /// [`Error::Checkpoint`] when the file is damaged; [`Error::Format`] when it is older or newer than what this version reads,
    /// or nothing that PRF wrote; [`Error::Io`] when it cannot be read.
    pub fn read(path: &Path) -> Result<Self> {
        let bytes = fs::read(path).map_err(Error::unreadable(path))?;
        let damaged = |error: safetensors::SafeTensorError| Error::checkpoint(path, error, "a whole safetensors file");
        let (_, metadata) = SafeTensors::read_metadata(&bytes).map_err(damaged)?;
        let tensors = SafeTensors::deserialize(&bytes).map_err(damaged)?;
        let architecture = Origin::read(&metadata, path)?;
        let mut values = Vec::new();
        for (name, shape) in architecture.parameters() {
            let tensor = tensors.tensor(&name).map_err(damaged)?;
            let found: Vec<i64> = tensor.shape().iter().map(|side| *side as i64).collect();
            if tensor.dtype() != Dtype::F32 || found != shape {
                let got = format!("`{name}` of type {} and shape {found:?}", tensor.dtype());
                return Err(Error::checkpoint(path, got, format!("F32 and shape {shape:?}")));
            }
            values.extend(floats_of(tensor.data()));
        }
        Ok(Self { architecture, values })
    }

    /// Checks that the model fits a task.
    ///
    /// # Errors
    /// [`Error::Mismatch`] with both shapes.
    pub fn check(&self, expected: &Architecture, path: &Path) -> Result<()> {
        if self.architecture == *expected {
            return Ok(());
        }
        Err(Error::mismatch(path, &self.architecture, expected))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn model(dueling: bool) -> Model {
        let architecture = Architecture { input: [44, 52], actions: 4, dueling };
        let mut rng = prf_envs::rng::stream(1, "network", 0);
        Model::of(&QNetwork::new(architecture, &Compute::plain(), &mut rng).expect("network")).expect("model")
    }

    #[test]
    fn a_model_is_read_back_to_the_bit() {
        for dueling in [false, true] {
            let dir = tempfile::tempdir().expect("dir");
            let path = dir.path().join("model.safetensors");
            model(dueling).write(&path).expect("write");
            assert_eq!(Model::read(&path).expect("read"), model(dueling));
            assert_eq!(fs::read_dir(dir.path()).expect("dir").count(), 1, "a temporary file was left");
        }
    }

    #[test]
    fn a_file_names_its_layers() {
        let bytes = model(true).to_bytes();
        let tensors = SafeTensors::deserialize(&bytes).expect("whole");
        let mut names = tensors.names();
        names.retain(|name| name.ends_with(".weight"));
        let streams =
            ["advantage.hidden", "advantage.output", "conv1", "conv2", "conv3", "value.hidden", "value.output"];
        names.sort_unstable();
        assert_eq!(names, streams.map(|layer| format!("{layer}.weight")));
        assert_eq!(tensors.tensor("value.output.weight").expect("it is named").shape(), [1, 512]);
        assert_eq!(tensors.tensor("advantage.output.weight").expect("it is named").shape(), [4, 512]);
    }

    #[test]
    fn a_file_cut_short_is_an_error_that_names_it() {
        let dir = tempfile::tempdir().expect("dir");
        let path = dir.path().join("model.safetensors");
        let bytes = model(false).to_bytes();
        for length in [0, 4, 100, bytes.len() / 2, bytes.len() - 1] {
            fs::write(&path, &bytes[..length]).expect("write");
            let error = Model::read(&path).expect_err("cut short").to_string();
            assert!(error.contains("model.safetensors") && error.contains("expected a whole"), "{error}");
            let error = super::super::check_length(&path).expect_err("cut short").to_string();
            assert!(error.contains(&format!("model.safetensors: got {length} bytes, expected ")), "{error}");
        }
        fs::write(&path, &bytes).expect("write");
        super::super::check_length(&path).expect("it is whole");
    }

    #[test]
    fn a_model_for_another_task_is_an_error_with_both_networks() {
        let expected = Architecture { input: [84, 84], actions: 3, dueling: false };
        let error = model(true).check(&expected, Path::new("m")).expect_err("other").to_string();
        let both = ["a dueling network for 44×52 px and 4 actions", "expected a network for 84×84 px and 3 actions"];
        assert!(both.iter().all(|network| error.contains(network)), "{error}");
    }
}
