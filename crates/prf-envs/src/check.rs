//! A conformance suite for any [`Environment`]: everything that its documentation promises, tried out.

use std::collections::HashSet;

use prf_core::Frame;

use crate::rng::{below, stream};
use crate::{Environment, Error, Step};

/// Makes a fresh world with the given step limit.
pub type Make<'a> = &'a dyn Fn(u32) -> Result<Box<dyn Environment>, Error>;

type World = Box<dyn Environment>;
type Rule = (&'static str, fn(Make<'_>) -> Result<(), Breach>);

/// A step limit that no rule reaches by accident.
const LONG: u32 = 10_000;
const SEEDS: std::ops::Range<u64> = 0..16;

const RULES: [Rule; 10] = [
    ("the spec makes sense", spec_makes_sense),
    ("a step needs a reset before it", step_needs_reset),
    ("an unknown action is refused and changes nothing", unknown_actions_are_refused),
    ("the same seed and actions give the same episode", episodes_repeat),
    ("seeds start differently where chance plays a part, else alike", starts_differ),
    ("a restored state goes on in the same way", restored_states_go_on),
    ("damaged states are refused and change nothing", damaged_states_are_refused),
    ("a drawing covers the whole frame, at any size", drawings_cover_the_frame),
    ("the step limit truncates", step_limit_truncates),
    ("after the end only a reset helps", end_is_final),
];

/// Why a rule doesn't hold.
enum Breach {
    Found(String),
    Failed(Error),
}

impl From<Error> for Breach {
    fn from(error: Error) -> Self {
        Breach::Failed(error)
    }
}

/// Tries every rule on the worlds that `make` makes.
///
/// # Errors
/// [`Error::BrokenRule`] with the first rule that is broken; any other error that `make` or the world returns.
pub fn conformance(make: Make<'_>) -> Result<(), Error> {
    for (rule, check) in RULES {
        check(make).map_err(|breach| match breach {
            Breach::Failed(error) => error,
            Breach::Found(detail) => {
                let world = make(LONG).map_or_else(|_| "the world".to_owned(), |world| world.spec().name.to_owned());
                Error::BrokenRule { world, rule, detail }
            }
        })?;
    }
    Ok(())
}

fn expect(holds: bool, detail: impl FnOnce() -> String) -> Result<(), Breach> {
    if holds { Ok(()) } else { Err(Breach::Found(detail())) }
}

fn spec_makes_sense(make: Make<'_>) -> Result<(), Breach> {
    let world = make(LONG)?;
    let spec = world.spec();
    let distinct: HashSet<_> = spec.actions.iter().collect();
    expect(!spec.name.is_empty(), || "the name is empty".to_owned())?;
    expect(spec.width > 0 && spec.height > 0, || "the frame is empty".to_owned())?;
    expect(!distinct.is_empty() && distinct.len() == spec.actions.len(), || {
        format!("the actions are {:?}", spec.actions)
    })?;
    expect(spec.limit_steps == LONG, || format!("asked for {LONG} steps, the spec says {}", spec.limit_steps))
}

fn step_needs_reset(make: Make<'_>) -> Result<(), Breach> {
    let mut world = make(LONG)?;
    expect(matches!(world.step(0), Err(Error::NotReset { .. })), || "a step before any reset is taken".to_owned())?;
    world.load_state(&make(LONG)?.save_state())?;
    world.reset(0);
    Ok(world.step(0).map(drop)?)
}

fn unknown_actions_are_refused(make: Make<'_>) -> Result<(), Breach> {
    let mut world = started(make, 0)?;
    let before = world.save_state();
    for action in [world.spec().actions.len(), usize::MAX] {
        let refused = matches!(world.step(action), Err(Error::UnknownAction { .. }));
        expect(refused && world.save_state() == before, || format!("action {action}"))?;
    }
    Ok(())
}

fn episodes_repeat(make: Make<'_>) -> Result<(), Breach> {
    for seed in SEEDS {
        let (mut one, mut other) = (started(make, seed)?, started(make, seed)?);
        play_alike(one.as_mut(), other.as_mut(), seed)?;
        one.reset(seed);
        other = started(make, seed)?;
        play_alike(one.as_mut(), other.as_mut(), seed)?;
    }
    Ok(())
}

fn starts_differ(make: Make<'_>) -> Result<(), Breach> {
    let mut pictures = HashSet::new();
    for seed in SEEDS {
        pictures.insert(picture(started(make, seed)?.as_ref()).as_slice().to_vec());
    }
    let (pictures, seeds) = (pictures.len(), SEEDS.count());
    let chance = make(LONG)?.spec().chance;
    let fits = if chance { pictures * 4 > seeds * 3 } else { pictures == 1 };
    expect(fits, || format!("{seeds} seeds have {pictures} first frames"))
}

fn restored_states_go_on(make: Make<'_>) -> Result<(), Breach> {
    for seed in SEEDS {
        let mut world = started(make, seed)?;
        for _ in 0..seed * 3 {
            if oracle_step(world.as_mut())?.status.is_over() {
                break;
            }
        }
        let state = world.save_state();
        let mut restored = started(make, seed + 1)?;
        restored.load_state(&state)?;
        expect(restored.save_state() == state, || format!("seed {seed}: saving again gives other bytes"))?;
        play_alike(world.as_mut(), restored.as_mut(), seed)?;
    }
    Ok(())
}

fn damaged_states_are_refused(make: Make<'_>) -> Result<(), Breach> {
    let state = started(make, 0)?.save_state();
    let unstarted = make(LONG)?.save_state();
    let mut world = started(make, 1)?;
    let before = world.save_state();
    let shorter = (0..state.len()).map(|len| state[..len].to_vec()).filter(|bytes| *bytes != unstarted);
    let longer = [state.as_slice(), &[0]].concat();
    for bytes in shorter.chain([longer]) {
        let refused = matches!(world.load_state(&bytes), Err(Error::BadState { .. }));
        expect(refused && world.save_state() == before, || format!("{} of {} bytes", bytes.len(), state.len()))?;
    }
    Ok(())
}

fn drawings_cover_the_frame(make: Make<'_>) -> Result<(), Breach> {
    let world = started(make, 0)?;
    let (width, height) = (world.spec().width, world.spec().height);
    let sizes = [(width, height), (2 * width, 2 * height), (1, 1), (97, 61), (13, 200), (height, width)];
    for (width, height) in sizes {
        let (mut on_black, mut on_white) = (Frame::new(width, height), Frame::new(width, height));
        on_white.fill(255);
        world.draw_into(&mut on_black);
        world.draw_into(&mut on_white);
        expect(on_black.as_slice() == on_white.as_slice(), || {
            format!("{width}×{height}: an old picture shines through")
        })?;
        expect(on_black.as_slice().iter().any(|&grey| grey != 0), || format!("{width}×{height}: all black"))?;
    }
    Ok(())
}

fn step_limit_truncates(make: Make<'_>) -> Result<(), Breach> {
    let limit = 4;
    for seed in SEEDS {
        let mut world = make(limit)?;
        world.reset(seed);
        for count in 1..=limit {
            let status = oracle_step(world.as_mut())?.status;
            let expected = if count < limit { crate::Status::Running } else { crate::Status::Truncated };
            expect(status == expected, || format!("seed {seed}: step {count} of {limit} is {status:?}"))?;
        }
    }
    Ok(())
}

fn end_is_final(make: Make<'_>) -> Result<(), Breach> {
    let mut world = make(1)?;
    world.reset(0);
    let action = world.oracle_action();
    world.step(action)?;
    let before = world.save_state();
    let refused = matches!(world.step(action), Err(Error::EpisodeOver { .. }));
    expect(refused && world.save_state() == before, || "a step after the end is taken".to_owned())?;
    let mut restored = make(1)?;
    restored.load_state(&before)?;
    expect(matches!(restored.step(action), Err(Error::EpisodeOver { .. })), || "a restored end goes on".to_owned())?;
    world.reset(0);
    Ok(world.step(action).map(drop)?)
}

fn started(make: Make<'_>, seed: u64) -> Result<World, Error> {
    let mut world = make(LONG)?;
    world.reset(seed);
    Ok(world)
}

fn picture(world: &dyn Environment) -> Frame {
    let mut frame = Frame::new(world.spec().width, world.spec().height);
    world.draw_into(&mut frame);
    frame
}

fn oracle_step(world: &mut dyn Environment) -> Result<Step, Breach> {
    let action = world.oracle_action();
    expect(action < world.spec().actions.len(), || format!("the oracle takes action {action}"))?;
    Ok(world.step(action)?)
}

/// Plays both worlds with the same actions, half the oracle's and half random, to the end or for 200 steps.
fn play_alike(one: &mut dyn Environment, other: &mut dyn Environment, seed: u64) -> Result<(), Breach> {
    let mut rng = stream(seed, "check", 0);
    for count in 0..200 {
        expect(one.save_state() == other.save_state(), || format!("seed {seed}: states differ after {count} steps"))?;
        expect(picture(one).as_slice() == picture(other).as_slice(), || {
            format!("seed {seed}: pictures differ after {count} steps")
        })?;
        let action = match below(&mut rng, 2) {
            0 => below(&mut rng, one.spec().actions.len()),
            _ => one.oracle_action(),
        };
        let steps = match (one.step(action), other.step(action)) {
            (Err(Error::EpisodeOver { .. }), Err(Error::EpisodeOver { .. })) => return Ok(()),
            (one, other) => (one?, other?),
        };
        expect(steps.0 == steps.1 && steps.0.reward.is_finite() && steps.0.score.is_finite(), || {
            format!("seed {seed}: step {count} brings {:?} and {:?}", steps.0, steps.1)
        })?;
    }
    Ok(())
}
