//! Serde's complaints about a config, in words for the person who wrote it.

use super::source::Source;
use crate::error::{CliError, nearest};

/// Says why the config does not fit the type it was read into.
///
/// Serde hands over a sentence, not its parts, so the parts are taken out of it: the names it puts
/// between backticks, and what stands around `, expected `. A sentence that has another form is
/// passed on as it is.
pub(super) fn misfit(source: &Source, error: &toml::de::Error) -> CliError {
    let message = error.message();
    let span = error.span().unwrap_or(0..0);
    let location = source.location(span.start);
    let key = source.key_at(&span);

    if let Some(rest) = message.strip_prefix("unknown field ") {
        return unknown_key(&location, &key, rest);
    }
    if let Some(rest) = message.strip_prefix("unknown variant ") {
        return unknown_choice(&location, &key, rest);
    }
    if let Some(rest) = message.strip_prefix("missing field ") {
        return missing_key(&location, &key, rest);
    }
    let wrong_value = ["invalid type: ", "invalid value: ", "invalid length "]
        .iter()
        .find_map(|prefix| message.strip_prefix(prefix))
        .and_then(|rest| rest.rsplit_once(", expected "));
    if let Some((got, expected)) = wrong_value {
        return wrong_type(&location, &key, got, expected);
    }
    CliError::misuse(format!("{location}: {}{message}", in_key(&key)))
}

fn unknown_key(location: &str, key: &str, rest: &str) -> CliError {
    let (word, known) = word_and_known(rest);
    let error = CliError::misuse(format!("{location}: unknown key `{key}`"));
    match (nearest(word, &known), known.is_empty()) {
        (Some(near), _) => error.hint(format!("did you mean `{near}`? known keys here: {}", known.join(", "))),
        (None, false) => error.hint(format!("known keys here: {}", known.join(", "))),
        (None, true) => error.hint("nothing can be set here"),
    }
}

fn unknown_choice(location: &str, key: &str, rest: &str) -> CliError {
    let (word, known) = word_and_known(rest);
    // A choice with a value of its own, as in `cell = { px = 8 }`, is a key to the user.
    if key.rsplit('.').next() == Some(word) {
        return unknown_key(location, key, rest);
    }
    let quoted: Vec<String> = known.iter().map(|word| format!("\"{word}\"")).collect();
    let error =
        CliError::misuse(format!("{location}: {}got \"{word}\", expected {}", in_key(key), quoted.join(" or ")));
    match nearest(word, &known) {
        Some(near) => error.hint(format!("did you mean \"{near}\"?")),
        None => error,
    }
}

fn missing_key(location: &str, table: &str, rest: &str) -> CliError {
    let missing = rest.trim_matches('`');
    let key = if table.is_empty() { missing.to_owned() } else { format!("{table}.{missing}") };
    CliError::misuse(format!("{location}: the key `{key}` is missing"))
        .hint("add it, or compare with the file that `prf init breakout` writes")
}

fn wrong_type(location: &str, key: &str, got: &str, expected: &str) -> CliError {
    let got = got.replace('`', "");
    let error = CliError::misuse(format!("{location}: {}got {got}, expected {}", in_key(key), plain_type(expected)));
    let number_in_quotes =
        got.strip_prefix("string \"").is_some_and(|value| value.trim_end_matches('"').parse::<f64>().is_ok());
    if number_in_quotes {
        return error.hint("write numbers without quotes");
    }
    error
}

fn in_key(key: &str) -> String {
    if key.is_empty() { String::new() } else { format!("`{key}`: ") }
}

/// Takes "`stepz`, expected one of `steps`, `gamma`" apart.
fn word_and_known(rest: &str) -> (&str, Vec<&str>) {
    let mut quoted = rest.split('`').skip(1).step_by(2);
    let word = quoted.next().unwrap_or_default();
    (word, quoted.collect())
}

/// A Rust type's name in words, for those that stand for a range of numbers.
fn plain_type(expected: &str) -> &str {
    match expected {
        "u8" => "a whole number from 0 to 255",
        "u16" | "u32" | "u64" | "usize" => "a whole number, 0 or more",
        "i8" | "i16" | "i32" | "i64" | "isize" => "a whole number",
        "f32" | "f64" => "a number",
        "a boolean" => "true or false",
        "path string" => "a path in quotes",
        other if other.starts_with("struct ") => "a table",
        other => other,
    }
}
