//! `cargo xtask compare`: our speed beside others', measured in turns on one machine.

use std::ffi::OsString;
use std::path::Path;
use std::process::ExitCode;

use anyhow::Result;

mod cases;
mod check;
mod document;
mod machine;
mod measure;
mod perception;
mod pictures;
mod python;
mod setup;
mod statistics;
mod table;
mod training;
mod worker;

pub use cases::{Case, Check, Peer, perception_cases};
pub use check::compare_values;
pub use document::replace_section;
pub use machine::{cpu_model, widest_vectors};
pub use measure::{Plan, in_turns};
pub use pictures::{Pictures, breakout, motion_goal, texture};
pub use statistics::{Ratio, median, quantile};
pub use table::{Row, missed, table};
pub use worker::{Answer, parse_answer};

/// What to compare.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Subject {
    /// From pixels to a reward, against OpenCV and scikit-image.
    Perception,
    /// The Python package: its calls, its rewards against OpenCV, its environments against others.
    Python,
    /// The trainer, against Stable-Baselines3 and PyTorch.
    Training,
}

impl Subject {
    /// From the words behind `compare`; `None` if they make no sense.
    pub fn parse(words: &[OsString]) -> Option<Subject> {
        match words {
            [] => Some(Subject::Perception),
            [word] if word == "perception" => Some(Subject::Perception),
            [word] if word == "python" => Some(Subject::Python),
            [word] if word == "training" => Some(Subject::Training),
            _ => None,
        }
    }
}

/// Sets up, measures, prints the tables and writes them into the document.
///
/// # Errors
/// If something can't be set up, or both sides don't agree on what they compute. A missed target is none.
pub fn run(root: &Path, subject: Subject) -> Result<ExitCode> {
    match subject {
        Subject::Perception => perception::run(root)?,
        Subject::Python => python::run(root)?,
        Subject::Training => training::run(root)?,
    }
    Ok(ExitCode::SUCCESS)
}
