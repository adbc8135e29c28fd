//! Breakout: a paddle, a ball and a wall of bricks. `docs/worlds/breakout.md` describes it for users.
//!
//! Nobody can aim: the side speed after a bounce is drawn from a stream of the episode's seed, so the ball's path does
//! not depend on the player as long as the ball is not lost. Every player who never misses has exactly the same
//! score, the optimum, and any other score says how long the ball was kept.

mod draw;
mod oracle;
mod physics;
mod state;
#[cfg(test)]
mod tests;

use prf_core::FrameMut;

use self::physics::{Ball, Field, Outcome, PADDLE_MAX_X, PADDLE_SPEED, SIDE_SPEEDS, Wall};
use crate::rng::{below, stream};
use crate::{Environment, Error, Spec, Status, Step};

/// The name in a config.
pub const NAME: &str = "breakout";
/// Steps of an episode unless the config says otherwise: the paper's (section IV).
pub const LIMIT_STEPS: u32 = 100;
/// Bricks of the whole wall, and so the largest score.
pub const BRICKS: u32 = Wall::BRICKS;

pub(crate) const STAY: usize = 0;
const LEFT: usize = 1;
const RIGHT: usize = 2;
const ACTIONS: [&str; 3] = ["stay", "left", "right"];

/// The highest row of the ball's top at the start: a little below the wall.
const LAUNCH_TOP: i32 = physics::WALL_BOTTOM + 3;
/// How many rows it may be in; from the lowest, the ball takes 10 steps to come down.
const LAUNCH_ROWS: usize = 16;
/// Steps that the paddle may idle away at the start. The first picture doesn't show where the ball is going; a
/// player who has only pictures to go by needs a few to see it.
const SLACK_STEPS: i32 = 6;

/// The world Breakout.
#[derive(Clone, Debug)]
pub struct Breakout {
    spec: Spec,
    game: Option<Game>,
}

/// An episode.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Game {
    seed: u64,
    steps: u32,
    bounces: u32,
    /// The paddle's left column.
    paddle: i32,
    field: Field,
    status: Status,
}

impl Breakout {
    /// A world whose episodes are truncated after `limit_steps` steps.
    ///
    /// # Errors
    /// `limit_steps` is 0.
    pub fn new(limit_steps: u32) -> Result<Breakout, Error> {
        if limit_steps == 0 {
            return Err(Error::param("env.limit_steps", "0", "at least 1"));
        }
        let spec = Spec {
            name: NAME,
            width: physics::FIELD as usize,
            height: physics::FIELD as usize,
            actions: &ACTIONS,
            limit_steps,
            chance: true,
        };
        // Drawn now, no step has to wait for it.
        draw::whole_wall();
        Ok(Breakout { spec, game: None })
    }
}

impl Environment for Breakout {
    fn spec(&self) -> &Spec {
        &self.spec
    }

    fn reset(&mut self, seed: u64) {
        self.game = Some(Game::launch(seed));
    }

    fn step(&mut self, action: usize) -> Result<Step, Error> {
        if action >= ACTIONS.len() {
            return Err(Error::UnknownAction { world: NAME, got: action, last: ACTIONS.len() - 1 });
        }
        let game = self.game.as_mut().ok_or(Error::NotReset { world: NAME })?;
        if game.status.is_over() {
            return Err(Error::EpisodeOver { world: NAME });
        }
        Ok(game.step(action, self.spec.limit_steps))
    }

    fn draw(&self, frame: &mut FrameMut<'_>) {
        match &self.game {
            Some(game) => draw::draw(game, frame),
            None => frame.fill(0),
        }
    }

    fn save_state(&self) -> Vec<u8> {
        state::save(self.game.as_ref())
    }

    fn load_state(&mut self, bytes: &[u8]) -> Result<(), Error> {
        self.game = state::load(bytes, self.spec.limit_steps)?;
        Ok(())
    }

    fn oracle_action(&self) -> usize {
        self.game.as_ref().map_or(STAY, oracle::action)
    }
}

impl Game {
    /// The start that belongs to `seed`: the ball comes down from somewhere below the wall, and the paddle is
    /// somewhere from where it can be there in time with [`SLACK_STEPS`] to spare.
    fn launch(seed: u64) -> Game {
        let mut rng = stream(seed, "breakout-launch", 0);
        let mut draw = |n: usize| below(&mut rng, n) as i32;
        let ball = Ball {
            x: draw(physics::BALL_MAX_X as usize + 1),
            y: LAUNCH_TOP + draw(LAUNCH_ROWS),
            side_speed: SIDE_SPEEDS[draw(SIDE_SPEEDS.len()) as usize],
            heading: 1,
        };
        let field = Field { wall: Wall::FULL, ball };
        let landing = field.landing();
        let reach = PADDLE_SPEED * (landing.steps - SLACK_STEPS);
        let first = (landing.x - physics::PADDLE_WIDTH + 1 - reach).max(0);
        let last = (landing.x + physics::BALL - 1 + reach).min(PADDLE_MAX_X);
        let paddle = first + draw((last - first + 1) as usize);
        Game { seed, steps: 0, bounces: 0, paddle, field, status: Status::Running }
    }

    fn step(&mut self, action: usize, limit_steps: u32) -> Step {
        let removed_before = self.field.wall.removed();
        self.move_paddle(action);
        let outcome = self.move_ball();
        self.steps += 1;
        self.status = match outcome {
            Outcome::Lost | Outcome::Cleared => Status::Terminated,
            Outcome::InPlay if self.steps >= limit_steps => Status::Truncated,
            Outcome::InPlay => Status::Running,
        };
        let removed = self.field.wall.removed();
        Step { reward: (removed - removed_before) as f32, score: removed as f32, status: self.status }
    }

    fn move_paddle(&mut self, action: usize) {
        let shift = match action {
            LEFT => -PADDLE_SPEED,
            RIGHT => PADDLE_SPEED,
            _ => 0,
        };
        self.paddle = (self.paddle + shift).clamp(0, PADDLE_MAX_X);
    }

    fn move_ball(&mut self) -> Outcome {
        let Game { seed, bounces, paddle, field, .. } = self;
        field.step(|ball_x| {
            physics::touches(*paddle, ball_x).then(|| {
                *bounces += 1;
                bounced_speed(*seed, *bounces)
            })
        })
    }
}

/// The side speed after the episode's `bounce`-th bounce from the paddle, counted from 1.
///
/// Each bounce has a stream of its own, so a saved state needs no position within one.
fn bounced_speed(seed: u64, bounce: u32) -> i32 {
    let mut rng = stream(seed, "breakout-bounce", u64::from(bounce));
    SIDE_SPEEDS[below(&mut rng, SIDE_SPEEDS.len())]
}
