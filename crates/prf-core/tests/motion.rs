//! Motion templates: by hand, by the book for any sequence, at the ends of what a sequence can be.
#![expect(clippy::unwrap_used, reason = "a test may stop at the first surprise")]

use prf_core::{DeltaSchedule, Error, Frame, MotionParams, MotionState, MotionTemplate};
use proptest::prelude::*;

const HUMAN: (f64, DeltaSchedule) = (0.3, DeltaSchedule::Divisor(4.0));
const ROBOT: (f64, DeltaSchedule) = (0.4, DeltaSchedule::Divisor(3.0));

fn params((tau_step, delta): (f64, DeltaSchedule)) -> MotionParams {
    MotionParams { tau_step, delta, ..MotionParams::default() }
}

fn frame(width: usize, height: usize, pixels: &[u8]) -> Frame {
    Frame::from_vec(width, height, pixels.to_vec()).unwrap()
}

fn history_image(template: &MotionTemplate) -> Frame {
    let mut image = Frame::new(1, 1);
    template.history_into(&mut image);
    image
}

fn energy_image(template: &MotionTemplate) -> Frame {
    let mut image = Frame::new(1, 1);
    template.energy_into(&mut image);
    image
}

/// The frames of a sequence by hand, each with its `μ` and the history image. `τ` is 0.1, 0.5, 0.9 and 1.3, and
/// `τ − δ` below 0 until then.
#[rustfmt::skip]
const BY_HAND: [([u8; 6], [f32; 6], [u8; 6]); 5] = [
    ([10, 10, 10, 200, 200, 200], [0.0, 0.0, 0.0, 0.0, 0.0, 0.0], [0, 0, 0, 0, 0, 0]),
    // 80 up, 30 up and 31 down: the threshold is 30.
    ([90, 10, 40, 200, 169, 200], [0.1, 0.0, 0.0, 0.0, 0.1, 0.0], [255, 0, 0, 0, 255, 0]),
    // 255 · 0.1/0.5 = 51
    ([90, 90, 40, 200, 169, 200], [0.1, 0.5, 0.0, 0.0, 0.1, 0.0], [51, 255, 0, 0, 51, 0]),
    // 255 · 0.5/0.9 = 141.67, 255 · 0.1/0.9 = 28.33
    ([10, 90, 40, 100, 169, 200], [0.9, 0.5, 0.0, 0.9, 0.1, 0.0], [255, 142, 0, 255, 28, 0]),
    // 255 · 0.9/1.3 = 176.54, then 98.08 and 19.62
    ([10, 90, 71, 100, 169, 200], [0.9, 0.5, 1.3, 0.9, 0.1, 0.0], [177, 98, 255, 177, 20, 0]),
];

#[test]
fn a_sequence_by_hand() {
    let mut template = MotionTemplate::new(params(ROBOT)).unwrap();
    for (pixels, history, image) in BY_HAND {
        template.observe(frame(3, 2, &pixels).view()).unwrap();
        assert_eq!(template.history(), history);
        assert_eq!(history_image(&template).as_slice(), image);
    }
    // Nothing moves any more. At t = 5 the oldest movement is as old as δ (2.1 − 2 = 0.1), at t = 6 it is older.
    let (still, last, _) = BY_HAND[4];
    for _ in 4..=6 {
        assert_eq!(template.history(), last);
        template.observe(frame(3, 2, &still).view()).unwrap();
    }
    assert_eq!(template.history(), [0.9, 0.5, 1.3, 0.9, 0.0, 0.0]);
    assert_eq!(energy_image(&template).as_slice(), [255, 255, 255, 255, 0, 0]);
    assert_eq!((template.iterations(), template.tau(), template.shape()), (7, 2.5, [2, 3]));
}

/// docs/reward.md goes through this by hand.
#[test]
fn the_example_of_the_documentation() {
    let frames = [[200, 0, 0, 0], [0, 200, 0, 0], [0, 0, 200, 0], [20, 0, 0, 200]].map(|pixels| frame(4, 1, &pixels));
    let mut template = MotionTemplate::new(MotionParams::default()).unwrap();
    template.observe(frames[0].view()).unwrap();
    assert_eq!((template.history(), history_image(&template).as_slice()), (&[0.0; 4][..], &[0; 4][..]));
    for (frame, history, bytes) in [
        (&frames[1], [0.1, 0.1, 0.0, 0.0], [255, 255, 0, 0]),
        (&frames[2], [0.1, 0.5, 0.5, 0.0], [51, 255, 255, 0]),
        (&frames[3], [0.1, 0.5, 0.9, 0.9], [28, 142, 255, 255]),
    ] {
        template.observe(frame.view()).unwrap();
        assert_eq!((template.history(), history_image(&template).as_slice()), (&history[..], &bytes[..]));
    }
    let forgetful = MotionParams { delta: DeltaSchedule::Duration(0.5), ..MotionParams::default() };
    let template = MotionTemplate::of(forgetful, frames.iter().map(Frame::view)).unwrap();
    assert_eq!(history_image(&template).as_slice(), [0, 142, 255, 255]);
}

/// A pixel that brightens by 20 a frame passes the threshold of 30 with every second frame, seen from the last one that counted.
#[test]
fn a_slow_movement_is_seen_once_it_is_large_enough() {
    let params = MotionParams { skip_still: true, ..MotionParams::default() };
    let mut template = MotionTemplate::new(params).unwrap();
    let iterations = (0..7u8).map(|step| {
        template.observe(frame(1, 1, &[20 * step]).view()).unwrap();
        template.iterations()
    });
    assert_eq!(iterations.collect::<Vec<_>>(), [0, 0, 1, 1, 2, 2, 3]);
    let error = template.observe(frame(2, 1, &[0, 0]).view()).unwrap_err();
    assert!(matches!(error, Error::FrameSize { shape: [1, 2], expected: [1, 1] }), "{error}");
}

/// With both of the paper's schedules `μ_k < τ_t − δ_t` is `6 k < t − 5`: 0.1 + 0.4 k < 0.1 + 0.4 t − (t + 1)/3, and
/// 0.1 + 0.3 k < 0.1 + 0.3 t − (t + 1)/4.
#[test]
fn a_movement_lives_exactly_as_long_as_the_paper_says() {
    let [still, moved] = [0, 255].map(|value| frame(1, 1, &[value]));
    for (schedule, k) in [HUMAN, ROBOT].into_iter().flat_map(|s| (0..40).map(move |k| (s, k))) {
        let mut template = MotionTemplate::new(params(schedule)).unwrap();
        (0..=k).for_each(|_| template.observe(still.view()).unwrap());
        for t in k..6 * k + 20 {
            template.observe(moved.view()).unwrap();
            assert_eq!(template.iterations(), t + 1);
            assert_eq!(template.has_motion(), 6 * k + 5 >= t, "moved at {k}, looked at {t}, {schedule:?}");
        }
    }
}

#[test]
fn no_frame_and_one_frame_give_a_black_template() {
    let params = MotionParams::default();
    let none = MotionTemplate::of(params, []).unwrap();
    assert!(!none.has_motion());
    assert_eq!((none.history(), none.shape(), none.tau()), (&[][..], [0, 0], 0.0));
    // There is no size yet, so the picture keeps its own.
    let mut image = frame(2, 1, &[7, 8]);
    none.history_into(&mut image);
    assert_eq!(image, Frame::new(2, 1));
    image.fill(9);
    none.energy_into(&mut image);
    assert_eq!(image, Frame::new(2, 1));

    let one = MotionTemplate::of(params, [frame(3, 2, &[255; 6]).view()]).unwrap();
    assert!(!one.has_motion());
    assert_eq!((one.history(), one.iterations(), one.tau()), (&[0.0; 6][..], 0, 0.0));
    assert_eq!((history_image(&one), energy_image(&one)), (Frame::new(3, 2), Frame::new(3, 2)));
}

#[test]
fn motion_is_a_difference_above_the_threshold_in_either_direction() {
    for threshold in [0, 1, 30, 254] {
        let params = MotionParams { threshold, ..MotionParams::default() };
        for (before, after) in [(0, threshold), (threshold, 0), (0, threshold + 1), (threshold + 1, 0)] {
            let frames = [frame(1, 1, &[before]), frame(1, 1, &[after])];
            let template = MotionTemplate::of(params, frames.iter().map(Frame::view)).unwrap();
            assert_eq!(template.has_motion(), before.abs_diff(after) > threshold, "{before} to {after}");
        }
    }
}

#[test]
fn noise_up_to_the_threshold_is_no_motion() {
    let params = MotionParams { threshold: 12, ..MotionParams::default() };
    let mut template = MotionTemplate::new(params).unwrap();
    for step in 0..50u32 {
        let noise = |i: u32| 100 + ((i * 31 + step).wrapping_mul(2_654_435_761) >> 16) as u8 % 13;
        let mut pixels: Vec<u8> = (0..200).map(noise).collect();
        pixels[60..70].fill(if step % 2 == 0 { 20 } else { 220 });
        template.observe(frame(20, 10, &pixels).view()).unwrap();
    }
    let energy = energy_image(&template);
    assert!((0..200).all(|i| energy.as_slice()[i] == if (60..70).contains(&i) { 255 } else { 0 }));
}

#[test]
fn another_size_is_refused_until_a_reset() {
    let mut template = MotionTemplate::new(MotionParams::default()).unwrap();
    template.observe(frame(3, 2, &[0; 6]).view()).unwrap();
    template.observe(frame(3, 2, &[90; 6]).view()).unwrap();
    let before = template.state().clone();
    for wrong in [frame(2, 3, &[0; 6]), frame(3, 3, &[0; 9])] {
        let error = template.observe(wrong.view()).unwrap_err();
        let (shape, expected) = ([wrong.height(), wrong.width()], [2, 3]);
        assert!(matches!(error, Error::FrameSize { shape: s, expected: e } if s == shape && e == expected));
        template.update(wrong.view(), 9.0, 1.0).unwrap_err();
        assert_eq!(template.state(), &before);
    }
    let error = template.observe(Frame::new(10, 8).view()).unwrap_err().to_string();
    assert!(error.starts_with("got a frame of 10x8 px, expected 3x2 "), "{error}");
    template.reset();
    template.observe(Frame::new(10, 8).view()).unwrap();
    assert_eq!((template.shape(), template.history()), ([8, 10], &[0.0; 80][..]));
}

#[test]
fn times_that_go_back_are_refused() {
    let mut template = MotionTemplate::new(MotionParams::default()).unwrap();
    let silhouette = frame(2, 1, &[1, 0]);
    template.update(silhouette.view(), 5.0, 1.0).unwrap();
    let before = template.state().clone();
    for (tau, delta) in [(4.9, 1.0), (f32::NAN, 1.0), (f32::INFINITY, 1.0)] {
        let error = template.update(silhouette.view(), tau, delta).unwrap_err().to_string();
        assert!(error.starts_with("tau: got "), "{error}");
    }
    for delta in [-1.0, f32::NAN] {
        let error = template.update(silhouette.view(), 6.0, delta).unwrap_err().to_string();
        assert!(error.starts_with("delta: got "), "{error}");
    }
    // The schedule's first times lie before 5 too.
    template.clone().observe(silhouette.view()).unwrap();
    assert_eq!(template.state(), &before);
    template.observe(silhouette.view()).unwrap();
    let error = template.observe(silhouette.view()).unwrap_err().to_string();
    assert!(error.starts_with("tau: got 0.5, expected a finite time of at least 5,"), "{error}");
    // Equal times and an endless memory are in order.
    template.update(silhouette.view(), 5.0, f32::INFINITY).unwrap();
    assert_eq!(template.history(), [5.0, 0.0]);
}

#[test]
fn pictures_of_the_smallest_and_largest_times_are_in_order() {
    for tau in [0.0, f32::from_bits(1), 1e-30, 1e30, f32::MAX] {
        let mut template = MotionTemplate::new(MotionParams::default()).unwrap();
        template.update(frame(3, 1, &[0, 1, 255]).view(), tau, 0.0).unwrap();
        assert_eq!(template.has_motion(), tau > 0.0);
        assert_eq!(history_image(&template).as_slice()[0], 0);
        if tau >= 1e-30 {
            assert_eq!(history_image(&template).as_slice(), [0, 255, 255]);
        }
    }
}

/// Ten million steps of 0.4, days at 60 a second: added up in 32 bits they would have come to a halt.
#[test]
fn a_very_long_sequence_keeps_its_order() {
    let mut template = MotionTemplate::new(params(ROBOT)).unwrap();
    let dark = Frame::new(2, 1);
    template.observe(dark.view()).unwrap();
    for (t, apart) in [(8_388_000, true), (1 << 40, false)] {
        let late = MotionState { iterations: t, ..template.state().clone() };
        template.restore(&late).unwrap();
        template.observe(frame(2, 1, &[255, 0]).view()).unwrap();
        template.observe(frame(2, 1, &[255, 255]).view()).unwrap();
        let &[first, second] = template.history() else { panic!("two pixels") };
        assert!(if apart { first < second } else { first <= second }, "{first} and {second} at {t}");
        let exact = 0.1 + 0.4 * t as f64;
        assert!((f64::from(first) - exact).abs() <= exact * f64::from(f32::EPSILON));
        template.observe(dark.view()).unwrap();
        template.observe(dark.view()).unwrap();
    }
}

#[test]
fn what_no_template_can_have_come_to_is_not_restored() {
    let frames = [frame(3, 2, &[0; 6]), frame(3, 2, &[90; 6])];
    let mut template = MotionTemplate::of(MotionParams::default(), frames.iter().map(Frame::view)).unwrap();
    let good = template.state().clone();
    let bad = [
        MotionState { shape: [3, 3], ..good.clone() },
        MotionState { shape: [0, 0], ..good.clone() },
        MotionState { shape: [usize::MAX, 2], ..good.clone() },
        MotionState { shape: [0, 3], history: Vec::new(), reference: Vec::new(), ..good.clone() },
        MotionState { iterations: 1, ..MotionState::default() },
        MotionState { reference: vec![0; 5], ..good.clone() },
        MotionState { history: vec![0.1; 5], ..good.clone() },
        MotionState { history: vec![f32::NAN; 6], ..good.clone() },
        MotionState { history: vec![-0.1; 6], ..good.clone() },
        MotionState { history: vec![0.11; 6], ..good.clone() },
        MotionState { tau: f32::NAN, ..good.clone() },
        MotionState { tau: f32::INFINITY, ..good.clone() },
        MotionState { tau: -1.0, ..good.clone() },
        MotionState { tau: 1.0, ..MotionState::default() },
    ];
    for state in bad {
        assert!(matches!(template.restore(&state), Err(Error::Restore { .. })), "{state:?}");
        assert_eq!(template.state(), &good);
    }
    template.restore(&MotionState { iterations: u64::MAX, ..good }).unwrap();
    template.observe(frames[0].view()).unwrap();
    assert_eq!(template.iterations(), u64::MAX);
    template.restore(&MotionState::default()).unwrap();
    template.observe(Frame::new(9, 9).view()).unwrap();
}

#[test]
fn steps_allocate_nothing_once_warm() {
    let mut template = MotionTemplate::new(MotionParams::default()).unwrap();
    let mut image = Frame::new(1, 1);
    let mut places = Vec::new();
    for step in 0..40 {
        if step % 10 == 9 {
            template.reset();
        }
        template.observe(frame(31, 17, &[step * 6; 31 * 17]).view()).unwrap();
        template.history_into(&mut image);
        template.energy_into(&mut image);
        let MotionState { reference, history, .. } = template.state();
        places.push((reference.as_ptr() as usize, history.as_ptr() as usize, image.as_slice().as_ptr() as usize));
    }
    places.dedup();
    assert_eq!(places.len(), 1);
}

/// Sequences of one size, in which neighbours are often alike.
fn sequence() -> impl Strategy<Value = Vec<Frame>> {
    let pixel = prop_oneof![3 => Just(0u8), 2 => Just(100), 1 => any::<u8>()];
    (1usize..40, 1usize..8, 0usize..12).prop_flat_map(move |(width, height, count)| {
        let frame = prop::collection::vec(pixel.clone(), width * height)
            .prop_map(move |pixels| Frame::from_vec(width, height, pixels).unwrap());
        prop::collection::vec(frame, count)
    })
}

prop_compose! {
    fn any_params()(
        threshold in 0u8..=254,
        tau_start in 0.001f64..5.0,
        tau_step in 0.001f64..5.0,
        grows: bool,
        amount in 0.01f64..9.0,
    ) -> MotionParams {
        let delta = if grows { DeltaSchedule::Divisor(amount) } else { DeltaSchedule::Duration(amount) };
        MotionParams { threshold, tau_start, tau_step, delta, skip_still: false }
    }
}

fn template_of(frames: &[Frame], params: MotionParams) -> MotionTemplate {
    MotionTemplate::of(params, frames.iter().map(Frame::view)).unwrap()
}

/// The paper's definition, pixel by pixel, over the whole sequence at once.
fn plain_history(frames: &[Frame], params: MotionParams) -> Vec<f32> {
    let pixels = frames.first().map_or(0, |frame| frame.as_slice().len());
    let times: Vec<(f64, f64)> =
        (0..frames.len() as u64).map(|t| (params.tau(t), params.tau(t) - params.delta.delta(t))).collect();
    let mut history = vec![0.0f32; pixels];
    for (i, mu) in history.iter_mut().enumerate() {
        for (pair, &(tau, oldest)) in frames.windows(2).zip(&times) {
            let difference = i16::from(pair[0].as_slice()[i]) - i16::from(pair[1].as_slice()[i]);
            if difference.abs() > i16::from(params.threshold) {
                *mu = tau as f32;
            } else if *mu < oldest as f32 {
                *mu = 0.0;
            }
        }
    }
    history
}

proptest! {
    #[test]
    fn a_template_is_that_of_the_definition(frames in sequence(), params in any_params()) {
        let template = template_of(&frames, params);
        prop_assert_eq!(template.history(), plain_history(&frames, params));
        prop_assert_eq!(template.iterations(), frames.len().saturating_sub(1) as u64);
    }

    /// Frames that repeat the one before change nothing, wherever they stand.
    #[test]
    fn pauses_are_passed_over(frames in sequence(), params in any_params(), pauses in prop::collection::vec(0usize..3, 12)) {
        let params = MotionParams { skip_still: true, ..params };
        let repeats = pauses.into_iter().chain(std::iter::repeat(0));
        let paused: Vec<Frame> =
            frames.iter().zip(repeats).flat_map(|(frame, times)| std::iter::repeat_n(frame.clone(), times + 1)).collect();
        let (without, with) = (template_of(&frames, params), template_of(&paused, params));
        prop_assert_eq!(without.state(), with.state());
    }

    #[test]
    fn frames_and_their_silhouettes_give_one_template(
        frames in sequence(), threshold in 0u8..=254, eighths in (1u8..9, 1u8..9, 0u8..40),
    ) {
        // Eighths are exact in 32 and in 64 bits, and many a movement is exactly as old as δ.
        let [tau_start, tau_step, duration] = <[u8; 3]>::from(eighths).map(|n| f64::from(n) / 8.0);
        let params = MotionParams { threshold, tau_start, tau_step, delta: DeltaSchedule::Duration(duration), skip_still: false };
        let mut by_hand = MotionTemplate::new(params).unwrap();
        for (t, pair) in (0..).zip(frames.windows(2)) {
            let pixels = pair[0].as_slice().iter().zip(pair[1].as_slice());
            let moved: Vec<u8> = pixels.map(|(a, b)| u8::from(a.abs_diff(*b) > threshold) * 3).collect();
            let silhouette = frame(pair[0].width(), pair[0].height(), &moved);
            by_hand.update(silhouette.view(), params.tau(t) as f32, duration as f32).unwrap();
        }
        let template = template_of(&frames, params);
        prop_assert_eq!(template.tau(), by_hand.tau());
        prop_assert!(frames.len() < 2 || template.history() == by_hand.history());
    }

    #[test]
    fn times_and_pictures_keep_to_their_ranges(frames in sequence(), params in any_params()) {
        let template = template_of(&frames, params);
        let (tau, history) = (f64::from(template.tau()), template.history());
        let (image, energy) = (history_image(&template), energy_image(&template));
        prop_assert_eq!(template.has_motion(), history.iter().any(|&mu| mu != 0.0));
        for (i, mu) in history.iter().enumerate() {
            prop_assert!(*mu == 0.0 || (params.tau_start as f32..=template.tau()).contains(mu));
            prop_assert_eq!(energy.as_slice()[i], if *mu > 0.0 { 255 } else { 0 });
            let exact = if *mu > 0.0 { 255.0 * f64::from(*mu) / tau } else { 0.0 };
            let got = f64::from(image.as_slice()[i]);
            prop_assert!((got - exact).abs() < 0.5001, "{got} for {exact}");
        }
    }

    #[test]
    fn a_still_sequence_is_black(image in sequence(), count in 2usize..6, params in any_params()) {
        for frame in &image {
            let template = template_of(&vec![frame.clone(); count], params);
            prop_assert!(!template.has_motion());
            prop_assert_eq!(history_image(&template), Frame::new(frame.width(), frame.height()));
        }
    }

    #[test]
    fn a_reset_forgets(before in sequence(), after in sequence(), params in any_params()) {
        let mut template = template_of(&before, params);
        template.reset();
        prop_assert_eq!(template.state(), &MotionState::default());
        after.iter().for_each(|frame| template.observe(frame.view()).unwrap());
        let fresh = template_of(&after, params);
        prop_assert_eq!(template.state(), fresh.state());
    }

    #[test]
    fn a_restored_template_goes_on_bit_by_bit(frames in sequence(), at in 0usize..12, params in any_params()) {
        let at = at.min(frames.len());
        let mut resumed = template_of(&frames, params);
        resumed.restore(template_of(&frames[..at], params).state()).unwrap();
        frames[at..].iter().for_each(|frame| resumed.observe(frame.view()).unwrap());
        let through = template_of(&frames, params);
        prop_assert_eq!(resumed.state(), through.state());
    }
}
