//! The worlds by name.

use crate::breakout::{self, Breakout};
use crate::flappy::{self, Flappy};
use crate::kobian::{self, Expression, Kobian};
use crate::{Controls, EnvConfig, Environment, Error, Pace};

struct Entry {
    name: &'static str,
    summary: &'static str,
    page: &'static str,
    controls: Controls,
    limit_steps: u32,
    make: fn(&EnvConfig) -> Result<Box<dyn Environment>, Error>,
}

const WORLDS: [Entry; 4] = [
    Entry {
        name: breakout::NAME,
        summary: "a paddle keeps a ball in play that breaks bricks out of a wall",
        page: "docs/worlds/breakout.md",
        controls: Controls { pace: Pace::Held, idle_action: breakout::STAY },
        limit_steps: breakout::LIMIT_STEPS,
        make: |config| Ok(Box::new(Breakout::new(never_solved(config)?)?)),
    },
    Entry {
        name: flappy::NAME,
        summary: "a bird falls, flaps and has to fly through the gaps between pipes",
        page: "docs/worlds/flappy.md",
        controls: Controls { pace: Pace::Impulses, idle_action: flappy::GLIDE },
        limit_steps: flappy::LIMIT_STEPS,
        make: |config| Ok(Box::new(Flappy::new(never_solved(config)?)?)),
    },
    Entry {
        name: Expression::Happy.name(),
        summary: "a robot's face is to smile; its brows and its mouth move",
        page: "docs/worlds/kobian.md",
        controls: Controls { pace: Pace::TurnBased, idle_action: kobian::REST },
        limit_steps: kobian::LIMIT_STEPS,
        make: |config| face(Expression::Happy, config),
    },
    Entry {
        name: Expression::Surprise.name(),
        summary: "a robot's face is to look surprised; its brows and its mouth move",
        page: "docs/worlds/kobian.md",
        controls: Controls { pace: Pace::TurnBased, idle_action: kobian::REST },
        limit_steps: kobian::LIMIT_STEPS,
        make: |config| face(Expression::Surprise, config),
    },
];

/// The step limit of a world whose episodes never end by success.
fn never_solved(config: &EnvConfig) -> Result<u32, Error> {
    match config.solved_within {
        None => Ok(config.limit_steps),
        Some(actions) => {
            let expected = format!("nothing, because \"{}\" has no end by success: remove it", config.name);
            Err(Error::param("env.solved_within", actions.to_string(), expected))
        }
    }
}

fn face(expression: Expression, config: &EnvConfig) -> Result<Box<dyn Environment>, Error> {
    let world = Kobian::new(expression, config.limit_steps)?;
    Ok(Box::new(match config.solved_within {
        None => world,
        Some(actions) => world.solved_within(actions)?,
    }))
}

/// The names of all worlds.
pub fn names() -> impl Iterator<Item = &'static str> {
    WORLDS.iter().map(|world| world.name)
}

/// The world that `config` describes, before its first episode.
///
/// # Errors
/// An unknown name, a step limit of 0, or a success that this world doesn't have or begins with; the keys are `env.name`,
/// `env.limit_steps` and `env.solved_within`.
pub fn make(config: &EnvConfig) -> Result<Box<dyn Environment>, Error> {
    let Some(world) = find(&config.name) else {
        return Err(Error::param("env.name", format!("\"{}\"", config.name), expected_names()));
    };
    (world.make)(config)
}

/// The step limit that the world called `name` has unless told otherwise; `None` if there is no such world.
pub fn default_limit_steps(name: &str) -> Option<u32> {
    find(name).map(|world| world.limit_steps)
}

/// What there is to do in the world called `name`, in a line; `None` if there is no such world.
pub fn summary(name: &str) -> Option<&'static str> {
    find(name).map(|world| world.summary)
}

/// Where the world called `name` is described, a path in this repository; `None` if there is no such world.
pub fn page(name: &str) -> Option<&'static str> {
    find(name).map(|world| world.page)
}

/// How a person plays the world called `name`; `None` if there is no such world.
pub fn controls(name: &str) -> Option<Controls> {
    find(name).map(|world| world.controls)
}

fn find(name: &str) -> Option<&'static Entry> {
    WORLDS.iter().find(|world| world.name == name)
}

fn expected_names() -> String {
    let quoted: Vec<_> = names().map(|name| format!("\"{name}\"")).collect();
    quoted.join(" or ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_world_can_be_told_of_and_played() {
        for world in &WORLDS {
            let spec = *make(&EnvConfig::new(world.name)).expect("the registry has it").spec();
            assert_eq!(spec.name, world.name);
            assert!(world.controls.idle_action < spec.actions.len(), "{}", world.name);
            let is_sentence = |line: &str| !line.is_empty() && line.len() <= 80 && !line.ends_with('.');
            assert!(is_sentence(world.summary) && !world.summary.contains('\n'), "{}", world.name);
            let page = concat!(env!("CARGO_MANIFEST_DIR"), "/../../").to_owned() + world.page;
            assert!(std::path::Path::new(&page).is_file(), "{page}");
        }
    }
}
