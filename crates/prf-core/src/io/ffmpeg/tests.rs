//! With a stand-in for ffmpeg: a script that does by a file's name what the real one might do.

use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::path::PathBuf;
use std::sync::LazyLock;

use tempfile::TempDir;

use super::*;
use crate::Frame;

/// Written once and before any process starts: a file that is open for writing can't be run.
static STAND_IN: LazyLock<(TempDir, PathBuf)> = LazyLock::new(|| {
    let dir = TempDir::new().expect("a folder for temporary files");
    let path = dir.path().join("ffmpeg");
    fs::write(&path, SCRIPT).expect("the folder is new");
    fs::set_permissions(&path, fs::Permissions::from_mode(0o755)).expect("the file is ours");
    (dir, path)
});

const SCRIPT: &str = r#"#!/bin/sh
for word; do case $word in file:*) input=${word#file:} ;; esac; done
header() { printf 'YUV4MPEG2 W2 H1 F10:1 Cmono\n'; }
case $input in
*two) header; printf 'FRAME\n\001\002FRAME\n\003\004' ;;
*noisy) header; head -c 1000000 /dev/zero | tr '\0' x >&2; printf 'FRAME\n\001\002' ;;
*refused) printf '[in#0 @ 0x55f0] [b @ 1] moov atom not found\nmore\n' >&2; exit 1 ;;
*silent) exit 3 ;;
*nothing) ;;
*late) header; printf 'FRAME\n\001\002'; echo 'error while decoding' >&2; exit 1 ;;
*damaged) header; printf 'FRAME\n\001\002'; echo '[h264 @ 0x1] concealing errors' >&2 ;;
*hangup) header; printf 'FRAME\n\001\002FRAME\n\003' ;;
*garbage) while printf 'no frames but noise, which never ends'; do :; done ;;
*huge) printf 'YUV4MPEG2 W9000 H9000 F10:1 Cmono\n' ;;
*empty) header ;;
*endless) header; echo $$ >"$input.pid"; while printf 'FRAME\n\001\002'; do :; done ;;
*limited) printf 'YUV4MPEG2 W2 H1 Cmono XCOLORRANGE=LIMITED\nFRAME\n\020\353' ;;
esac
"#;

fn open_at(program: &OsStr, path: &Path) -> Result<Video, PictureProblem> {
    let mut file = super::super::sniff::open(path)?;
    let start = Start::of(&mut file)?;
    Video::open(program, path, &start, Limits::default())
}

/// The path of a file that seems to be a video, named by what shall happen to it.
fn video(dir: &TempDir, name: &str) -> PathBuf {
    let path = dir.path().join(name);
    fs::write(&path, b"\0\0\0\x18ftyp").expect("the folder is new");
    path
}

fn open(name: &str) -> Result<Video, PictureProblem> {
    let dir = TempDir::new().expect("a folder for temporary files");
    open_at(STAND_IN.1.as_os_str(), &video(&dir, name))
}

/// A frame's pixels and its time in seconds.
type Seen = (Vec<u8>, Option<f64>);

/// The frames, and the error that ended them.
fn frames(name: &str) -> (Vec<Seen>, Option<PictureProblem>) {
    let mut video = open(name).expect(name);
    let (mut frame, mut seen) = (Frame::new(1, 1), Vec::new());
    loop {
        match video.next_into(&mut frame) {
            Ok(Some(timed)) => seen.push((frame.as_slice().to_vec(), timed.time_s)),
            Ok(None) => return (seen, None),
            Err(problem) => return (seen, Some(problem)),
        }
    }
}

#[test]
fn frames_come_with_their_times() {
    let (seen, problem) = frames("two");
    assert_eq!(seen, [(vec![1, 2], Some(0.0)), (vec![3, 4], Some(0.1))]);
    assert!(problem.is_none(), "{problem:?}");
    assert_eq!(frames("limited").0, [(vec![0, 255], None)]);
    assert!(frames("empty").0.is_empty());
}

#[test]
fn a_refusal_is_quoted() {
    let detail = |name: &str| match open(name).err() {
        Some(PictureProblem::NotAVideo { start, detail }) => {
            assert_eq!(start, r#""\x00\x00\x00\x18ftyp""#);
            detail
        }
        other => panic!("{name}: {other:?}"),
    };
    assert_eq!(detail("refused"), "moov atom not found");
    assert_eq!(detail("silent"), "it ended with exit status: 3");
    assert_eq!(detail("nothing"), "it wrote nothing");
    // The header's line does not end.
    assert!(detail("garbage").contains("y4m"), "{}", detail("garbage"));
    let problem = open("huge").err();
    assert!(matches!(problem, Some(PictureProblem::TooLarge { width: 9000, .. })), "{problem:?}");
}

#[test]
fn what_was_read_before_a_failure_is_kept() {
    for (name, expected) in [
        ("late", "the video is damaged (error while decoding)"),
        ("damaged", "the video is damaged (concealing errors)"),
        ("hangup", "is cut short"),
        ("noisy", "xxxx"),
    ] {
        let (seen, problem) = frames(name);
        assert_eq!(seen, [(vec![1, 2], Some(0.0))], "{name}");
        let message = problem.expect(name).to_string();
        assert!(message.contains(expected) && message.len() < 2000, "{name}: {message}");
    }
}

#[test]
fn a_missing_program_is_named() {
    let dir = TempDir::new().expect("a folder for temporary files");
    let problem = open_at(dir.path().join("ffmpeg").as_os_str(), &video(&dir, "two")).err();
    let Some(problem @ PictureProblem::NoFfmpeg { .. }) = problem else { panic!("{problem:?}") };
    assert!(problem.to_string().contains("ffmpeg, which videos need, is not on PATH"), "{problem}");
}

#[test]
fn text_is_never_a_video() {
    let dir = TempDir::new().expect("a folder for temporary files");
    let path = dir.path().join("two");
    fs::write(&path, "#EXTM3U\nhttp://example.org/video.ts\n").expect("the folder is new");
    let problem = open_at(STAND_IN.1.as_os_str(), &path).err();
    assert!(matches!(problem, Some(PictureProblem::NotAPicture { .. })), "{problem:?}");
}

#[test]
#[cfg(target_os = "linux")]
fn the_process_ends_with_the_video() {
    let dir = TempDir::new().expect("a folder for temporary files");
    let path = video(&dir, "endless");
    let mut endless = open_at(STAND_IN.1.as_os_str(), &path).expect("it begins well");
    for _ in 0..100 {
        assert!(endless.next_into(&mut Frame::new(2, 1)).is_ok_and(|timed| timed.is_some()));
    }
    let pid = fs::read_to_string(dir.path().join("endless.pid")).expect("the stand-in wrote it");
    let process = PathBuf::from("/proc").join(pid.trim());
    assert!(process.exists());
    drop(endless);
    assert!(!process.exists());
}

#[test]
fn a_name_is_never_an_option_or_a_url() {
    for name in ["-y", "http://example.org/a.mp4"] {
        let words = arguments(Path::new(name), Limits::default());
        let at = words.iter().position(|word| word == "-i").expect("there is an input");
        assert_eq!(words[at + 1], OsString::from(format!("file:{name}")));
        assert!(!words.contains(&OsString::from(name)));
    }
}
