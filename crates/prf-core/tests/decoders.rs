//! The fuzz targets of `fuzz/`, on stable Rust: over the golden files, cut at every length and with
//! every byte changed.
#![cfg(feature = "io")]
#![expect(clippy::unwrap_used, reason = "a test may stop at the first surprise")]

use std::fs;
use std::path::PathBuf;

#[path = "../../../fuzz/src/targets.rs"]
#[expect(unreachable_pub, reason = "the fuzz targets are crates of their own")]
mod targets;

type Target = fn(&[u8]);

const FILES: [(&str, Target); 11] = [
    ("still.png", |data| targets::picture(targets::PNG, data)),
    ("still.jpg", |data| targets::picture(targets::JPEG, data)),
    ("still.bmp", |data| targets::picture(targets::BMP, data)),
    ("still.webp", |data| targets::picture(targets::WEBP, data)),
    ("still-lossy.webp", |data| targets::picture(targets::WEBP, data)),
    ("moving.gif", |data| targets::picture(targets::GIF, data)),
    ("moving.gif", targets::animation),
    ("moving.png", targets::animation),
    ("moving.webp", targets::animation),
    ("moving-lossy.webp", targets::animation),
    ("moving.y4m", targets::y4m),
];

fn bytes(name: &str) -> Vec<u8> {
    let golden = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../tests/golden/frames");
    fs::read(golden.join(name)).unwrap()
}

#[test]
fn nothing_cut_short_panics() {
    for (name, target) in FILES {
        let whole = bytes(name);
        (0..=whole.len()).for_each(|len| target(&whole[..len]));
    }
}

#[test]
fn nothing_changed_panics() {
    for (name, target) in FILES {
        let mut changed = bytes(name);
        for at in 0..changed.len() {
            let byte = changed[at];
            for wrong in [byte ^ 1 << (at % 8), 0, 0xff] {
                changed[at] = wrong;
                target(&changed);
            }
            changed[at] = byte;
        }
    }
}

/// A PNG's chunks have check sums, before which no change gets far: they are made right again.
#[test]
fn nothing_changed_in_a_chunk_panics() {
    for name in ["still.png", "moving.png", "moving-hidden.png"] {
        let whole = bytes(name);
        for at in 8..whole.len() {
            for wrong in [whole[at] ^ 1 << (at % 8), 0, 0xff] {
                let mut changed = whole.clone();
                changed[at] = wrong;
                mend_check_sums(&mut changed);
                targets::picture(targets::PNG, &changed);
                targets::animation(&changed);
            }
        }
    }
}

#[test]
fn no_goal_panics() {
    let noise = |i: usize| (i.wrapping_mul(2_654_435_761) >> 13) as u8;
    for start in 0..3000 {
        let data: Vec<u8> = (start * 40..start * 40 + 7 + start % 50).map(noise).collect();
        targets::goal(&data);
    }
}

fn mend_check_sums(png: &mut [u8]) {
    let mut at = 8;
    while let Some(&[a, b, c, d]) = png.get(at..at + 4).and_then(|length| length.first_chunk()) {
        let end = u32::from_be_bytes([a, b, c, d]) as usize + at + 8;
        let Some(sum) = png.get(at + 4..end).map(crc) else { return };
        let Some(place) = png.get_mut(end..end + 4) else { return };
        place.copy_from_slice(&sum.to_be_bytes());
        at = end + 4;
    }
}

fn crc(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(!0u32, |crc, &byte| {
        (0..8).fold(crc ^ u32::from(byte), |crc, _| (crc >> 1) ^ (0xedb8_8320 & 0u32.wrapping_sub(crc & 1)))
    })
}
