//! Flappy Bird: a bird, gravity and pipes. `docs/worlds/flappy.md` describes it for users.
//!
//! All is whole numbers, heights in quarters of a pixel, so an episode is the same on every machine.

mod draw;
mod oracle;
mod physics;
mod state;
#[cfg(test)]
mod tests;

use prf_core::{FrameMut, Label};

use self::physics::{Bird, Flight};
use crate::{Environment, Error, Spec, Status, Step};

/// The name in a config.
pub const NAME: &str = "flappy";
/// Steps of an episode unless the config says otherwise: the paper's (section IV).
pub const LIMIT_STEPS: u32 = 5_000;

pub(crate) const GLIDE: usize = 0;
const FLAP: usize = 1;
const ACTIONS: [&str; 2] = ["glide", "flap"];

/// The variable reward of a step between two pipes, of any other, and of the crash.
const BETWEEN: f32 = 1.0;
const ALIVE: f32 = 0.1;
const CRASH: f32 = -1.0;

/// The world Flappy Bird.
#[derive(Clone, Debug)]
pub struct Flappy {
    spec: Spec,
    game: Option<Game>,
}

/// An episode.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Game {
    flight: Flight,
    steps: u32,
    status: Status,
}

impl Flappy {
    /// A world whose episodes are truncated after `limit_steps` steps.
    ///
    /// # Errors
    /// `limit_steps` is 0.
    pub fn new(limit_steps: u32) -> Result<Flappy, Error> {
        if limit_steps == 0 {
            return Err(Error::param("env.limit_steps", "0", "at least 1"));
        }
        let side = physics::FIELD as usize;
        Ok(Flappy {
            spec: Spec { name: NAME, width: side, height: side, actions: &ACTIONS, limit_steps, chance: true },
            game: None,
        })
    }
}

impl Environment for Flappy {
    fn spec(&self) -> &Spec {
        &self.spec
    }

    fn reset(&mut self, seed: u64) {
        let flight = Flight::new(seed, 0, Bird::start(seed));
        self.game = Some(Game { flight, steps: 0, status: Status::Running });
    }

    fn step(&mut self, action: usize) -> Result<Step, Error> {
        if action >= ACTIONS.len() {
            return Err(Error::UnknownAction { world: NAME, got: action, last: ACTIONS.len() - 1 });
        }
        let game = self.game.as_mut().ok_or(Error::NotReset { world: NAME })?;
        if game.status.is_over() {
            return Err(Error::EpisodeOver { world: NAME });
        }
        Ok(game.step(action == FLAP, self.spec.limit_steps))
    }

    fn draw(&self, frame: &mut FrameMut<'_>) {
        match &self.game {
            Some(game) => draw::draw(&game.flight, frame),
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
        self.game.as_ref().map_or(GLIDE, |game| if oracle::flaps(&game.flight) { FLAP } else { GLIDE })
    }

    /// A success is to be between two pipes; the score is how near the bird is to the middle of their gap, in pixels below 0, while
    /// their sides are around it.
    fn label(&self, _: f32) -> Label {
        let flight = self.game.as_ref().map(|game| &game.flight);
        Label {
            score: flight.and_then(Flight::off_middle).map(|off| -off),
            success: flight.map(Flight::is_between_pipes),
        }
    }
}

impl Game {
    fn step(&mut self, flaps: bool, limit_steps: u32) -> Step {
        self.flight.step(flaps);
        self.steps += 1;
        let has_crashed = self.flight.has_crashed();
        self.status = match has_crashed {
            true => Status::Terminated,
            false if self.steps >= limit_steps => Status::Truncated,
            false => Status::Running,
        };
        let reward = match has_crashed {
            true => CRASH,
            false if self.flight.is_between_pipes() => BETWEEN,
            false => ALIVE,
        };
        Step { reward, score: self.flight.passed() as f32, status: self.status }
    }
}
