//! The arithmetic of one iteration, in one pass over the pixels.
//!
//! All instruction sets give the same bits: nothing is rounded but the bytes of a picture.

use crate::simd::Kernel;

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
pub(super) struct Observe<'a> {
    pub(super) frame: &'a [u8],
    pub(super) threshold: u8,
    pub(super) reference: &'a mut [u8],
    pub(super) history: &'a mut [f32],
    pub(super) moment: Moment,
}

impl Kernel for Observe<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let (frames, frame) = self.frame.as_chunks::<BLOCK>();
        let (references, reference) = self.reference.as_chunks_mut::<BLOCK>();
        let (histories, history) = self.history.as_chunks_mut::<BLOCK>();
        for ((frame, reference), history) in frames.iter().zip(references).zip(histories) {
            observe_block(frame, self.threshold, reference, history, self.moment);
        }
        observe_block(frame, self.threshold, reference, history, self.moment);
    }
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

/// Whether any byte differs by more than `threshold` between `reference` and `frame`, of the same length.
pub(super) struct Moves<'a> {
    pub(super) frame: &'a [u8],
    pub(super) threshold: u8,
    pub(super) reference: &'a [u8],
}

impl Kernel for Moves<'_> {
    type Output = bool;

    #[inline(always)]
    fn run(self) -> bool {
        let largest =
            self.frame.iter().zip(self.reference).fold(0, |largest, (&now, &before)| now.abs_diff(before).max(largest));
        largest > self.threshold
    }
}

/// Moves `history` on by a silhouette, which is not 0 where something moved.
pub(super) struct Update<'a> {
    pub(super) silhouette: &'a [u8],
    pub(super) history: &'a mut [f32],
    pub(super) moment: Moment,
}

impl Kernel for Update<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        for (mu, &moved) in self.history.iter_mut().zip(self.silhouette) {
            *mu = self.moment.next(moved != 0, *mu);
        }
    }
}

/// Writes `255 · μ/tau`, rounded to the nearest byte, for `μ` of 0 to `tau`.
pub(super) struct HistoryBytes<'a> {
    pub(super) history: &'a [f32],
    pub(super) tau: f32,
    pub(super) bytes: &'a mut [u8],
}

impl Kernel for HistoryBytes<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        // Where `tau` is 0 nothing but 0 is scaled.
        let scale = (255.0 / self.tau).min(f32::MAX);
        for (byte, &mu) in self.bytes.iter_mut().zip(self.history) {
            // Beside 2²³ an f32 has no room for a fraction: the sum is rounded to a whole number in its lowest bits.
            *byte = (mu * scale + 8_388_608.0).to_bits() as u8;
        }
    }
}

/// Writes 255 where `μ` is above 0, and 0 elsewhere.
pub(super) struct EnergyBytes<'a> {
    pub(super) history: &'a [f32],
    pub(super) bytes: &'a mut [u8],
}

impl Kernel for EnergyBytes<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        for (byte, &mu) in self.bytes.iter_mut().zip(self.history) {
            *byte = if mu > 0.0 { 255 } else { 0 };
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simd::Simd;

    /// Every instruction set of this machine against the definition, at lengths around whole blocks.
    #[test]
    fn all_instruction_sets_give_the_bits_of_the_definition() {
        let noise = |i: usize, seed: usize| (((i + 1) * (seed + 7) * 2_654_435_761) >> 11) as u8;
        let moment = Moment { now: 2.1, oldest: 0.9 };
        for simd in Simd::available() {
            for len in (0..5).chain(BLOCK - 1..BLOCK + 2).chain([3 * BLOCK, 5 * BLOCK + 17]) {
                let frame: Vec<u8> = (0..len).map(|i| noise(i, 1)).collect();
                let before: Vec<u8> = (0..len).map(|i| noise(i, 2)).collect();
                let history: Vec<f32> = (0..len).map(|i| f32::from(noise(i, 3) % 4) * 0.45).collect();
                let moved = |i: usize| frame[i].abs_diff(before[i]) > 60;
                let kept = |i: usize| if history[i] < 0.9 { 0.0 } else { history[i] };
                let expected: Vec<f32> = (0..len).map(|i| if moved(i) { 2.1 } else { kept(i) }).collect();

                let (mut reference, mut observed) = (before.clone(), history.clone());
                let (threshold, frame) = (60, &frame[..]);
                let moves = simd.run(Moves { frame, threshold, reference: &reference });
                assert_eq!(moves, (0..len).any(moved), "{simd:?}, {len} pixels");
                simd.run(Observe { frame, threshold, reference: &mut reference, history: &mut observed, moment });
                assert_eq!((&observed, &reference[..]), (&expected, frame), "{simd:?}, {len} pixels");

                let silhouette: Vec<u8> = (0..len).map(|i| 3 * u8::from(moved(i))).collect();
                let mut updated = history.clone();
                simd.run(Update { silhouette: &silhouette, history: &mut updated, moment });
                assert_eq!(updated, expected, "{simd:?}, {len} pixels");

                let mut bytes = vec![1; len];
                simd.run(HistoryBytes { history: &expected, tau: 2.1, bytes: &mut bytes });
                let shares = expected.iter().map(|&mu| (255.0 * f64::from(mu) / f64::from(2.1f32)).round() as u8);
                assert_eq!(bytes, shares.collect::<Vec<_>>(), "{simd:?}, {len} pixels");
                simd.run(EnergyBytes { history: &expected, bytes: &mut bytes });
                let lit = expected.iter().map(|&mu| if mu > 0.0 { 255 } else { 0 });
                assert_eq!(bytes, lit.collect::<Vec<u8>>(), "{simd:?}, {len} pixels");
            }
        }
    }
}
