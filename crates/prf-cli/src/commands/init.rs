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
    /// Flappy Bird, from a cut-out of the bird between two pipes
    Flappy,
    /// Flappy Bird with the game's own reward, to compare with
    FlappyVrf,
    /// A robot's face learns to smile, from a moving picture of itself
    KobianHappyKprf,
    /// The same from pictures of a person
    KobianHappyHprf,
    /// The same with the distance to the face as reward, to compare with
    KobianHappyVrf,
    /// A robot's face learns to look surprised, from a moving picture of itself
    KobianSurpriseKprf,
    /// The same from pictures of a person
    KobianSurpriseHprf,
    /// The same with the distance to the face as reward, to compare with
    KobianSurpriseVrf,
}

/// A file of a preset, at a path relative to the config's folder.
struct PresetFile {
    path: &'static str,
    content: &'static [u8],
}

/// A file under `configs/`, which is also its path beside the config.
macro_rules! preset_file {
    ($path:literal) => {
        PresetFile { path: $path, content: include_bytes!(concat!("../../../../configs/", $path)) }
    };
}

/// The pictures of a person who begins to smile.
const HAPPY_PERSON: [PresetFile; 9] = [
    preset_file!("goals/human/happy/01.png"),
    preset_file!("goals/human/happy/02.png"),
    preset_file!("goals/human/happy/03.png"),
    preset_file!("goals/human/happy/04.png"),
    preset_file!("goals/human/happy/05.png"),
    preset_file!("goals/human/happy/06.png"),
    preset_file!("goals/human/happy/07.png"),
    preset_file!("goals/human/happy/08.png"),
    preset_file!("goals/human/happy/09.png"),
];

/// The pictures of a person who is surprised.
const SURPRISED_PERSON: [PresetFile; 9] = [
    preset_file!("goals/human/surprise/01.png"),
    preset_file!("goals/human/surprise/02.png"),
    preset_file!("goals/human/surprise/03.png"),
    preset_file!("goals/human/surprise/04.png"),
    preset_file!("goals/human/surprise/05.png"),
    preset_file!("goals/human/surprise/06.png"),
    preset_file!("goals/human/surprise/07.png"),
    preset_file!("goals/human/surprise/08.png"),
    preset_file!("goals/human/surprise/09.png"),
];

impl Preset {
    /// The config, which is the last, and what it needs.
    fn files(self) -> (Vec<PresetFile>, PresetFile) {
        match self {
            Self::Breakout => (vec![preset_file!("goals/black.png")], preset_file!("breakout.toml")),
            Self::BreakoutVrf => (Vec::new(), preset_file!("breakout-vrf.toml")),
            Self::Flappy => (vec![preset_file!("goals/flappy.png")], preset_file!("flappy.toml")),
            Self::FlappyVrf => (Vec::new(), preset_file!("flappy-vrf.toml")),
            Self::KobianHappyKprf => {
                (vec![preset_file!("goals/kobian-happy.gif")], preset_file!("kobian-happy-kprf.toml"))
            }
            Self::KobianHappyHprf => (HAPPY_PERSON.into(), preset_file!("kobian-happy-hprf.toml")),
            Self::KobianHappyVrf => (Vec::new(), preset_file!("kobian-happy-vrf.toml")),
            Self::KobianSurpriseKprf => {
                (vec![preset_file!("goals/kobian-surprise.gif")], preset_file!("kobian-surprise-kprf.toml"))
            }
            Self::KobianSurpriseHprf => (SURPRISED_PERSON.into(), preset_file!("kobian-surprise-hprf.toml")),
            Self::KobianSurpriseVrf => (Vec::new(), preset_file!("kobian-surprise-vrf.toml")),
        }
    }
}

pub(crate) fn run(args: &InitArgs, printer: &mut Printer) -> Result<ExitStatus> {
    let (goals, config) = args.preset.files();
    let config_path = config_path(args.out.as_deref(), config.path);
    let folder = config_path.parent().unwrap_or(Path::new("")).to_owned();

    // The config last: once it is there, everything it names is there too.
    let mut files = Vec::new();
    for goal in goals {
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
