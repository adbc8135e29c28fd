//! Set-up and test driver of the workspace. It never depends on `tch`: it runs before anything else
//! can be built.

use std::env;
use std::path::{Path, PathBuf};
use std::process::Command;

pub mod compare;
pub mod compiler;
pub mod libtorch;
pub mod prf;
pub mod python;
pub mod test;
mod venv;

/// The workspace's root.
///
/// Cargo names this package's folder when it runs it; the compiled-in one serves a binary that was
/// started by hand.
pub fn root() -> PathBuf {
    let package =
        env::var_os("CARGO_MANIFEST_DIR").map_or_else(|| PathBuf::from(env!("CARGO_MANIFEST_DIR")), PathBuf::from);
    package.parent().map(Path::to_path_buf).unwrap_or(package)
}

/// The cargo that runs this program, or the one on `PATH`.
fn cargo() -> Command {
    Command::new(env::var_os("CARGO").unwrap_or_else(|| "cargo".into()))
}

/// The file `name` in the first folder of `path` (in the form of `PATH`) that has it.
fn find_in(path: &std::ffi::OsStr, name: &str) -> Option<PathBuf> {
    env::split_paths(path).map(|folder| folder.join(name)).find(|file| file.is_file())
}
