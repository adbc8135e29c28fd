//! `run.mcap`: recorded episodes as a robotics recording, which Foxglove and the `mcap` tools open.

use std::collections::BTreeMap;
use std::fs::{self, File};
use std::io::{self, BufWriter};
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

use mcap::records::{MessageHeader, Metadata};
use mcap::{Attachment, McapError, WriteOptions, Writer};
use prf_core::{Goal, io::png};
use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::messages::{Clock, Message, Topic, goal_message, messages};
use super::{Event, KeptRecorder, Loss, Recorder};
use crate::error::{Error, Result};
use crate::files::{PARTIAL, sync_dir};

mod salvage;

use salvage::{Stored, salvage};

/// What a recording begins with.
#[derive(Debug, Clone, Default)]
pub struct Preamble {
    /// The goal; none for a variable reward.
    pub goal: Option<Goal>,
    /// The run's configuration as TOML.
    pub config: String,
    /// Where the run comes from: `seed`, `prf_version`, `git_revision`, `device`.
    pub provenance: BTreeMap<String, String>,
}

/// Writes `run.mcap`: goal and configuration as attachments, where the run comes from as metadata, and every event's
/// [`messages`]. Chunks end with each evaluation and each checkpoint, and when they are full; a killed run loses the last one at
/// most.
pub struct McapRecorder {
    path: PathBuf,
    preamble: Preamble,
    /// None before the first rewind and after the end.
    output: Option<Output>,
    so_far: SoFar,
    /// Messages in the chunk that is open.
    in_chunk: u64,
}

/// A file in the making.
struct Output {
    writer: Writer<BufWriter<File>>,
    /// The same file, for waiting until it is on the disk.
    file: File,
    /// It still has another name: the file before it holds more, until the first chunk ends.
    partial: bool,
}

/// What was recorded so far: the mark of a checkpoint.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
struct SoFar {
    /// Steps on the clock.
    steps: u64,
    /// Messages, without the goal's.
    messages: u64,
    /// Messages of each topic, in the order of [`Topic::ALL`].
    sequences: Vec<u32>,
    /// The last chunk was ended by an interruption: it goes on after a resume.
    open: bool,
}

impl Default for SoFar {
    fn default() -> Self {
        Self { steps: 0, messages: 0, sequences: vec![0; Topic::ALL.len()], open: false }
    }
}

impl McapRecorder {
    /// A recorder of the file at `path`, which [`rewind`](KeptRecorder::rewind) opens.
    pub fn new(path: &Path, preamble: Preamble) -> Self {
        Self { path: path.to_owned(), preamble, output: None, so_far: SoFar::default(), in_chunk: 0 }
    }

    fn partial(&self) -> PathBuf {
        let name = self.path.file_name().unwrap_or_default().to_string_lossy();
        self.path.with_file_name(format!("{PARTIAL}{name}"))
    }

    /// A new file with everything but what happened in the run. The file that was there stays until [`flush`](Self::flush).
    fn begin(&mut self) -> Result<()> {
        let partial = self.partial();
        let file = File::create(&partial).map_err(Error::io("make", &partial))?;
        let twin = file.try_clone().map_err(Error::io("make", &partial))?;
        let output = self.preface(file).map_err(|error| failed(&partial, error))?;
        self.output = Some(Output { writer: output, file: twin, partial: true });
        (self.so_far, self.in_chunk) = (SoFar::default(), 0);
        Ok(())
    }

    fn preface(&self, file: File) -> mcap::McapResult<Writer<BufWriter<File>>> {
        // One thread, so that the bytes do not depend on the machine.
        let options = WriteOptions::new().library(concat!("prf ", env!("CARGO_PKG_VERSION"))).compression_threads(0);
        let mut writer = options.create(BufWriter::new(file))?;
        let Preamble { goal, config, provenance } = &self.preamble;
        writer.write_metadata(&Metadata { name: "prf".to_owned(), metadata: provenance.clone() })?;
        attach(&mut writer, "config.toml", "application/toml", config.as_bytes())?;
        if let Some(goal) = goal {
            attach(&mut writer, "goal.png", "image/png", &png(goal.picture.view()))?;
            if let Some(mask) = &goal.mask {
                attach(&mut writer, "mask.png", "image/png", &png(mask.view()))?;
            }
        }
        for (id, topic) in (1..).zip(Topic::ALL) {
            let schema = topic.schema();
            let schema = writer.add_schema(&schema.name, &schema.encoding, &schema.data)?;
            let channel = writer.add_channel(schema, topic.name(), topic.encoding(), &BTreeMap::new())?;
            debug_assert_eq!(channel, id, "channels are numbered from 1");
        }
        if let Some(goal) = goal {
            let Message { time_ns, data, .. } = goal_message(goal.picture.view());
            writer.write_to_known_channel(&header(Topic::Goal, 0, time_ns), &data)?;
            writer.flush()?;
        }
        Ok(writer)
    }

    fn output(&mut self) -> &mut Output {
        self.output.as_mut().expect("a rewind comes first, and nothing after the end")
    }

    fn write(&mut self, header: &MessageHeader, data: &[u8]) -> Result<()> {
        let written = self.output().writer.write_to_known_channel(header, data);
        written.map_err(|error| failed(&self.path, error))?;
        self.in_chunk += 1;
        Ok(())
    }

    /// Ends the chunk and waits until it is on the disk.
    fn flush(&mut self) -> Result<()> {
        let (path, partial) = (self.path.clone(), self.partial());
        let output = self.output();
        output.writer.flush().map_err(|error| failed(&path, error))?;
        output.file.sync_data().map_err(Error::io("write", &path))?;
        if std::mem::take(&mut output.partial) {
            fs::rename(&partial, &path).map_err(Error::io("write", &path))?;
            sync_dir(path.parent().filter(|dir| !dir.as_os_str().is_empty()).unwrap_or(Path::new(".")))?;
        }
        self.in_chunk = 0;
        Ok(())
    }

    /// Writes again what the old file holds of `mark.messages` messages, with the same chunks. Gives how many there were and, if
    /// they are too few, why.
    fn copy(&mut self, mark: &SoFar) -> Result<(u64, String)> {
        let mut copied = 0;
        let file = match File::open(&self.path) {
            Ok(file) => file,
            Err(error) => return Ok((0, format!("cannot be opened ({error})"))),
        };
        let why = salvage(file, &mut |chunk: Vec<Stored>| {
            for Stored { header, data } in chunk {
                if header.channel_id == GOAL_CHANNEL {
                    continue;
                }
                if copied == mark.messages {
                    return Ok(ControlFlow::Break(()));
                }
                self.write(&header, &data)?;
                copied += 1;
            }
            // Of the last chunk only the mark knows whether it goes on.
            if copied == mark.messages {
                return Ok(ControlFlow::Break(()));
            }
            self.output().writer.flush().map_err(|error| failed(&self.path, error))?;
            self.in_chunk = 0;
            Ok(ControlFlow::Continue(()))
        })?;
        Ok((copied, why))
    }
}

/// The channel of [`Topic::Goal`].
const GOAL_CHANNEL: u16 = 1;

fn header(topic: Topic, sequence: u32, time_ns: u64) -> MessageHeader {
    let channel_id = GOAL_CHANNEL + index(topic) as u16;
    MessageHeader { channel_id, sequence, log_time: time_ns, publish_time: time_ns }
}

fn index(topic: Topic) -> usize {
    Topic::ALL.iter().position(|&other| other == topic).expect("all topics are listed")
}

fn attach(writer: &mut Writer<BufWriter<File>>, name: &str, media_type: &str, data: &[u8]) -> mcap::McapResult<()> {
    let (name, media_type) = (name.to_owned(), media_type.to_owned());
    writer.attach(&Attachment { log_time: 0, create_time: 0, name, media_type, data: data.into() })
}

fn failed(path: &Path, error: McapError) -> Error {
    let source = match error {
        McapError::Io(source) => source,
        other => io::Error::other(other),
    };
    Error::io("write", path)(source)
}

impl Recorder for McapRecorder {
    fn record(&mut self, event: &Event<'_>) -> Result<()> {
        let mut clock = Clock { steps: self.so_far.steps };
        for Message { topic, time_ns, data } in messages(event, &mut clock) {
            let sequence = self.so_far.sequences[index(topic)];
            self.write(&header(topic, sequence, time_ns), &data)?;
            self.so_far.sequences[index(topic)] = sequence.wrapping_add(1);
            self.so_far.messages += 1;
        }
        self.so_far.steps = clock.steps;
        // Then somebody may want to look.
        if matches!(event, Event::Evaluation(_)) { self.flush() } else { Ok(()) }
    }
}

impl KeptRecorder for McapRecorder {
    fn name(&self) -> &'static str {
        "run.mcap"
    }

    fn mark(&mut self, due: bool) -> Result<Value> {
        let open = !due && self.in_chunk > 0;
        self.flush()?;
        let mark = SoFar { open, ..self.so_far.clone() };
        Ok(serde_json::to_value(mark).expect("a mark holds only numbers"))
    }

    fn rewind(&mut self, mark: Option<&Value>) -> Result<Option<Loss>> {
        let mark = match mark {
            Some(mark) => SoFar::deserialize(mark).ok().filter(|mark| mark.sequences.len() == Topic::ALL.len()),
            None => Some(SoFar::default()),
        };
        let mark = mark.ok_or_else(|| Error::checkpoint(&self.path, "another mark in it", "that of this version"))?;
        self.output = None;
        self.begin()?;
        let (copied, why) = if mark.messages > 0 { self.copy(&mark)? } else { (0, String::new()) };
        if copied < mark.messages || !mark.open {
            self.flush()?;
        }
        self.so_far = SoFar { open: false, ..mark };
        let lost = self.so_far.messages - copied;
        let what = format!("{lost} of the {} messages recorded before the checkpoint are lost", self.so_far.messages);
        Ok((lost > 0).then(|| Loss::new(&self.path, why, what)))
    }

    fn finish(&mut self) -> Result<()> {
        if self.output.is_some() {
            // Also gives the file its name.
            self.flush()?;
        }
        let Some(mut output) = self.output.take() else { return Ok(()) };
        output.writer.finish().map_err(|error| failed(&self.path, error))?;
        let buffered = output.writer.into_inner();
        let file = buffered.into_inner().map_err(|error| Error::io("write", &self.path)(error.into_error()))?;
        file.sync_all().map_err(Error::io("write", &self.path))
    }
}

#[cfg(test)]
mod tests;
