use super::physics::{BIRD_HEIGHT, BIRD_WIDTH, BIRD_X, Bird, FIRST_X, Flight, GAP, GROUND, PARTS, PIPE_WIDTH, SPACING};
use super::*;

fn flight(distance: u32, y: i32) -> Flight {
    Flight::new(5, distance, Bird { y: y * PARTS, speed: 0 })
}

#[test]
fn a_flap_and_what_follows_by_hand() {
    let mut flight = flight(0, 40);
    let mut heights = Vec::new();
    for step in 0..12 {
        flight.step(step == 0);
        heights.push(flight.bird.y - 40 * PARTS);
    }
    // Speeds −10, −8, … 12, in quarters of a pixel.
    assert_eq!(heights, [-10, -18, -24, -28, -30, -30, -28, -24, -18, -10, 0, 12]);
    for _ in 0..30 {
        flight.step(false);
    }
    assert_eq!((flight.bird.y, flight.bird.speed), (GROUND, 14));
    assert!(flight.has_crashed());
}

#[test]
fn the_ceiling_stops_the_bird_and_is_no_crash() {
    let mut flight = flight(0, 3);
    for _ in 0..3 {
        flight.step(true);
    }
    assert_eq!(flight.bird, Bird { y: 0, speed: 0 });
    assert!(!flight.has_crashed());
    flight.step(false);
    assert_eq!(flight.bird.y, 2);
}

#[test]
fn a_pair_counts_once_it_lies_behind() {
    let first_behind = (FIRST_X + PIPE_WIDTH + 1 - BIRD_X) as u32;
    for (distance, passed) in [
        (0, 0),
        (first_behind - 1, 0),
        (first_behind, 1),
        (first_behind + SPACING as u32 - 1, 1),
        (first_behind + SPACING as u32, 2),
    ] {
        assert_eq!(flight(distance, 40).passed(), passed, "{distance} px");
        assert_eq!(flight(distance, 40).next(), flight(distance, 40).pipes(passed));
    }
    assert!(flight(first_behind - 1, 40).next().are_around_bird());
    assert!(!flight(first_behind, 40).next().are_around_bird());
    let first_touch = (FIRST_X - 1 - (BIRD_X + BIRD_WIDTH)) as u32;
    assert!(!flight(first_touch, 40).next().are_around_bird());
    assert!(flight(first_touch + 1, 40).next().are_around_bird());
}

#[test]
fn only_the_gap_lets_the_bird_through() {
    let inside = flight(50, 0).next();
    assert!(inside.are_around_bird());
    let fits = |top: i32| !flight(50, top).has_crashed();
    assert!(fits(inside.gap) && fits(inside.gap + GAP - BIRD_HEIGHT));
    assert!(!fits(inside.gap - 1) && !fits(inside.gap + GAP - BIRD_HEIGHT + 1));
    assert!(flight(50, inside.gap).is_between_pipes());
    assert!(!flight(0, inside.gap).is_between_pipes() && !flight(0, inside.gap).has_crashed());
}

#[test]
fn a_state_is_labelled_by_where_the_bird_is() {
    let label = |distance: u32, top: i32| {
        let flight = flight(distance, top);
        Flappy { game: Some(Game { flight, steps: 1, status: Status::Running }), ..Flappy::new(9).expect("above 0") }
            .label(7.0)
    };
    let gap = flight(50, 0).next().gap;
    let middle = gap + (GAP - BIRD_HEIGHT) / 2;
    assert_eq!(label(50, middle), Label { score: Some(0.0), success: Some(true) });
    assert_eq!(label(50, gap), Label { score: Some(-10.0), success: Some(true) });
    assert_eq!(label(50, gap - 3), Label { score: Some(-13.0), success: Some(false) });
    assert_eq!(label(0, middle), Label { score: None, success: Some(false) });
}

#[test]
fn gaps_are_drawn_from_all_heights() {
    let mut seen = std::collections::BTreeSet::new();
    for number in 0..2_000 {
        seen.insert(flight(0, 40).pipes(number).gap);
    }
    assert_eq!(seen, (8..=50).collect());
}

/// What a seed means is part of the world's version.
#[test]
fn the_numbers_behind_a_seed_stay() {
    let gaps: Vec<i32> = (0..6).map(|number| flight(0, 40).pipes(number).gap).collect();
    let starts: Vec<i32> = (0..6).map(|seed| Bird::start(seed).top()).collect();
    assert_eq!((gaps, starts), (vec![18, 32, 14, 48, 48, 26], vec![37, 34, 39, 48, 44, 35]));
}

#[test]
fn rewards_are_those_of_the_paper() {
    let mut world = Flappy::new(100).expect("above 0");
    world.reset(5);
    let mut rewards = Vec::new();
    loop {
        let step = world.step(world.oracle_action()).expect("the action exists");
        rewards.push(step.reward);
        if step.status.is_over() {
            assert_eq!((step.status, step.score), (Status::Truncated, 3.0));
            break;
        }
    }
    // Two pixels a step: pairs are around the bird for 22 pixels, and the first begins to be after 34 of them.
    assert_eq!(rewards[..17], [ALIVE; 17]);
    assert_eq!(rewards[17..28], [BETWEEN; 11]);
    assert_eq!(rewards[28], ALIVE);
    world.reset(5);
    let crash = (0..200).find_map(|_| {
        let step = world.step(GLIDE).expect("the action exists");
        step.status.is_over().then_some(step)
    });
    let crash = crash.expect("it falls");
    assert_eq!((crash.reward, crash.score, crash.status), (CRASH, 0.0, Status::Terminated));
}

#[test]
fn states_that_no_episode_has_are_refused() {
    let mut world = Flappy::new(100).expect("above 0");
    world.reset(5);
    world.step(FLAP).expect("the action exists");
    let good = world.save_state();
    let damaged = |at: usize, value: u8| {
        let mut bytes = good.clone();
        let at = bytes.len() - at;
        bytes[at] = value;
        bytes
    };
    // From the end: status, speed, and the four bytes of the height.
    for (bytes, told) in [
        (damaged(1, 7), "status 7"),
        (damaged(1, 1), "a status that fits"),
        (damaged(1, 2), "a number of steps"),
        (damaged(2, 100), "a speed that the bird can have"),
        (damaged(3, 200), "the bird inside the field"),
        (damaged(4, 1), "the bird inside the field"),
    ] {
        let error = world.load_state(&bytes).expect_err("damaged").to_string();
        assert!(error.contains(told), "{error}");
        assert_eq!(world.save_state(), good);
    }
}
