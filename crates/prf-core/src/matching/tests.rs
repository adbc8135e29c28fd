//! Every way and every instruction set of this machine against the definition.

use super::plan::Tiling;
use super::*;

const METHODS: [MatchMethod; 2] = [MatchMethod::CcorrNormed, MatchMethod::CcoeffNormed];

/// Pictures that are hard in different ways: noise, hardly any contrast beside a lot of it, shapes, flat areas.
fn picture(kind: usize, width: usize, height: usize) -> Frame {
    let pixel = |i: usize| {
        let (x, y, noise) = (i % width, i / width, (((i + 1) * 2_654_435_761) >> 11) as u8);
        match kind {
            0 => noise,
            1 => 40 + (noise & 1) + if x < width / 5 { noise & 127 } else { 0 },
            2 => (128.0 + 60.0 * (x as f32 / 5.0).sin() + 60.0 * (y as f32 / 7.0).cos()) as u8,
            _ => [0, 255][usize::from((x / 7 + y / 5).is_multiple_of(4))],
        }
    };
    Frame::from_vec(width, height, (0..width * height).map(pixel).collect()).expect("sides above 0")
}

fn crop(frame: &Frame, [y, x]: [usize; 2], [height, width]: [usize; 2]) -> Frame {
    let rows = (y..y + height).flat_map(|row| frame.row(row)[x..x + width].to_vec());
    Frame::from_vec(width, height, rows.collect()).expect("sides above 0")
}

/// An ellipse with a ring left out.
fn ring([height, width]: [usize; 2]) -> Frame {
    let part = |i: usize, len: usize| (i as f32 + 0.5) / len as f32 * 2.0 - 1.0;
    let radius = |i: usize| part(i % width, width).hypot(part(i / width, height));
    let pixels = (0..width * height).map(|i| 9 * u8::from(radius(i) < 0.1 || (0.4..=1.0).contains(&radius(i))));
    Frame::from_vec(width, height, pixels.collect()).expect("sides above 0")
}

/// A score by its definition, in 64 bits.
fn defined(template: &Frame, mask: Option<&Frame>, method: MatchMethod, window: &Frame) -> f64 {
    let counts: Vec<bool> = (0..template.as_slice().len()).map(|i| mask.is_none_or(|m| m.as_slice()[i] != 0)).collect();
    let values = |frame: &Frame| -> Vec<f64> {
        let counted = frame.as_slice().iter().zip(&counts).filter(|(_, counts)| **counts);
        let values: Vec<f64> = counted.map(|(&v, _)| f64::from(v)).collect();
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        values.iter().map(|v| if method == MatchMethod::CcoeffNormed { v - mean } else { *v }).collect()
    };
    let (t, i) = (values(template), values(window));
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let scale = (dot(&t, &t) * dot(&i, &i)).sqrt();
    if scale < 1e-9 { 0.0 } else { dot(&t, &i) / scale }
}

fn matcher(template: &Template, plan: Plan, simd: Simd, frame: &Frame) -> TemplateMatcher {
    let shape = [frame.height(), frame.width()];
    let prepared = Some(Prepared::planned(plan, simd, template, shape));
    TemplateMatcher { simd, template: template.clone(), prepared }
}

/// The ways that a template of this shape may go.
fn plans(template: [usize; 2], frame: [usize; 2]) -> Vec<Plan> {
    let direct = (template[0] * template[1] <= direct::MAX_PIXELS).then_some(Plan::Direct);
    // One tile for all, the cheapest tiling, and many small tiles, of which the last pair may lack one.
    let shapes = [frame.map(|side| side.next_multiple_of(16)), template.map(|side| (side + 8).next_multiple_of(16))];
    let regular = |shape: &[usize; 2]| shape.iter().all(|&side| fft::radices(side).is_some());
    let tilings = shapes.into_iter().filter(regular).map(|shape| Tiling::of(template, frame, shape));
    direct.into_iter().chain(tilings.chain([Tiling::new(template, frame)]).map(Plan::Spectral)).collect()
}

fn compare(frame: &Frame, template: &Frame, mask: Option<&Frame>, method: MatchMethod) {
    let (shape, size) = ([frame.height(), frame.width()], [template.height(), template.width()]);
    let [rows, columns] = plan::windows(size, shape);
    let windows = (0..rows * columns).map(|i| crop(frame, [i / columns, i % columns], size));
    let expected: Vec<f64> = windows.map(|window| defined(template, mask, method, &window)).collect();
    let prepared = Template::new(template, mask, method).expect("a mask that fits");
    let mut found = Vec::new();
    for plan in plans(size, shape) {
        let mut maps = Vec::new();
        for simd in Simd::available() {
            let mut matcher = matcher(&prepared, plan, simd, frame);
            let mut map = Plane::from_vec(1, 1, vec![0.0]).expect("one pixel");
            matcher.scores_into(frame.view(), &mut map).expect("it fits");
            assert_eq!([map.height(), map.width()], [rows, columns]);
            for (at, (got, expected)) in map.as_slice().iter().zip(&expected).enumerate() {
                let off = (f64::from(*got) - expected).abs();
                assert!(off < 4.1e-5, "{got} for {expected} at {at}, {simd:?}, {plan:?}, {method:?}");
            }
            found.push(matcher.best(frame.view()).expect("it fits"));
            maps.push(map);
        }
        assert!(maps.iter().all(|other| *other == maps[0]), "instructions change bits, {plan:?}");
    }
    // The same by every way, to the bit, and no window is better.
    assert!(found.iter().all(|other| *other == found[0]), "{found:?}");
    let score = expected[found[0].rect.y * columns + found[0].rect.x];
    assert!(expected.iter().all(|other| *other < score + 1e-9), "{:?}", found[0]);
    assert!((f64::from(found[0].score) - score).abs() < 1e-6, "{score}: {:?}", found[0]);
}

#[test]
fn every_way_gives_the_scores_of_the_definition() {
    for kind in 0..4 {
        let frame = picture(kind, 61, 47);
        for size in [[1, 1], [1, 9], [5, 1], [6, 7], [15, 17], [20, 33], [47, 61]] {
            let template = crop(&frame, [(47 - size[0]) / 2, (61 - size[1]) / 3], size);
            for method in METHODS {
                compare(&frame, &template, None, method);
                compare(&frame, &template, Some(&ring(size)), method);
            }
        }
    }
}

#[test]
fn a_template_from_elsewhere_is_compared_as_well() {
    for (kind, other) in [(0, 2), (2, 0), (1, 0), (3, 2)] {
        let (frame, template) = (picture(kind, 50, 40), picture(other, 13, 16));
        METHODS.into_iter().for_each(|method| compare(&frame, &template, None, method));
    }
}

/// The bound is a promise that the map and the best match rely on; no proof, so it is kept far from what happens.
#[test]
fn transforms_stay_far_below_their_error_bound() {
    for kind in 0..4 {
        for (size, shape) in [([12, 40], [90, 130]), ([50, 30], [100, 240]), ([9, 9], [200, 300])] {
            let frame = picture(kind, shape[1], shape[0]);
            for other in 0..4 {
                let template = Template::new(&picture(other, size[1], size[0]), None, METHODS[0]).expect("no mask");
                let [rows, columns] = plan::windows(size, shape);
                let mut map = vec![0.0; rows * columns];
                let mut spectral = Spectral::new(Tiling::new(size, shape), &template, Simd::detect());
                let run = spectral::Correlate {
                    spectral: &mut spectral,
                    frame: frame.view(),
                    centre: 100.0,
                    windows: columns,
                    map: &mut map,
                };
                let bound = Simd::detect().run(run);
                for (at, got) in map.iter().enumerate().step_by(97) {
                    let window = crop(&frame, [at / columns, at % columns], size);
                    let pixels = window.as_slice().iter().map(|&v| f64::from(v) - 100.0);
                    let expected: f64 = pixels.zip(template.kernel()).map(|(v, &t)| v * f64::from(t)).sum();
                    let off = (f64::from(*got) - expected).abs();
                    assert!(off * 4.0 < bound, "off by {off}, bound {bound}, {kind}, {other}, {size:?}");
                }
            }
        }
    }
}
