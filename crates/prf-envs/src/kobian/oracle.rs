//! The player that knows the target.

use super::face::{Face, MOVEMENTS};

/// The movement that is farthest from the target, the first of equals, and whether it has to go up; none when the target is reached. So all
/// movements come along together, as a person's do.
pub(super) fn next(face: Face, target: Face) -> Option<(usize, bool)> {
    let (here, there) = (face.levels(), target.levels());
    let missing = |movement: usize| there[movement] - here[movement];
    let farthest = (0..MOVEMENTS).rev().max_by_key(|&movement| missing(movement).abs())?;
    (missing(farthest) != 0).then(|| (farthest, missing(farthest) > 0))
}
