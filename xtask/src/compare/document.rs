//! The part of a document that is written by this program; all around it is kept by hand.

use anyhow::{Context, Result};

const BEGIN: &str = "<!-- begin: written by cargo xtask compare -->";
const END: &str = "<!-- end -->";

/// `text` with all between the two comments replaced by `section`.
///
/// # Errors
/// If the comments are not there, or in the wrong order.
pub fn replace_section(text: &str, section: &str) -> Result<String> {
    let (before, rest) = text.split_once(BEGIN).with_context(|| format!("it has no line `{BEGIN}`"))?;
    let (_, after) = rest.split_once(END).with_context(|| format!("it has no line `{END}` behind `{BEGIN}`"))?;
    Ok(format!("{before}{BEGIN}\n\n{}\n\n{END}{after}", section.trim()))
}
