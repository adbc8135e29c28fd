//! What can go wrong in a world or a task.

/// An error of this crate. Nothing has changed in the world or task that returned it.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// A parameter is out of its range, or something of the reward could not be prepared.
    #[error(transparent)]
    Core(#[from] prf_core::Error),

    /// The action's number is too large.
    #[error("action {got} is unknown to {world}: expected 0 to {last}")]
    UnknownAction {
        /// The world's name.
        world: &'static str,
        /// The action asked for.
        got: usize,
        /// The largest action there is.
        last: usize,
    },

    /// A step was asked for before the first episode.
    #[error("{world} has no episode yet: expected a reset before the first step")]
    NotReset {
        /// The world's name.
        world: &'static str,
    },

    /// A step was asked for after the episode's end.
    #[error("the episode of {world} is over: expected a reset before the next step")]
    EpisodeOver {
        /// The world's name.
        world: &'static str,
    },

    /// Saved bytes that are damaged, or belong to something else.
    #[error("the saved state of {what} can't be used: got {got}, expected {expected}")]
    BadState {
        /// Whose state was expected.
        what: &'static str,
        /// What the bytes hold.
        got: String,
        /// What they should hold.
        expected: String,
    },

    /// A world breaks a rule of [`check`](crate::check).
    #[error("{world} breaks the rule \"{rule}\": {detail}")]
    BrokenRule {
        /// The world's name.
        world: String,
        /// The rule, in a few words.
        rule: &'static str,
        /// What happened.
        detail: String,
    },
}

impl Error {
    /// A parameter named by its full key in a config file, such as `env.limit_steps`.
    pub(crate) fn param(key: &str, got: impl Into<String>, expected: impl Into<String>) -> Error {
        Error::Core(prf_core::Error::InvalidParam { key: key.to_owned(), got: got.into(), expected: expected.into() })
    }
}
