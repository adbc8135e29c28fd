//! Videos through a real ffmpeg, which has to be on PATH: `cargo xtask test` brings one and runs this.
#![cfg(feature = "io")]

use std::process::Command;

use prf_core::Frame;
use prf_core::io::FrameSource;

#[test]
fn a_video_gives_the_frames_and_times_it_was_made_of() {
    let dir = tempfile::tempdir().expect("a folder for temporary files");
    // Neither an option nor a format by its name.
    let path = dir.path().join("-black and white.mkv");
    let made = Command::new("ffmpeg")
        .args(
            "-v error -f lavfi -i color=black:s=32x16:r=5:d=1[a];color=white:s=32x16:r=5:d=1[b];[a][b]concat"
                .split(' '),
        )
        .args(["-pix_fmt", "yuv420p"])
        .arg(&path)
        .status();
    assert!(made.expect("ffmpeg is on PATH").success());

    let mut video = FrameSource::open(&path).expect("a video");
    let mut frame = Frame::new(1, 1);
    let mut seen = Vec::new();
    while let Some(read) = video.next_into(&mut frame) {
        let info = read.expect("a whole video");
        assert_eq!((frame.width(), frame.height()), (32, 16));
        assert!(frame.as_slice().iter().all(|v| v.abs_diff(frame.as_slice()[0]) <= 1));
        seen.push((frame.as_slice()[0], info.time_s.map(|time_s| (time_s * 10.0).round() as u32)));
    }
    let expected: Vec<_> = (0..10).map(|i| (if i < 5 { 0 } else { 255 }, Some(2 * i))).collect();
    assert_eq!(seen, expected);
}
