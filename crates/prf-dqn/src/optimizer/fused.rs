//! Adam's step on the CPU in one pass over memory.
//!
//! Written as tensor operations a step reads and writes the 1.7 million parameters seven times and takes longer than the
//! backward pass; here each number is touched once. libtorch offers no safe slice of a tensor's storage, hence the
//! `unsafe` blocks: they turn contiguous f32 CPU tensors, checked just before, into slices.
#![expect(unsafe_code, reason = "a slice of a tensor's storage exists only behind a pointer")]

use std::slice;

use tch::{Device, Kind, Tensor};

use super::{BETA1, BETA2, EPSILON, StepSize};
use crate::error::Result;

/// Parameters below which a second thread costs more than it saves.
const LEAST_PER_THREAD: usize = 100_000;

pub(super) fn step(
    parameters: &mut Tensor,
    first: &mut Tensor,
    second: &mut Tensor,
    gradients: &[Tensor],
    size: StepSize,
) -> Result<()> {
    let gradients: Vec<Tensor> = gradients.iter().map(Tensor::f_contiguous).collect::<Result<_, _>>()?;
    let count: usize = gradients.iter().map(Tensor::numel).sum();
    assert_eq!(parameters.numel(), count, "gradients and parameters differ in number");
    assert_eq!(first.numel(), count, "moments and parameters differ in number");
    assert_eq!(second.numel(), count, "moments and parameters differ in number");
    if count == 0 {
        return Ok(());
    }
    assert_disjoint(&[parameters, first, second], &gradients);

    let (mut parameters, mut first, mut second) = (values_mut(parameters), values_mut(first), values_mut(second));
    let threads = tch::get_num_threads().max(1) as usize;
    let share = count.div_ceil(threads).max(LEAST_PER_THREAD);
    std::thread::scope(|scope| {
        for gradient in gradients.iter().map(values) {
            for gradient in gradient.chunks(share) {
                let piece = Piece {
                    parameters: split_off_front(&mut parameters, gradient.len()),
                    first: split_off_front(&mut first, gradient.len()),
                    second: split_off_front(&mut second, gradient.len()),
                    gradient,
                };
                // Whole shares go to threads of their own, what is left over stays on this one. Pieces never
                // interact, so the threads cannot change the result.
                if threads > 1 && gradient.len() == share {
                    scope.spawn(move || piece.step(size));
                } else {
                    piece.step(size);
                }
            }
        }
    });
    Ok(())
}

struct Piece<'a> {
    parameters: &'a mut [f32],
    first: &'a mut [f32],
    second: &'a mut [f32],
    gradient: &'a [f32],
}

impl Piece<'_> {
    fn step(self, size: StepSize) {
        let (beta1, beta2, epsilon) = (BETA1 as f32, BETA2 as f32, EPSILON as f32);
        let (rest1, rest2) = ((1.0 - BETA1) as f32, (1.0 - BETA2) as f32);
        let (rate, correction) = (size.rate as f32, (1.0 / size.second_correction) as f32);
        let moments = self.first.iter_mut().zip(self.second);
        for ((parameter, &gradient), (first, second)) in self.parameters.iter_mut().zip(self.gradient).zip(moments) {
            *first = settle(beta1 * *first + rest1 * gradient);
            *second = settle(beta2 * *second + rest2 * gradient * gradient);
            *parameter -= rate * *first / (second.sqrt() * correction + epsilon);
        }
    }
}

/// A moment without its last, meaningless traces.
///
/// The moments of a weight that gets no gradient any more (many do, behind units that are never active) shrink until
/// they are denormal, and stay there for ever, because 0.9 of the least number is rounded up to itself. Arithmetic on such
/// numbers is tens of times slower. Next to ε neither moment below this bound moves a parameter.
fn settle(moment: f32) -> f32 {
    const NEGLIGIBLE: f32 = 1e-32;
    if moment.abs() < NEGLIGIBLE { 0.0 } else { moment }
}

fn split_off_front<'a>(values: &mut &'a mut [f32], count: usize) -> &'a mut [f32] {
    values.split_off_mut(..count).expect("the counts were compared")
}

fn values(tensor: &Tensor) -> &[f32] {
    assert_host_f32(tensor);
    // SAFETY: the storage is on the host, holds numel() contiguous f32 and lives as long as the borrowed tensor.
    unsafe { slice::from_raw_parts(tensor.data_ptr().cast(), tensor.numel()) }
}

fn values_mut(tensor: &mut Tensor) -> &mut [f32] {
    assert_host_f32(tensor);
    // SAFETY: as above, and `step` has made sure that no other slice it takes lies over this one; no libtorch call runs
    // while the slices live.
    unsafe { slice::from_raw_parts_mut(tensor.data_ptr().cast(), tensor.numel()) }
}

fn assert_host_f32(tensor: &Tensor) {
    assert!(
        tensor.device() == Device::Cpu && tensor.kind() == Kind::Float && tensor.is_contiguous(),
        "Adam's fused step needs contiguous f32 tensors on the CPU"
    );
}

/// Tensors can be views of each other, which Rust's borrows do not see.
fn assert_disjoint(written: &[&mut Tensor], read: &[Tensor]) {
    let range = |tensor: &Tensor| {
        let start = tensor.data_ptr() as usize;
        start..start + tensor.numel() * size_of::<f32>()
    };
    let mut ranges: Vec<_> = written.iter().map(|tensor| (range(tensor), true)).collect();
    ranges.extend(read.iter().map(|tensor| (range(tensor), false)));
    ranges.sort_by_key(|(range, _)| range.start);
    for pair in ranges.windows(2) {
        let [(before, a), (after, b)] = pair else { unreachable!("windows of two") };
        assert!(before.end <= after.start || !(*a || *b), "Adam's tensors share memory");
    }
}
