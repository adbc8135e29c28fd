//! A deep Q-network that learns from pixels, on libtorch.
//!
//! [`trainer::Trainer`] is the loop; everything else is a part of it that can be read and tested alone. The network is
//! that of Mnih et al. (Nature, 2015) on a single 84×84 picture, as in the paper's section "Experiments and results".

pub mod checkpoint;
pub mod compute;
pub mod config;
pub mod device;
pub mod error;
pub mod estimate;
pub mod evaluate;
pub mod files;
pub mod learner;
pub mod machine;
pub mod network;
pub mod optimizer;
pub mod record;
pub mod replay;
pub mod run_dir;
pub mod schedule;
pub mod trainer;

pub use error::{Error, Result};

/// The one version of libtorch that the `tch` of this crate can speak to.
pub const LIBTORCH_VERSION: &str = "2.11.0";
