//! Writing results: whole or not at all, and never over a file unasked.

use std::fs;
use std::io::{self, Write as _};
use std::path::Path;

use crate::error::{CliError, Result};

/// Refuses to go on when something is at `path`.
pub(crate) fn refuse_existing(path: &Path) -> Result<()> {
    if path.symlink_metadata().is_ok() {
        return Err(exists(path).into());
    }
    Ok(())
}

fn exists(path: &Path) -> CliError {
    CliError::failed(format!("{} exists already and is left as it is", path.display()))
        .hint("write to another place, or over it with --force")
}

/// Writes a file whole or not at all.
pub(crate) fn write_whole(path: &Path, content: &[u8], force: bool) -> Result<()> {
    let failed = |error: io::Error| {
        CliError::failed(format!("cannot write {}: {error}", path.display()))
            .hint("check that the folder can be written to and has room")
    };
    let file = filled_temporary(path, content).map_err(failed)?;
    let persisted = if force { file.persist(path) } else { file.persist_noclobber(path) };
    match persisted {
        Ok(_) => Ok(()),
        Err(error) if !force && error.error.kind() == io::ErrorKind::AlreadyExists => Err(exists(path).into()),
        Err(error) => Err(failed(error.error).into()),
    }
}

/// The content in a file beside `path`, whose folder is made if there is none.
fn filled_temporary(path: &Path, content: &[u8]) -> io::Result<tempfile::NamedTempFile> {
    let folder = match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    fs::create_dir_all(folder)?;
    let mut file = new_temporary(folder)?;
    file.write_all(content)?;
    file.as_file().sync_all()?;
    Ok(file)
}

fn new_temporary(folder: &Path) -> io::Result<tempfile::NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(".prf-");
    // Readable to whom the umask says, like any other file, and not to the owner alone.
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    builder.tempfile_in(folder)
}
