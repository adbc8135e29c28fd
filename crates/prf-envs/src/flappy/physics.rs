//! How the bird flies and where the pipes are, in whole numbers.

use crate::rng::{below, stream};

/// Side of the square field, in pixels.
pub(super) const FIELD: i32 = 84;
/// Parts of a pixel that heights and speeds are counted in.
pub(super) const PARTS: i32 = 4;
/// The bird's left column, and its sides in pixels.
pub(super) const BIRD_X: i32 = 20;
pub(super) const BIRD_WIDTH: i32 = 7;
pub(super) const BIRD_HEIGHT: i32 = 6;
/// Sides of a pipe, in pixels; the lip is wider by one on both sides.
pub(super) const PIPE_WIDTH: i32 = 14;
pub(super) const LIP_HEIGHT: i32 = 3;
/// Height of the gap between two pipes, in pixels.
pub(super) const GAP: i32 = 26;
/// The least height of a pipe, in pixels.
const PIPE_LEAST: i32 = 8;
/// From one pair of pipes to the next, and from the start to the first one's place, in pixels.
pub(super) const SPACING: i32 = 60;
pub(super) const FIRST_X: i32 = 62;
/// Pixels that the pipes come nearer in a step.
pub(super) const SPEED: i32 = 2;
/// What a step adds to the bird's speed, the speed of a flap and the fastest fall, in parts of a pixel a step.
const GRAVITY: i32 = 2;
const FLAP: i32 = -10;
const FASTEST: i32 = 14;
/// The bird's lowest place, where it lies on the ground, in parts of a pixel.
pub(super) const GROUND: i32 = (FIELD - BIRD_HEIGHT) * PARTS;
/// How far from the middle it may start, in pixels.
const START_ASIDE: i32 = 12;

/// The bird's height and speed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Bird {
    /// Its upper edge, in parts of a pixel.
    pub(super) y: i32,
    /// Downwards, in parts of a pixel a step.
    pub(super) speed: i32,
}

impl Bird {
    /// Somewhere around the middle, without speed.
    pub(super) fn start(seed: u64) -> Bird {
        let mut rng = stream(seed, "flappy-start", 0);
        let aside = below(&mut rng, 2 * START_ASIDE as usize + 1) as i32 - START_ASIDE;
        Bird { y: ((FIELD - BIRD_HEIGHT) / 2 + aside) * PARTS, speed: 0 }
    }

    /// Falls for a step, after a flap if it flaps. The ceiling stops it, and so does the ground.
    fn step(&mut self, flaps: bool) {
        self.speed = if flaps { FLAP } else { (self.speed + GRAVITY).min(FASTEST) };
        self.y += self.speed;
        if self.y < 0 {
            *self = Bird { y: 0, speed: 0 };
        }
        self.y = self.y.min(GROUND);
    }

    /// The row of its upper edge, in whole pixels: where it is drawn, and where it touches things.
    pub(super) fn top(self) -> i32 {
        self.y / PARTS
    }

    pub(super) fn speeds() -> std::ops::RangeInclusive<i32> {
        FLAP..=FASTEST
    }
}

/// A pair of pipes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Pipes {
    /// The left column of both, left of the field for those that have gone by.
    pub(super) x: i32,
    /// The first row of the gap.
    pub(super) gap: i32,
}

impl Pipes {
    /// Whether some of the bird is between the pipes' sides, lips included.
    pub(super) fn are_around_bird(self) -> bool {
        self.x - 1 < BIRD_X + BIRD_WIDTH && BIRD_X < self.x + PIPE_WIDTH + 1
    }

    fn leave_room_for(self, bird: Bird) -> bool {
        self.gap <= bird.top() && bird.top() + BIRD_HEIGHT <= self.gap + GAP
    }
}

/// The bird on its way. It is small and `Copy`, so that a player can try out the future.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Flight {
    pub(super) seed: u64,
    /// Pixels flown.
    pub(super) distance: u32,
    pub(super) bird: Bird,
    gaps: Gaps,
}

/// The gaps of the pairs in sight, so that they are drawn from their streams once.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Gaps {
    /// Number of the first pair.
    first: u32,
    /// First rows of the gaps.
    rows: [i32; IN_SIGHT],
}

/// One pair that has just gone by, one that comes next, and one behind it.
const IN_SIGHT: usize = 3;

impl Gaps {
    fn of(seed: u64, first: u32) -> Gaps {
        Gaps { first, rows: std::array::from_fn(|index| gap(seed, first + index as u32)) }
    }
}

/// The first row of the gap of a pair. Every pair has a stream of its own, so a state needs no list of them.
fn gap(seed: u64, number: u32) -> i32 {
    let mut rng = stream(seed, "flappy-pipes", u64::from(number));
    let room = FIELD - GAP - 2 * PIPE_LEAST;
    PIPE_LEAST + below(&mut rng, room as usize + 1) as i32
}

impl Flight {
    pub(super) fn new(seed: u64, distance: u32, bird: Bird) -> Flight {
        let mut flight = Flight { seed, distance, bird, gaps: Gaps::of(seed, 0) };
        flight.look_ahead();
        flight
    }

    pub(super) fn step(&mut self, flaps: bool) {
        self.bird.step(flaps);
        self.distance += SPEED as u32;
        self.look_ahead();
    }

    fn look_ahead(&mut self) {
        let first = self.first_in_sight();
        if first != self.gaps.first {
            self.gaps = Gaps::of(self.seed, first);
        }
    }

    /// The pair of this number, from 0.
    pub(super) fn pipes(&self, number: u32) -> Pipes {
        let x = FIRST_X + number as i32 * SPACING - self.distance as i32;
        let index = number.wrapping_sub(self.gaps.first) as usize;
        let gap = self.gaps.rows.get(index).copied().unwrap_or_else(|| gap(self.seed, number));
        Pipes { x, gap }
    }

    /// The number of the first pair that can still be seen: the one that has just gone by.
    pub(super) fn first_in_sight(&self) -> u32 {
        self.passed().saturating_sub(1)
    }

    /// How many pairs the bird has left behind.
    pub(super) fn passed(&self) -> u32 {
        // A pair is behind when its right edge, lip included, is not beyond the bird's left one.
        let flown = self.distance as i32 + BIRD_X - (FIRST_X + PIPE_WIDTH + 1);
        if flown < 0 { 0 } else { (flown / SPACING) as u32 + 1 }
    }

    /// The pair that the bird is between or comes to next.
    pub(super) fn next(&self) -> Pipes {
        self.pipes(self.passed())
    }

    pub(super) fn has_crashed(&self) -> bool {
        let next = self.next();
        self.bird.y >= GROUND || (next.are_around_bird() && !next.leave_room_for(self.bird))
    }

    /// How far the bird's middle is from that of the gap, in pixels, while pipes are around it.
    pub(super) fn off_middle(&self) -> Option<f64> {
        let next = self.next();
        let twice_off = (2 * self.bird.top() + BIRD_HEIGHT).abs_diff(2 * next.gap + GAP);
        next.are_around_bird().then_some(f64::from(twice_off) / 2.0)
    }

    pub(super) fn is_between_pipes(&self) -> bool {
        let next = self.next();
        next.are_around_bird() && next.leave_room_for(self.bird)
    }
}
