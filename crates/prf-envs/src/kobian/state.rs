//! An episode as bytes.

use super::face::{Face, MOVEMENTS};
use super::{Episode, Expression, Kobian};
use crate::bytes::Reader;
use crate::{Error, Status};

/// Marks the world and the version of this layout; the target's letter follows.
const TAG: &[u8] = b"kobian1";

/// The tag alone before the first episode.
pub(super) fn save(expression: Expression, episode: Option<&Episode>) -> Vec<u8> {
    let mut bytes = tag(expression);
    let Some(Episode { face, steps, status }) = episode else { return bytes };
    bytes.extend(steps.to_le_bytes());
    bytes.extend(face.levels().map(|level| level as u8));
    bytes.push(*status as u8);
    bytes
}

/// The episode in `bytes`, if it is one that can be played in `world`.
pub(super) fn load(world: &Kobian, bytes: &[u8]) -> Result<Option<Episode>, Error> {
    let (expression, limit_steps) = (world.expression, world.spec.limit_steps);
    let mut reader = Reader::new(expression.name(), bytes);
    let tag = tag(expression);
    reader.tag(&tag)?;
    if bytes.len() == tag.len() {
        return Ok(None);
    }
    let steps = reader.u32()?;
    let levels: [u8; MOVEMENTS] = reader.array()?;
    let status = reader.status()?;
    reader.finish()?;
    let face = Face::new(levels.map(|level| level as i8))
        .ok_or_else(|| reader.bad("levels that no face has", "each movement within its range"))?;
    if u64::from(steps) < u64::from(face.actions_to(Face::default())) {
        return Err(reader.bad(format!("{steps} steps"), "as many as the face has moved"));
    }
    let fits = match status {
        Status::Terminated => steps <= limit_steps && world.is_solved(face),
        Status::Running => steps < limit_steps && !world.is_solved(face),
        Status::Truncated => steps == limit_steps && !world.is_solved(face),
    };
    if !fits {
        let got = format!("{steps} steps, {status:?}");
        return Err(reader.bad(got, format!("a status that fits the face and {limit_steps} steps")));
    }
    Ok(Some(Episode { face, steps, status }))
}

fn tag(expression: Expression) -> Vec<u8> {
    let letter = match expression {
        Expression::Happy => b'h',
        Expression::Surprise => b's',
    };
    [TAG, &[letter]].concat()
}
