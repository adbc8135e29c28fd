//! The player that never crashes.

use super::physics::{BIRD_HEIGHT, Flight, GAP, PARTS};

/// How far above the lower pipe the bird is kept, in pixels: a flap lifts it by 7.5, and the gap leaves room for that.
const ABOVE_PX: i32 = 4;

/// Flaps where the bird would otherwise come too near to the lower pipe of the next pair.
pub(super) fn flaps(flight: &Flight) -> bool {
    let mut glides = *flight;
    glides.step(false);
    let lowest = (flight.next().gap + GAP - BIRD_HEIGHT - ABOVE_PX) * PARTS;
    glides.bird.y > lowest
}
