//! How long it takes to score every window of a frame. `cargo bench -p prf-core --bench matching`

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use prf_core::{Frame, MatchMethod, Plane, TemplateMatcher};

/// Waves and noise.
fn texture(width: usize, height: usize) -> Frame {
    let pixel = |i: usize| {
        let (x, y) = ((i % width) as f32, (i / width) as f32);
        (127.0 + 60.0 * (x / 5.0).sin() * (y / 7.0).cos() + ((i * 2_654_435_761) >> 9 & 31) as f32) as u8
    };
    Frame::from_vec(width, height, (0..width * height).map(pixel).collect()).expect("sides above 0")
}

/// A part of a frame.
fn crop(frame: &Frame, x: usize, y: usize, width: usize, height: usize) -> Frame {
    let rows = (y..y + height).flat_map(|row| frame.row(row)[x..x + width].to_vec());
    Frame::from_vec(width, height, rows.collect()).expect("sides above 0")
}

fn matching(c: &mut Criterion) {
    let mut map = Plane::from_vec(1, 1, vec![0.0]).expect("one pixel");
    for ([height, width], [h, w]) in
        [([84, 84], [28, 28]), ([160, 210], [64, 64]), ([288, 512], [52, 100]), ([480, 640], [160, 200])]
    {
        let frame = texture(width, height);
        let template = crop(&frame, width / 4, height / 3, w, h);
        for (name, method) in [("plain", MatchMethod::CcorrNormed), ("zero-mean", MatchMethod::CcoeffNormed)] {
            let mut matcher = TemplateMatcher::new(&template, None, method).expect("no mask");
            let title = format!("match {width}x{height} with {w}x{h}, {name}");
            c.bench_function(&format!("{title}, scores"), |b| {
                b.iter(|| matcher.scores_into(black_box(frame.view()), &mut map));
            });
            c.bench_function(&format!("{title}, best"), |b| b.iter(|| matcher.best(black_box(frame.view()))));
        }
    }
}

criterion_group!(benches, matching);
criterion_main!(benches);
