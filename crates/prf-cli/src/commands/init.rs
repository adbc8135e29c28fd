//! `prf init`: a config to start from, with its goal picture.

use std::fs;
use std::io::{self, Write as _};
use std::path::{Path, PathBuf};

use clap::ValueEnum;

use crate::ExitStatus;
use crate::args::InitArgs;
use crate::error::{CliError, Result};
use crate::printer::Printer;

/// The configs that come with `prf`.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum Preset {
    /// Breakout, from a black picture
    Breakout,
    /// Breakout with the game's own points as reward, to compare with
    BreakoutVrf,
}

/// A file of a preset, at a path relative to the config's folder.
struct PresetFile {
    path: &'static str,
    content: &'static [u8],
}

impl Preset {
    fn config(self) -> PresetFile {
        match self {
            Self::Breakout => {
                PresetFile { path: "breakout.toml", content: include_bytes!("../../../../configs/breakout.toml") }
            }
            Self::BreakoutVrf => PresetFile {
                path: "breakout-vrf.toml",
                content: include_bytes!("../../../../configs/breakout-vrf.toml"),
            },
        }
    }

    fn goal(self) -> Option<PresetFile> {
        match self {
            Self::Breakout => Some(PresetFile {
                path: "goals/black.png",
                content: include_bytes!("../../../../configs/goals/black.png"),
            }),
            Self::BreakoutVrf => None,
        }
    }
}

pub(crate) fn run(args: &InitArgs, printer: &mut Printer) -> Result<ExitStatus> {
    let config = args.preset.config();
    let config_path = config_path(args.out.as_deref(), config.path);
    let folder = config_path.parent().unwrap_or(Path::new("")).to_owned();

    // The config last: once it is there, everything it names is there too.
    let mut files = Vec::new();
    if let Some(goal) = args.preset.goal() {
        let path = folder.join(goal.path);
        if !holds(&path, goal.content) {
            files.push((path, goal.content));
        }
    }
    files.push((config_path.clone(), config.content));
    if !args.force {
        files.iter().try_for_each(|(path, _)| refuse_existing(path))?;
    }
    for (path, content) in &files {
        write_whole(path, content, args.force)?;
        printer.line(path.display())?;
    }
    printer.note(format_args!("train it with: prf train {}", config_path.display()));
    Ok(ExitStatus::Done)
}

fn config_path(out: Option<&Path>, name: &str) -> PathBuf {
    match out {
        None => PathBuf::from(name),
        Some(out) if out.extension().is_some_and(|ext| ext == "toml") && !out.is_dir() => out.to_owned(),
        Some(folder) => folder.join(name),
    }
}

/// Whether the file is there as we would write it, so that presets can share a goal.
fn holds(path: &Path, content: &[u8]) -> bool {
    fs::read(path).is_ok_and(|found| found == content)
}

fn refuse_existing(path: &Path) -> Result<()> {
    if path.symlink_metadata().is_ok() {
        return Err(exists(path).into());
    }
    Ok(())
}

fn exists(path: &Path) -> CliError {
    CliError::failed(format!("{} exists already and is left as it is", path.display()))
        .hint("write elsewhere with --out, or over it with --force")
}

/// Writes a file whole or not at all.
fn write_whole(path: &Path, content: &[u8], force: bool) -> Result<()> {
    let folder = match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    let write = || -> io::Result<()> {
        fs::create_dir_all(folder)?;
        let mut file = new_temporary(folder)?;
        file.write_all(content)?;
        file.as_file().sync_all()?;
        if force {
            file.persist(path)?;
        } else {
            file.persist_noclobber(path)?;
        }
        Ok(())
    };
    write().map_err(|error| match error.kind() {
        io::ErrorKind::AlreadyExists if !force => exists(path).into(),
        _ => CliError::failed(format!("cannot write {}: {error}", path.display()))
            .hint("check that the folder can be written to and has room")
            .into(),
    })
}

fn new_temporary(folder: &Path) -> io::Result<tempfile::NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(".prf-");
    // Readable to whom the umask says, like any other file, and not to the owner alone.
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    builder.tempfile_in(folder)
}
