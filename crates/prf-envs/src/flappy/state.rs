//! An episode as bytes.

use super::physics::{Bird, Flight, GROUND, SPEED};
use super::{Game, NAME};
use crate::bytes::Reader;
use crate::{Error, Status};

/// Marks the world and the version of this layout.
const TAG: &[u8] = b"flappy1";

/// The tag alone before the first episode, then what of [`Game`] doesn't follow from the rest.
pub(super) fn save(game: Option<&Game>) -> Vec<u8> {
    let mut bytes = TAG.to_vec();
    let Some(Game { flight: Flight { seed, bird, .. }, steps, status }) = game else { return bytes };
    bytes.extend(seed.to_le_bytes());
    bytes.extend(steps.to_le_bytes());
    bytes.extend((bird.y as u32).to_le_bytes());
    bytes.extend([bird.speed as i8 as u8, *status as u8]);
    bytes
}

/// The episode in `bytes`, if it is one that can be played under `limit_steps`.
pub(super) fn load(bytes: &[u8], limit_steps: u32) -> Result<Option<Game>, Error> {
    let mut reader = Reader::new(NAME, bytes);
    reader.tag(TAG)?;
    if bytes.len() == TAG.len() {
        return Ok(None);
    }
    let (seed, steps, y) = (reader.u64()?, reader.u32()?, reader.u32()?);
    let speed = i32::from(reader.u8()? as i8);
    let status = reader.status()?;
    reader.finish()?;
    let (Some(y), Some(distance)) = (i32::try_from(y).ok(), steps.checked_mul(SPEED as u32)) else {
        return Err(reader.bad("values that no episode has", "the bird inside the field"));
    };
    // Beyond, the pipes' places can't be counted.
    if distance >= i32::MAX as u32 / 2 {
        return Err(reader.bad("values that no episode has", "a distance that can be counted"));
    }
    let game = Game { flight: Flight::new(seed, distance, Bird { y, speed }), steps, status };
    match broken_rule(&game, limit_steps) {
        Some(rule) => Err(reader.bad("values that no episode has", rule)),
        None => Ok(Some(game)),
    }
}

/// A rule that `game` breaks and no episode can.
fn broken_rule(game: &Game, limit_steps: u32) -> Option<&'static str> {
    let Game { flight, steps, status } = game;
    let rules: [(&str, &dyn Fn() -> bool); 4] = [
        ("the bird inside the field", &|| (0..=GROUND).contains(&flight.bird.y)),
        ("a speed that the bird can have", &|| Bird::speeds().contains(&flight.bird.speed)),
        ("a status that fits the bird and the pipes", &|| (*status == Status::Terminated) == flight.has_crashed()),
        ("a number of steps that fits the step limit", &|| match status {
            Status::Running => *steps < limit_steps,
            Status::Terminated => (1..=limit_steps).contains(steps),
            Status::Truncated => *steps == limit_steps,
        }),
    ];
    rules.iter().find(|(_, holds)| !holds()).map(|(rule, _)| *rule)
}
