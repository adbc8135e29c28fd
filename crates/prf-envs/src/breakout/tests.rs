//! Cases worked out by hand, and what must hold whatever is played.

use prf_core::Frame;
use proptest::prelude::*;

use super::physics::{Landing, touches};
use super::*;

fn field(x: i32, y: i32, side_speed: i32, heading: i32) -> Field {
    Field { wall: Wall::FULL, ball: Ball { x, y, side_speed, heading } }
}

/// A wall without the brick at (column, row).
fn wall_without(column: i32, row: i32) -> Wall {
    Wall(Wall::FULL.0 & !(1 << (row * physics::COLUMNS + column)))
}

/// One step with no paddle anywhere.
fn step(mut field: Field) -> (Field, Outcome) {
    let outcome = field.step(|_| None);
    (field, outcome)
}

#[test]
fn the_ball_moves_three_pixels_down_and_its_side_speed_to_the_side() {
    for side_speed in SIDE_SPEEDS {
        let (after, outcome) = step(field(40, 50, side_speed, 1));
        assert_eq!((after, outcome), (field(40 + side_speed, 53, side_speed, 1), Outcome::InPlay));
    }
}

#[test]
fn the_sides_reflect() {
    // One pixel to the wall at x = 83, the second pixel is spent on turning round.
    assert_eq!(step(field(81, 50, 2, 1)).0, field(82, 53, -2, 1));
    assert_eq!(step(field(1, 50, -2, -1)).0, field(0, 47, 2, -1));
    assert_eq!(step(field(82, 50, 1, 1)).0, field(82, 53, -1, 1));
}

#[test]
fn the_ceiling_reflects() {
    // Up to row 0, turn round, down again.
    assert_eq!(step(field(40, 1, 1, -1)).0, field(41, 1, 1, 1));
}

#[test]
fn a_brick_hit_from_below_vanishes_and_reflects() {
    // Cell (4, 4) is x 28..35, y 28..33. The ball's top row reaches 33 and then finds row 32 taken.
    let (after, outcome) = step(field(30, 34, 1, -1));
    assert_eq!(outcome, Outcome::InPlay);
    assert_eq!(after, Field { wall: wall_without(4, 4), ..field(31, 34, 1, 1) });
}

#[test]
fn a_ball_under_two_bricks_takes_the_one_ahead_of_it() {
    // Columns 34 and 35 lie under cells 4 and 5. Both speeds move sideways only after the second pixel up.
    let (after, _) = step(field(34, 33, 1, -1));
    assert_eq!(after.wall, wall_without(5, 4));
    let (after, _) = step(field(34, 33, -1, -1));
    assert_eq!(after.wall, wall_without(4, 4));
    // If the one ahead is gone, the other is taken.
    let (after, _) = step(Field { wall: wall_without(5, 4), ..field(34, 33, 1, -1) });
    assert_eq!(after.wall, Wall(wall_without(5, 4).0 & wall_without(4, 4).0));
}

#[test]
fn a_brick_hit_from_the_side_reflects_sideways() {
    // In the shaft of column 0 (x 0..7): the brick (1, 4) begins at x = 7, y 28..33.
    let shaft = (0..physics::ROWS).fold(Wall::FULL, |wall, row| Wall(wall.0 & wall_without(0, row).0));
    let (after, _) = step(Field { wall: shaft, ..field(4, 34, 2, -1) });
    // Up to 33, right to 5; up to 32; up to 31, and the way to the right is blocked.
    assert_eq!(after, Field { wall: Wall(shaft.0 & wall_without(1, 4).0), ..field(5, 31, -2, -1) });
}

#[test]
fn the_gap_belongs_to_its_brick() {
    // x = 6 is the gap right of the first brick: drawn black, but no way through.
    for x in 0..=physics::BALL_MAX_X {
        let (after, _) = step(field(x, 33, 1, -1));
        assert_eq!((after.wall.removed(), after.ball.heading), (1, 1), "column {x}");
    }
}

#[test]
fn the_paddle_reflects_with_a_new_side_speed() {
    let mut field = field(40, 77, 1, 1);
    let mut asked = Vec::new();
    let outcome = field.step(|x| {
        asked.push(x);
        Some(-2)
    });
    // Down to 78 and 79 (where speed 1 moves sideways, in the second third), then caught; -2 moves in the last third.
    assert_eq!((asked, outcome), (vec![41], Outcome::InPlay));
    assert_eq!(field.ball, Ball { x: 40, y: 79, side_speed: -2, heading: -1 });
}

#[test]
fn a_ball_that_is_not_caught_is_lost() {
    let (after, outcome) = step(field(40, 79, 1, 1));
    assert_eq!((after.ball.y, outcome), (80, Outcome::Lost));
}

#[test]
fn the_paddle_catches_with_every_pixel_of_its_width() {
    let caught: Vec<_> = (0..84).filter(|&x| touches(30, x)).collect();
    assert_eq!(caught, (29..=43).collect::<Vec<_>>());
}

#[test]
fn the_last_brick_clears_the_wall() {
    let last = Wall(Wall::FULL.0 & !wall_without(4, 4).0);
    let (after, outcome) = step(Field { wall: last, ..field(30, 34, 1, -1) });
    assert_eq!((after.wall.removed(), outcome), (BRICKS, Outcome::Cleared));
}

#[test]
fn a_landing_is_where_and_when_the_ball_is_lost() {
    // 30 px down, of which one is spent on passing the paddle's height: the tenth step.
    assert_eq!(field(10, 50, 2, 1).landing(), Landing { x: 29, steps: 10 });
}

#[test]
fn the_paddle_stops_at_the_sides() {
    let mut game = Game::launch(0);
    for (action, edge) in [(LEFT, 0), (RIGHT, PADDLE_MAX_X)] {
        for _ in 0..40 {
            game.move_paddle(action);
        }
        assert_eq!(game.paddle, edge);
    }
    game.paddle = 10;
    game.move_paddle(STAY);
    assert_eq!(game.paddle, 10);
    game.move_paddle(LEFT);
    assert_eq!(game.paddle, 7);
}

#[test]
fn losing_and_clearing_terminate_even_at_the_step_limit() {
    let mut game = Game { paddle: 0, field: field(60, 79, 1, 1), ..Game::launch(0) };
    assert_eq!(game.step(STAY, 1), Step { reward: 0.0, score: 0.0, status: Status::Terminated });
    let last = Wall(Wall::FULL.0 & !wall_without(4, 4).0);
    let mut game = Game { field: Field { wall: last, ..field(30, 34, 1, -1) }, ..Game::launch(0) };
    assert_eq!(game.step(STAY, 1), Step { reward: 1.0, score: 60.0, status: Status::Terminated });
}

#[test]
fn every_start_can_be_caught_by_a_player_who_looks_first() {
    for seed in 0..20_000 {
        let game = Game::launch(seed);
        let landing = game.field.landing();
        assert!((10..=15).contains(&landing.steps), "seed {seed}: {landing:?}");
        assert!((0..=PADDLE_MAX_X).contains(&game.paddle));
        let reached = |push: i32| (game.paddle + push * PADDLE_SPEED).clamp(0, PADDLE_MAX_X);
        let left = landing.steps - SLACK_STEPS;
        let caught = (-left..=left).any(|push| touches(reached(push), landing.x));
        assert!(caught, "seed {seed}: {game:?}");
    }
}

#[test]
fn the_numbers_behind_a_seed_stay() {
    let game = Game::launch(7);
    assert_eq!((game.paddle, game.field.ball), GOLDEN_LAUNCH);
    let speeds: Vec<_> = (1..=12).map(|bounce| bounced_speed(7, bounce)).collect();
    assert_eq!(speeds, GOLDEN_SPEEDS);
}

const GOLDEN_LAUNCH: (i32, Ball) = (61, Ball { x: 41, y: 37, side_speed: 1, heading: 1 });
const GOLDEN_SPEEDS: [i32; 12] = [-1, -1, 2, -2, 2, -1, 1, -1, -1, 1, -2, -2];

#[test]
fn bounces_draw_every_speed_equally_often() {
    let mut counts = [0; 4];
    for seed in 0..1_000 {
        for bounce in 1..=4 {
            let speed = bounced_speed(seed, bounce);
            counts[SIDE_SPEEDS.iter().position(|&s| s == speed).expect("it is one of them")] += 1;
        }
    }
    assert!(counts.iter().all(|count| (880..1120).contains(count)), "{counts:?}");
}

#[test]
fn the_picture_at_its_own_size_is_exact() {
    let mut frame = Frame::new(84, 84);
    let game = Game { paddle: 20, field: field(40, 50, 1, 1), ..Game::launch(0) };
    draw::draw(&game, &mut frame.view_mut());
    let ascii = |y: usize| frame.row(y).iter().map(|grey| char::from(b'.' + u8::from(*grey > 0))).collect::<String>();
    let bricks = ["//////.".repeat(6), ".//////".repeat(6)].concat();
    assert_eq!((ascii(7), ascii(8), ascii(12)), (".".repeat(84), bricks.clone(), ".".repeat(84)));
    assert_eq!((ascii(31), ascii(32), ascii(33)), (bricks, ".".repeat(84), ".".repeat(84)));
    assert_eq!((frame.row(8)[0], frame.row(31)[83]), (200, 120));
    let ball = (0..84).flat_map(|y| (0..84).map(move |x| (x, y))).filter(|&(x, y)| frame.row(y)[x] == 255);
    assert_eq!(ball.collect::<Vec<_>>(), [(40, 50), (41, 50), (40, 51), (41, 51)]);
    for y in 81..84 {
        assert_eq!(ascii(y), [".".repeat(20), "/".repeat(14), ".".repeat(50)].concat());
    }
    assert!(frame.row(80).iter().all(|&grey| grey == 0));
}

#[test]
fn a_multiple_of_the_size_repeats_each_pixel() {
    // The whole wall, one with a few bricks missing, and one with most of them.
    for wall in [Wall::FULL, Wall(Wall::FULL.0 & !0x8021), Wall(0x8021)] {
        let launch = Game::launch(3);
        let game = Game { field: Field { wall, ..launch.field }, ..launch };
        let (mut small, mut large) = (Frame::new(84, 84), Frame::new(84 * 3, 84 * 2));
        draw::draw(&game, &mut small.view_mut());
        draw::draw(&game, &mut large.view_mut());
        for y in 0..large.height() {
            let wide: Vec<_> = small.row(y / 2).iter().flat_map(|&grey| [grey; 3]).collect();
            assert_eq!(large.row(y), wide, "row {y}");
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(128) })]

    #[test]
    fn whatever_is_played_the_rules_hold(seed: u64, follow in 0..4u8, actions in prop::collection::vec(0..3usize, 1..400)) {
        let mut world = Breakout::new(400)?;
        world.reset(seed);
        let mut total = 0.0;
        for (count, action) in actions.into_iter().enumerate() {
            let before = world.game.expect("it was reset");
            // Some players are good enough to come far.
            let action = if count % 4 < usize::from(follow) { world.oracle_action() } else { action };
            let step = world.step(action)?;
            let game = world.game.expect("it was reset");
            total += step.reward;
            prop_assert_eq!(game.field.wall.0 & !before.field.wall.0, 0, "a brick came back");
            prop_assert_eq!(step.score, (BRICKS - game.field.wall.0.count_ones()) as f32);
            prop_assert_eq!(step.score, total);
            let lost = step.status == Status::Terminated;
            prop_assert!(state::broken_rule(&game, 400).is_none(), "{:?}", game);
            prop_assert_eq!(game.field.ball.y > physics::BALL_MAX_Y, lost);
            if step.status.is_over() {
                break;
            }
        }
    }

    #[test]
    fn any_bytes_load_safely(mut bytes in prop::collection::vec(any::<u8>(), 34), tagged in 0..8, actions in prop::collection::vec(0..3usize, 50)) {
        if tagged > 0 {
            bytes.splice(0..0, *b"breakout1");
        }
        play_if_loaded(&bytes, &actions);
    }

    #[test]
    fn states_with_a_few_wrong_bytes_load_safely(
        seed: u64,
        wrong in prop::collection::vec((9..43usize, any::<u8>()), 0..3),
        actions in prop::collection::vec(0..3usize, 150),
    ) {
        let mut world = Breakout::new(100)?;
        world.reset(seed);
        let mut bytes = world.save_state();
        for (at, byte) in wrong {
            let at = at.min(bytes.len() - 1);
            bytes[at] = byte;
        }
        play_if_loaded(&bytes, &actions);
    }
}

/// Whatever could be loaded can also be played, drawn and saved.
fn play_if_loaded(bytes: &[u8], actions: &[usize]) {
    let mut world = Breakout::new(100).expect("the limit is not 0");
    if world.load_state(bytes).is_err() {
        return;
    }
    let mut frame = Frame::new(50, 50);
    for &action in actions {
        world.oracle_action();
        world.draw_into(&mut frame);
        if world.step(action).map_or(true, |step| step.status.is_over()) {
            break;
        }
    }
    let saved = world.save_state();
    world.load_state(&saved).expect("what was saved loads");
}
