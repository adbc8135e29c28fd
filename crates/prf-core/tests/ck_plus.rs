//! The folders of the Extended Cohn-Kanade data set.
#![cfg(feature = "io")]
#![expect(clippy::unwrap_used, reason = "a test may stop at the first surprise")]

use std::fs;
use std::path::Path;

use prf_core::io::ck_plus::{Emotion, Selection, Sequence, list};
use prf_core::{Error, FrameView, io};
use tempfile::TempDir;

fn frames(root: &Path, subject: &str, session: &str, count: usize) {
    let folder = root.join("cohn-kanade-images").join(subject).join(session);
    fs::create_dir_all(&folder).unwrap();
    fs::write(folder.join(".DS_Store"), "a desktop's own").unwrap();
    for number in 1..=count {
        let name = format!("{subject}_{session}_{number:08}.png");
        io::write_frame(FrameView::new(2, 1, &[number as u8, 0]).unwrap(), folder.join(name)).unwrap();
    }
}

fn label(root: &Path, subject: &str, session: &str, text: &str) {
    let folder = root.join("Emotion").join(subject).join(session);
    fs::create_dir_all(&folder).unwrap();
    fs::write(folder.join(format!("{subject}_{session}_00000011_emotion.txt")), text).unwrap();
}

/// Four sequences, of which two have labels.
fn tree() -> TempDir {
    let root = tempfile::tempdir().unwrap();
    frames(root.path(), "S010", "002", 3);
    frames(root.path(), "S005", "001", 11);
    frames(root.path(), "S010", "001", 2);
    frames(root.path(), "S999", "003", 4);
    frames(root.path(), "S999", "004", 0);
    label(root.path(), "S005", "001", "   3.0000000e+00\n");
    label(root.path(), "S010", "002", "   7.0000000e+00\n");
    fs::create_dir_all(root.path().join("Emotion/S010/001")).unwrap();
    for file in ["cohn-kanade-images/.DS_Store", "cohn-kanade-images/S010/.DS_Store", "Emotion/S005/.DS_Store"] {
        fs::write(root.path().join(file), "a desktop's own").unwrap();
    }
    fs::write(root.path().join("Emotion/S005/001/._S005_001_00000011_emotion.txt"), "no label").unwrap();
    root
}

fn names(sequences: &[Sequence]) -> Vec<String> {
    sequences.iter().map(|sequence| format!("{}/{}", sequence.subject, sequence.session)).collect()
}

fn all() -> Selection {
    Selection::default()
}

#[test]
fn every_sequence_is_found_in_order_with_its_label() {
    let root = tree();
    let found = list(root.path(), &all()).unwrap();
    assert_eq!(names(&found), ["S005/001", "S010/001", "S010/002", "S999/003"]);
    assert_eq!(found.iter().map(|sequence| sequence.frames).collect::<Vec<_>>(), [11, 2, 3, 4]);
    let emotions: Vec<_> = found.iter().map(|sequence| sequence.emotion).collect();
    assert_eq!(emotions, [Some(Emotion::Disgust), None, Some(Emotion::Surprise), None]);
    assert_eq!(found[0].folder, root.path().join("cohn-kanade-images/S005/001"));
}

#[test]
fn the_folder_of_pictures_itself_will_do() {
    let root = tree();
    let found = list(root.path().join("cohn-kanade-images"), &all()).unwrap();
    assert_eq!(found, list(root.path(), &all()).unwrap());
    fs::remove_dir_all(root.path().join("Emotion")).unwrap();
    assert!(list(root.path(), &all()).unwrap().iter().all(|sequence| sequence.emotion.is_none()));
}

#[test]
fn a_selection_narrows() {
    let root = tree();
    let found = |subject: Option<&str>, session: Option<&str>, emotion| {
        let [subject, session] = [subject, session].map(|name| name.map(str::to_owned));
        names(&list(root.path(), &Selection { subject, session, emotion }).unwrap())
    };
    assert_eq!(found(Some("s010"), None, None), ["S010/001", "S010/002"]);
    assert_eq!(found(None, Some("001"), None), ["S005/001", "S010/001"]);
    assert_eq!(found(None, None, Some(Emotion::Surprise)), ["S010/002"]);
    assert!(found(Some("S005"), None, Some(Emotion::Surprise)).is_empty());
    assert!(found(Some("S006"), None, None).is_empty());
}

#[test]
fn every_number_is_its_emotion_and_nothing_else_is() {
    let root = tempfile::tempdir().unwrap();
    frames(root.path(), "S005", "001", 2);
    for (code, emotion) in Emotion::ALL.into_iter().enumerate() {
        label(root.path(), "S005", "001", &format!("   {code}.0000000e+00\n"));
        assert_eq!(list(root.path(), &all()).unwrap()[0].emotion, Some(emotion));
    }
    for text in ["", "happy", "8.0000000e+00", "-1", "2.5", "nan", "3 4", "\u{0}\u{1}"] {
        label(root.path(), "S005", "001", text);
        let error = list(root.path(), &all()).unwrap_err().to_string();
        assert!(error.contains("S005_001_00000011_emotion.txt: got "), "{error}");
        assert!(error.contains("from 0 (neutral) to 7 (surprise)"), "{error}");
    }
    let one = Selection { subject: Some("S006".to_owned()), ..all() };
    assert!(list(root.path(), &one).unwrap().is_empty(), "labels of others are not read");
}

#[test]
fn another_layout_is_refused_with_what_is_there() {
    let root = tree();
    let images = root.path().join("cohn-kanade-images");
    fs::create_dir(root.path().join("empty")).unwrap();
    for (path, got) in [
        (images.join("S010"), "got a folder with .DS_Store, 001, 002, expected"),
        (images.join("S005/001"), "got a folder with .DS_Store, S005_001_00000001.png, S005_001_00000002.png"),
        (images.join("S005/001/S005_001_00000001.png"), "got a file, expected"),
        (root.path().join("empty"), "got an empty folder"),
        (root.path().join("nowhere"), "got nothing at this path"),
    ] {
        let error = list(&path, &all()).unwrap_err();
        assert!(matches!(error, Error::Sequence { .. }));
        let error = error.to_string();
        assert!(error.starts_with(&path.display().to_string()) && error.contains(got), "{error}");
        assert!(error.contains("cohn-kanade-images/S005/001/S005_001_00000001.png"), "{error}");
    }
}

#[test]
fn sessions_without_pictures_are_named_if_there_is_nothing_else() {
    let root = tree();
    let [subject, session] = ["S999", "004"].map(|name| Some(name.to_owned()));
    let error = list(root.path(), &Selection { subject, session, emotion: None }).unwrap_err().to_string();
    assert!(error.contains("S999/004: got a folder with .DS_Store, expected the pictures"), "{error}");
}
