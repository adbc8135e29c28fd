//! `prf init`: a config to start from, with its goal picture.

use std::fs;
use std::path::{Path, PathBuf};

use clap::ValueEnum;

use crate::ExitStatus;
use crate::args::InitArgs;
use crate::error::Result;
use crate::files::{refuse_existing, write_whole};
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
