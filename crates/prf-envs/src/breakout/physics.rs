//! How the ball, the wall and the paddle behave, in whole pixels.

/// Side of the square field, in pixels.
pub(super) const FIELD: i32 = 84;
/// Columns of bricks.
pub(super) const COLUMNS: i32 = 12;
/// Rows of bricks.
pub(super) const ROWS: i32 = 5;
/// Width of a brick with its gap.
pub(super) const CELL_WIDTH: i32 = 7;
/// Height of a brick with its gap.
pub(super) const CELL_HEIGHT: i32 = 5;
/// First row of pixels of the wall.
pub(super) const WALL_TOP: i32 = 8;
/// First row of pixels below the wall.
pub(super) const WALL_BOTTOM: i32 = WALL_TOP + ROWS * CELL_HEIGHT;
/// Side of the square ball.
pub(super) const BALL: i32 = 2;
/// Largest position of the ball's left column.
pub(super) const BALL_MAX_X: i32 = FIELD - BALL;
/// Position of the ball's top row while it lies on the paddle.
pub(super) const BALL_MAX_Y: i32 = PADDLE_TOP - BALL;
/// Pixels that the ball moves up or down in a step.
pub(super) const BALL_SPEED: i32 = 3;
/// The speeds to the side that a bounce may draw, in pixels a step.
pub(super) const SIDE_SPEEDS: [i32; 4] = [-2, -1, 1, 2];
/// Width of the paddle.
pub(super) const PADDLE_WIDTH: i32 = 14;
/// Height of the paddle.
pub(super) const PADDLE_HEIGHT: i32 = 3;
/// First row of pixels of the paddle.
pub(super) const PADDLE_TOP: i32 = FIELD - PADDLE_HEIGHT;
/// Largest position of the paddle's left column.
pub(super) const PADDLE_MAX_X: i32 = FIELD - PADDLE_WIDTH;
/// Pixels that the paddle moves in a step.
pub(super) const PADDLE_SPEED: i32 = 3;

/// The bricks that are left, a bit each: row by row, from the top left.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Wall(pub(super) u64);

impl Wall {
    pub(super) const BRICKS: u32 = (COLUMNS * ROWS) as u32;
    pub(super) const FULL: Wall = Wall((1 << Wall::BRICKS) - 1);

    pub(super) fn has(self, column: i32, row: i32) -> bool {
        self.0 & Wall::bit(column, row) != 0
    }

    pub(super) fn removed(self) -> u32 {
        Wall::BRICKS - self.0.count_ones()
    }

    /// Column and row of each brick that was removed.
    pub(super) fn missing(self) -> impl Iterator<Item = (i32, i32)> {
        let mut bits = Wall::FULL.0 & !self.0;
        std::iter::from_fn(move || {
            let index = (bits != 0).then(|| bits.trailing_zeros() as i32)?;
            bits &= bits - 1;
            Some((index % COLUMNS, index / COLUMNS))
        })
    }

    pub(super) fn is_cleared(self) -> bool {
        self.0 == 0
    }

    /// Whether a brick's cell covers pixel (x, y) of the field.
    pub(super) fn covers(self, x: i32, y: i32) -> bool {
        (WALL_TOP..WALL_BOTTOM).contains(&y) && self.has(x / CELL_WIDTH, (y - WALL_TOP) / CELL_HEIGHT)
    }

    /// Removes the brick at the first of the two pixels that has one.
    fn hit(&mut self, pixels: [(i32, i32); 2]) -> bool {
        for (x, y) in pixels {
            if self.covers(x, y) {
                self.0 &= !Wall::bit(x / CELL_WIDTH, (y - WALL_TOP) / CELL_HEIGHT);
                return true;
            }
        }
        false
    }

    fn bit(column: i32, row: i32) -> u64 {
        1 << (row * COLUMNS + column)
    }
}

/// The ball: position of its top left pixel, and where it is going.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Ball {
    pub(super) x: i32,
    pub(super) y: i32,
    /// One of [`SIDE_SPEEDS`], in pixels a step.
    pub(super) side_speed: i32,
    /// −1 up, 1 down.
    pub(super) heading: i32,
}

impl Ball {
    /// The column on the side to which the ball is moving, then the other.
    fn columns(self) -> [i32; 2] {
        if self.side_speed > 0 { [self.x + 1, self.x] } else { [self.x, self.x + 1] }
    }

    /// The row on the side to which the ball is moving, then the other.
    fn rows(self) -> [i32; 2] {
        if self.heading > 0 { [self.y + 1, self.y] } else { [self.y, self.y + 1] }
    }
}

/// What became of the ball in a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Outcome {
    InPlay,
    Lost,
    Cleared,
}

/// The field without the paddle. It is small and `Copy`, so that a player can try out the future.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Field {
    pub(super) wall: Wall,
    pub(super) ball: Ball,
}

impl Field {
    /// Moves the ball for one step, pixel by pixel, so that it never jumps over anything.
    ///
    /// When the ball comes down on the paddle's height at column `x`, `catch(x)` gives its new side speed, or `None`
    /// if no paddle is there. A blocked pixel of movement is spent on turning round.
    pub(super) fn step(&mut self, mut catch: impl FnMut(i32) -> Option<i32>) -> Outcome {
        for part in 0..BALL_SPEED {
            if !self.move_vertically(&mut catch) {
                return Outcome::Lost;
            }
            if moves_sideways(self.ball.side_speed, part) {
                self.move_sideways();
            }
            if self.wall.is_cleared() {
                return Outcome::Cleared;
            }
        }
        Outcome::InPlay
    }

    /// One pixel up or down; false if the ball is lost.
    fn move_vertically(&mut self, catch: &mut impl FnMut(i32) -> Option<i32>) -> bool {
        let ball = &mut self.ball;
        let y = ball.rows()[0] + ball.heading;
        if y >= PADDLE_TOP {
            let Some(side_speed) = catch(ball.x) else {
                ball.y += 1;
                return false;
            };
            ball.side_speed = side_speed;
            ball.heading = -1;
        } else if y < 0 || self.wall.hit(ball.columns().map(|x| (x, y))) {
            ball.heading = -ball.heading;
        } else {
            ball.y += ball.heading;
        }
        true
    }

    /// One pixel to the side.
    fn move_sideways(&mut self) {
        let ball = &mut self.ball;
        let x = ball.columns()[0] + ball.side_speed.signum();
        if !(0..FIELD).contains(&x) || self.wall.hit(ball.rows().map(|y| (x, y))) {
            ball.side_speed = -ball.side_speed;
        } else {
            ball.x += ball.side_speed.signum();
        }
    }

    /// Where and when the ball next comes down on the paddle's height (or clears the wall).
    ///
    /// It always does: it can only turn upwards by removing a brick, or at the paddle. A lost ball lands at once.
    pub(super) fn landing(mut self) -> Landing {
        let mut steps = 1;
        while self.step(|_| None) == Outcome::InPlay {
            steps += 1;
        }
        Landing { x: self.ball.x, steps }
    }
}

/// Where the ball comes down.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Landing {
    /// The ball's left column.
    pub(super) x: i32,
    /// In how many steps, counted from 1.
    pub(super) steps: i32,
}

/// Whether the ball moves to the side in this third of a step: in the middle one at speed 1, in the others at 2.
fn moves_sideways(side_speed: i32, part: i32) -> bool {
    (part == 1) == (side_speed.abs() == 1)
}

/// Whether a paddle at `paddle` touches the ball at column `ball_x`.
pub(super) fn touches(paddle: i32, ball_x: i32) -> bool {
    (paddle - BALL + 1..paddle + PADDLE_WIDTH).contains(&ball_x)
}
