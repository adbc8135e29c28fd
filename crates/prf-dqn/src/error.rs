//! What can go wrong while learning.

use std::fmt;
use std::path::{Path, PathBuf};

use crate::checkpoint::{FORMAT, Writer};
use crate::trainer::Divergence;

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
    /// A checkpoint that is whole, but was made for something else.
    #[error("{} does not fit: got {got}, expected {expected}", path.display())]
    Mismatch {
        /// The file or directory.
        path: PathBuf,
        /// What it was made for.
        got: String,
        /// What it is wanted for.
        expected: String,
    },
    /// A checkpoint of another format, or a file that PRF did not write.
    #[error("cannot use checkpoint {}: got {}, expected format {FORMAT}", path.display(), origin(writer))]
    Format {
        /// The file.
        path: PathBuf,
        /// Who wrote it, if it was PRF.
        writer: Option<Writer>,
    },
    /// Another process trains in the run directory.
    #[error("{} is being written by another prf", path.display())]
    Busy {
        /// The file that is locked.
        path: PathBuf,
    },
    /// The loss became infinite or NaN.
    #[error("{divergence}")]
    Diverged {
        /// What was found.
        divergence: Box<Divergence>,
        /// The directory with the network and the batch of that moment, or why it could not be written.
        saved: Result<PathBuf, Box<Error>>,
    },
    /// A reward that cannot be learned from.
    #[error("the reward of environment {environment} in step {step} is {reward}, expected a finite number")]
    Reward {
        /// The environment's number, from 0.
        environment: usize,
        /// The step, over all environments, from 1.
        step: u64,
        /// The reward.
        reward: f32,
    },
    /// The system gives no threads.
    #[error("cannot start {threads} threads for the network: {reason}")]
    Threads {
        /// How many were wanted.
        threads: usize,
        /// Why.
        reason: String,
    },
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
    /// A file of a checkpoint that is damaged.
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

    /// For `map_err` on files that belong to a checkpoint: one that is missing is damage, not an accident of reading.
    pub(crate) fn unreadable(path: &Path) -> impl FnOnce(std::io::Error) -> Self {
        move |source| match source.kind() {
            std::io::ErrorKind::NotFound => Self::checkpoint(path, "no such file", "all files of the checkpoint"),
            _ => Self::io("read", path)(source),
        }
    }

    /// A checkpoint file that does not hold what it should.
    pub(crate) fn checkpoint(path: impl Into<PathBuf>, got: impl fmt::Display, expected: impl fmt::Display) -> Self {
        Self::Checkpoint { path: path.into(), got: got.to_string(), expected: expected.to_string() }
    }

    /// A checkpoint that was made for something else.
    pub(crate) fn mismatch(path: impl Into<PathBuf>, got: impl fmt::Display, expected: impl fmt::Display) -> Self {
        Self::Mismatch { path: path.into(), got: got.to_string(), expected: expected.to_string() }
    }
}

fn origin(writer: &Option<Writer>) -> String {
    writer.as_ref().map_or("a file that prf did not write".to_owned(), |Writer { format, prf_version }| {
        format!("format {format} of prf {prf_version}")
    })
}

/// A result whose error is [`enum@Error`].
pub type Result<T, E = Error> = std::result::Result<T, E>;
