//! The Python package beside the large libraries that people use it with.

use std::path::Path;

use anyhow::Result;

use super::Runner;
use super::package::Environment;

/// Installs the wheel that the suite of the wheel has built, and runs the tests that need those libraries.
pub(super) fn test(root: &Path, runner: &mut Runner<'_>) -> Result<()> {
    let files = ["requirements-test.txt", "requirements-clients.txt"];
    let environment = Environment::prepare(root, "clients/venv", &files, runner)?;
    environment.install_wheel(runner)?;
    environment.pytest("clients", runner)
}
