//! `cargo xtask …` and `cargo prf …`: see `USAGE`.

use std::env;
use std::ffi::OsString;
use std::path::Path;
use std::process::ExitCode;

use anyhow::Result;
use xtask::compare::{self, Subject};
use xtask::{libtorch, prf, root, test};

const USAGE: &str = "\
usage: cargo xtask setup                   fetch libtorch, if it is not there yet
       cargo xtask test                    set everything up and run every test
       cargo xtask compare [perception]    time prf against OpenCV and scikit-image, and write it down
       cargo xtask compare python          time the Python package against OpenCV, ALE, EnvPool and others
       cargo xtask compare training        time the trainer against Stable-Baselines3 and PyTorch
       cargo prf ARGS…                     set libtorch up, build prf and run it with ARGS";

/// Exit status of a command line that makes no sense.
const MISUSE: u8 = 2;

fn main() -> ExitCode {
    let mut args = env::args_os().skip(1);
    let command = args.next();
    let rest: Vec<OsString> = args.collect();
    match run(command.as_ref().and_then(|name| name.to_str()), &rest) {
        Ok(code) => code,
        Err(error) => {
            eprintln!("error: {error:#}");
            ExitCode::FAILURE
        }
    }
}

fn run(command: Option<&str>, rest: &[OsString]) -> Result<ExitCode> {
    let root = root();
    match (command, rest) {
        (Some("prf"), args) => prf::run(&root, args),
        (Some("setup"), []) => setup(&root),
        (Some("test"), []) => test::run(&root),
        (Some("compare"), words) => match Subject::parse(words) {
            Some(subject) => compare::run(&root, subject),
            None => misuse(),
        },
        (Some("help" | "--help" | "-h"), _) => {
            println!("{USAGE}");
            Ok(ExitCode::SUCCESS)
        }
        _ => misuse(),
    }
}

fn misuse() -> Result<ExitCode> {
    eprintln!("{USAGE}");
    Ok(ExitCode::from(MISUSE))
}

fn setup(root: &Path) -> Result<ExitCode> {
    let source = libtorch::ensure(root)?;
    eprintln!("{source}");
    Ok(ExitCode::SUCCESS)
}
