//! The pictures of a folder.

use std::fs;
use std::path::{Path, PathBuf};

use image::ImageFormat;

use super::sniff::{self, Start};
use super::{Limits, natural};
use crate::PictureProblem;

/// The pictures in a folder in natural order: every file that is named like one (so that a damaged one
/// is not passed over) or begins like one. Hidden files, folders and all else are left out.
pub(super) fn pictures(folder: &Path, limits: Limits) -> Result<Vec<PathBuf>, PictureProblem> {
    let mut pictures = Vec::new();
    for entry in fs::read_dir(folder).map_err(PictureProblem::Io)? {
        let path = entry.map_err(PictureProblem::Io)?.path();
        if is_picture(&path) {
            pictures.push(path);
            limits.check_count(pictures.len() as u64)?;
        }
    }
    if pictures.is_empty() {
        return Err(PictureProblem::NoPictures);
    }
    pictures.sort_by(|a, b| natural::compare(name(a), name(b)));
    Ok(pictures)
}

fn name(path: &Path) -> &[u8] {
    path.file_name().unwrap_or_default().as_encoded_bytes()
}

fn is_picture(path: &Path) -> bool {
    let hidden = name(path).starts_with(b".");
    !hidden && !path.is_dir() && (is_named_like_one(path) || begins_like_one(path))
}

fn is_named_like_one(path: &Path) -> bool {
    path.extension().and_then(ImageFormat::from_extension).is_some_and(|format| format.reading_enabled())
}

fn begins_like_one(path: &Path) -> bool {
    let format = || Start::of(&mut sniff::open(path).ok()?).ok()?.picture();
    format().is_some()
}
