//! Adam's step on the CPU in one pass over memory.
//!
//! Written as tensor operations a step reads and writes the 1.7 million parameters seven times and takes longer than the
//! backward pass; here each number is touched once, and what the next forward pass reads is rounded on the way. libtorch
//! offers no safe slice of a tensor's storage, hence the `unsafe` blocks: they turn contiguous CPU tensors, whose types are
//! checked just before, into slices.
#![expect(unsafe_code, reason = "a slice of a tensor's storage exists only behind a pointer")]

use std::slice;

use tch::{Device, Kind, Tensor};

use super::{BETA1, BETA2, EPSILON, StepSize};
use crate::error::Result;
use crate::network::Parameters;

/// Parameters that one worker moves at a time, unless fewer are left.
const SHARE: usize = 200_000;
/// Parameters that are moved, then rounded while they are still in the nearest cache.
const TOGETHER: usize = 1024;

pub(super) fn step(
    parameters: &mut Parameters,
    first: &mut Tensor,
    second: &mut Tensor,
    gradients: &[Tensor],
    size: StepSize,
) -> Result<()> {
    let gradients: Vec<Tensor> = gradients.iter().map(Tensor::f_contiguous).collect::<Result<_, _>>()?;
    let count: usize = gradients.iter().map(Tensor::numel).sum();
    let Parameters { flat, rounded } = parameters;
    for tensor in [&*flat, first, second].into_iter().chain(rounded.as_ref()) {
        assert_eq!(tensor.numel(), count, "gradients, parameters and moments differ in number");
    }
    if count == 0 {
        return Ok(());
    }
    let written = [&*flat, first, second].into_iter().chain(rounded.as_ref());
    assert_disjoint(written, &gradients);

    let mut rest = Piece {
        parameters: values_mut(flat),
        first: values_mut(first),
        second: values_mut(second),
        rounded: rounded.as_mut().map_or(&mut [], values_mut),
    };
    rayon::in_place_scope(|scope| {
        for gradient in &gradients {
            let gradient = Gradient::of(gradient);
            for start in (0..gradient.len()).step_by(SHARE) {
                let gradient = gradient.part(start, SHARE);
                let piece = rest.split_off_front(gradient.len());
                // Whole shares go to whichever worker is free, what is left over stays on this one. Pieces never
                // interact, so the workers cannot change the result.
                if gradient.len() == SHARE {
                    scope.spawn(move |_| piece.step(gradient, size));
                } else {
                    piece.step(gradient, size);
                }
            }
        }
    });
    Ok(())
}

/// What belongs to some of the parameters.
struct Piece<'a> {
    parameters: &'a mut [f32],
    first: &'a mut [f32],
    second: &'a mut [f32],
    /// As many again, or none where nothing has to be rounded.
    rounded: &'a mut [Bf16],
}

impl<'a> Piece<'a> {
    fn split_off_front(&mut self, count: usize) -> Self {
        let rounded = if self.rounded.is_empty() { 0 } else { count };
        Piece {
            parameters: split_off_front(&mut self.parameters, count),
            first: split_off_front(&mut self.first, count),
            second: split_off_front(&mut self.second, count),
            rounded: split_off_front(&mut self.rounded, rounded),
        }
    }

    /// Square roots and quotients are half of the work, so it is compiled for wider vectors as well. No product is fused
    /// with a sum, so the bits are the same.
    fn step(self, gradient: Gradient<'_>, size: StepSize) {
        #[cfg(target_arch = "x86_64")]
        if is_x86_feature_detected!("avx512f") {
            // SAFETY: the machine was asked for the instructions.
            return unsafe { self.step_by_avx512(gradient, size) };
        }
        self.step_in_blocks(gradient, size);
    }

    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx512f")]
    fn step_by_avx512(self, gradient: Gradient<'_>, size: StepSize) {
        self.step_in_blocks(gradient, size);
    }

    #[inline(always)]
    fn step_in_blocks(mut self, gradient: Gradient<'_>, size: StepSize) {
        for start in (0..gradient.len()).step_by(TOGETHER) {
            let gradient = gradient.part(start, TOGETHER);
            let piece = self.split_off_front(gradient.len());
            match gradient {
                Gradient::F32(gradient) => adam(piece.parameters, piece.first, piece.second, gradient, size),
                Gradient::Bf16(gradient) => adam(piece.parameters, piece.first, piece.second, gradient, size),
            }
            for (rounded, &parameter) in piece.rounded.iter_mut().zip(&*piece.parameters) {
                *rounded = Bf16::nearest(parameter);
            }
        }
    }
}

#[inline(always)]
fn adam<G: Element>(
    parameters: &mut [f32],
    first: &mut [f32],
    second: &mut [f32],
    gradient: &[G],
    StepSize { rate, second_correction }: StepSize,
) {
    let (beta1, beta2, epsilon) = (BETA1 as f32, BETA2 as f32, EPSILON as f32);
    let (rest1, rest2) = ((1.0 - BETA1) as f32, (1.0 - BETA2) as f32);
    let (rate, correction) = (rate as f32, (1.0 / second_correction) as f32);
    let moments = first.iter_mut().zip(second);
    for ((parameter, &gradient), (first, second)) in parameters.iter_mut().zip(gradient).zip(moments) {
        let gradient = gradient.widened();
        *first = settle(beta1 * *first + rest1 * gradient);
        *second = settle(beta2 * *second + rest2 * gradient * gradient);
        *parameter -= rate * *first / (second.sqrt() * correction + epsilon);
    }
}

/// A moment without its last, meaningless traces.
///
/// The moments of a weight that gets no gradient any more (many do, behind units that are never active) shrink until
/// they are denormal, and stay there for ever, because 0.9 of the least number is rounded up to itself. Arithmetic on such
/// numbers is tens of times slower. Next to ε neither moment below this bound moves a parameter.
#[inline(always)]
fn settle(moment: f32) -> f32 {
    const NEGLIGIBLE: f32 = 1e-32;
    if moment.abs() < NEGLIGIBLE { 0.0 } else { moment }
}

/// The upper half of an f32.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(transparent)]
struct Bf16(u16);

impl Bf16 {
    /// The nearest value, of two equally near ones the even one; what is no number stays none.
    #[inline(always)]
    fn nearest(value: f32) -> Self {
        let bits = value.to_bits();
        let even = bits.wrapping_add(0x7fff + (bits >> 16 & 1));
        Self((if value.is_nan() { bits | 1 << 22 } else { even } >> 16) as u16)
    }
}

/// The gradient of some of the parameters, in the numbers that the network computes with.
#[derive(Clone, Copy)]
enum Gradient<'a> {
    F32(&'a [f32]),
    Bf16(&'a [Bf16]),
}

impl<'a> Gradient<'a> {
    fn of(tensor: &'a Tensor) -> Self {
        match tensor.kind() {
            Kind::BFloat16 => Self::Bf16(values(tensor)),
            _ => Self::F32(values(tensor)),
        }
    }

    fn len(self) -> usize {
        match self {
            Self::F32(values) => values.len(),
            Self::Bf16(values) => values.len(),
        }
    }

    /// At most `count` of them, from `start` on.
    fn part(self, start: usize, count: usize) -> Self {
        let range = start..self.len().min(start + count);
        match self {
            Self::F32(values) => Self::F32(&values[range]),
            Self::Bf16(values) => Self::Bf16(&values[range]),
        }
    }
}

fn split_off_front<'a, T>(values: &mut &'a mut [T], count: usize) -> &'a mut [T] {
    values.split_off_mut(..count).expect("the counts were compared")
}

/// Numbers as libtorch stores them.
trait Element: Copy {
    const KIND: Kind;

    fn widened(self) -> f32;
}

impl Element for f32 {
    const KIND: Kind = Kind::Float;

    #[inline(always)]
    fn widened(self) -> f32 {
        self
    }
}

impl Element for Bf16 {
    const KIND: Kind = Kind::BFloat16;

    #[inline(always)]
    fn widened(self) -> f32 {
        f32::from_bits(u32::from(self.0) << 16)
    }
}

fn values<T: Element>(tensor: &Tensor) -> &[T] {
    assert_readable::<T>(tensor);
    // SAFETY: the storage is on the host, holds numel() contiguous T and lives as long as the borrowed tensor.
    unsafe { slice::from_raw_parts(tensor.data_ptr().cast(), tensor.numel()) }
}

fn values_mut<T: Element>(tensor: &mut Tensor) -> &mut [T] {
    assert_readable::<T>(tensor);
    // SAFETY: as above, and `step` has made sure that no other slice it takes lies over this one; while the slices live, no
    // libtorch call reads or writes these numbers: parts of a step don't overlap, and whoever takes one sees to it that nothing
    // computes with its parameters any more (`Adam::begin`).
    unsafe { slice::from_raw_parts_mut(tensor.data_ptr().cast(), tensor.numel()) }
}

fn assert_readable<T: Element>(tensor: &Tensor) {
    assert!(
        tensor.device() == Device::Cpu && tensor.kind() == T::KIND && tensor.is_contiguous(),
        "Adam's fused step needs contiguous tensors on the CPU, of {:?}",
        T::KIND
    );
}

/// Tensors can be views of each other, which Rust's borrows do not see.
fn assert_disjoint<'a>(written: impl Iterator<Item = &'a Tensor>, read: &[Tensor]) {
    let range = |tensor: &Tensor| {
        let start = tensor.data_ptr() as usize;
        start..start + tensor.numel() * tensor.kind().elt_size_in_bytes()
    };
    let mut ranges: Vec<_> = written.map(|tensor| (range(tensor), true)).collect();
    ranges.extend(read.iter().map(|tensor| (range(tensor), false)));
    ranges.sort_by_key(|(range, _)| range.start);
    for pair in ranges.windows(2) {
        let [(before, a), (after, b)] = pair else { unreachable!("windows of two") };
        assert!(before.end <= after.start || !(*a || *b), "Adam's tensors share memory");
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rounding_is_to_the_nearest_then_the_even_and_keeps_what_is_no_number() {
        for (value, expected) in [
            (1.0, 1.0),
            (1.0 + 1.0 / 256.0, 1.0), // halfway between 1 and 1 + 1/128: the even one
            (1.0 + 3.0 / 256.0, 1.0 + 2.0 / 128.0), // halfway again, now upwards
            (-1.0 - 1.001 / 256.0, -1.0 - 1.0 / 128.0),
            (f32::MAX, f32::INFINITY),
            (f32::NEG_INFINITY, f32::NEG_INFINITY),
            (1e-40, f32::from_bits(0x1_0000)),
        ] {
            assert_eq!(Bf16::nearest(value).widened(), expected, "{value}");
        }
        for bits in [0x7fc0_0000, 0x7f80_0001, 0x7fff_ffff, 0xffff_ffff] {
            assert!(Bf16::nearest(f32::from_bits(bits)).widened().is_nan(), "{bits:x}");
        }
    }
}
