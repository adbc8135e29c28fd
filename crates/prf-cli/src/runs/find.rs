//! Run folders under a folder.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// What was found.
#[derive(Debug, Default)]
pub(crate) struct Found {
    /// Run folders, in the order of their names.
    pub(crate) folders: Vec<PathBuf>,
    /// Folders that could not be looked into.
    pub(crate) closed: Vec<PathBuf>,
}

/// The runs at `folder` and below it. Neither runs, nor hidden folders, nor links are looked into.
///
/// # Errors
///
/// `folder` itself can't be read.
pub(crate) fn run_folders(folder: &Path) -> io::Result<Found> {
    let mut found = Found::default();
    if is_run(folder) {
        found.folders.push(folder.to_owned());
        return Ok(found);
    }
    let mut open = folders_in(folder)?;
    while let Some(path) = open.pop() {
        if is_run(&path) {
            found.folders.push(path);
            continue;
        }
        match folders_in(&path) {
            Ok(below) => open.extend(below),
            Err(_) => found.closed.push(path),
        }
    }
    found.folders.sort();
    found.closed.sort();
    Ok(found)
}

/// A run has these; one of them may have been lost.
fn is_run(path: &Path) -> bool {
    let has =
        [path.join("config.toml").is_file(), path.join("metrics.jsonl").is_file(), path.join("checkpoints").is_dir()];
    has.iter().filter(|&&has| has).count() >= 2
}

fn folders_in(folder: &Path) -> io::Result<Vec<PathBuf>> {
    let mut folders = Vec::new();
    for entry in fs::read_dir(folder)? {
        let entry = entry?;
        if entry.file_type().is_ok_and(|kind| kind.is_dir()) && !entry.file_name().to_string_lossy().starts_with('.') {
            folders.push(entry.path());
        }
    }
    Ok(folders)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_are_found_at_any_depth_and_not_within_each_other() {
        let root = tempfile::tempdir().expect("dir");
        let make = |path: &str| {
            let path = root.path().join(path);
            fs::create_dir_all(path.parent().expect("it has one")).expect("dir");
            fs::write(path, "").expect("write");
        };
        for file in [
            "b/config.toml",
            "b/metrics.jsonl",
            "b/old/config.toml",
            "b/old/metrics.jsonl",
            "deep/er/a/config.toml",
            "deep/er/a/checkpoints/best/model.safetensors",
            "lost/metrics.jsonl",
            "lost/checkpoints/best/model.safetensors",
            ".hidden/config.toml",
            ".hidden/metrics.jsonl",
            "cargo/config.toml",
        ] {
            make(file);
        }
        let found = run_folders(root.path()).expect("it is there").folders;
        let names: Vec<_> = found.iter().map(|path| path.strip_prefix(root.path()).expect("under it")).collect();
        assert_eq!(names, [Path::new("b"), Path::new("deep/er/a"), Path::new("lost")]);
        assert_eq!(run_folders(&root.path().join("b")).expect("it is there").folders, [root.path().join("b")]);
        assert!(run_folders(&root.path().join("none")).is_err());
    }
}
