//! Random numbers: named streams, and nothing else draws any.
//!
//! A stream is ChaCha8 keyed by what it is for, so that no part of a program can disturb the numbers of another, and
//! what a seed means never depends on the order in which things happen.

pub use rand_chacha::ChaCha8Rng;
use rand_core::{Rng, SeedableRng};

use crate::Error;
use crate::bytes::Reader;

/// The longest purpose of a stream, in bytes.
pub const PURPOSE_LEN: usize = 16;

/// The stream of `seed` for one `purpose`; `index` tells apart the streams of the same purpose.
///
/// The 32-byte key is the seed and the index (both little-endian), then the purpose padded with zeros.
///
/// # Panics
/// If `purpose`, a literal in the program, is empty, is not ASCII or is longer than [`PURPOSE_LEN`].
pub fn stream(seed: u64, purpose: &str, index: u64) -> ChaCha8Rng {
    assert!(
        (1..=PURPOSE_LEN).contains(&purpose.len()) && purpose.is_ascii(),
        "the purpose of a stream is 1 to {PURPOSE_LEN} ASCII bytes, not {purpose:?}"
    );
    let mut key = [0; 32];
    key[..8].copy_from_slice(&seed.to_le_bytes());
    key[8..16].copy_from_slice(&index.to_le_bytes());
    key[16..16 + purpose.len()].copy_from_slice(purpose.as_bytes());
    ChaCha8Rng::from_seed(key)
}

/// A number in `0..n`, each equally likely (Lemire's multiplication with rejection).
///
/// # Panics
/// If `n` is 0: there is nothing to choose from.
pub fn below(rng: &mut ChaCha8Rng, n: usize) -> usize {
    assert!(n > 0, "a number below 0 was asked for");
    let n = n as u64;
    // Products whose low half falls under 2^64 mod n belong to the values that would come up once too often.
    let surplus = n.wrapping_neg() % n;
    loop {
        let product = u128::from(rng.next_u64()) * u128::from(n);
        if product as u64 >= surplus {
            return (product >> 64) as usize;
        }
    }
}

/// A number in [0, 1), a multiple of 2⁻²⁴.
pub fn unit_f32(rng: &mut ChaCha8Rng) -> f32 {
    (rng.next_u32() >> 8) as f32 / (1 << 24) as f32
}

/// A stream's key and position, for a checkpoint.
pub fn save(rng: &ChaCha8Rng) -> Vec<u8> {
    let mut bytes = rng.get_seed().to_vec();
    bytes.extend(rng.get_word_pos().to_le_bytes());
    bytes
}

/// The stream that [`save`] was given; it continues with the same numbers.
///
/// # Errors
/// [`Error::BadState`] if `bytes` are not those of [`save`].
pub fn restore(bytes: &[u8]) -> Result<ChaCha8Rng, Error> {
    let mut reader = Reader::new("a random stream", bytes);
    let mut rng = ChaCha8Rng::from_seed(reader.array()?);
    let position = u128::from_le_bytes(reader.array()?);
    reader.finish()?;
    rng.set_word_pos(position);
    if rng.get_word_pos() != position {
        return Err(reader.bad(format!("position {position}"), "a position within the stream's period"));
    }
    Ok(rng)
}
