//! Files that are no pictures to work with.

use std::fs;
use std::path::Path;

use crate::pictures::bars;

/// Files that are no pictures to work with, each with a part of what is to be said about it.
pub(crate) fn files(folder: &Path) -> Vec<(&'static str, &'static str)> {
    let whole = folder.join("whole.png");
    bars(&whole, 5);
    let bytes = fs::read(&whole).expect("the picture was just written");
    let write = |name: &str, content: &[u8]| {
        fs::write(folder.join(name), content).expect("the folder is ours");
    };
    write("empty.png", b"");
    write("text.png", b"This is no picture.\n");
    write("truncated.png", &bytes[..bytes.len() / 2]);
    write("huge.png", &huge());
    fs::create_dir(folder.join("folder.png")).expect("the folder is ours");
    vec![
        ("empty.png", "0 bytes"),
        ("text.png", "not a picture"),
        ("truncated.png", "cut short"),
        ("huge.png", "20000x20000"),
        ("folder.png", "folder.png"),
    ]
}

/// A PNG of a few bytes that claims to have 20,000 × 20,000 pixels.
fn huge() -> Vec<u8> {
    let side = 20_000u32.to_be_bytes();
    let grey_8_bits = [8, 0, 0, 0, 0];
    let header = [&side[..], &side, &grey_8_bits].concat();
    let pixels = [0x78, 0x9c, 0x03, 0x00, 0x00, 0x00, 0x00, 0x01]; // an empty zlib stream
    let signature = b"\x89PNG\r\n\x1a\n";
    [signature.to_vec(), chunk(b"IHDR", &header), chunk(b"IDAT", &pixels), chunk(b"IEND", &[])].concat()
}

fn chunk(kind: &[u8; 4], data: &[u8]) -> Vec<u8> {
    let length = u32::try_from(data.len()).expect("chunks here are short").to_be_bytes();
    let body = [&kind[..], data].concat();
    [&length[..], &body, &crc32(&body).to_be_bytes()].concat()
}

/// The checksum of PNG chunks.
fn crc32(bytes: &[u8]) -> u32 {
    let mut crc = u32::MAX;
    for &byte in bytes {
        crc ^= u32::from(byte);
        for _ in 0..8 {
            crc = if crc & 1 == 1 { 0xEDB8_8320 ^ (crc >> 1) } else { crc >> 1 };
        }
    }
    !crc
}
