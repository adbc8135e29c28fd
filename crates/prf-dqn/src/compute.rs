//! Where a network computes, and in what numbers.

use serde::{Deserialize, Serialize};
use tch::{Device, Kind};

/// Where a network computes, and in what numbers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Compute {
    /// Where its tensors lie.
    pub device: Device,
    /// The numbers of its forward and backward passes.
    pub precision: Precision,
}

/// The numbers of forward and backward passes. Parameters, Adam's moments and losses are f32 with each.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Precision {
    /// Bf16 where the processor multiplies it natively, f32 elsewhere.
    Auto,
    /// 32 bits.
    #[default]
    F32,
    /// Bfloat16: the range of f32 with 8 significant bits.
    Bf16,
}

impl Compute {
    /// In f32 on the processor: the same on every machine, up to the order of sums.
    pub const PLAIN: Self = Self { device: Device::Cpu, precision: Precision::F32 };

    /// The type of the tensors that are computed with.
    pub(crate) fn kind(self) -> Kind {
        if self.precision.resolved(self.device) == Precision::Bf16 { Kind::BFloat16 } else { Kind::Float }
    }
}

impl Precision {
    /// What `Auto` stands for on this machine; anything else is itself.
    #[must_use]
    pub fn resolved(self, device: Device) -> Self {
        match self {
            Self::Auto if device == Device::Cpu && multiplies_bf16() => Self::Bf16,
            Self::Auto => Self::F32,
            given => given,
        }
    }
}

/// Whether the processor has instructions for products of bf16.
fn multiplies_bf16() -> bool {
    #[cfg(target_arch = "x86_64")]
    return std::arch::is_x86_feature_detected!("avx512bf16");
    #[cfg(target_arch = "aarch64")]
    return std::arch::is_aarch64_feature_detected!("bf16");
    #[cfg(not(any(target_arch = "x86_64", target_arch = "aarch64")))]
    return false;
}
