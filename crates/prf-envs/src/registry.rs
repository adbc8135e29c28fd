//! The worlds by name.

use crate::breakout::{self, Breakout};
use crate::flappy::{self, Flappy};
use crate::kobian::{self, Expression, Kobian};
use crate::{EnvConfig, Environment, Error};

struct Entry {
    name: &'static str,
    limit_steps: u32,
    make: fn(u32) -> Result<Box<dyn Environment>, Error>,
}

const WORLDS: [Entry; 4] = [
    Entry {
        name: breakout::NAME,
        limit_steps: breakout::LIMIT_STEPS,
        make: |limit_steps| Ok(Box::new(Breakout::new(limit_steps)?)),
    },
    Entry {
        name: flappy::NAME,
        limit_steps: flappy::LIMIT_STEPS,
        make: |limit_steps| Ok(Box::new(Flappy::new(limit_steps)?)),
    },
    Entry {
        name: Expression::Happy.name(),
        limit_steps: kobian::LIMIT_STEPS,
        make: |limit_steps| Ok(Box::new(Kobian::new(Expression::Happy, limit_steps)?)),
    },
    Entry {
        name: Expression::Surprise.name(),
        limit_steps: kobian::LIMIT_STEPS,
        make: |limit_steps| Ok(Box::new(Kobian::new(Expression::Surprise, limit_steps)?)),
    },
];

/// The names of all worlds.
pub fn names() -> impl Iterator<Item = &'static str> {
    WORLDS.iter().map(|world| world.name)
}

/// The world that `config` describes, before its first episode.
///
/// # Errors
/// An unknown name, or a step limit of 0; the keys are `env.name` and `env.limit_steps`.
pub fn make(config: &EnvConfig) -> Result<Box<dyn Environment>, Error> {
    let Some(world) = find(&config.name) else {
        return Err(Error::param("env.name", format!("\"{}\"", config.name), expected_names()));
    };
    (world.make)(config.limit_steps)
}

/// The step limit that the world called `name` has unless told otherwise; `None` if there is no such world.
pub fn default_limit_steps(name: &str) -> Option<u32> {
    find(name).map(|world| world.limit_steps)
}

fn find(name: &str) -> Option<&'static Entry> {
    WORLDS.iter().find(|world| world.name == name)
}

fn expected_names() -> String {
    let quoted: Vec<_> = names().map(|name| format!("\"{name}\"")).collect();
    quoted.join(" or ")
}
