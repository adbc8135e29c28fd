//! The player that never loses the ball.

use super::physics::{BALL, PADDLE_WIDTH};
use super::{Game, LEFT, RIGHT, STAY};

/// Half the paddle's speed: nearer to its goal than this, a move would only carry it past.
const NEAR_PX: i32 = 1;

/// Moves the paddle's middle to where the ball will come down, which it knows by playing ahead.
pub(super) fn action(game: &Game) -> usize {
    let goal = game.field.landing().x - (PADDLE_WIDTH - BALL) / 2;
    match goal - game.paddle {
        ahead if ahead > NEAR_PX => RIGHT,
        ahead if ahead < -NEAR_PX => LEFT,
        _ => STAY,
    }
}
