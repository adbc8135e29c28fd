//! Template matching by hand, and what must hold for any frame and template.
#![expect(clippy::unwrap_used, reason = "a test may stop at the first surprise")]

use prf_core::{Error, Frame, Match, MatchMethod, Plane, Rect, TemplateMatcher};
use proptest::prelude::*;

mod shapes;

use MatchMethod::{CcoeffNormed, CcorrNormed};
use shapes::any_shape;

fn frame(width: usize, pixels: &[u8]) -> Frame {
    Frame::from_vec(width, pixels.len() / width, pixels.to_vec()).unwrap()
}

fn flat(width: usize, height: usize, value: u8) -> Frame {
    Frame::from_vec(width, height, vec![value; width * height]).unwrap()
}

fn crop(frame: &Frame, rect: Rect) -> Frame {
    let rows = (rect.y..rect.y + rect.height).flat_map(|y| frame.row(y)[rect.x..rect.x + rect.width].to_vec());
    Frame::from_vec(rect.width, rect.height, rows.collect()).unwrap()
}

fn scores(matcher: &mut TemplateMatcher, frame: &Frame) -> Plane {
    let mut map = Plane::from_vec(1, 1, vec![0.0]).unwrap();
    matcher.scores_into(frame.view(), &mut map).unwrap();
    map
}

fn map(template: &Frame, mask: Option<&Frame>, method: MatchMethod, frame: &Frame) -> Vec<f32> {
    scores(&mut TemplateMatcher::new(template, mask, method).unwrap(), frame).as_slice().to_vec()
}

fn best(template: &Frame, method: MatchMethod, frame: &Frame) -> Match {
    TemplateMatcher::new(template, None, method).unwrap().best(frame.view()).unwrap()
}

fn assert_close(got: &[f32], expected: &[f32]) {
    assert_eq!(got.len(), expected.len());
    assert!(got.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-6), "{got:?} for {expected:?}");
}

#[rustfmt::skip]
const THREE: [u8; 9] = [
    1, 2, 0,
    3, 4, 0,
    0, 0, 5,
];

#[test]
fn plain_scores_by_hand() {
    // Products of 1 2 3 4 with the windows: 30, 14, 11, 24. Squares: 30 for it, and 30, 20, 25, 41 for them.
    let template = frame(2, &[1, 2, 3, 4]);
    let expected = [1.0, 14.0 / 600f32.sqrt(), 11.0 / 750f32.sqrt(), 24.0 / 1230f32.sqrt()];
    assert_close(&map(&template, None, CcorrNormed, &frame(3, &THREE)), &expected);
}

#[test]
fn zero_mean_scores_by_hand() {
    // Four times the products without means, 4 Σ I T − 10 Σ I: 20, −4, −26, 6. Squares: 20, and 20, 44, 51, 83.
    let template = frame(2, &[1, 2, 3, 4]);
    let expected = [1.0, -4.0 / 880f32.sqrt(), -26.0 / 1020f32.sqrt(), 6.0 / 1660f32.sqrt()];
    assert_close(&map(&template, None, CcoeffNormed, &frame(3, &THREE)), &expected);
}

#[test]
fn only_what_is_under_the_mask_counts() {
    // 1 and 4 against 1 4, 2 0, 3 0 and 4 5.
    let (template, mask) = (frame(2, &[1, 99, 99, 4]), frame(2, &[255, 0, 0, 1]));
    let expected = [1.0, 2.0 / 68f32.sqrt(), 3.0 / 153f32.sqrt(), 24.0 / 697f32.sqrt()];
    assert_close(&map(&template, Some(&mask), CcorrNormed, &frame(3, &THREE)), &expected);
    // Of two pixels only the order is left.
    assert_close(&map(&template, Some(&mask), CcoeffNormed, &frame(3, &THREE)), &[1.0, -1.0, -1.0, 1.0]);
}

#[test]
fn flat_windows_and_flat_templates_score_0() {
    let dot = |width: usize, height: usize, value: u8| {
        let mut frame = flat(width, height, 80);
        frame.row_mut(height / 2)[width / 2] = value;
        frame
    };
    for (size, side) in [(3, 12), (20, 50), (300, 301)] {
        let (template, other) = (dot(size, size, 81), dot(side, side, 255));
        assert!(map(&template, None, CcoeffNormed, &flat(side, side, 200)).iter().all(|&score| score == 0.0));
        assert!(map(&template, None, CcorrNormed, &flat(side, side, 0)).iter().all(|&score| score == 0.0));
        assert!(map(&flat(size, size, 200), None, CcoeffNormed, &other).iter().all(|&score| score == 0.0));
        assert!(map(&flat(size, size, 0), None, CcorrNormed, &other).iter().all(|&score| score == 0.0));
        let found = best(&template, CcoeffNormed, &flat(side, side, 200));
        assert_eq!(found, Match { rect: Rect { x: 0, y: 0, width: size, height: size }, score: 0.0 });
        // One grey level of one pixel is enough not to be flat.
        assert_eq!(best(&template, CcoeffNormed, &dot(side, side, 81)).score, 1.0);
    }
}

#[test]
fn the_first_of_equal_matches_wins() {
    for (template_side, period) in [(4, 6), (24, 30)] {
        let pixel = |i: usize, width: usize| (((i % width % period) * 37 + (i / width % period) * 91) % 251) as u8;
        let tiles = |side: usize| frame(side, &(0..side * side).map(|i| pixel(i, side)).collect::<Vec<_>>());
        let large = tiles(4 * period);
        let rect = Rect { x: 2 * period + 3, y: period + 2, width: template_side, height: template_side };
        for method in [CcorrNormed, CcoeffNormed] {
            let found = best(&crop(&large, rect), method, &large);
            assert_eq!(found, Match { rect: Rect { x: 3, y: 2, ..rect }, score: 1.0 });
        }
    }
}

#[test]
fn a_template_that_does_not_fit_is_refused_with_both_sizes() {
    let mut matcher = TemplateMatcher::new(&flat(7, 3, 1), None, CcorrNormed).unwrap();
    for shape in [[2, 100], [100, 6], [0, 0]] {
        let error = matcher.prepare(shape).unwrap_err();
        assert!(matches!(error, Error::TemplateTooLarge { template: [3, 7], frame } if frame == shape), "{error}");
    }
    let error = matcher.best(flat(6, 9, 0).view()).unwrap_err().to_string();
    assert!(error.starts_with("a template of 7x3 px doesn't fit into a frame of 6x9 px"), "{error}");
    matcher.prepare([3, 7]).unwrap();
    assert!(matcher.best(flat(7, 3, 9).view()).is_ok());
}

#[test]
fn a_mask_must_fit_and_hold_something() {
    let template = flat(4, 3, 9);
    let refused = |mask: &Frame| TemplateMatcher::new(&template, Some(mask), CcorrNormed).unwrap_err().to_string();
    assert!(refused(&flat(3, 4, 1)).starts_with("mask: got 3x4 px, expected 4x3 px"));
    assert!(refused(&flat(4, 3, 0)).starts_with("mask: got only zeros"));
}

#[test]
fn methods_are_written_as_words() {
    for (method, word) in [(CcorrNormed, r#""ccorr-normed""#), (CcoeffNormed, r#""ccoeff-normed""#)] {
        assert_eq!(serde_json::to_string(&method).unwrap(), word);
        assert_eq!(serde_json::from_str::<MatchMethod>(word).unwrap(), method);
    }
    assert_eq!(MatchMethod::default(), CcorrNormed);
}

fn method() -> impl Strategy<Value = MatchMethod> {
    prop::sample::select(vec![CcorrNormed, CcoeffNormed])
}

/// Bytes with many equal neighbours, as worlds draw them, or noise.
fn picture(sides: std::ops::Range<usize>) -> impl Strategy<Value = Frame> {
    let pixel = || prop_oneof![3 => Just(0u8), 1 => Just(200), 1 => Just(255), 2 => any::<u8>()];
    (sides.clone(), sides).prop_flat_map(move |(width, height)| {
        prop::collection::vec(pixel(), width * height)
            .prop_map(move |pixels| Frame::from_vec(width, height, pixels).unwrap())
    })
}

/// A frame and a part of it.
fn frame_and_part() -> impl Strategy<Value = (Frame, Rect)> {
    let part = |frame: Frame| {
        let (width, height) = (frame.width(), frame.height());
        let sizes = (Just(frame), 1..=width, 1..=height);
        sizes.prop_flat_map(move |(frame, w, h)| {
            (Just(frame), 0..=width - w, 0..=height - h)
                .prop_map(move |(frame, x, y)| (frame, Rect { x, y, width: w, height: h }))
        })
    };
    picture(1..48).prop_flat_map(part)
}

proptest! {
    #[test]
    fn scores_stay_within_their_bounds(template in any_shape(24), frame in picture(24..60), method in method()) {
        let least = if method == CcorrNormed { 0.0 } else { -1.0 };
        let mut matcher = TemplateMatcher::new(&template, None, method).unwrap();
        let map = scores(&mut matcher, &frame);
        prop_assert!(map.as_slice().iter().all(|score| (least..=1.0).contains(score)));
        let found = matcher.best(frame.view()).unwrap();
        prop_assert!((least..=1.0).contains(&found.score));
        let most = map.as_slice().iter().fold(-1f32, |a, &b| a.max(b));
        prop_assert!((most - found.score).abs() < 5e-5, "{most} in the map, {found:?}");
        let there = map.as_slice()[found.rect.y * map.width() + found.rect.x];
        prop_assert!((there - found.score).abs() < 5e-5, "{there} in the map, {found:?}");
    }

    #[test]
    fn a_part_of_the_frame_is_found((frame, rect) in frame_and_part(), method in method()) {
        let template = crop(&frame, rect);
        let found = best(&template, method, &frame);
        let flat = template.as_slice().iter().all(|&v| v == template.as_slice()[0]);
        let scoreless = if method == CcorrNormed { template.as_slice().iter().all(|&v| v == 0) } else { flat };
        prop_assert_eq!(found.score, if scoreless { 0.0 } else { 1.0 });
        prop_assert!((found.rect.y, found.rect.x) <= (rect.y, rect.x), "{found:?} behind {rect:?}");
    }

    #[test]
    fn brightness_and_contrast_do_not_count_without_means(
        template in any_shape(20), pixels in prop::collection::vec(0u8..80, 900), gain in 1u8..4, offset in 0u8..16,
    ) {
        let dark = frame(30, &pixels);
        let bright = frame(30, &pixels.iter().map(|v| v * gain + offset).collect::<Vec<_>>());
        let mut matcher = TemplateMatcher::new(&template, None, CcoeffNormed).unwrap();
        let (a, b) = (scores(&mut matcher, &dark), scores(&mut matcher, &bright));
        for (a, b) in a.as_slice().iter().zip(b.as_slice()) {
            prop_assert!((a - b).abs() < 1e-4, "{a} and {b}");
        }
    }

    #[test]
    fn a_templates_brightness_and_contrast_do_not_count_without_means(
        dark in any_shape(20), frame in picture(20..40), gain in 1u8..4, offset in 0u8..16,
    ) {
        let pixels = |change: &dyn Fn(u8) -> u8| dark.as_slice().iter().map(|v| change(v % 80)).collect::<Vec<_>>();
        let bright = self::frame(dark.width(), &pixels(&|v| v * gain + offset));
        let dark = self::frame(dark.width(), &pixels(&|v| v));
        let (a, b) = (map(&dark, None, CcoeffNormed, &frame), map(&bright, None, CcoeffNormed, &frame));
        for (a, b) in a.iter().zip(&b) {
            prop_assert!((a - b).abs() < 1e-4, "{a} and {b}");
        }
    }

    /// Also of templates with several best windows, as the first of them moves along.
    #[test]
    fn a_translated_template_moves_the_match_by_as_much(
        template in any_shape(12), from in (12usize..37, 12usize..37), to in (12usize..37, 12usize..37),
        method in method(),
    ) {
        let found = |(x, y): (usize, usize)| {
            let mut frame = Frame::new(60, 60);
            for row in 0..template.height() {
                frame.row_mut(y + row)[x..x + template.width()].copy_from_slice(template.row(row));
            }
            best(&template, method, &frame)
        };
        let (a, b) = (found(from), found(to));
        prop_assert_eq!(a.score, b.score);
        if a.score == 0.0 {
            prop_assert_eq!((a.rect.x, a.rect.y, b.rect.x, b.rect.y), (0, 0, 0, 0));
        } else {
            prop_assert_eq!(a.score, 1.0);
            prop_assert_eq!((b.rect.x + from.0, b.rect.y + from.1), (a.rect.x + to.0, a.rect.y + to.1));
        }
    }

    #[test]
    fn a_shifted_picture_shifts_its_scores(
        inner in picture(20..40), template in picture(1..18), x in 0usize..20, y in 0usize..20, method in method(),
    ) {
        let mut outer = Frame::new(60, 60);
        for row in 0..inner.height() {
            outer.row_mut(y + row)[x..x + inner.width()].copy_from_slice(inner.row(row));
        }
        let mut matcher = TemplateMatcher::new(&template, None, method).unwrap();
        let (inner, outer) = (scores(&mut matcher, &inner), scores(&mut matcher, &outer));
        for row in 0..inner.height() {
            let shifted = &outer.as_slice()[(y + row) * outer.width() + x..][..inner.width()];
            for (a, b) in inner.as_slice()[row * inner.width()..].iter().zip(shifted) {
                prop_assert!((a - b).abs() < 1e-4, "{a} and {b}");
            }
        }
    }

    #[test]
    fn a_full_mask_is_no_mask(template in picture(1..20), frame in picture(20..40), method in method()) {
        let full = flat(template.width(), template.height(), 3);
        prop_assert_eq!(map(&template, Some(&full), method, &frame), map(&template, None, method, &frame));
    }

    #[test]
    fn a_score_does_not_depend_on_what_was_matched_before(
        template in picture(1..12), frames in prop::collection::vec(picture(12..40), 1..6), method in method(),
    ) {
        let mut kept = TemplateMatcher::new(&template, None, method).unwrap();
        for frame in frames.iter().chain(frames.iter().rev()) {
            prop_assert_eq!(kept.best(frame.view()).unwrap(), best(&template, method, frame));
            prop_assert_eq!(scores(&mut kept, frame).as_slice().to_vec(), map(&template, None, method, frame));
        }
    }
}
