//! Pictures in files: what is read, and what is refused with which words.
#![cfg(feature = "io")]
#![expect(clippy::unwrap_used, reason = "a test may stop at the first surprise")]

use std::fs;
use std::path::{Path, PathBuf};

use image::{DynamicImage, ImageFormat, Rgba, RgbaImage};
use prf_core::{Error, Frame, PictureProblem, io};
use tempfile::TempDir;

/// A picture with some detail, so that cutting its file short loses something.
fn picture(width: u32, height: u32) -> DynamicImage {
    let noise = |x: u32, y: u32| (x.wrapping_mul(7919) ^ y.wrapping_mul(104_729)).wrapping_mul(2_654_435_761) >> 24;
    let pixel = |x, y| Rgba([noise(x, y) as u8, noise(y, x) as u8, (x * 3 + y) as u8, 255]);
    DynamicImage::ImageRgba8(RgbaImage::from_fn(width, height, pixel))
}

fn saved(dir: &TempDir, name: &str, image: &DynamicImage, format: ImageFormat) -> PathBuf {
    let path = dir.path().join(name);
    image.to_rgb8().save_with_format(&path, format).unwrap();
    path
}

fn problem(path: &Path) -> PictureProblem {
    match io::read_frame(path) {
        Err(Error::Picture { path: named, problem }) => {
            assert_eq!(named, path);
            problem
        }
        other => panic!("{}: got {other:?}", path.display()),
    }
}

#[test]
fn a_frame_survives_writing_and_reading() {
    let dir = TempDir::new().unwrap();
    let path = dir.path().join("frame.png");
    let frame = Frame::from_vec(7, 5, (0..35).map(|i| i * 7).collect()).unwrap();
    io::write_frame(frame.view(), &path).unwrap();
    assert_eq!(io::read_frame(&path).unwrap(), frame);
}

#[test]
fn every_format_is_told_by_its_content() {
    let dir = TempDir::new().unwrap();
    let flat = DynamicImage::ImageRgba8(RgbaImage::from_pixel(20, 16, Rgba([200, 200, 200, 255])));
    use ImageFormat::{Bmp, Gif, Jpeg, Png, WebP};
    for (format, name) in [(Png, "a.jpg"), (Jpeg, "b.png"), (Bmp, "c"), (Gif, "d.txt"), (WebP, "e.gif")] {
        let frame = io::read_frame(saved(&dir, name, &flat, format)).unwrap();
        assert_eq!((frame.width(), frame.height()), (20, 16));
        let off = frame.as_slice().iter().map(|v| v.abs_diff(200)).max();
        assert!(off.is_some_and(|off| off <= 2), "{format:?} is off by {off:?}");
    }
}

#[test]
fn colour_alpha_and_depth_become_bytes_of_grey() {
    let dir = TempDir::new().unwrap();
    let path = dir.path().join("a.png");
    let pixels = RgbaImage::from_fn(3, 1, |x, _| Rgba([255, 255, 255, [255, 128, 0][x as usize]]));
    pixels.save(&path).unwrap();
    assert_eq!(io::read_frame(&path).unwrap().as_slice(), [255, 128, 0]);

    let deep = image::ImageBuffer::<image::Luma<u16>, _>::from_raw(2, 1, vec![65_535u16, 257 * 100]).unwrap();
    deep.save(&path).unwrap();
    assert_eq!(io::read_frame(&path).unwrap().as_slice(), [255, 100]);

    let red = image::RgbImage::from_pixel(1, 1, image::Rgb([255, 0, 0]));
    red.save(&path).unwrap();
    assert_eq!(io::read_frame(&path).unwrap().as_slice(), [76]);
}

#[test]
fn what_is_no_file_is_named() {
    let dir = TempDir::new().unwrap();
    let missing = dir.path().join("missing.png");
    assert!(matches!(problem(&missing), PictureProblem::Missing));
    assert!(matches!(problem(dir.path()), PictureProblem::NotAFile));
    let message = io::read_frame(&missing).unwrap_err().to_string();
    assert!(message.contains("missing.png: no such file"), "{message}");
}

#[test]
fn empty_and_foreign_files_are_named() {
    let dir = TempDir::new().unwrap();
    let path = dir.path().join("goal.png");
    fs::write(&path, "").unwrap();
    assert!(matches!(problem(&path), PictureProblem::Empty));
    // Text, one byte, a TIFF (a picture, but of no format read here), and a text named by nothing.
    for start in [&b"this is no picture"[..], b"x", b"II*\0\x08\0\0\0\0\0\0\0"] {
        fs::write(&path, start).unwrap();
        assert!(matches!(problem(&path), PictureProblem::NotAPicture { .. }));
    }
    fs::write(&path, "hello\nworld").unwrap();
    let message = io::read_frame(&path).unwrap_err().to_string();
    assert!(message.contains(r#"begins with "hello\nwo""#), "{message}");
    assert!(message.contains("expected PNG, JPEG, BMP, WebP or GIF"), "{message}");
}

#[test]
fn a_file_cut_anywhere_is_refused() {
    let dir = TempDir::new().unwrap();
    use ImageFormat::{Bmp, Gif, Jpeg, Png, WebP};
    for format in [Png, Jpeg, Bmp, Gif, WebP] {
        let path = saved(&dir, "whole", &picture(40, 30), format);
        let whole = fs::read(&path).unwrap();
        io::read_frame(&path).unwrap();
        let cut = dir.path().join("cut");
        for len in [20, whole.len() / 8, whole.len() / 2, whole.len() * 9 / 10] {
            fs::write(&cut, &whole[..len]).unwrap();
            let problem = problem(&cut);
            assert!(
                matches!(problem, PictureProblem::Truncated { .. }),
                "{format:?}, {len} of {} bytes: {problem:?}",
                whole.len()
            );
        }
    }
}

#[test]
fn a_jpeg_with_a_thumbnail_inside_is_told_whole_from_cut() {
    let dir = TempDir::new().unwrap();
    let path = saved(&dir, "a.jpg", &picture(40, 30), ImageFormat::Jpeg);
    let plain = fs::read(&path).unwrap();
    // A thumbnail lies in a segment before the picture: a whole JPEG with its own end.
    let length = (plain.len() as u16 + 2).to_be_bytes();
    let nested = [&plain[..2], &[0xff, 0xe1], &length, &plain, &plain[2..]].concat();
    fs::write(&path, &nested).unwrap();
    io::read_frame(&path).unwrap();
    fs::write(&path, &nested[..nested.len() - 200]).unwrap();
    assert!(matches!(problem(&path), PictureProblem::Truncated { .. }));
}

#[test]
fn damage_inside_is_refused() {
    let dir = TempDir::new().unwrap();
    let path = saved(&dir, "a.png", &picture(40, 30), ImageFormat::Png);
    let mut bytes = fs::read(&path).unwrap();
    let middle = bytes.len() / 2;
    bytes[middle] ^= 0x55;
    fs::write(&path, bytes).unwrap();
    assert!(matches!(problem(&path), PictureProblem::Damaged { .. }), "{:?}", problem(&path));
}

/// A PNG that says it is this large and holds nothing.
fn png_header(width: u32, height: u32) -> Vec<u8> {
    let mut ihdr = b"IHDR".to_vec();
    ihdr.extend(width.to_be_bytes());
    ihdr.extend(height.to_be_bytes());
    ihdr.extend([8, 6, 0, 0, 0]); // 8 bits of red, green, blue and alpha
    let mut png = b"\x89PNG\r\n\x1a\n".to_vec();
    for chunk in [&ihdr[..], b"IDAT"] {
        png.extend((chunk.len() as u32 - 4).to_be_bytes());
        png.extend(chunk);
        png.extend(crc(chunk).to_be_bytes());
    }
    png
}

fn crc(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(!0u32, |crc, &byte| {
        (0..8).fold(crc ^ u32::from(byte), |crc, _| (crc >> 1) ^ (0xedb8_8320 & 0u32.wrapping_sub(crc & 1)))
    })
}

#[test]
fn a_decompression_bomb_is_refused_from_its_header() {
    let dir = TempDir::new().unwrap();
    let path = dir.path().join("bomb.png");
    for (width, height) in [(20_000, 20_000), (8_193, 1), (1, 8_193), (i32::MAX as u32, i32::MAX as u32)] {
        fs::write(&path, png_header(width, height)).unwrap();
        let problem = problem(&path);
        let PictureProblem::TooLarge { width: w, height: h, .. } = problem else {
            panic!("{width}x{height}: {problem:?}");
        };
        assert_eq!((w, h), (width, height));
    }
    fs::write(&path, png_header(20_000, 20_000)).unwrap();
    let message = io::read_frame(&path).unwrap_err().to_string();
    assert!(message.contains("20000x20000, expected at most 8192 on a side"), "{message}");
}

#[test]
fn limits_can_be_chosen() {
    let dir = TempDir::new().unwrap();
    let path = saved(&dir, "a.png", &picture(40, 30), ImageFormat::Png);
    let within = |max_side, max_pixels| {
        io::read_frame_within(&path, io::Limits { max_side, max_pixels, ..io::Limits::default() })
    };
    assert!(within(40, 1200).is_ok());
    assert!(within(39, 1200).is_err());
    assert!(within(40, 1199).is_err());
}

#[test]
fn writing_into_nothing_is_an_error() {
    let dir = TempDir::new().unwrap();
    let path = dir.path().join("no/such/folder.png");
    let error = io::write_frame(Frame::new(2, 2).view(), &path).unwrap_err();
    assert!(error.to_string().contains("folder.png"), "{error}");
}
