use std::fs;
use std::path::Path;

use prf_core::Frame;
use tempfile::TempDir;

use super::*;

fn goal() -> Goal {
    Goal::from(Frame::from_vec(3, 2, vec![0, 50, 100, 150, 200, 250]).expect("3 x 2"))
}

fn opened(folder: &Path, mark: Option<&Value>) -> (TensorBoardRecorder, Option<Loss>) {
    let mut recorder = TensorBoardRecorder::new(folder, Some(&goal()));
    let loss = recorder.rewind(mark).expect("rewind");
    (recorder, loss)
}

fn evaluation_event(step: u64, score: f64) -> Event<'static> {
    Event::Evaluation(EvaluationRecord {
        step,
        episode: 4,
        episodes: 2,
        mean_score: score,
        std_score: 0.5,
        mean_reward: 7.25,
        mean_steps: 30.0,
        time_s: 1.0,
    })
}

/// Steps, tags and numbers of all records, each of whose checksums is right.
fn scalars(folder: &Path) -> Vec<(i64, String, f32)> {
    let bytes = fs::read(folder.join(FILE)).expect("the file is there");
    let (mut at, mut found) = (0, Vec::new());
    while let Some(record) = tfrecord::first(&bytes[at..]) {
        let event = TensorBoardEvent::decode(record).expect("an event");
        if let Some(What::Summary(summary)) = event.what {
            let values = summary.value.into_iter().filter_map(|v| v.simple_value.map(|number| (v.tag, number)));
            found.extend(values.map(|(tag, number)| (event.step, tag, number)));
        }
        at += 16 + record.len();
    }
    assert_eq!(at, bytes.len(), "something behind the last whole record");
    found
}

/// By the published check value of CRC-32C.
#[test]
fn a_record_is_framed_as_tensorflow_does() {
    // CRC-32C of "123456789" is 0xe3069283; masked: ((c >> 15) | (c << 17)) + 0xa282ead8.
    let framed = tfrecord::framed(b"123456789");
    assert_eq!(framed[..8], [9, 0, 0, 0, 0, 0, 0, 0]);
    assert_eq!(framed[12..21], *b"123456789");
    let crc: u32 = 0xe306_9283;
    let masked = crc.rotate_right(15).wrapping_add(0xa282_ead8);
    assert_eq!(framed[21..], masked.to_le_bytes());
    assert_eq!(tfrecord::first(&framed), Some(&b"123456789"[..]));
}

#[test]
fn every_damaged_byte_of_a_record_is_noticed() {
    let framed = tfrecord::framed(b"a record");
    assert_eq!(tfrecord::whole(&[&framed[..], &framed].concat()), 2 * framed.len());
    for at in 0..framed.len() {
        let mut damaged = framed.clone();
        damaged[at] ^= 0x10;
        assert_eq!(tfrecord::whole(&damaged), 0, "byte {at}");
        assert_eq!(tfrecord::whole(&framed[..at]), 0, "{at} bytes");
    }
}

#[test]
fn the_file_begins_with_its_version_and_the_goal() {
    let folder = TempDir::new().expect("folder");
    let _recorder = opened(folder.path(), None);
    let bytes = fs::read(folder.path().join(FILE)).expect("the file is there");
    let version = tfrecord::first(&bytes).expect("whole");
    let goal = tfrecord::first(&bytes[16 + version.len()..]).expect("whole");
    let what = |record| TensorBoardEvent::decode(record).expect("an event").what.expect("something");
    assert_eq!(what(version), What::FileVersion("brain.Event:2".to_owned()));
    let What::Summary(summary) = what(goal) else { panic!("no summary") };
    let image = summary.value[0].image.as_ref().expect("a picture");
    assert_eq!((summary.value[0].tag.as_str(), image.width, image.height, image.colorspace), ("goal", 3, 2, 1));
    assert_eq!(image.encoded_image_string, png(self::goal().picture.view()));
}

#[test]
fn what_was_recorded_after_the_checkpoint_is_dropped() {
    let folder = TempDir::new().expect("folder");
    let (mut recorder, _) = opened(folder.path(), None);
    recorder.record(&evaluation_event(10, 1.0)).expect("record");
    let mark = recorder.mark(true).expect("mark");
    recorder.record(&evaluation_event(20, 2.0)).expect("record");
    drop(recorder);
    let (mut recorder, loss) = opened(folder.path(), Some(&mark));
    assert_eq!(loss, None);
    recorder.record(&evaluation_event(20, 3.0)).expect("record");
    recorder.finish().expect("finish");
    let scores: Vec<_> = scalars(folder.path()).into_iter().filter(|(_, tag, _)| tag == "evaluation/score").collect();
    let tag = "evaluation/score".to_owned();
    assert_eq!(scores, [(10, tag.clone(), 1.0), (20, tag, 3.0)]);
}

#[test]
fn what_is_damaged_is_told_and_the_rest_kept() {
    let folder = TempDir::new().expect("folder");
    let (mut recorder, _) = opened(folder.path(), None);
    recorder.record(&evaluation_event(10, 1.0)).expect("record");
    let whole = recorder.mark(true).expect("mark").as_u64().expect("a length") as usize;
    recorder.record(&evaluation_event(20, 2.0)).expect("record");
    let mark = recorder.mark(true).expect("mark");
    drop(recorder);
    let path = folder.path().join(FILE);
    let bytes = fs::read(&path).expect("the file is there");
    let mut flipped = bytes.clone();
    flipped[whole + 20] ^= 1;
    for damaged in [&bytes[..bytes.len() - 1], &flipped] {
        fs::write(&path, damaged).expect("the file is ours");
        let (_, loss) = opened(folder.path(), Some(&mark));
        let loss = loss.expect("a loss").to_string();
        assert!(loss.contains(FILE) && loss.contains(&format!("{} of the", bytes.len() - whole)), "{loss}");
        assert_eq!(scalars(folder.path()).len(), 3);
    }
    fs::remove_file(&path).expect("the file is ours");
    let (_, loss) = opened(folder.path(), Some(&mark));
    assert!(loss.is_some());
    assert_eq!(scalars(folder.path()), []);
}
