//! What can go wrong while learning.

use std::fmt;
use std::path::PathBuf;

/// An error of the learner, its replay, its checkpoints or its records.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// A value of the configuration cannot be used.
    #[error(transparent)]
    Config(#[from] prf_core::Error),
    /// The task could not be built or refused a step.
    #[error(transparent)]
    Task(#[from] prf_envs::Error),
    /// libtorch refused a computation.
    #[error("libtorch failed: {0}")]
    Torch(#[from] tch::TchError),
    /// A device that this libtorch or this machine does not offer.
    #[error("device {got} is not available, expected {expected}")]
    Device {
        /// The device asked for.
        got: String,
        /// What would work, or what is missing.
        expected: String,
    },
    /// A file could not be read or written.
    #[error("cannot {action} {}: {source}", path.display())]
    Io {
        /// What was tried: `read`, `write`, …
        action: &'static str,
        /// The file.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// A checkpoint that is damaged or belongs to another run.
    #[error("cannot use checkpoint {}: got {got}, expected {expected}", path.display())]
    Checkpoint {
        /// The file.
        path: PathBuf,
        /// What was found.
        got: String,
        /// What is needed.
        expected: String,
    },
}

impl Error {
    /// For `map_err` on file operations.
    pub(crate) fn io(action: &'static str, path: impl Into<PathBuf>) -> impl FnOnce(std::io::Error) -> Self {
        let path = path.into();
        move |source| Self::Io { action, path, source }
    }

    /// A checkpoint file that does not hold what it should.
    pub(crate) fn checkpoint(path: impl Into<PathBuf>, got: impl fmt::Display, expected: impl fmt::Display) -> Self {
        Self::Checkpoint { path: path.into(), got: got.to_string(), expected: expected.to_string() }
    }
}

/// A result whose error is [`enum@Error`].
pub type Result<T, E = Error> = std::result::Result<T, E>;
