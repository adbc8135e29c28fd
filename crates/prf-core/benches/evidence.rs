//! How long it takes to judge about a hundred settings by a thousand frames, on all cores. `cargo bench -p prf-core --bench evidence`

use std::hint::black_box;
use std::num::NonZero;
use std::thread;

use criterion::{Criterion, criterion_group, criterion_main};
use prf_core::{DescriptorParams, Footage, Frame, Goal, Label, RewardParams, WindowParams, settings};

/// Six rows of ten bricks, of which the first `gone` are gone, a ball and a paddle.
fn breakout(gone: usize, step: usize) -> Frame {
    let mut frame = Frame::new(84, 84);
    let mut fill = |x: usize, y: usize, width: usize, height: usize, value: u8| {
        (y..y + height).for_each(|y| frame.row_mut(y)[x..x + width].fill(value));
    };
    for brick in gone..60 {
        fill(2 + brick % 10 * 8, 10 + brick / 10 * 4, 7, 3, 120 + (brick / 10 * 20) as u8);
    }
    fill(step * 7 % 82, 36 + step * 3 % 40, 2, 2, 255);
    fill(step * 5 % 70, 78, 14, 2, 200);
    frame
}

fn sweep(c: &mut Criterion) {
    let mut footage = Footage::new(None, 1000).expect("above 0");
    for step in 0..1000 {
        let gone = step * 60 / 1000;
        let label = Label { score: Some(gone as f64), success: None };
        footage.observe(breakout(gone, step).view(), label).expect("one size");
    }
    let threads = thread::available_parallelism().unwrap_or(NonZero::<usize>::MIN);
    let mut ball = Frame::new(20, 32);
    (14..16).for_each(|y| ball.row_mut(y)[9..11].fill(255));
    ball.row_mut(28)[3..17].fill(200);
    for (name, descriptor, goal) in [
        ("direct, black goal", DescriptorParams::Direct, Frame::new(84, 84)),
        ("window of 20x32", DescriptorParams::Window(WindowParams::default()), ball),
    ] {
        let goal = Goal::from(goal);
        let settings = settings(&goal, RewardParams::default());
        let title = format!("{} settings, 1000 frames of 84x84, {threads} threads: {name}", settings.len());
        c.bench_function(&title, |b| {
            b.iter(|| {
                let evidence = footage.scored(&descriptor, black_box(&goal)).expect("scores differ");
                evidence.sweep(&settings, threads)
            });
        });
    }
}

criterion_group! {
    name = benches;
    config = Criterion::default().sample_size(10);
    targets = sweep
}
criterion_main!(benches);
