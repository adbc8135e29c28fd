//! Whether a JPEG is whole. Its decoder paints what is missing grey and says nothing.

use std::fs::File;
use std::io::{BufReader, Read, Result, Seek};

const START_OF_SCAN: u8 = 0xda;
const END_OF_IMAGE: u8 = 0xd9;

/// Whether the end marker follows the beginning of the pixels; leaves the file at its beginning.
pub(super) fn is_whole(file: &mut File) -> Result<bool> {
    let mut bytes = BufReader::new(&mut *file).bytes();
    let whole = skip_to(&mut bytes, START_OF_SCAN)? && find_end(&mut bytes)?;
    file.rewind()?;
    Ok(whole)
}

/// Goes from segment to segment (each has its length in it: a thumbnail inside one is a whole JPEG)
/// up to the one with this marker. False if the file ends before.
fn skip_to(bytes: &mut impl Iterator<Item = Result<u8>>, marker: u8) -> Result<bool> {
    let mut next = || bytes.next().transpose();
    loop {
        // Markers stand behind any number of 0xff; those up to 0xd8 from 0xd0 and 0x01 stand alone.
        match next()? {
            Some(0xff | 0x01 | 0xd0..=0xd8) => continue,
            Some(found) if found == marker => return Ok(true),
            Some(_) => {}
            None => return Ok(false),
        }
        let (Some(high), Some(low)) = (next()?, next()?) else { return Ok(false) };
        // The length counts its own two bytes.
        for _ in 2..u16::from_be_bytes([high, low]) {
            next()?;
        }
    }
}

/// Whether the end marker comes. Inside of pixel data 0xff is always followed by something else.
fn find_end(bytes: &mut impl Iterator<Item = Result<u8>>) -> Result<bool> {
    let mut last = 0;
    for byte in bytes {
        let byte = byte?;
        if (last, byte) == (0xff, END_OF_IMAGE) {
            return Ok(true);
        }
        last = byte;
    }
    Ok(false)
}
