//! How long one perception takes. `cargo bench -p prf-core`

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use prf_core::{
    CellSize, DeltaSchedule, DescriptorParams, DirectDescriptor, EmaState, Frame, Hog, HogParams, MotionParams, Norm,
    Resizer, RewardParams, TaskDescriptor, WindowParams, crop_box,
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
    for (width, height) in [(64, 64), (160, 208), (512, 288), (640, 480)] {
        let params = HogParams { cell: CellSize::Px(8), block_cells: 2, norm: Norm::L2Hys, ..HogParams::default() };
        let mut hog = Hog::new(params).expect("valid parameters");
        let image = texture(width, height);
        c.bench_function(&format!("hog {width}x{height}, 9 bins, 8 px, 2x2"), |b| {
            b.iter(|| hog.compute_bytes_into(black_box(image.view()), &mut features));
        });
    }
}

fn small_cells(c: &mut Criterion) {
    let (image, mut features) = (texture(160, 210), Vec::new());
    for cell_px in [1, 2, 3, 5] {
        let params = HogParams { cell: CellSize::Px(cell_px), ..HogParams::default() };
        let mut hog = Hog::new(params).expect("valid parameters");
        c.bench_function(&format!("hog 160x210, 9 bins, {cell_px} px, 1x1"), |b| {
            b.iter(|| hog.compute_bytes_into(black_box(image.view()), &mut features));
        });
    }
}

/// A part of a frame.
fn crop(frame: &Frame, x: usize, y: usize, width: usize, height: usize) -> Frame {
    let rows = (y..y + height).flat_map(|row| frame.row(row)[x..x + width].to_vec());
    Frame::from_vec(width, height, rows.collect()).expect("sides above 0")
}

/// A picture with a black border of a twelfth of its width, and the same with other pixels inside.
fn framed(picture: &Frame) -> [Frame; 2] {
    let (width, height) = (picture.width(), picture.height());
    let border = width / 12;
    [0, 1].map(|turn| {
        let mut frame = Frame::new(width, height);
        for y in border..height - border {
            let row = &picture.row((y * (1 + 4 * turn)) % height)[border..width - border];
            frame.row_mut(y)[border..width - border].copy_from_slice(row);
        }
        frame
    })
}

/// Whole rewards, each with the cell that its kind has by default. All but the windows are rescaled.
fn descriptors(c: &mut Criterion) {
    for ([height, width], [h, w]) in [([84, 84], [28, 28]), ([210, 160], [64, 64]), ([288, 512], [52, 100])] {
        let picture = texture(width, height);
        let frames = framed(&picture);
        let part = crop(&picture, width / 4, height / 3, w, h);
        let motion = MotionParams { delta: DeltaSchedule::Duration(0.4), ..MotionParams::default() };
        for (name, kind, goal, frames, cell) in [
            ("direct", DescriptorParams::Direct, &Frame::new(width, height), &frames[..], 0.03),
            ("window", DescriptorParams::Window(WindowParams::default()), &part, std::slice::from_ref(&picture), 0.1),
            ("motion", DescriptorParams::Motion(motion), &picture, &frames, 0.05),
        ] {
            let mut params = RewardParams::default();
            params.hog.cell = CellSize::Fraction(cell);
            let mut descriptor = kind.describe(&goal.clone().into(), params).expect("valid parameters");
            let mut turns = frames.iter().cycle();
            let mut step = || turns.next().map(|frame| descriptor.observe(black_box(frame.view())));
            c.bench_function(&format!("reward {width}x{height}, {name}"), |b| b.iter(&mut step));
        }
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
    let (picture, mut resizer) = (crop(&texture(84, 84), 7, 7, 70, 70), Resizer::default());
    c.bench_function("resize 70x70 to 84x84", |b| {
        b.iter(|| resizer.resize(black_box(picture.view()), 84, 84).map(|plane| plane.as_slice()[0]));
    });
    c.bench_function("crop 84x84", |b| b.iter(|| crop_box(black_box(frame.view()))));
    let mut state = EmaState::new(84, 84, 0.7).expect("valid parameters");
    c.bench_function("ema 84x84", |b| b.iter(|| state.update(black_box(frame.view()))[0]));
}

criterion_group!(benches, hog, small_cells, reward, descriptors, parts);
criterion_main!(benches);
