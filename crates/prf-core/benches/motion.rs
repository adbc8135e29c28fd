//! How long one frame of a motion template takes. `cargo bench -p prf-core --bench motion`

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use prf_core::{DeltaSchedule, Frame, MotionParams, MotionTemplate};

/// Two frames that differ nearly everywhere, so that they can take turns for ever.
fn noise(width: usize, height: usize) -> [Frame; 2] {
    [2_654_435_761, 2_246_822_519].map(|prime: usize| {
        let pixels = (0..width * height).map(|i| (i.wrapping_mul(prime) >> 13) as u8).collect();
        Frame::from_vec(width, height, pixels).expect("sides above 0")
    })
}

fn motion(c: &mut Criterion) {
    for (width, height) in [(84, 84), (512, 288)] {
        let params = MotionParams { delta: DeltaSchedule::Duration(0.4), ..MotionParams::default() };
        let mut template = MotionTemplate::new(params).expect("valid parameters");
        let frames = noise(width, height);
        let mut turns = frames.iter().cycle();
        let mut step = || turns.next().map(|frame| template.observe(black_box(frame.view())));
        c.bench_function(&format!("motion step {width}x{height}"), |b| b.iter(&mut step));

        let mut picture = Frame::new(width, height);
        c.bench_function(&format!("motion history image {width}x{height}"), |b| {
            b.iter(|| black_box(&template).history_into(&mut picture));
        });
    }
}

criterion_group!(benches, motion);
criterion_main!(benches);
