//! The files that a recording becomes.

use std::ffi::OsStr;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use prf_core::io::png;

use super::recorder::Recording;
use crate::args::RecordingArgs;
use crate::error::{CliError, Result};
use crate::files::{refuse_existing, write_whole};

/// Refuses to record over what is there already, before anybody has played.
///
/// # Errors
///
/// Misuse or a failure, with the file or folder that is in the way.
pub(crate) fn refuse_occupied(args: &RecordingArgs) -> Result<()> {
    if !args.force {
        args.gif.iter().chain(&args.motion_goal).try_for_each(|path| refuse_existing(path))?;
    }
    let Some(folder) = &args.frames else { return Ok(()) };
    if folder.symlink_metadata().is_ok() && !folder.is_dir() {
        let message = format!("--frames: {} is a file, expected a folder", folder.display());
        return Err(CliError::misuse(message).hint("name a folder; it need not be there yet").into());
    }
    let is_filled = fs::read_dir(folder).is_ok_and(|mut entries| entries.next().is_some());
    if is_filled && !args.force {
        return Err(CliError::failed(format!("{} has files already and is left as it is", folder.display()))
            .hint("name a new folder, or replace the frames in this one with --force")
            .into());
    }
    Ok(())
}

/// Writes everything that was recorded: for each file or folder what was written, or why it could not be.
pub(crate) fn write(recording: &Recording, args: &RecordingArgs) -> Vec<Result<String>> {
    let frames = recording.frames;
    let gif = args.gif.as_ref().zip(recording.gif.as_ref()).map(|(path, gif)| {
        write_whole(path, gif, args.force).map(|()| format!("drew {frames} frames into {}", path.display()))
    });
    let pngs = args.frames.as_ref().map(|folder| {
        write_frames(folder, &recording.pngs).map(|()| format!("wrote {frames} frames into {}", folder.display()))
    });
    let motion = args.motion_goal.as_ref().zip(recording.motion.as_ref()).map(|(path, motion)| {
        write_whole(path, &png(motion.view()), args.force)
            .map(|()| format!("wrote the motion template of {frames} frames into {}", path.display()))
    });
    [gif, pngs, motion].into_iter().flatten().collect()
}

/// Replaces the frames in `folder` by these; other files stay.
fn write_frames(folder: &Path, pngs: &[Vec<u8>]) -> Result<()> {
    let write = || -> io::Result<()> {
        fs::create_dir_all(folder)?;
        // First all of them beside each other, so that a full disk leaves the old frames as they were.
        let new = tempfile::Builder::new().prefix(".prf-").tempdir_in(folder)?;
        let name = |index: usize| format!("{index:04}.png");
        for (index, png) in pngs.iter().enumerate() {
            fs::write(new.path().join(name(index)), png)?;
        }
        frames_in(folder)?.iter().try_for_each(fs::remove_file)?;
        (0..pngs.len()).try_for_each(|index| fs::rename(new.path().join(name(index)), folder.join(name(index))))
    };
    write().map_err(|error| {
        CliError::failed(format!("cannot write the frames into {}: {error}", folder.display()))
            .hint("check that the folder can be written to and has room")
            .into()
    })
}

/// The files that are named like frames of ours. A shorter episode must not leave the end of a longer one.
fn frames_in(folder: &Path) -> io::Result<Vec<PathBuf>> {
    let mut frames = Vec::new();
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        let stem = path.file_stem().and_then(OsStr::to_str).unwrap_or_default();
        let is_number = stem.len() >= 4 && stem.bytes().all(|byte| byte.is_ascii_digit());
        if is_number && path.extension() == Some(OsStr::new("png")) {
            frames.push(path);
        }
    }
    Ok(frames)
}
