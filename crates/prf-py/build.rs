//! Reads the presets: their goals become pixels here, so that the package needs no files for them. Also lets plain
//! `cargo build` link on macOS, where Python's symbols are found at run time only.

use std::error::Error;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::{env, fs};

use prf_core::io::{self, FrameSource, MotionSequence};
use prf_core::{DescriptorParams, Error as GoalError, Frame};
use prf_envs::TaskConfig;
use toml::Table;

fn main() -> Result<(), Box<dyn Error>> {
    pyo3_build_config::add_extension_module_link_args();
    let configs = Path::new(&env::var("CARGO_MANIFEST_DIR")?).join("../../configs");
    let out = PathBuf::from(env::var("OUT_DIR")?);
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-changed={}", configs.display());
    let mut presets = String::new();
    for name in names(&configs)? {
        let (task, goal) = read(&configs, &name).map_err(|error| format!("configs/{name}.toml: {error}"))?;
        write!(presets, "Preset {{ name: {name:?}, task: {task:?}, goal: ")?;
        match goal {
            Some(goal) => {
                let file = out.join(format!("{name}.grey"));
                fs::write(&file, goal.as_slice())?;
                let (width, height) = (goal.width(), goal.height());
                writeln!(
                    presets,
                    "Some(Picture {{ width: {width}, height: {height}, pixels: include_bytes!({file:?}) }}) }},"
                )?;
            }
            None => presets.push_str("None },\n"),
        }
    }
    fs::write(out.join("presets.rs"), format!("&[\n{presets}]\n"))?;
    Ok(())
}

/// The configs' names, in order.
fn names(configs: &Path) -> Result<Vec<String>, Box<dyn Error>> {
    let mut names = Vec::new();
    for entry in fs::read_dir(configs)? {
        let path = entry?.path();
        if path.extension().is_some_and(|extension| extension == "toml") {
            names.extend(path.file_stem().map(|stem| stem.to_string_lossy().into_owned()));
        }
    }
    names.sort();
    Ok(names)
}

/// What a config says of its task, and the goal it names.
fn read(configs: &Path, name: &str) -> Result<(String, Option<Frame>), Box<dyn Error>> {
    let mut table: Table = fs::read_to_string(configs.join(name).with_extension("toml"))?.parse()?;
    table.retain(|key, _| ["env", "reward", "state"].contains(&key));
    let task = table.to_string();
    let config: TaskConfig = table.try_into()?;
    config.validate()?;
    if config.reward.window.as_ref().is_some_and(|window| window.mask.is_some()) {
        return Err("the goal of a preset has no mask".into());
    }
    let (Some(path), Some(descriptor)) = (&config.reward.goal, config.reward.descriptor_params()) else {
        return Ok((task, None));
    };
    Ok((task, Some(read_goal(&configs.join(path), descriptor)?)))
}

fn read_goal(path: &Path, descriptor: DescriptorParams) -> Result<Frame, GoalError> {
    match descriptor {
        DescriptorParams::Motion(motion) => Ok(MotionSequence::of(FrameSource::open(path)?, motion, false)?.template),
        DescriptorParams::Direct | DescriptorParams::Window(_) => io::read_frame(path),
    }
}
