//! Breakout's picture.

use std::ops::Range;
use std::sync::LazyLock;

use prf_core::{Frame, FrameMut, Rect};

use super::Game;
use super::physics::{
    BALL, CELL_HEIGHT, CELL_WIDTH, COLUMNS, FIELD, PADDLE_HEIGHT, PADDLE_TOP, PADDLE_WIDTH, ROWS, WALL_TOP, Wall,
};
use crate::raster::{covered, fill_rect};

/// Grey of each row of bricks, from the top.
const BRICK_GREYS: [u8; ROWS as usize] = [200, 180, 160, 140, 120];
const PADDLE_GREY: u8 = 230;
const BALL_GREY: u8 = 255;

/// The whole wall on black, at the mirror frame's size. It is made with the first world.
pub(super) fn whole_wall() -> &'static Frame {
    static WHOLE_WALL: LazyLock<Frame> = LazyLock::new(|| {
        let mut frame = Frame::new(FIELD as usize, FIELD as usize);
        draw_wall(Wall::FULL, &mut frame.view_mut());
        frame
    });
    &WHOLE_WALL
}

/// Draws the bricks that are left, the paddle and the ball over the whole `frame`.
pub(super) fn draw(game: &Game, frame: &mut FrameMut<'_>) {
    let wall = game.field.wall;
    let is_mirror = [frame.width(), frame.height()] == [FIELD as usize; 2];
    if is_mirror && wall.removed() < Wall::BRICKS / 2 {
        // Most of a step's time goes here, so what is seldom missing is not drawn brick by brick.
        frame.as_mut_slice().copy_from_slice(whole_wall().as_slice());
        for (column, row) in wall.missing() {
            let top = WALL_TOP + row * CELL_HEIGHT;
            fill(frame, (brick_left(column), top), (CELL_WIDTH - 1, CELL_HEIGHT - 1), 0);
        }
    } else {
        frame.fill(0);
        draw_wall(wall, frame);
    }
    fill(frame, (game.paddle, PADDLE_TOP), (PADDLE_WIDTH, PADDLE_HEIGHT), PADDLE_GREY);
    fill(frame, (game.field.ball.x, game.field.ball.y), (BALL, BALL), BALL_GREY);
}

/// Draws only the first pixel row of each row of bricks and copies it to the others.
fn draw_wall(wall: Wall, frame: &mut FrameMut<'_>) {
    let (width, height) = (frame.width(), frame.height());
    for (row, grey) in (0..).zip(BRICK_GREYS) {
        let mut rows = span(WALL_TOP + row * CELL_HEIGHT, CELL_HEIGHT - 1, height);
        let Some(first) = rows.next() else { continue };
        for column in (0..COLUMNS).filter(|&column| wall.has(column, row)) {
            frame.row_mut(first)[span(brick_left(column), CELL_WIDTH - 1, width)].fill(grey);
        }
        for y in rows {
            frame.as_mut_slice().copy_within(first * width..(first + 1) * width, y * width);
        }
    }
}

fn span(start: i32, len: i32, pixels: usize) -> Range<usize> {
    covered(start as usize, len as usize, FIELD as usize, pixels)
}

/// The gap of one pixel is right of the bricks of the left half and left of those of the right half, so that the wall
/// is symmetric.
fn brick_left(column: i32) -> i32 {
    column * CELL_WIDTH + i32::from(column >= COLUMNS / 2)
}

fn fill(frame: &mut FrameMut<'_>, (x, y): (i32, i32), (width, height): (i32, i32), grey: u8) {
    let side = FIELD as usize;
    let rect = Rect { x: x as usize, y: y as usize, width: width as usize, height: height as usize };
    fill_rect(frame, (side, side), rect, grey);
}
