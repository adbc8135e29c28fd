use std::fs;
use std::path::Path;

use foxglove::Decode;
use foxglove::messages::{ImageAnnotations, RawImage};
use prf_core::{Frame, RewardParams, TaskDescriptor, WindowDescriptor, WindowParams};
use tempfile::TempDir;

use super::super::{EpisodeKind, EvaluationRecord, STEP_NS, StepRecord};
use super::*;

fn goal() -> Goal {
    let mut picture = Frame::new(5, 4);
    picture.row_mut(1)[1..4].fill(200);
    picture.row_mut(2)[2..5].fill(120);
    Goal::from(picture)
}

fn preamble() -> Preamble {
    let provenance = BTreeMap::from([("seed".to_owned(), "7".to_owned())]);
    Preamble { goal: Some(goal()), config: "seed = 7\n".to_owned(), provenance }
}

/// The goal lies at (3 + step, 6).
fn mirror(step: u32) -> Frame {
    let mut frame = Frame::new(20, 16);
    let goal = goal().picture;
    for y in 0..4 {
        frame.row_mut(6 + y)[3 + step as usize..][..5].copy_from_slice(goal.view().row(y));
    }
    frame
}

fn opened(dir: &Path, mark: Option<&Value>) -> (McapRecorder, Option<Loss>) {
    let mut recorder = McapRecorder::new(&dir.join("run.mcap"), preamble());
    let loss = recorder.rewind(mark).expect("rewind");
    (recorder, loss)
}

/// Records the steps of an evaluation's episode.
fn steps(recorder: &mut McapRecorder, steps: std::ops::Range<u32>) {
    let mut descriptor =
        WindowDescriptor::new(&goal().picture, None, WindowParams::default(), RewardParams::default()).expect("valid");
    for step in steps {
        let frame = mirror(step % 10);
        let score = descriptor.observe(frame.view()).expect("it fits");
        let record = StepRecord {
            kind: EpisodeKind::Evaluation,
            trained_steps: 40,
            episode: 0,
            step: step + 1,
            mirror: frame.view(),
            explanation: Some(descriptor.explain(frame.view())),
            action: 1,
            action_name: "left",
            reward: score.reward,
            score: 2.0,
            epsilon: 0.0,
            last: false,
        };
        recorder.record(&Event::Step(&record)).expect("record");
    }
}

fn evaluation(recorder: &mut McapRecorder) {
    let [mean_score, std_score, mean_reward, mean_steps, time_s] = [3.0, 1.0, 8.0, 9.0, 1.5];
    let record =
        EvaluationRecord { step: 40, episode: 4, episodes: 2, mean_score, std_score, mean_reward, mean_steps, time_s };
    recorder.record(&Event::Evaluation(record)).expect("record");
}

fn bytes(dir: &Path) -> Vec<u8> {
    fs::read(dir.join("run.mcap")).expect("the file is there")
}

/// What a killed process leaves: the file as it is while the recorder is still there.
fn killed(recorder: McapRecorder, dir: &Path) {
    let left = bytes(dir);
    drop(recorder);
    fs::write(dir.join("run.mcap"), left).expect("the file is ours");
}

fn found(dir: &Path) -> Vec<mcap::Message<'static>> {
    let stream = mcap::MessageStream::new(bytes(dir).leak()).expect("an mcap file");
    stream.map(|message| message.expect("a message")).collect()
}

#[test]
fn a_recording_is_read_back_as_it_was_told() {
    let dir = TempDir::new().expect("dir");
    let (mut recorder, _) = opened(dir.path(), None);
    steps(&mut recorder, 0..3);
    evaluation(&mut recorder);
    recorder.finish().expect("finish");
    let messages = found(dir.path());
    let on = |topic: &str| messages.iter().filter(|m| m.channel.topic == topic).collect::<Vec<_>>();
    let image = |message: &mcap::Message<'_>| RawImage::decode(&message.data[..]).expect("a picture");

    assert_eq!(image(on("/goal")[0]).data, goal().picture.as_slice());
    let mirrors = on("/evaluation/mirror");
    assert_eq!(mirrors.len(), 3);
    for (step, message) in (0..).zip(&mirrors) {
        let picture = image(message);
        assert_eq!((picture.width, picture.height, picture.step, picture.encoding.as_str()), (20, 16, 20, "mono8"));
        assert_eq!(picture.data, mirror(step).as_slice());
        assert_eq!((message.sequence, message.log_time), (step, u64::from(step) * STEP_NS));
        assert_eq!(message.publish_time, message.log_time);
    }
    let outlines = on("/evaluation/match");
    let outline = ImageAnnotations::decode(&outlines[2].data[..]).expect("annotations");
    let corners: Vec<_> = outline.points[0].points.iter().map(|corner| (corner.x, corner.y)).collect();
    assert_eq!(corners, [(5.0, 6.0), (10.0, 6.0), (10.0, 10.0), (5.0, 10.0)]);
    // What of the goal isn't black.
    let template = image(on("/evaluation/template")[1]);
    assert_eq!((template.width, template.height), (4, 2));
    assert_eq!(template.data[..], [200, 200, 200, 0, 0, 120, 120, 120]);

    let numbers: Value = serde_json::from_slice(&on("/evaluation/step")[1].data).expect("JSON");
    let expected = serde_json::json!({
        "kind": "evaluation", "trained_steps": 40, "episode": 0, "step": 2, "action": 1, "action_name": "left",
        "reward": 1.0, "distance": 0.0, "score": 2.0, "epsilon": 0.0,
        "match": { "x": 4, "y": 6, "width": 5, "height": 4, "score": 1.0 },
    });
    assert_eq!(numbers, expected);
    let summary = on("/evaluation/summary")[0];
    assert_eq!(summary.log_time, 2 * STEP_NS, "it has the time of the step before");
    let summary: Value = serde_json::from_slice(&summary.data).expect("JSON");
    assert_eq!((&summary["mean_score"], &summary["time_s"]), (&Value::from(3.0), &Value::Null));
    assert_eq!(on("/training/mirror").len(), 0);

    let bytes = bytes(dir.path());
    let index = mcap::Summary::read(&bytes).expect("a summary").expect("a summary");
    let names: Vec<_> = index.attachment_indexes.iter().map(|attachment| attachment.name.as_str()).collect();
    assert_eq!(names, ["config.toml", "goal.png"]);
    let config = mcap::read::attachment(&bytes, &index.attachment_indexes[0]).expect("an attachment");
    assert_eq!(&config.data[..], b"seed = 7\n");
    let metadata = mcap::read::metadata(&bytes, &index.metadata_indexes[0]).expect("metadata");
    assert_eq!((metadata.name.as_str(), metadata.metadata["seed"].as_str()), ("prf", "7"));
}

/// Every number of a message is described by its schema, and nothing else is.
#[test]
fn the_schemas_describe_the_messages() {
    let dir = TempDir::new().expect("dir");
    let (mut recorder, _) = opened(dir.path(), None);
    steps(&mut recorder, 0..1);
    evaluation(&mut recorder);
    recorder.finish().expect("finish");
    let mut checked = 0;
    for message in found(dir.path()).iter().filter(|message| message.channel.message_encoding == "json") {
        let schema: Value = serde_json::from_slice(&message.channel.schema.as_ref().expect("one").data).expect("JSON");
        let keys = |value: &Value| {
            let mut keys: Vec<_> = value.as_object().expect("an object").keys().cloned().collect();
            keys.sort();
            keys
        };
        let numbers: Value = serde_json::from_slice(&message.data).expect("JSON");
        assert_eq!(keys(&numbers), keys(&schema["properties"]));
        checked += 1;
    }
    assert_eq!(checked, 2);
}

/// Kills and interruptions, at checkpoints that are due and at others, leave no trace.
#[test]
fn an_interrupted_recording_goes_on_to_the_same_bytes() {
    let [whole, parts] = [0; 2].map(|_| TempDir::new().expect("dir"));
    let (mut recorder, _) = opened(whole.path(), None);
    steps(&mut recorder, 0..5);
    evaluation(&mut recorder);
    steps(&mut recorder, 5..8);
    recorder.mark(true).expect("mark");
    steps(&mut recorder, 8..3000);
    evaluation(&mut recorder);
    recorder.finish().expect("finish");

    let (mut recorder, _) = opened(parts.path(), None);
    steps(&mut recorder, 0..2);
    // Interrupted in the middle of a chunk, twice.
    let mark = recorder.mark(false).expect("mark");
    recorder.finish().expect("finish");
    let (mut recorder, loss) = opened(parts.path(), Some(&mark));
    assert_eq!(loss, None);
    let mark = recorder.mark(false).expect("mark");
    steps(&mut recorder, 2..4);
    killed(recorder, parts.path());
    let (recorder, _) = opened(parts.path(), Some(&mark));
    // Killed before anything new was written: what the checkpoint remembers is still there.
    killed(recorder, parts.path());
    let (mut recorder, loss) = opened(parts.path(), Some(&mark));
    assert_eq!(loss, None);
    steps(&mut recorder, 2..5);
    evaluation(&mut recorder);
    // Interrupted where a chunk has just ended.
    let mark = recorder.mark(false).expect("mark");
    killed(recorder, parts.path());
    let (mut recorder, _) = opened(parts.path(), Some(&mark));
    steps(&mut recorder, 5..8);
    let mark = recorder.mark(true).expect("mark");
    steps(&mut recorder, 8..2000);
    evaluation(&mut recorder);
    killed(recorder, parts.path());
    let (mut recorder, loss) = opened(parts.path(), Some(&mark));
    assert_eq!(loss, None);
    // Interrupted after chunks that ended because they were full.
    steps(&mut recorder, 8..1900);
    let mark = recorder.mark(false).expect("mark");
    recorder.finish().expect("finish");
    let (mut recorder, _) = opened(parts.path(), Some(&mark));
    steps(&mut recorder, 1900..3000);
    evaluation(&mut recorder);
    recorder.finish().expect("finish");
    assert!(bytes(whole.path()) == bytes(parts.path()), "the two recordings differ");
}

#[test]
fn a_damaged_recording_is_kept_up_to_the_damage() {
    let dir = TempDir::new().expect("dir");
    let (mut recorder, _) = opened(dir.path(), None);
    steps(&mut recorder, 0..5);
    evaluation(&mut recorder);
    let whole = bytes(dir.path()).len();
    steps(&mut recorder, 5..8);
    let mark = recorder.mark(true).expect("mark");
    recorder.finish().expect("finish");
    let good = bytes(dir.path());
    for at in [whole + 60, whole + 200] {
        let mut damaged = good.clone();
        damaged[at] ^= 0x40;
        fs::write(dir.path().join("run.mcap"), &damaged).expect("the file is ours");
        let (mut recorder, loss) = opened(dir.path(), Some(&mark));
        let loss = loss.expect("a loss").to_string();
        assert!(loss.contains("run.mcap: is damaged") && loss.contains("12 of the 33 messages"), "{loss}");
        steps(&mut recorder, 8..9);
        recorder.finish().expect("finish");
        let times: Vec<_> = found(dir.path())
            .iter()
            .filter(|message| message.channel.topic == "/evaluation/step")
            .map(|message| (message.sequence, message.log_time / STEP_NS))
            .collect();
        assert_eq!(times, [(0, 0), (1, 1), (2, 2), (3, 3), (4, 4), (8, 8)]);
    }
}

#[test]
fn whatever_stands_in_its_place_a_recording_goes_on() {
    let dir = TempDir::new().expect("dir");
    let path = dir.path().join("run.mcap");
    let (mut recorder, _) = opened(dir.path(), None);
    steps(&mut recorder, 0..5);
    let mark = recorder.mark(true).expect("mark");
    recorder.finish().expect("finish");
    let good = bytes(dir.path());
    let garbage = [b"\x89MCAP0\r\n".to_vec(), vec![0xff; 4000]].concat();
    let cut: Vec<_> = (0..good.len()).step_by(97).map(|length| good[..length].to_vec()).collect();
    for found_there in [Vec::new(), vec![7; 3000], garbage].into_iter().chain(cut) {
        fs::write(&path, found_there).expect("the file is ours");
        let (mut recorder, _) = opened(dir.path(), Some(&mark));
        steps(&mut recorder, 5..6);
        recorder.finish().expect("finish");
        assert_eq!(found(dir.path()).iter().filter(|message| message.log_time == 5 * STEP_NS).count(), 4);
    }
    fs::remove_file(&path).expect("the file is ours");
    let (_, loss) = opened(dir.path(), Some(&mark));
    let loss = loss.expect("a loss").to_string();
    assert!(loss.contains("cannot be opened") && loss.contains("20 of the 20 messages"), "{loss}");
}
