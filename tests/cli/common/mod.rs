//! What all tests of the command share.

use std::path::Path;

use assert_cmd::Command;

/// `prf`, run in `folder`.
pub(crate) fn prf(folder: &Path) -> Command {
    let mut command = Command::new(assert_cmd::cargo::cargo_bin!("prf"));
    command.current_dir(folder);
    command
}
