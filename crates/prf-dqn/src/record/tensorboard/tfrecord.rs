//! TFRecord: the length of a record, its checksum, the record, its checksum.

/// Bytes before and after a record.
const HEAD: usize = 12;
const TAIL: usize = 4;

/// A record as it stands in a file.
pub(super) fn framed(record: &[u8]) -> Vec<u8> {
    let length = (record.len() as u64).to_le_bytes();
    [&length, &checksum(&length)[..], record, &checksum(record)].concat()
}

/// The record that `bytes` begins with, if it is whole.
pub(super) fn first(bytes: &[u8]) -> Option<&[u8]> {
    let (length, rest) = bytes.split_at_checked(8)?;
    let (length_checksum, rest) = rest.split_at_checked(4)?;
    if checksum(length) != length_checksum {
        return None;
    }
    let length = usize::try_from(u64::from_le_bytes(length.try_into().ok()?)).ok()?;
    let (record, rest) = rest.split_at_checked(length)?;
    (rest.get(..TAIL)? == checksum(record)).then_some(record)
}

/// Length of the whole records that `bytes` begins with.
pub(super) fn whole(bytes: &[u8]) -> usize {
    let mut at = 0;
    while let Some(record) = first(&bytes[at..]) {
        at += HEAD + record.len() + TAIL;
    }
    at
}

/// CRC-32C, masked as the format wants it: checksums of what holds checksums are weak.
fn checksum(bytes: &[u8]) -> [u8; 4] {
    crc32c::crc32c(bytes).rotate_right(15).wrapping_add(0xa282_ead8).to_le_bytes()
}
