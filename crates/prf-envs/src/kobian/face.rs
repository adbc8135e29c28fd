//! Where the face's 24 vertices are: the neutral face, and how each movement shifts it.

use std::ops::Range;

/// Side of the square field that vertices lie in, in pixels of the mirror frame.
pub(super) const FIELD: f32 = 84.0;

/// A place in the field, `[x, y]` in pixels from its left and upper edge.
pub type Point = [f32; 2];

/// Number of vertices: 4 a brow, 8 around the lips and 8 around the mouth's opening.
pub const VERTICES: usize = 24;
/// Number of movements, each in whole levels that are 0 in the neutral face: brows up, their inner ends up, their outer ends up; mouth wider,
/// its corners up, its lips apart.
pub const MOVEMENTS: usize = 6;

/// The least and the greatest level of each movement.
pub(super) const LEVELS: [[i8; 2]; MOVEMENTS] = [[-2, 3], [-2, 2], [-2, 2], [-2, 3], [-2, 3], [0, 5]];

/// The movements of the brows, and those of the mouth.
pub(super) const BROW_MOVEMENTS: Range<usize> = 0..3;
pub(super) const MOUTH_MOVEMENTS: Range<usize> = 3..MOVEMENTS;

/// A vertex of the left half: where it is in the neutral face, and what a level of each movement adds.
struct Row {
    at: Point,
    shifts: [Point; MOVEMENTS],
}

const STILL: Point = [0.0, 0.0];

const fn brow(at: Point, inner: f32, outer: f32) -> Row {
    Row { at, shifts: [[0.0, -2.5], [0.0, -inner], [0.0, -outer], STILL, STILL, STILL] }
}

const fn lip(at: Point, out: f32, up: f32, open: Point) -> Row {
    Row { at, shifts: [STILL, STILL, STILL, [-out, 0.0], [0.0, -up], open] }
}

/// The left brow, from its outer end to its inner one.
const BROW: [Row; 4] = [
    brow([15.5, 27.5], 0.0, 2.5),
    brow([21.5, 23.0], 0.0, 1.2),
    brow([29.0, 22.8], 1.2, 0.0),
    brow([35.5, 25.6], 2.5, 0.0),
];

/// The left half of the lips' outline and of the mouth's opening: the corner, then above and below the side and the middle.
const LIPS: [[Row; 5]; 2] = [
    [
        lip([30.0, 60.5], 2.6, 2.2, [0.4, 0.6]),
        lip([36.5, 58.0], 1.6, 0.7, [0.0, -0.5]),
        lip([42.0, 58.6], 0.0, -0.2, [0.0, -0.7]),
        lip([36.0, 63.4], 1.6, 0.7, [0.0, 1.9]),
        lip([42.0, 64.6], 0.0, -0.4, [0.0, 2.5]),
    ],
    [
        lip([32.5, 60.6], 2.6, 2.2, [0.4, 0.6]),
        lip([37.0, 60.2], 1.6, 0.7, [0.0, -0.4]),
        lip([42.0, 60.5], 0.0, -0.2, [0.0, -0.6]),
        lip([37.0, 61.1], 1.6, 0.7, [0.0, 1.8]),
        lip([42.0, 61.5], 0.0, -0.4, [0.0, 2.3]),
    ],
];

/// Rows of [`LIPS`] in the order of vertices: from the left corner, above, to the right one, and back below.
const AROUND: [(usize, bool); 8] =
    [(0, false), (1, false), (2, false), (1, true), (0, true), (3, true), (4, false), (3, false)];

/// A face, neutral or not: the level of each movement.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Face {
    levels: [i8; MOVEMENTS],
}

/// How far a face's features are from those of the neutral one, in pixels of the mirror frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Displacement {
    /// Mean height that the brows' vertices have gained.
    pub brows_up: f32,
    /// What the mouth has gained in width, between its outer corners.
    pub mouth_wider: f32,
    /// What the mouth's opening has gained in height, in the middle.
    pub mouth_opener: f32,
    /// Height that the corners of the mouth have gained.
    pub corners_up: f32,
}

impl Face {
    /// The face with these levels, if it can have them.
    #[must_use]
    pub fn new(levels: [i8; MOVEMENTS]) -> Option<Face> {
        let fits = levels.iter().zip(LEVELS).all(|(level, [least, greatest])| (least..=greatest).contains(level));
        fits.then_some(Face { levels })
    }

    /// The level of each movement.
    #[must_use]
    pub fn levels(self) -> [i8; MOVEMENTS] {
        self.levels
    }

    /// Every face that differs from the neutral one in these movements alone, in the order of [`position`](Face::position).
    pub(super) fn all(movements: Range<usize>) -> impl Iterator<Item = Face> {
        let counts = LEVELS.map(|[least, greatest]| (greatest - least + 1) as usize);
        (0..counts[movements.clone()].iter().product()).map(move |mut position: usize| {
            let mut levels = [0; MOVEMENTS];
            for movement in movements.clone().rev() {
                levels[movement] = LEVELS[movement][0] + (position % counts[movement]) as i8;
                position /= counts[movement];
            }
            Face { levels }
        })
    }

    /// Where the levels of these movements stand among all that they can have.
    pub(super) fn position(self, movements: Range<usize>) -> usize {
        let levels = self.levels[movements.clone()].iter().zip(&LEVELS[movements]);
        levels.fold(0, |position, (level, [least, greatest])| {
            position * (greatest - least + 1) as usize + (level - least) as usize
        })
    }

    /// Takes a movement one level up or down; at its end the face stays as it is.
    pub(super) fn shift(&mut self, movement: usize, up: bool) {
        let [least, greatest] = LEVELS[movement];
        let level = &mut self.levels[movement];
        *level = if up { *level + 1 } else { *level - 1 }.clamp(least, greatest);
    }

    /// The fewest actions that lead from this face to `other`.
    #[must_use]
    pub fn actions_to(self, other: Face) -> u32 {
        self.levels.iter().zip(other.levels).map(|(&a, b)| u32::from(a.abs_diff(b))).sum()
    }

    /// All vertices: the left brow and the right one, each from its outer end to its inner one, then the lips' outline and the
    /// mouth's opening, each from its left corner over the upper lip round.
    #[must_use]
    pub fn vertices(self) -> [Point; VERTICES] {
        let mut vertices = [STILL; VERTICES];
        for (index, row) in BROW.iter().enumerate() {
            let left = self.place(row);
            vertices[index] = left;
            vertices[index + 4] = mirrored(left);
        }
        for (rows, vertices) in LIPS.iter().zip(vertices[8..].chunks_exact_mut(8)) {
            for (vertex, (row, is_right)) in vertices.iter_mut().zip(AROUND) {
                let left = self.place(&rows[row]);
                *vertex = if is_right { mirrored(left) } else { left };
            }
        }
        vertices
    }

    /// Mean distance between the vertices of both faces, in pixels of the mirror frame.
    #[must_use]
    pub fn distance_to(self, other: Face) -> f32 {
        mean_distance(&self.vertices(), &other.vertices())
    }

    /// How this face differs from the neutral one.
    #[must_use]
    pub fn displacement(self) -> Displacement {
        let (now, neutral) = (self.vertices(), Face::default().vertices());
        let height = |points: &[Point]| points.iter().map(|point| -point[1]).sum::<f32>() / points.len() as f32;
        let width = |points: &[Point; VERTICES]| points[12][0] - points[8][0];
        let opening = |points: &[Point; VERTICES]| points[22][1] - points[18][1];
        Displacement {
            brows_up: height(&now[..8]) - height(&neutral[..8]),
            mouth_wider: width(&now) - width(&neutral),
            mouth_opener: opening(&now) - opening(&neutral),
            corners_up: height(&now[8..9]) - height(&neutral[8..9]),
        }
    }

    fn place(self, row: &Row) -> Point {
        let shifted = |axis: usize| {
            let shifts = row.shifts.iter().zip(self.levels).map(|(shift, level)| shift[axis] * f32::from(level));
            row.at[axis] + shifts.sum::<f32>()
        };
        [shifted(0), shifted(1)]
    }
}

/// Mean distance between the vertices of two faces.
pub(super) fn mean_distance(here: &[Point; VERTICES], there: &[Point; VERTICES]) -> f32 {
    let sum: f32 = here.iter().zip(there).map(|(a, b)| length([a[0] - b[0], a[1] - b[1]])).sum();
    sum / VERTICES as f32
}

/// Without `hypot`, whose last bit depends on the system.
fn length([x, y]: Point) -> f32 {
    (x * x + y * y).sqrt()
}

fn mirrored([x, y]: Point) -> Point {
    [FIELD - x, y]
}
