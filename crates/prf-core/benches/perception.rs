//! How long one perception takes. `cargo bench -p prf-core`

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use prf_core::{
    CellSize, DirectDescriptor, EmaState, Frame, Hog, HogParams, Norm, RewardParams, TaskDescriptor, crop_box,
};

/// A picture with a gradient at every pixel: the slowest kind.
fn texture(width: usize, height: usize) -> Frame {
    let pixel = |i: usize| {
        let (x, y) = ((i % width) as f32, (i / width) as f32);
        (127.0 + 60.0 * (x / 5.0).sin() * (y / 7.0).cos() + ((i * 2_654_435_761) >> 9 & 31) as f32) as u8
    };
    Frame::from_vec(width, height, (0..width * height).map(pixel).collect()).expect("sides above 0")
}

/// Six rows of ten bricks, a ball and a paddle on black.
fn breakout() -> Frame {
    let mut frame = Frame::new(84, 84);
    let mut fill = |x: usize, y: usize, width: usize, height: usize, value: u8| {
        (y..y + height).for_each(|y| frame.row_mut(y)[x..x + width].fill(value));
    };
    for brick in 0..60 {
        fill(2 + brick % 10 * 8, 10 + brick / 10 * 4, 7, 3, 120 + (brick / 10 * 20) as u8);
    }
    fill(40, 50, 2, 2, 255);
    fill(30, 78, 14, 2, 200);
    frame
}

fn hog(c: &mut Criterion) {
    let mut features = Vec::new();
    for (width, height) in [(64, 64), (160, 208), (512, 288)] {
        let params = HogParams { cell: CellSize::Px(8), block_cells: 2, norm: Norm::L2Hys, ..HogParams::default() };
        let mut hog = Hog::new(params).expect("valid parameters");
        let image = texture(width, height);
        c.bench_function(&format!("hog {width}x{height}, 9 bins, 8 px, 2x2"), |b| {
            b.iter(|| hog.compute_bytes_into(black_box(image.view()), &mut features));
        });
    }
}

fn reward(c: &mut Criterion) {
    let black = Frame::new(84, 84);
    for (name, goal, frame) in [
        ("breakout, black goal", &black, &breakout()),
        ("texture, goal of another size", &texture(60, 70), &texture(84, 84)),
        ("texture, black goal", &black, &texture(84, 84)),
    ] {
        let mut descriptor = DirectDescriptor::new(goal, RewardParams::default()).expect("valid parameters");
        c.bench_function(&format!("reward 84x84, {name}"), |b| {
            b.iter(|| descriptor.observe(black_box(frame.view())));
        });
    }
}

fn parts(c: &mut Criterion) {
    let frame = breakout();
    c.bench_function("crop 84x84", |b| b.iter(|| crop_box(black_box(frame.view()))));
    let mut state = EmaState::new(84, 84, 0.7).expect("valid parameters");
    c.bench_function("ema 84x84", |b| b.iter(|| state.update(black_box(frame.view()))[0]));
}

criterion_group!(benches, hog, reward, parts);
criterion_main!(benches);
