//! Breakout as its users meet it.

use std::collections::HashSet;

use prf_core::Frame;
use prf_envs::breakout::BRICKS;
use prf_envs::players::{Oracle, Random, mean_score, play_episode};
use prf_envs::{EnvConfig, Environment, Error, Status, check, registry};

fn breakout(limit_steps: u32) -> Box<dyn Environment> {
    make(limit_steps).expect("breakout exists")
}

fn make(limit_steps: u32) -> Result<Box<dyn Environment>, Error> {
    registry::make(&EnvConfig { limit_steps, ..EnvConfig::new("breakout") })
}

#[test]
fn it_conforms() -> Result<(), Error> {
    check::conformance(&make)
}

#[test]
fn the_oracle_never_loses_the_ball() {
    let mut world = breakout(100);
    for seed in 0..5_000 {
        let episode = play_episode(world.as_mut(), &mut Oracle, seed).expect("the oracle's actions exist");
        assert_eq!(episode.steps, 100, "seed {seed}");
        assert!(episode.score >= 2.0, "seed {seed}: {episode:?}");
    }
}

#[test]
fn the_oracle_clears_the_wall() {
    let mut world = breakout(20_000);
    for seed in 0..100 {
        let episode = play_episode(world.as_mut(), &mut Oracle, seed).expect("the oracle's actions exist");
        assert_eq!(episode.score, BRICKS as f32, "seed {seed}: {episode:?}");
    }
}

#[test]
fn ceiling_and_floor_are_far_apart() {
    let mut world = breakout(100);
    let oracle = mean_score(world.as_mut(), &mut Oracle, 0..1_000).expect("the oracle's actions exist");
    let random = mean_score(world.as_mut(), &mut Random::new(), 0..1_000).expect("random actions exist");
    assert!((3.0..=6.0).contains(&oracle), "oracle {oracle}");
    assert!(random <= 0.5, "random {random}");
}

/// A keeper with habits of its own: it catches with another part of the paddle than the oracle does, and dawdles.
fn keep_differently(world: &mut dyn Environment, seed: u64) -> f32 {
    world.reset(seed);
    let mut count = 0u64;
    loop {
        let wait = count % 30 < seed % 12;
        let action = if wait { 0 } else { world.oracle_action() };
        count += 1;
        let step = world.step(action).expect("the action exists");
        match step.status {
            Status::Running => {}
            Status::Truncated => return step.score,
            Status::Terminated => return f32::NAN,
        }
    }
}

#[test]
fn who_never_misses_has_the_oracles_score() {
    let mut world = breakout(100);
    let mut kept = 0;
    for seed in 0..300 {
        let score = keep_differently(world.as_mut(), seed);
        if !score.is_nan() {
            kept += 1;
            let oracle = play_episode(world.as_mut(), &mut Oracle, seed).expect("the oracle's actions exist");
            assert_eq!(score, oracle.score, "seed {seed}");
        }
    }
    assert!(kept > 100, "only {kept} episodes were kept to the end");
}

#[test]
fn starts_are_mostly_distinct() {
    let mut world = breakout(100);
    let mut frame = Frame::new(84, 84);
    let starts = (0..1_000).map(|seed| {
        world.reset(seed);
        world.draw_into(&mut frame);
        frame.as_slice().to_vec()
    });
    let distinct = starts.collect::<HashSet<_>>().len();
    assert!(distinct > 950, "{distinct} of 1000");
}

#[test]
fn it_is_black_before_the_first_episode() {
    let mut frame = Frame::new(20, 20);
    frame.fill(9);
    breakout(100).draw_into(&mut frame);
    assert!(frame.as_slice().iter().all(|&grey| grey == 0));
}

#[test]
fn a_state_needs_its_own_step_limit() {
    let mut long = breakout(200);
    long.reset(1);
    for _ in 0..150 {
        let action = long.oracle_action();
        long.step(action).expect("the action exists");
    }
    let error = breakout(100).load_state(&long.save_state()).expect_err("150 steps are too many");
    assert_eq!(
        error.to_string(),
        "the saved state of breakout can't be used: got values that no episode has, expected a number of steps that \
         fits the step limit"
    );
}

#[test]
fn errors_name_what_was_wrong() {
    let unknown = registry::make(&EnvConfig::new("brakeout")).map(|_| ()).expect_err("no such world");
    assert_eq!(
        unknown.to_string(),
        "env.name: got \"brakeout\", expected \"breakout\" or \"flappy\" or \"kobian-happy\" or \"kobian-surprise\""
    );
    let endless = make(0).map(|_| ()).expect_err("no steps");
    assert_eq!(endless.to_string(), "env.limit_steps: got 0, expected at least 1");
    let mut world = breakout(100);
    let early = world.step(0).expect_err("not reset");
    assert_eq!(early.to_string(), "breakout has no episode yet: expected a reset before the first step");
    let action = world.step(3).expect_err("three actions");
    assert_eq!(action.to_string(), "action 3 is unknown to breakout: expected 0 to 2");
    let foreign = world.load_state(b"flappy001").expect_err("another world");
    assert_eq!(
        foreign.to_string(),
        "the saved state of breakout can't be used: got a state marked \"flappy001\", expected \"breakout1\""
    );
}
