//! An episode as bytes.

use super::physics::{BALL_MAX_X, BALL_MAX_Y, Ball, Field, PADDLE_MAX_X, SIDE_SPEEDS, Wall};
use super::{Game, NAME};
use crate::bytes::Reader;
use crate::{Error, Status};

/// Marks the world and the version of this layout.
const TAG: &[u8] = b"breakout1";

/// The tag alone before the first episode, then every field of [`Game`].
pub(super) fn save(game: Option<&Game>) -> Vec<u8> {
    let mut bytes = TAG.to_vec();
    let Some(game) = game else { return bytes };
    let Ball { x, y, side_speed, heading } = game.field.ball;
    bytes.extend(game.seed.to_le_bytes());
    bytes.extend(game.steps.to_le_bytes());
    bytes.extend(game.bounces.to_le_bytes());
    bytes.extend(game.field.wall.0.to_le_bytes());
    bytes.extend([game.paddle, x, y].map(|position| position as u8));
    bytes.extend([side_speed, heading].map(|speed| speed as i8 as u8));
    bytes.push(game.status as u8);
    bytes
}

/// The episode in `bytes`, if it is one that can be played under `limit_steps`.
pub(super) fn load(bytes: &[u8], limit_steps: u32) -> Result<Option<Game>, Error> {
    let mut reader = Reader::new(NAME, bytes);
    reader.tag(TAG)?;
    if bytes.len() == TAG.len() {
        return Ok(None);
    }
    let seed = reader.u64()?;
    let steps = reader.u32()?;
    let bounces = reader.u32()?;
    let wall = Wall(reader.u64()?);
    let [paddle, x, y] = reader.array()?.map(|position: u8| i32::from(position));
    let [side_speed, heading] = reader.array()?.map(|speed: u8| i32::from(speed as i8));
    let status = reader.status()?;
    reader.finish()?;
    let ball = Ball { x, y, side_speed, heading };
    let game = Game { seed, steps, bounces, paddle, field: Field { wall, ball }, status };
    match broken_rule(&game, limit_steps) {
        Some(rule) => Err(reader.bad("values that no episode has", rule)),
        None => Ok(Some(game)),
    }
}

/// A rule that `game` breaks and no episode can.
pub(super) fn broken_rule(game: &Game, limit_steps: u32) -> Option<&'static str> {
    let Field { wall, ball } = game.field;
    let lost = ball.y == BALL_MAX_Y + 1;
    let corners = || (0..4).map(|corner| (ball.x + corner % 2, ball.y + corner / 2));
    // In this order: the later rules are only meaningful, and safe to compute, if the earlier ones hold.
    let rules: [(&str, &dyn Fn() -> bool); 8] = [
        ("at most 60 bricks", &|| wall.0 & !Wall::FULL.0 == 0),
        ("the paddle inside the field", &|| (0..=PADDLE_MAX_X).contains(&game.paddle)),
        ("the ball inside the field", &|| (0..=BALL_MAX_X).contains(&ball.x) && (0..=BALL_MAX_Y + 1).contains(&ball.y)),
        ("a speed that the ball can have", &|| {
            SIDE_SPEEDS.contains(&ball.side_speed) && [-1, 1].contains(&ball.heading)
        }),
        ("the ball outside the bricks", &|| !corners().any(|(x, y)| wall.covers(x, y))),
        ("at most one bounce a step", &|| game.bounces <= game.steps),
        ("a status that fits the ball and the wall", &|| {
            (game.status == Status::Terminated) == (lost || wall.is_cleared())
        }),
        ("a number of steps that fits the step limit", &|| match game.status {
            Status::Running => game.steps < limit_steps,
            Status::Terminated => (1..=limit_steps).contains(&game.steps),
            Status::Truncated => game.steps == limit_steps,
        }),
    ];
    rules.iter().find(|(_, holds)| !holds()).map(|(rule, _)| *rule)
}
