//! Sentences about the disk.

use std::io::ErrorKind;
use std::path::Path;

use anyhow::{Error, Result, bail};

const MEGABYTE: u64 = 1_000_000;

/// # Errors
/// If fewer bytes are free in `folder` than are needed.
pub(super) fn check(folder: &Path, free: u64, needed: u64) -> Result<()> {
    if free >= needed {
        return Ok(());
    }
    bail!(
        "libtorch needs {} MB in {} while it is set up, and {} MB are free: free some, then run the same \
         command again",
        needed / MEGABYTE,
        folder.display(),
        free / MEGABYTE
    )
}

/// What to say when the disk fills half-way.
pub(super) fn full(folder: &Path) -> String {
    format!("the disk that holds {} is full: free some space, then run the same command again", folder.display())
}

/// `error`, in plain words if it comes from a full disk.
pub(super) fn explain(error: Error, folder: &Path) -> Error {
    let is_full = error
        .chain()
        .filter_map(|cause| cause.downcast_ref::<std::io::Error>())
        .any(|cause| cause.kind() == ErrorKind::StorageFull);
    if is_full { Error::msg(full(folder)) } else { error }
}
