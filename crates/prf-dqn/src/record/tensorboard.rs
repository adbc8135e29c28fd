//! `tensorboard/`: the run's numbers and pictures as an event file, which TensorBoard opens.

use std::fs::{self, File, OpenOptions};
use std::io::{Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::time::{SystemTime, UNIX_EPOCH};

use prf_core::io::png;
use prf_core::{FrameView, Goal};
use prost::Message;
use serde_json::Value;

use super::{EpisodeKind, EvaluationRecord, Event, KeptRecorder, Loss, Recorder, StepRecord, TrainRecord};
use crate::error::{Error, Result};

mod proto;
mod tfrecord;

use proto::{Summary, SummaryImage, SummaryValue, TensorBoardEvent, What};

/// TensorBoard knows its files by the middle of their names.
const FILE: &str = "events.out.tfevents.prf";

/// Writes scalars of training and evaluation, the goal, and the last frame and `T_A` of each evaluation's first recorded episode,
/// over training steps. Each is on its way to the disk at once.
pub struct TensorBoardRecorder {
    path: PathBuf,
    goal: Option<Vec<u8>>,
    /// None before the first rewind and after the end.
    file: Option<File>,
}

impl TensorBoardRecorder {
    /// A recorder of the event file in `folder`, which [`rewind`](KeptRecorder::rewind) opens.
    pub fn new(folder: &Path, goal: Option<&Goal>) -> Self {
        Self { path: folder.join(FILE), goal: goal.map(|goal| png(goal.picture.view())), file: None }
    }

    fn open(&self) -> Result<File> {
        let folder = self.path.parent().unwrap_or(Path::new("."));
        fs::create_dir_all(folder).map_err(Error::io("make", folder))?;
        let options = OpenOptions::new().read(true).write(true).create(true).truncate(false).open(&self.path);
        options.map_err(Error::io("open", &self.path))
    }

    /// What every event file begins with, and the goal.
    fn begin(&mut self) -> Result<()> {
        self.write(0, What::FileVersion("brain.Event:2".to_owned()))?;
        match self.goal.clone() {
            Some(goal) => self.summary(0, vec![picture("goal", goal)]),
            None => Ok(()),
        }
    }

    fn summary(&mut self, step: u64, value: Vec<SummaryValue>) -> Result<()> {
        self.write(step, What::Summary(Summary { value }))
    }

    fn write(&mut self, step: u64, what: What) -> Result<()> {
        let wall_time = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default().as_secs_f64();
        let event = TensorBoardEvent { wall_time, step: step as i64, what: Some(what) };
        let record = tfrecord::framed(&event.encode_to_vec());
        self.file().write_all(&record).map_err(Error::io("write", &self.path))
    }

    fn file(&mut self) -> &mut File {
        self.file.as_mut().expect("a rewind comes first, and nothing after the end")
    }
}

fn training(record: &TrainRecord) -> Vec<SummaryValue> {
    let values = [
        ("training/score", record.mean_score),
        ("training/reward", record.mean_reward),
        ("training/episode_steps", record.mean_steps),
        ("training/loss", record.mean_loss),
        ("training/epsilon", Some(record.epsilon.into())),
        ("training/steps_per_s", Some(record.steps_per_s)),
    ];
    values.into_iter().filter_map(|(tag, value)| value.map(|value| scalar(tag, value))).collect()
}

fn evaluation(record: &EvaluationRecord) -> Vec<SummaryValue> {
    vec![
        scalar("evaluation/score", record.mean_score),
        scalar("evaluation/reward", record.mean_reward),
        scalar("evaluation/episode_steps", record.mean_steps),
    ]
}

fn last_pictures(step: &StepRecord<'_>) -> Vec<SummaryValue> {
    let frame = |tag, frame: FrameView<'_>| picture(tag, png(frame));
    let template = step.explanation.map(|explanation| explanation.agent_template());
    let mirror = frame("evaluation/mirror", step.mirror);
    [mirror].into_iter().chain(template.map(|t| frame("evaluation/template", t.view()))).collect()
}

fn scalar(tag: &str, value: f64) -> SummaryValue {
    SummaryValue { tag: tag.to_owned(), simple_value: Some(value as f32), image: None }
}

/// A PNG file of ours, which has its size in bytes 16 to 24.
fn picture(tag: &str, png: Vec<u8>) -> SummaryValue {
    let side = |at: usize| i32::from_be_bytes([png[at], png[at + 1], png[at + 2], png[at + 3]]);
    let (width, height) = (side(16), side(20));
    let image = SummaryImage { height, width, colorspace: 1, encoded_image_string: png };
    SummaryValue { tag: tag.to_owned(), simple_value: None, image: Some(image) }
}

impl Recorder for TensorBoardRecorder {
    fn record(&mut self, event: &Event<'_>) -> Result<()> {
        match event {
            Event::Train(record) => self.summary(record.step, training(record)),
            Event::Evaluation(record) => self.summary(record.step, evaluation(record)),
            Event::Step(step) if step.kind == EpisodeKind::Evaluation && step.episode == 0 && step.last => {
                self.summary(step.trained_steps, last_pictures(step))
            }
            Event::Step(_) | Event::Progress(_) | Event::Checkpoint(_) => Ok(()),
        }
    }
}

impl KeptRecorder for TensorBoardRecorder {
    fn name(&self) -> &'static str {
        "tensorboard"
    }

    fn mark(&mut self, _due: bool) -> Result<Value> {
        let path = self.path.clone();
        let file = self.file();
        let length = file.sync_data().and_then(|()| file.stream_position());
        Ok(length.map_err(Error::io("write", path))?.into())
    }

    fn rewind(&mut self, mark: Option<&Value>) -> Result<Option<Loss>> {
        let mark = mark.map_or(Some(0), Value::as_u64);
        let mark = mark.ok_or_else(|| Error::checkpoint(&self.path, "another mark in it", "a length"))?;
        let mut file = self.open()?;
        let mut bytes = Vec::new();
        Read::by_ref(&mut file).take(mark).read_to_end(&mut bytes).map_err(Error::io("read", &self.path))?;
        // Records behind a damaged one cannot be read by anyone.
        let whole = tfrecord::whole(&bytes) as u64;
        file.set_len(whole).and_then(|()| file.seek(SeekFrom::Start(whole))).map_err(Error::io("cut", &self.path))?;
        self.file = Some(file);
        if whole == 0 {
            self.begin()?;
        }
        let lost = format!("{} of the {mark} bytes recorded before the checkpoint are lost", mark - whole);
        Ok((whole < mark).then(|| Loss::new(&self.path, "is damaged or ends too early", lost)))
    }

    fn finish(&mut self) -> Result<()> {
        let Some(file) = self.file.take() else { return Ok(()) };
        file.sync_all().map_err(Error::io("write", &self.path))
    }
}

#[cfg(test)]
mod tests;
