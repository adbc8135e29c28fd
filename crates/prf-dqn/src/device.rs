//! Where the network computes.

use std::fmt;

use crate::error::{Error, Result};

/// A device that the user may name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Device {
    /// The processor.
    Cpu,
    /// The first NVIDIA GPU.
    Cuda,
    /// Apple's GPU.
    Mps,
}

impl Device {
    /// The device as libtorch names it.
    ///
    /// # Errors
    /// [`Error::Device`] when this libtorch cannot use it on this machine.
    pub fn open(self) -> Result<tch::Device> {
        match self {
            Self::Cpu => Ok(tch::Device::Cpu),
            Self::Cuda if tch::Cuda::is_available() => Ok(tch::Device::Cuda(0)),
            Self::Mps if tch::utils::has_mps() => Ok(tch::Device::Mps),
            Self::Cuda => Err(self.missing("cpu, or a libtorch built for CUDA (set LIBTORCH to it) and an NVIDIA GPU")),
            Self::Mps => Err(self.missing("cpu, or a Mac with an Apple GPU")),
        }
    }

    fn missing(self, expected: &str) -> Error {
        Error::Device { got: self.to_string(), expected: expected.to_owned() }
    }
}

impl fmt::Display for Device {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Cpu => "cpu",
            Self::Cuda => "cuda",
            Self::Mps => "mps",
        })
    }
}
