//! Where a config's keys and values stand.

use std::ops::Range;
use std::path::PathBuf;

use serde::de::DeserializeOwned;
use toml::Spanned;
use toml::de::{DeTable, DeValue, Deserializer};

use super::explain;
use super::overrides::Override;
use crate::error::CliError;

/// A config's text, with the changes made to it on the command line.
///
/// Byte offsets in here count on through the changes, as if these followed the file's text
/// one after the other. So a span says by itself which of them it belongs to.
#[derive(Debug)]
pub(crate) struct Source {
    path: PathBuf,
    text: String,
    overrides: Vec<Override>,
}

impl Source {
    pub(super) fn new(path: PathBuf, text: String, sets: &[String]) -> Result<Self, CliError> {
        let mut end = text.len();
        let mut overrides = Vec::with_capacity(sets.len());
        for set in sets {
            let change = Override::parse(set, end + 1)?;
            end = change.span().end;
            overrides.push(change);
        }
        Ok(Self { path, text, overrides })
    }

    pub(super) fn deserialize<T: DeserializeOwned>(&self) -> Result<T, CliError> {
        let tree = self.tree()?;
        T::deserialize(Deserializer::from(tree)).map_err(|error| explain::misfit(self, &error))
    }

    /// The error for a value of the right type that is wrong all the same: `key`, such as
    /// `train.gamma`, is `got` where `expected` was wanted.
    pub(crate) fn explain(&self, key: &str, got: &str, expected: &str) -> CliError {
        CliError::misuse(format!("{}: `{key}`: got {got}, expected {expected}", self.locate(key)))
    }

    /// Where the value of the dotted `key` stands, or its table if the key is missing:
    /// `configs/breakout.toml:12:1`, or the `--set` as it was typed.
    pub(crate) fn locate(&self, key: &str) -> String {
        self.location(self.span_of(key).start)
    }

    /// The file that `path`, the value of `key`, means: relative to the config's folder, or to the
    /// current folder if it was typed on the command line.
    pub(crate) fn resolve(&self, key: &str, path: &std::path::Path) -> PathBuf {
        match self.path.parent() {
            Some(folder) if self.span_of(key).start <= self.text.len() => folder.join(path),
            _ => path.to_owned(),
        }
    }

    pub(super) fn location(&self, offset: usize) -> String {
        let typed = |change: &&Override| (change.span().start..=change.span().end).contains(&offset);
        if let Some(change) = self.overrides.iter().find(typed) {
            return change.typed();
        }
        let (line, column) = line_column(self.text.as_bytes(), offset);
        format!("{}:{line}:{column}", self.path.display())
    }

    /// The dotted path of the key or the value that spans exactly `span`; empty for the whole file.
    pub(super) fn key_at(&self, span: &Range<usize>) -> String {
        let mut path = Vec::new();
        if let Ok(tree) = self.tree() {
            find_span(tree.get_ref(), span, &mut path);
        }
        path.join(".")
    }

    fn span_of(&self, key: &str) -> Range<usize> {
        let mut span = 0..0;
        // A text that cannot be parsed has been reported long before anybody asks for a key.
        let Ok(tree) = self.tree() else { return span };
        let mut table = tree.get_ref();
        for part in key.split('.') {
            let Some(value) = table.get(part) else { break };
            span = value.span();
            let DeValue::Table(inner) = value.get_ref() else { break };
            table = inner;
        }
        span
    }

    /// The config as a tree, changes included.
    fn tree(&self) -> Result<Spanned<DeTable<'_>>, CliError> {
        let mut tree = DeTable::parse(&self.text).map_err(|error| {
            let location = self.location(error.span().map_or(0, |span| span.start));
            CliError::misuse(format!("{location}: this is not TOML: {}", error.message()))
        })?;
        for change in &self.overrides {
            change.apply(tree.get_mut())?;
        }
        Ok(tree)
    }
}

/// Leaves in `path` the keys that lead to `span`, or nothing if it is nowhere.
fn find_span(table: &DeTable<'_>, span: &Range<usize>, path: &mut Vec<String>) -> bool {
    for (key, value) in table {
        path.push(key.get_ref().to_string());
        let found = match value.get_ref() {
            DeValue::Table(inner) => find_span(inner, span, path),
            _ => false,
        };
        if found || key.span() == *span || value.span() == *span {
            return true;
        }
        path.pop();
    }
    false
}

/// The line and the column, both from 1, of a byte offset; columns count characters.
pub(super) fn line_column(text: &[u8], offset: usize) -> (usize, usize) {
    let before = &text[..offset.min(text.len())];
    let line_start = before.iter().rposition(|&byte| byte == b'\n').map_or(0, |newline| newline + 1);
    let line = before.iter().filter(|&&byte| byte == b'\n').count() + 1;
    let column = String::from_utf8_lossy(&before[line_start..]).chars().count() + 1;
    (line, column)
}
