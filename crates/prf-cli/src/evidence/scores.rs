//! A CSV beside frames: what is known of each.

use std::collections::HashMap;
use std::ffi::OsStr;
use std::fs::File;
use std::path::Path;

use csv::StringRecord;
use prf_core::Label;
use prf_core::io::FrameInfo;

use crate::error::{CliError, Result};

const COLUMNS: &str =
    "the first line names the columns: score, success or both, and frame if lines are not in the frames' order";

/// Labels, and which frame each belongs to.
#[derive(Debug)]
pub(super) struct Scores {
    path: String,
    labels: Vec<Label>,
    /// The lines of frames that are named; without names, lines are in the frames' order.
    named: Option<HashMap<String, usize>>,
    /// Which lines have found their frame.
    used: Vec<bool>,
    /// Whether it is unknown how many frames there were so far, since some could not be read.
    is_lost: bool,
}

impl Scores {
    /// Reads a file; a score of at least `success_at` is a success where the file doesn't say.
    ///
    /// # Errors
    ///
    /// Misuse, with the line, for what is no CSV or holds what is no score.
    pub(super) fn read(path: &Path, success_at: Option<f64>) -> Result<Scores> {
        let shown = path.display().to_string();
        let file = File::open(path).map_err(|error| CliError::misuse(format!("cannot read {shown}: {error}")))?;
        let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::All).from_reader(file);
        let broken = |error: csv::Error| CliError::misuse(format!("{shown}: {error}")).hint(COLUMNS);
        let columns = Columns::of(reader.headers().map_err(broken)?, &shown)?;
        let mut scores =
            Scores { path: shown.clone(), labels: Vec::new(), named: None, used: Vec::new(), is_lost: false };
        for record in reader.records() {
            let record = record.map_err(broken)?;
            let label = columns.label(&record, success_at).map_err(|wrong| located(&shown, &record, &wrong))?;
            if let Some(column) = columns.frame {
                let name = record.get(column).unwrap_or_default().to_owned();
                let lines = scores.named.get_or_insert_default();
                if lines.insert(name.clone(), scores.labels.len()).is_some() {
                    return Err(located(&shown, &record, &format!("the frame \"{name}\" has a line already")).into());
                }
            }
            scores.labels.push(label);
        }
        if scores.labels.is_empty() {
            return Err(CliError::misuse(format!("{shown} has no line for any frame")).hint(COLUMNS).into());
        }
        scores.used = vec![false; scores.labels.len()];
        Ok(scores)
    }

    /// What is known of a frame, the `index`-th of all; nothing where the file doesn't say. One of an animation or a video is known by
    /// its number.
    ///
    /// # Errors
    ///
    /// Failure when the frame's line can't be told any more.
    pub(super) fn label(&mut self, info: &FrameInfo, is_picture: bool, index: usize) -> Result<Option<Label>> {
        let line = match &self.named {
            None if self.is_lost => {
                let message = format!("which line of {} belongs to {} can't be told", self.path, info.path.display());
                return Err(CliError::failed(format!("{message}, as frames before it could not be read"))
                    .hint("name the frames in a column `frame`")
                    .into());
            }
            None => Some(index),
            Some(lines) if is_picture => names(info).iter().find_map(|name| lines.get(name)).copied(),
            Some(lines) => lines.get(&index.to_string()).copied(),
        };
        let Some((label, used)) = line.and_then(|line| Some((self.labels.get(line)?, self.used.get_mut(line)?))) else {
            return Ok(None);
        };
        *used = true;
        Ok(Some(*label).filter(|label| label.score.is_some() || label.success.is_some()))
    }

    /// Some frames could not be read, and it is unknown how many.
    pub(super) fn lose_count(&mut self) {
        self.is_lost = true;
    }

    /// Refuses a file that belongs to other frames: `frames` of them were there, and all could be read.
    pub(super) fn check(&self, frames: usize) -> Result<()> {
        let lines = self.labels.len();
        let unused = self.named.iter().flatten().filter(|&(_, &line)| !self.used[line]).min_by_key(|&(_, &line)| line);
        let message = match (&self.named, unused) {
            (None, _) if lines != frames => {
                format!("{} has lines for {lines} frames, expected {frames}: one for each, in their order", self.path)
            }
            (_, Some((name, _))) => {
                format!("{} has a line for \"{name}\", which is none of the {frames} frames", self.path)
            }
            _ => return Ok(()),
        };
        Err(CliError::misuse(message).hint(COLUMNS).into())
    }
}

/// What a line may call a picture: its path, or its file with or without the ending.
fn names(info: &FrameInfo) -> Vec<String> {
    let part = |part: Option<&OsStr>| part.map(|part| part.to_string_lossy().into_owned());
    let path = info.path.to_string_lossy().into_owned();
    [Some(path), part(info.path.file_name()), part(info.path.file_stem())].into_iter().flatten().collect()
}

fn located(path: &str, record: &StringRecord, wrong: &str) -> CliError {
    let line = record.position().map_or(0, csv::Position::line);
    CliError::misuse(format!("{path}:{line}: {wrong}"))
}

/// Where in a line what stands.
struct Columns {
    frame: Option<usize>,
    score: Option<usize>,
    success: Option<usize>,
}

impl Columns {
    fn of(header: &StringRecord, path: &str) -> Result<Columns> {
        let place = |name: &str| header.iter().position(|column| column.eq_ignore_ascii_case(name));
        let columns = Columns { frame: place("frame"), score: place("score"), success: place("success") };
        if columns.score.is_none() && columns.success.is_none() {
            let got: Vec<&str> = header.iter().collect();
            let message = format!("{path}:1: got the columns \"{}\", expected score or success", got.join(","));
            return Err(CliError::misuse(message).hint(COLUMNS).into());
        }
        Ok(columns)
    }

    fn label(&self, record: &StringRecord, success_at: Option<f64>) -> std::result::Result<Label, String> {
        let value =
            |column: Option<usize>| column.and_then(|column| record.get(column)).filter(|text| !text.is_empty());
        let score = value(self.score).map(score).transpose()?;
        let success = value(self.success).map(success).transpose()?;
        Ok(Label { score, success: success.or_else(|| reached(score, success_at)) })
    }
}

/// Whether a score is that of a success, where both are known.
pub(super) fn reached(score: Option<f64>, success_at: Option<f64>) -> Option<bool> {
    Some(score? >= success_at?)
}

fn score(text: &str) -> std::result::Result<f64, String> {
    let number = text.parse().ok().filter(|score: &f64| score.is_finite());
    number.ok_or_else(|| format!("score: got \"{text}\", expected a number or nothing"))
}

fn success(text: &str) -> std::result::Result<bool, String> {
    match text.to_ascii_lowercase().as_str() {
        "1" | "true" | "yes" => Ok(true),
        "0" | "false" | "no" => Ok(false),
        _ => Err(format!("success: got \"{text}\", expected 1, 0 or nothing")),
    }
}
