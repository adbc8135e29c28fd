//! `metrics.jsonl`, read back.

use std::fs;
use std::path::Path;

use serde::Deserialize;

use super::{EvaluationRecord, Event, TrainRecord};
use crate::error::{Error, Result};

/// The records of a run, in the order in which they were written.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Metrics {
    /// Training episodes, summed up between evaluations.
    pub training: Vec<TrainRecord>,
    /// Greedy evaluations.
    pub evaluations: Vec<EvaluationRecord>,
    /// Lines, from 1, that are no records. The last line of a killed run, which was cut short, is none of them.
    pub damaged_lines: Vec<usize>,
}

impl Metrics {
    /// Reads the file of a run, which may be going on. Records of kinds that are not known here are passed over.
    ///
    /// # Errors
    /// [`Error::Io`] when it cannot be read.
    pub fn read(path: &Path) -> Result<Self> {
        Ok(Self::parse(&fs::read(path).map_err(Error::io("read", path))?))
    }

    fn parse(bytes: &[u8]) -> Self {
        let mut metrics = Self::default();
        for (index, line) in bytes.split_inclusive(|&byte| byte == b'\n').enumerate() {
            match serde_json::from_slice(line) {
                Ok(Event::Train(record)) => metrics.training.push(record),
                Ok(Event::Evaluation(record)) => metrics.evaluations.push(record),
                Ok(Event::Step(_) | Event::Progress(_) | Event::Checkpoint(_)) => {}
                Err(_) if line.last() == Some(&b'\n') && !is_of_another_kind(line) => {
                    metrics.damaged_lines.push(index + 1);
                }
                Err(_) => {}
            }
        }
        metrics
    }
}

/// Whether the line is a record that another version of PRF wrote.
fn is_of_another_kind(line: &[u8]) -> bool {
    #[derive(Deserialize)]
    struct Kind {
        kind: String,
    }
    serde_json::from_slice(line).is_ok_and(|Kind { kind }| kind != "train" && kind != "evaluation")
}

#[cfg(test)]
mod tests {
    use super::super::{JsonlRecorder, Recorder, is_being_recorded};
    use super::*;

    fn evaluation(step: u64) -> EvaluationRecord {
        EvaluationRecord {
            step,
            episode: step / 50,
            episodes: 3,
            mean_score: 1.0 / 3.0,
            std_score: 0.1,
            mean_reward: 20.5,
            mean_steps: 30.0,
            time_s: 1.25,
        }
    }

    fn training(step: u64) -> TrainRecord {
        TrainRecord {
            step,
            episode: 7,
            update: 0,
            mean_score: None,
            mean_reward: Some(0.1),
            mean_steps: None,
            mean_loss: None,
            epsilon: 0.3,
            time_s: 2.0,
            steps_per_s: 100.0,
        }
    }

    #[test]
    fn what_was_recorded_is_read_back() {
        let dir = tempfile::tempdir().expect("dir");
        let path = dir.path().join("metrics.jsonl");
        let mut recorder = JsonlRecorder::open(&path).expect("open");
        for step in [100, 200] {
            recorder.record(&Event::Train(training(step))).expect("record");
            recorder.record(&Event::Evaluation(evaluation(step))).expect("record");
            recorder.record(&Event::Checkpoint(step)).expect("record");
        }
        let metrics = Metrics::read(&path).expect("read");
        assert_eq!(metrics.training, [training(100), training(200)]);
        assert_eq!(metrics.evaluations, [evaluation(100), evaluation(200)]);
        assert!(metrics.damaged_lines.is_empty());
        assert!(is_being_recorded(&path).expect("open"));
        drop(recorder);
        assert!(!is_being_recorded(&path).expect("open"));
    }

    #[test]
    fn a_torn_end_is_no_damage_and_a_torn_middle_is() {
        let whole = serde_json::to_string(&Event::Evaluation(evaluation(100))).expect("plain numbers");
        for length in 0..whole.len() {
            let torn = &whole[..length];
            let metrics = Metrics::parse(format!("{whole}\n{torn}").as_bytes());
            assert_eq!((metrics.evaluations.len(), metrics.damaged_lines.len()), (1, 0), "{torn}");
            let metrics = Metrics::parse(format!("{torn}\n{whole}\n").as_bytes());
            assert_eq!((metrics.evaluations.len(), metrics.damaged_lines), (1, vec![1]), "{torn}");
        }
        // Cut off only its end of line, it has all that it says.
        assert_eq!(Metrics::parse(whole.as_bytes()).evaluations, [evaluation(100)]);
    }

    #[test]
    fn records_of_other_kinds_are_passed_over() {
        let metrics = Metrics::parse(b"{\"kind\":\"image\",\"step\":1}\n\xff\n{\"kind\":\"train\"}\n[]\n");
        assert_eq!(metrics.damaged_lines, [2, 3, 4]);
        assert_eq!(Metrics::parse(b""), Metrics::default());
    }
}
