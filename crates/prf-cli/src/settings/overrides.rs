//! `--set key.path=value`: one change to a config, and how it gets into the config's tree.

use std::borrow::Cow;
use std::ops::Range;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use crate::error::CliError;

#[derive(Debug)]
pub(super) struct Override {
    /// As it was typed, for error messages.
    argument: String,
    span: Range<usize>,
    keys: Vec<Spanned<String>>,
    /// The value as a TOML document with one key, behind as many blanks as there is text before it,
    /// so that parsing it yields its span.
    document: String,
    value_start: usize,
}

/// Makes a document of a value; no longer than the key and `=` that are typed before it.
const KEY: &str = "v=";

impl Override {
    /// Reads `argument`, which is taken to stand at byte `start`.
    pub(super) fn parse(argument: &str, start: usize) -> Result<Self, CliError> {
        let wrong = |what: &str| {
            CliError::misuse(format!("--set {argument}: {what}")).hint("write it like --set train.steps=1000")
        };
        let (path, value) = argument.split_once('=').ok_or_else(|| wrong("there is no `=` between key and value"))?;
        let keys = split(path, start);
        if keys.iter().any(|key| key.get_ref().is_empty()) {
            return Err(wrong("a key is empty"));
        }
        let value_start = start + path.len() + "=".len();
        Ok(Self {
            argument: argument.to_owned(),
            span: start..start + argument.len(),
            keys,
            document: " ".repeat(value_start - KEY.len()) + KEY + value,
            value_start,
        })
    }

    pub(super) fn typed(&self) -> String {
        format!("--set {}", self.argument)
    }

    pub(super) fn span(&self) -> Range<usize> {
        self.span.clone()
    }

    /// Puts the value into the tree, in place of the one that is there.
    pub(super) fn apply<'a>(&'a self, root: &mut DeTable<'a>) -> Result<(), CliError> {
        let Some((last, parents)) = self.keys.split_last() else { return Ok(()) };
        let mut table = root;
        for (depth, key) in parents.iter().enumerate() {
            let made = || Spanned::new(key.span(), DeValue::Table(DeTable::new()));
            let child = table.entry(borrowed(key)).or_insert_with(made);
            table = match child.get_mut() {
                DeValue::Table(inner) => inner,
                _ => return Err(self.not_a_table(&self.keys[..=depth])),
            };
        }
        // Removed first, because inserting keeps an old key and with it the old key's place.
        table.remove(last.get_ref().as_str());
        table.insert(borrowed(last), self.value());
        Ok(())
    }

    /// The value read as TOML, or else as a string without quotes.
    fn value(&self) -> Spanned<DeValue<'_>> {
        let parsed = DeTable::parse(&self.document).ok().map(Spanned::into_inner);
        match parsed.filter(|table| table.len() == 1).and_then(|mut table| table.remove("v")) {
            Some(value) => value,
            None => {
                let text = self.document[self.value_start..].trim();
                Spanned::new(self.value_start..self.span.end, DeValue::String(Cow::Borrowed(text)))
            }
        }
    }

    fn not_a_table(&self, keys: &[Spanned<String>]) -> CliError {
        let path: Vec<&str> = keys.iter().map(|key| key.get_ref().as_str()).collect();
        CliError::misuse(format!("{}: `{}` is a value and has no keys of its own", self.typed(), path.join(".")))
    }
}

/// The keys of a dotted path that stands at byte `start`.
fn split(path: &str, start: usize) -> Vec<Spanned<String>> {
    let mut at = start;
    let key = |part: &str| {
        let span = at..at + part.len();
        at = span.end + ".".len();
        Spanned::new(span, part.trim().to_owned())
    };
    path.split('.').map(key).collect()
}

fn borrowed(key: &Spanned<String>) -> Spanned<Cow<'_, str>> {
    Spanned::new(key.span(), Cow::Borrowed(key.get_ref().as_str()))
}
