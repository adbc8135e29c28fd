//! The arithmetic of one iteration, in one pass over the pixels.
//!
//! Each loop is compiled for several instruction sets, of which the best that the processor knows is
//! chosen at run time. All of them give the same bits: nothing is rounded but the bytes of a picture.

use multiversion::multiversion;

/// Pixels that are worked on at a time.
const BLOCK: usize = 32;

/// The times of one iteration.
#[derive(Clone, Copy, Debug)]
pub(super) struct Moment {
    /// `τ`, what a pixel gets that moves now.
    pub(super) now: f32,
    /// `τ − δ`; a movement before this is forgotten.
    pub(super) oldest: f32,
}

impl Moment {
    /// `μ_t` of one pixel.
    #[inline(always)]
    fn next(self, moved: bool, before: f32) -> f32 {
        let kept = if before < self.oldest { 0.0 } else { before };
        if moved { self.now } else { kept }
    }
}

/// Moves `history` on by the silhouette of what differs by more than `threshold` between `reference`
/// and `frame`, which becomes the next reference. All have the same length.
#[multiversion(targets("x86_64+avx512f+avx512bw+avx512vl", "x86_64+avx2"))]
pub(super) fn observe(frame: &[u8], threshold: u8, reference: &mut [u8], history: &mut [f32], moment: Moment) {
    let (frames, frame) = frame.as_chunks::<BLOCK>();
    let (references, reference) = reference.as_chunks_mut::<BLOCK>();
    let (histories, history) = history.as_chunks_mut::<BLOCK>();
    for ((frame, reference), history) in frames.iter().zip(references).zip(histories) {
        observe_block(frame, threshold, reference, history, moment);
    }
    observe_block(frame, threshold, reference, history, moment);
}

/// Up to a block of pixels. Bytes are compared before floats are touched: in one loop, there would be as few
/// bytes at a time as there are floats.
#[inline(always)]
fn observe_block(frame: &[u8], threshold: u8, reference: &mut [u8], history: &mut [f32], moment: Moment) {
    let mut silhouette = [false; BLOCK];
    for ((moved, &now), &before) in silhouette.iter_mut().zip(frame).zip(&*reference) {
        *moved = now.abs_diff(before) > threshold;
    }
    reference.copy_from_slice(frame);
    for (mu, &moved) in history.iter_mut().zip(&silhouette) {
        *mu = moment.next(moved, *mu);
    }
}

/// Moves `history` on by a silhouette, which is not 0 where something moved.
#[multiversion(targets("x86_64+avx512f+avx512bw+avx512vl", "x86_64+avx2"))]
pub(super) fn update(silhouette: &[u8], history: &mut [f32], moment: Moment) {
    for (mu, &moved) in history.iter_mut().zip(silhouette) {
        *mu = moment.next(moved != 0, *mu);
    }
}

/// Writes `255 · μ/tau`, rounded to the nearest byte, for `μ` of 0 to `tau`.
#[multiversion(targets("x86_64+avx512f+avx512bw+avx512vl", "x86_64+avx2"))]
pub(super) fn history_bytes(history: &[f32], tau: f32, bytes: &mut [u8]) {
    // Where `tau` is 0 nothing but 0 is scaled.
    let scale = (255.0 / tau).min(f32::MAX);
    for (byte, &mu) in bytes.iter_mut().zip(history) {
        // Beside 2²³ an f32 has no room for a fraction: the sum is rounded to a whole number in its lowest bits.
        *byte = (mu * scale + 8_388_608.0).to_bits() as u8;
    }
}

/// Writes 255 where `μ` is above 0, and 0 elsewhere.
#[multiversion(targets("x86_64+avx512f+avx512bw+avx512vl", "x86_64+avx2"))]
pub(super) fn energy_bytes(history: &[f32], bytes: &mut [u8]) {
    for (byte, &mu) in bytes.iter_mut().zip(history) {
        *byte = if mu > 0.0 { 255 } else { 0 };
    }
}

/// Whether any `μ` is above 0. Without an early exit, so that it runs many pixels at a time.
#[multiversion(targets("x86_64+avx512f+avx512bw+avx512vl", "x86_64+avx2"))]
pub(super) fn has_motion(history: &[f32]) -> bool {
    history.iter().fold(false, |seen, &mu| seen | (mu > 0.0))
}
