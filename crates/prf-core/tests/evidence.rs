//! Rewards judged on the frames of `tests/golden/flappy`, where an innocent choice of cell and norm turns a reward's sign.

use std::fs;
use std::num::NonZero;
use std::path::PathBuf;

use prf_core::{
    CellSize, DescriptorParams, Evidence, FigureKind, Footage, Frame, Goal, HogParams, Judgement, Label, MotionParams,
    MotionTemplate, Norm, Rect, RewardParams, Verdict, WindowParams, io, recommend, settings, windows_around,
};

const THREADS: NonZero<usize> = NonZero::new(2).expect("above 0");

fn golden(name: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../tests/golden/flappy").join(name)
}

fn footage() -> Footage {
    let mut footage = Footage::new(None, 1000).expect("above 0");
    let mut frames = io::FrameSource::open(golden("frames.png")).expect("an animation");
    let mut frame = Frame::new(1, 1);
    for line in fs::read_to_string(golden("scores.csv")).expect("a table").lines().skip(1) {
        let (score, success) = line.split_once(',').expect("two columns");
        frames.next_into(&mut frame).expect("a frame for each line").expect("a whole animation");
        let label = Label { score: score.parse().ok(), success: Some(success == "1") };
        footage.observe(frame.view(), label).expect("one size");
    }
    assert!(frames.next_into(&mut frame).is_none());
    footage
}

fn window() -> DescriptorParams {
    DescriptorParams::Window(WindowParams::default())
}

fn params(norm: Norm, block_cells: usize, fraction: f32) -> RewardParams {
    let hog = HogParams { norm, block_cells, cell: CellSize::Fraction(fraction), ..HogParams::default() };
    RewardParams { hog, ..RewardParams::default() }
}

/// The windows around the given one, cut out of the screen.
fn goals() -> Vec<Goal> {
    let screen = io::read_frame(golden("screen.png")).expect("a picture");
    let cut = |Rect { x, y, width, height }: Rect| {
        let pixels = (y..y + height).flat_map(|row| screen.row(row)[x..x + width].to_vec()).collect();
        Goal::from(Frame::from_vec(width, height, pixels).expect("a window"))
    };
    let given = Rect { x: 13, y: 26, width: 20, height: 32 };
    assert_eq!(cut(given).picture, io::read_frame(golden("goal.png")).expect("a picture"));
    windows_around(given, [84, 84]).into_iter().map(cut).collect()
}

#[test]
fn the_innocent_choice_punishes_being_between_the_pipes() {
    let (footage, goal) = (footage(), &goals()[0]);
    let naive = params(Norm::L2, 1, 0.1);
    let by_frames = footage.scored(&window(), goal).expect("it fits").judge(naive).expect("it fits");
    assert_eq!(by_frames.verdict, Verdict::Misleading);
    assert!(by_frames.figure(FigureKind::Success) < Some(0.3), "{by_frames:?}");
    assert!(by_frames.figure(FigureKind::Rank) < Some(-0.1), "{by_frames:?}");
    // Nothing but the goal tells as much.
    let by_goal = Evidence::of_goal(&window(), goal).expect("a bird").judge(naive).expect("it fits");
    assert_eq!(by_goal.verdict, Verdict::Misleading);
    assert!(by_goal.figure(FigureKind::Absence) < Some(0.3), "{by_goal:?}");
}

#[test]
fn a_sweep_finds_a_window_and_settings_that_order_the_frames() {
    let footage = footage();
    let mut judged: Vec<Judgement> = Vec::new();
    for goal in goals() {
        let evidence = footage.scored(&window(), &goal).expect("it fits");
        judged.extend(evidence.sweep(&settings(&goal, params(Norm::L2, 1, 0.1)), THREADS).expect("settings fit"));
    }
    let best = &judged[recommend(&judged).expect("there is a good one")];
    assert_eq!(best.verdict, Verdict::Good, "{best:?}");
    assert!(best.figure(FigureKind::Success) >= Some(0.9), "{best:?}");
    assert!(best.figure(FigureKind::Rank) >= Some(0.8), "{best:?}");
}

#[test]
fn the_goal_alone_calls_nothing_good_that_punishes_progress() {
    let footage = footage();
    let (mut by_frames, mut by_goal) = (Vec::new(), Vec::new());
    for goal in goals() {
        let settings = settings(&goal, params(Norm::L2, 1, 0.1));
        let Ok(alone) = Evidence::of_goal(&window(), &goal) else { continue };
        by_goal.extend(alone.sweep(&settings, THREADS).expect("settings fit"));
        let evidence = footage.scored(&window(), &goal).expect("it fits");
        by_frames.extend(evidence.sweep(&settings, THREADS).expect("settings fit"));
    }
    let flipped = |judgement: &Judgement| judgement.figure(FigureKind::Success) < Some(0.5);
    let pairs = || by_frames.iter().zip(&by_goal);
    assert!(pairs().filter(|(frames, _)| flipped(frames)).count() > 1000);
    let fooled: Vec<_> = pairs().filter(|(frames, goal)| flipped(frames) && goal.verdict == Verdict::Good).collect();
    assert!(fooled.is_empty(), "{} of {}: {:?}", fooled.len(), by_goal.len(), fooled.first());
    // What it recommends is right more often than wrong on the frames, too.
    let frames = &by_frames[recommend(&by_goal).expect("there is a good one")];
    assert!(
        frames.figure(FigureKind::Success) > Some(0.6) && frames.figure(FigureKind::Rank) > Some(0.6),
        "{frames:?}"
    );
}

/// A ball that rolls into its place, as a demonstration.
fn rolling(step: usize) -> Frame {
    let mut frame = Frame::new(60, 40);
    frame.row_mut(0).fill(80);
    frame.row_mut(39).fill(80);
    (20..28).for_each(|y| frame.row_mut(y)[2 + 4 * step..10 + 4 * step].fill(220));
    frame
}

#[test]
fn a_demonstration_is_in_order_and_its_reverse_is_not() {
    let goal = Goal::from(rolling(12));
    let order = |steps: &mut dyn Iterator<Item = usize>| {
        let mut footage = Footage::new(None, 100).expect("above 0");
        footage.begin();
        steps.for_each(|step| footage.observe(rolling(step).view(), Label::default()).expect("one size"));
        let evidence = footage.demonstrated(&DescriptorParams::Direct, &goal).expect("13 frames");
        evidence
            .judge(params(Norm::L2Hys, 1, 0.5))
            .expect("it fits")
            .figure(FigureKind::ValueOrder)
            .expect("rewards differ")
    };
    assert!(order(&mut (0..=12)) > 0.6);
    assert!(order(&mut (0..=12).rev()) < -0.6);
}

#[test]
fn a_movement_is_judged_by_what_moves_in_it() {
    let motion = MotionParams::default();
    let mut template = MotionTemplate::new(motion).expect("valid");
    (0..=12).for_each(|step| template.observe(rolling(step).view()).expect("one size"));
    let mut picture = Frame::new(1, 1);
    template.history_into(&mut picture);
    let goal = Goal::from(picture);
    let mut footage = Footage::new(Some(motion), 100).expect("valid");
    for _ in 0..2 {
        footage.begin();
        (0..=12).for_each(|step| footage.observe(rolling(step).view(), Label::default()).expect("one size"));
    }
    let evidence = footage.demonstrated(&DescriptorParams::Motion(motion), &goal).expect("long enough");
    let distances = evidence.distances(params(Norm::L2, 1, 0.2)).expect("it fits");
    assert_eq!((distances[12], distances[25]), (0.0, 0.0), "the whole movement is the goal");
    assert!(distances[3] > 0.3, "{distances:?}");
    assert_eq!(distances[..13], distances[13..], "the second episode remembers nothing of the first");
}
