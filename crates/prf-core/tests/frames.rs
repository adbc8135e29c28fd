//! Sources of frames: every kind, its order, times and limits, and what is damaged.
#![cfg(feature = "io")]
#![expect(clippy::unwrap_used, reason = "a test may stop at the first surprise")]

use std::fs;
use std::path::{Path, PathBuf};

use image::codecs::gif::GifEncoder;
use image::{Delay, Rgba, RgbaImage};
use prf_core::io::{FrameInfo, FrameSource, Limits};
use prf_core::{Error, Frame, PictureProblem, io};
use tempfile::TempDir;

fn grey(width: usize, height: usize, value: u8) -> Frame {
    Frame::from_vec(width, height, vec![value; width * height]).unwrap()
}

/// A picture whose pixels have the value.
fn write_grey(path: &Path, value: u8) {
    io::write_frame(grey(3, 2, value).view(), path).unwrap();
}

/// A GIF with a frame of each value, each shown for 30 ms.
fn write_gif(path: &Path, values: &[u8]) {
    let mut encoder = GifEncoder::new(fs::File::create(path).unwrap());
    for &value in values {
        let image = RgbaImage::from_pixel(6, 4, Rgba([value, value, value, 255]));
        let delay = Delay::from_numer_denom_ms(30, 1);
        encoder.encode_frame(image::Frame::from_parts(image, 0, 0, delay)).unwrap();
    }
}

/// A y4m of 2x1 pixels in full range with a frame of each value.
fn y4m(values: &[u8]) -> Vec<u8> {
    let mut bytes = b"YUV4MPEG2 W2 H1 F4:1 C420jpeg XCOLORRANGE=FULL\n".to_vec();
    for &value in values {
        bytes.extend(b"FRAME Ip\n");
        bytes.extend([value, value, 128, 128]);
    }
    bytes
}

fn golden(name: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../tests/golden/frames").join(name)
}

/// The problem of this path, which the error has to name.
fn problem<T: std::fmt::Debug>(path: &Path, read: Result<T, Error>) -> PictureProblem {
    match read {
        Err(Error::Picture { path: named, problem }) => {
            assert_eq!(named, path);
            problem
        }
        other => panic!("{}: got {other:?}", path.display()),
    }
}

fn refused(path: &Path) -> PictureProblem {
    problem(path, FrameSource::open(path))
}

/// First value of every frame, with an error where there was one.
fn values(path: &Path, limits: Limits) -> Vec<Result<u8, PictureProblem>> {
    let source = FrameSource::open_within(path, limits).unwrap();
    source
        .map(|read| match read {
            Ok((_, frame)) => Ok(frame.as_slice()[0]),
            Err(Error::Picture { problem, .. }) => Err(problem),
            Err(error) => panic!("{error}"),
        })
        .collect()
}

/// The values of a source that ends with an error, and that error.
fn values_and_end(path: &Path, limits: Limits) -> (Vec<u8>, PictureProblem) {
    let mut values = values(path, limits);
    let end = values.pop().unwrap().unwrap_err();
    (values.into_iter().map(Result::unwrap).collect(), end)
}

#[test]
fn a_picture_is_a_source_of_one_frame() {
    let dir = TempDir::new().unwrap();
    let path = dir.path().join("a");
    write_grey(&path, 7);
    let mut source = FrameSource::open(&path).unwrap();
    assert_eq!(source.len_hint(), Some(1));
    let mut frame = Frame::new(9, 9);
    let info = source.next_into(&mut frame).unwrap().unwrap();
    assert_eq!((info, frame), (FrameInfo { index: 0, time_s: None, path }, grey(3, 2, 7)));
    assert_eq!(source.len_hint(), Some(0));
    assert!(source.next_into(&mut Frame::new(1, 1)).is_none());
}

#[test]
fn a_folder_is_read_in_natural_order() {
    let dir = TempDir::new().unwrap();
    for (name, value) in [
        ("frame10.png", 10),
        ("frame2.png", 2),
        ("frame1.PNG", 1),
        ("no-extension", 20), // comes behind the others and is told by its content
        (".hidden.png", 30),
        (".hidden", 31),
    ] {
        let path = dir.path().join(name);
        write_grey(&path.with_extension("tmp"), value);
        fs::rename(path.with_extension("tmp"), path).unwrap();
    }
    fs::create_dir(dir.path().join("frame3.png")).unwrap();
    fs::write(dir.path().join("Thumbs.db"), b"\xd0\xcf\x11\xe0").unwrap();
    fs::write(dir.path().join("notes.txt"), "frame 2 is the best").unwrap();
    fs::write(dir.path().join("clip.y4m"), y4m(&[1])).unwrap();
    fs::write(dir.path().join("empty"), "").unwrap();
    let source = FrameSource::open(dir.path()).unwrap();
    assert_eq!(source.len_hint(), Some(4));
    let names = source.map(|read| {
        let (info, frame) = read.unwrap();
        assert_eq!(info.time_s, None);
        let name = info.path.file_name().unwrap().to_str().unwrap().to_owned();
        (info.index, name, frame.as_slice()[0])
    });
    let expected = [(0, "frame1.PNG", 1), (1, "frame2.png", 2), (2, "frame10.png", 10), (3, "no-extension", 20)];
    assert_eq!(names.collect::<Vec<_>>(), expected.map(|(i, name, value)| (i, name.to_owned(), value)));
}

#[test]
fn a_damaged_picture_does_not_end_a_folder() {
    let dir = TempDir::new().unwrap();
    for i in 1..=4 {
        write_grey(&dir.path().join(format!("{i}.png")), i);
    }
    let damaged = dir.path().join("2.png");
    let bytes = fs::read(&damaged).unwrap();
    fs::write(&damaged, &bytes[..bytes.len() / 2]).unwrap();
    fs::write(dir.path().join("3.png"), "").unwrap();
    let mut source = FrameSource::open(dir.path()).unwrap();
    let mut frame = Frame::new(1, 1);
    let mut next = || source.next_into(&mut frame).map(|read| read.map(|info| info.index));
    assert_eq!(next().unwrap().unwrap(), 0);
    assert!(matches!(problem(&damaged, next().unwrap()), PictureProblem::Truncated { .. }));
    assert!(matches!(problem(&dir.path().join("3.png"), next().unwrap()), PictureProblem::Empty));
    assert_eq!(next().unwrap().unwrap(), 3);
    assert!(next().is_none());
}

#[test]
fn pictures_of_a_folder_may_differ_in_size() {
    let dir = TempDir::new().unwrap();
    let frames = [grey(3, 2, 1), grey(5, 7, 2), grey(1, 1, 3)];
    for (i, frame) in frames.iter().enumerate() {
        io::write_frame(frame.view(), dir.path().join(format!("{i}.png"))).unwrap();
    }
    let read: Vec<Frame> = FrameSource::open(dir.path()).unwrap().map(|read| read.unwrap().1).collect();
    assert_eq!(read, frames);
}

#[test]
fn a_folder_without_pictures_is_refused() {
    let dir = TempDir::new().unwrap();
    assert!(matches!(refused(dir.path()), PictureProblem::NoPictures));
    fs::write(dir.path().join("notes.txt"), "nothing here").unwrap();
    assert!(matches!(refused(dir.path()), PictureProblem::NoPictures));
}

#[test]
fn what_has_no_frames_is_named() {
    let dir = TempDir::new().unwrap();
    let path = dir.path().join("a");
    assert!(matches!(refused(&path), PictureProblem::Missing));
    fs::write(&path, "").unwrap();
    assert!(matches!(refused(&path), PictureProblem::Empty));
    fs::write(&path, "this is no picture").unwrap();
    let message = FrameSource::open(&path).unwrap_err().to_string();
    assert!(message.contains(r#"begins with "this is ""#) && message.contains("expected PNG"), "{message}");
    // With an ffmpeg at hand it is asked and refuses; without, it is named as missing.
    fs::write(&path, b"\x01\x02\x03 garbage \xff\xfe").unwrap();
    let message = FrameSource::open(&path).unwrap_err().to_string();
    assert!(message.contains(r#"begins with "\x01\x02\x03"#) && message.contains("ffmpeg"), "{message}");
}

#[test]
fn an_animation_gives_frames_with_times() {
    let dir = TempDir::new().unwrap();
    let path = dir.path().join("a.png"); // a GIF whatever its name says
    write_gif(&path, &[10, 200, 90]);
    let mut source = FrameSource::open(&path).unwrap();
    assert_eq!(source.len_hint(), None);
    let mut frame = Frame::new(6, 4);
    let buffer = frame.as_slice().as_ptr();
    for (index, value) in (0..).zip([10, 200, 90]) {
        let info = source.next_into(&mut frame).unwrap().unwrap();
        assert_eq!(info, FrameInfo { index, time_s: Some(index as f64 * 30.0 / 1000.0), path: path.clone() });
        assert_eq!(frame, grey(6, 4, value));
        assert_eq!(frame.as_slice().as_ptr(), buffer, "the buffer is used again");
    }
    assert!(source.next_into(&mut frame).is_none());
    assert!(source.next_into(&mut frame).is_none());
}

#[test]
fn a_y4m_gives_luma_with_times() {
    let dir = TempDir::new().unwrap();
    let path = dir.path().join("a.y4m");
    fs::write(&path, y4m(&[16, 235])).unwrap();
    let read: Vec<_> = FrameSource::open(&path).unwrap().map(Result::unwrap).collect();
    assert_eq!(read.iter().map(|(info, _)| info.time_s).collect::<Vec<_>>(), [Some(0.0), Some(0.25)]);
    assert_eq!(read.iter().map(|(_, frame)| frame.as_slice()).collect::<Vec<_>>(), [[16, 16], [235, 235]]);
    // Without a word on its range it is a video's: black is 16.
    let limited = String::from_utf8_lossy(&y4m(&[])).replace(" XCOLORRANGE=FULL", "").into_bytes();
    fs::write(&path, [&limited[..], &y4m(&[16, 235])[limited.len() + 17..]].concat()).unwrap();
    assert_eq!(values(&path, Limits::default()).into_iter().map(Result::unwrap).collect::<Vec<_>>(), [0, 255]);
}

#[test]
fn a_cut_stream_gives_what_is_whole() {
    let dir = TempDir::new().unwrap();
    let path = dir.path().join("cut");
    let limits = Limits::default();
    for (name, frames) in [("moving.gif", 7), ("moving.png", 7), ("moving.webp", 7), ("moving.y4m", 3)] {
        let whole = fs::read(golden(name)).unwrap();
        let all: Vec<u8> = values(&golden(name), limits).into_iter().map(Result::unwrap).collect();
        assert_eq!(all.len(), frames, "{name}");
        let mut most = 0;
        for len in (whole.len() / 2..whole.len() - 20).step_by(7) {
            fs::write(&path, &whole[..len]).unwrap();
            let (seen, end) = values_and_end(&path, limits);
            assert!(matches!(end, PictureProblem::Truncated { .. }), "{name}, {len} bytes: {end:?}");
            assert_eq!(seen, all[..seen.len()], "{name}, {len} bytes");
            most = most.max(seen.len());
        }
        assert_eq!(most, frames - 1, "{name}");
    }
}

#[test]
fn a_stream_damaged_inside_ends_there() {
    let dir = TempDir::new().unwrap();
    let path = dir.path().join("damaged.y4m");
    let mut bytes = y4m(&[1, 2, 3]);
    let third = bytes.len() - 13;
    bytes[third] = b'f';
    fs::write(&path, bytes).unwrap();
    let (seen, end) = values_and_end(&path, Limits::default());
    assert_eq!(seen, [1, 2]);
    assert!(end.to_string().contains(r#""fRAME Ip" stands where FRAME should"#), "{end}");

    let mut bytes = fs::read(golden("moving.png")).unwrap();
    let middle = bytes.len() / 2;
    bytes[middle] ^= 0x55;
    fs::write(&path, bytes).unwrap();
    let (seen, end) = values_and_end(&path, Limits::default());
    assert!(!seen.is_empty() && matches!(end, PictureProblem::Damaged { .. }), "{seen:?}, {end:?}");
}

#[test]
fn a_stream_without_frames_is_refused() {
    let dir = TempDir::new().unwrap();
    let path = dir.path().join("a");
    fs::write(&path, y4m(&[])).unwrap();
    let (seen, end) = values_and_end(&path, Limits::default());
    assert!(seen.is_empty() && matches!(end, PictureProblem::NoFrames), "{end:?}");
}

#[test]
fn frames_are_counted() {
    let dir = TempDir::new().unwrap();
    let limits = |max_frames| Limits { max_frames, ..Limits::default() };
    let (folder, animation) = (dir.path().join("folder"), dir.path().join("a.gif"));
    fs::create_dir(&folder).unwrap();
    (0..3).for_each(|i| write_grey(&folder.join(format!("{i}.png")), i));
    write_gif(&animation, &[1, 2, 3]);
    for path in [&folder, &animation] {
        assert_eq!(values(path, limits(3)).len(), 3);
    }
    let refusal = problem(&folder, FrameSource::open_within(&folder, limits(2)));
    assert!(matches!(refusal, PictureProblem::TooManyFrames { max_frames: 2 }), "{refusal:?}");
    let (seen, end) = values_and_end(&animation, limits(2));
    assert_eq!(seen, [1, 2]);
    assert!(end.to_string().contains("more than 2 frames"), "{end}");
}

#[test]
fn a_header_that_asks_for_too_much_is_refused() {
    let dir = TempDir::new().unwrap();
    let path = dir.path().join("bomb");
    let too_large = |bytes: &[u8]| {
        fs::write(&path, bytes).unwrap();
        let refusal = refused(&path);
        assert!(matches!(refusal, PictureProblem::TooLarge { .. }), "{refusal:?}");
    };
    too_large(b"YUV4MPEG2 W60000 H60000 F25:1\nFRAME\n");
    let mut gif = fs::read(golden("moving.gif")).unwrap();
    gif[6..10].fill(0xff);
    too_large(&gif);
    too_large(b"RIFF\x64\0\0\0WEBPVP8X\x0a\0\0\0\x02\0\0\0\xff\xff\xff\xff\xff\xff");
    let mut png = fs::read(golden("moving.png")).unwrap();
    png[16..24].copy_from_slice(&[0, 1, 0, 0, 0, 1, 0, 0]);
    fs::write(&path, png).unwrap();
    // Its check sum no longer holds.
    assert!(matches!(refused(&path), PictureProblem::Damaged { .. }));
}

#[test]
fn a_patch_larger_than_the_limits_is_refused() {
    let dir = TempDir::new().unwrap();
    let path = dir.path().join("a.gif");
    write_gif(&path, &[1, 2]);
    let mut bytes = fs::read(&path).unwrap();
    // The second frame's descriptor: its place and then its size.
    let second = bytes.windows(9).rposition(|at| at == b"\x2c\0\0\0\0\x06\0\x04\0").unwrap();
    bytes[second + 5..second + 9].fill(0xff);
    fs::write(&path, bytes).unwrap();
    let (seen, end) = values_and_end(&path, Limits::default());
    assert_eq!(seen, [1]);
    assert!(matches!(end, PictureProblem::TooLarge { width: 65_535, .. }), "{end:?}");
}

#[test]
fn a_frame_that_lies_about_its_size_is_refused() {
    let dir = TempDir::new().unwrap();
    let path = dir.path().join("a.webp");
    for name in ["moving.webp", "moving-lossy.webp"] {
        let mut bytes = fs::read(golden(name)).unwrap();
        let first = bytes.windows(4).position(|at| at == b"ANMF").unwrap();
        bytes[first + 14] -= 4; // the lowest byte of its width
        fs::write(&path, bytes).unwrap();
        let (seen, end) = values_and_end(&path, Limits::default());
        assert!(seen.is_empty() && matches!(end, PictureProblem::Damaged { .. }), "{name}: {end:?}");
        assert!(matches!(problem(&path, io::read_frame(&path)), PictureProblem::Damaged { .. }), "{name}");
    }
}

#[test]
fn a_source_can_go_to_another_thread() {
    let source = FrameSource::open(golden("moving.gif")).unwrap();
    assert_eq!(std::thread::spawn(|| source.count()).join().unwrap(), 7);
}
