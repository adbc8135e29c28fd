//! Getting libtorch, which `tch` links to.

use std::env;
use std::path::Path;

use anyhow::Result;

mod fetch;
mod install;
pub mod pins;
mod progress;
mod source;
mod space;
mod unpack;

pub use install::Install;
pub use source::Source;

use crate::python::Python;

/// Has a libtorch ready: the user's own where the environment names one, else the pinned one, which
/// is fetched if it is not there.
///
/// # Errors
/// One sentence with what to do.
pub fn ensure(root: &Path) -> Result<Source> {
    let source = Source::choose(root, |name| env::var_os(name))?;
    if let Source::Pinned(folder) = &source {
        let path = env::var_os("PATH").unwrap_or_default();
        Install::new(folder, pins::for_this_machine()?).run(|| Python::find(&path))?;
    }
    Ok(source)
}
