//! The pictures that both sides work on, the same at every run.

/// Grey pictures of one size.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Pictures {
    /// Pixels in a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// One picture after the other, row by row.
    pub pixels: Vec<u8>,
}

impl Pictures {
    /// `count` pictures, of which pixel (`x`, `y`) of picture `t` is `pixel(x, y, t)`.
    pub fn new(width: usize, height: usize, count: usize, pixel: impl Fn(usize, usize, usize) -> u8) -> Pictures {
        let mut pixels = Vec::with_capacity(width * height * count);
        for t in 0..count {
            pixels.extend((0..width * height).map(|i| pixel(i % width, i / width, t)));
        }
        Pictures { width, height, pixels }
    }

    /// How many there are.
    pub fn count(&self) -> usize {
        self.pixels.len() / (self.width * self.height)
    }

    /// A part of the first one.
    pub fn part(&self, left: usize, top: usize, width: usize, height: usize) -> Pictures {
        Pictures::new(width, height, 1, |x, y, _| self.pixels[(top + y) * self.width + left + x])
    }
}

/// Waves and noise, seen by a camera that moves; no pixel is black, and next to none is like its neighbours.
pub fn texture(width: usize, height: usize, count: usize) -> Pictures {
    Pictures::new(width, height, count, |x, y, t| {
        let (x, y) = (x + 2 * t, y + t);
        let wave = 60.0 * (x as f64 / 5.0).sin() * (y as f64 / 7.0).cos();
        (127.0 + wave) as u8 + (noise(x, y) & 31) as u8
    })
}

/// Breakout as of the middle of a game, on a field of 84 by 84 that fills the picture: bricks of which one goes with
/// each picture, a ball, and a paddle below it.
pub fn breakout(width: usize, height: usize, count: usize) -> Pictures {
    Pictures::new(width, height, count, |x, y, t| {
        let (x, y) = (x * FIELD / width, y * FIELD / height);
        if (10..34).contains(&y) && (2..82).contains(&x) {
            return brick(x - 2, y - 10, t);
        }
        let (ball, ball_y, paddle) = (30 + 2 * t, 70 - 2 * t, 22 + t);
        match (x, y) {
            _ if (ball..ball + 2).contains(&x) && (ball_y..ball_y + 2).contains(&y) => 255,
            _ if (paddle..paddle + 14).contains(&x) && (78..80).contains(&y) => 200,
            _ => 0,
        }
    })
}

const FIELD: usize = 84;

/// A pixel of the wall: six rows of ten bricks, 7 by 3 with a gap of 1.
fn brick(x: usize, y: usize, t: usize) -> u8 {
    let (row, column) = (y / 4, x / 8);
    let gone = (row * 10 + column).wrapping_mul(7) % 60 < 10 + t;
    if gone || x % 8 == 7 || y % 4 == 3 { 0 } else { 120 + 20 * row as u8 }
}

/// Where something moved in a sequence, the later the brighter: a goal for the motion descriptor.
pub fn motion_goal(frames: &Pictures) -> Pictures {
    let size = frames.width * frames.height;
    let pictures: Vec<&[u8]> = frames.pixels.chunks(size).collect();
    Pictures::new(frames.width, frames.height, 1, |x, y, _| {
        let at = y * frames.width + x;
        let moved = pictures.windows(2).rposition(|pair| pair[0][at].abs_diff(pair[1][at]) > THRESHOLD);
        moved.map_or(0, |t| (255 * (t + 1) / (pictures.len() - 1)) as u8)
    })
}

/// A pixel has moved when it changed by more.
pub(super) const THRESHOLD: u8 = 30;

/// Unlike at every place.
fn noise(x: usize, y: usize) -> usize {
    let mixed = (x.wrapping_mul(0x9e37_79b9) ^ y.wrapping_mul(0x85eb_ca6b)) & 0xffff_ffff;
    (mixed ^ (mixed >> 15)).wrapping_mul(0x2c1b_3c6d) >> 12
}
