//! Worlds that draw themselves, and the tasks that rewards make of them.
//!
//! A world ([`Environment`]) has rules, a picture and a score of its own, and knows nothing of perceptual rewards. A
//! [`Task`] joins a world with a source of reward and a state representation: it is what an agent learns.
//!
//! ```
//! use prf_envs::players::{self, Oracle};
//! use prf_envs::{EnvConfig, registry};
//!
//! let mut world = registry::make(&EnvConfig::new("breakout"))?;
//! let episode = players::play_episode(world.as_mut(), &mut Oracle, 7)?;
//! assert!(episode.score >= 2.0);
//! # Ok::<(), prf_envs::Error>(())
//! ```

pub mod breakout;
mod bytes;
pub mod check;
mod controls;
mod coverage;
mod env;
mod error;
pub mod flappy;
pub mod kobian;
pub mod players;
pub mod raster;
pub mod registry;
pub mod rng;
pub mod survey;
mod task;
mod vector;

pub use controls::{Controls, Pace};
pub use env::{Environment, Spec, Status, Step};
pub use error::Error;
pub use task::{
    EnvConfig, RewardConfig, RewardForm, RewardSource, StateConfig, StateKind, Task, TaskConfig, TaskStep, WindowConfig,
};
pub use vector::{Command, Results, VectorTask};
