//! What went wrong, said to the person who typed the command.

use std::fmt;

/// What every command returns; anything but a [`CliError`] inside counts as [`Kind::Failed`].
pub(crate) type Result<T> = anyhow::Result<T>;

/// Who has to act, which decides the exit code.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    /// The arguments or the config are wrong: exit code 2.
    Misuse,
    /// It was asked for rightly and did not work: exit code 1.
    Failed,
    /// Nobody reads our stdout any more: end quietly.
    ClosedPipe,
}

/// An error with its exit code and what to do about it.
#[derive(Debug)]
pub(crate) struct CliError {
    kind: Kind,
    message: String,
    hint: Option<String>,
}

impl CliError {
    pub(crate) fn misuse(message: impl Into<String>) -> Self {
        Self::new(Kind::Misuse, message)
    }

    pub(crate) fn failed(message: impl Into<String>) -> Self {
        Self::new(Kind::Failed, message)
    }

    pub(crate) fn closed_pipe() -> Self {
        Self::new(Kind::ClosedPipe, "stdout was closed")
    }

    fn new(kind: Kind, message: impl Into<String>) -> Self {
        Self { kind, message: message.into(), hint: None }
    }

    /// Adds what to do about it.
    #[must_use]
    pub(crate) fn hint(mut self, hint: impl Into<String>) -> Self {
        self.hint = Some(hint.into());
        self
    }
}

impl fmt::Display for CliError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)
    }
}

impl std::error::Error for CliError {}

/// The kind of any error a command ends with.
pub(crate) fn kind(error: &anyhow::Error) -> Kind {
    error.downcast_ref::<CliError>().map_or(Kind::Failed, |cli| cli.kind)
}

/// The lines that tell `error` to a person, causes and hint included.
pub(crate) fn render(error: &anyhow::Error) -> String {
    let mut text = format!("error: {error}\n");
    let mut said = error.to_string();
    for cause in error.chain().skip(1).map(ToString::to_string) {
        // Many libraries repeat their source's words in their own.
        if !said.contains(&cause) {
            text.push_str(&format!("  caused by: {cause}\n"));
            said = cause;
        }
    }
    if let Some(hint) = error.downcast_ref::<CliError>().and_then(|cli| cli.hint.as_deref()) {
        text.push_str(&format!("  hint: {hint}\n"));
    }
    text
}

/// The entry of `known` that `word` was most likely meant to be.
pub(crate) fn nearest<'a>(word: &str, known: &[&'a str]) -> Option<&'a str> {
    const SIMILAR_ENOUGH: f64 = 0.75;
    known
        .iter()
        .map(|&candidate| (strsim::jaro_winkler(word, candidate), candidate))
        .filter(|&(similarity, _)| similarity >= SIMILAR_ENOUGH)
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(_, candidate)| candidate)
}
