//! Flappy Bird's picture.

use prf_core::{FrameMut, Rect};

use super::physics::{BIRD_HEIGHT, BIRD_WIDTH, BIRD_X, FIELD, Flight, GAP, LIP_HEIGHT, PIPE_WIDTH, Pipes};
use crate::raster::fill_rect;

const PIPE_GREY: u8 = 110;
const LIP_GREY: u8 = 150;
const BIRD_GREY: u8 = 220;
const EYE_GREY: u8 = 255;
const BEAK_GREY: u8 = 180;

/// Draws the pipes in sight and the bird over the whole `frame`.
pub(super) fn draw(flight: &Flight, frame: &mut FrameMut<'_>) {
    frame.fill(0);
    for pipes in (flight.first_in_sight()..).map(|number| flight.pipes(number)).take_while(|pipes| pipes.x <= FIELD) {
        draw_pipes(pipes, frame);
    }
    let top = flight.bird.top();
    fill(frame, (BIRD_X, top), (BIRD_WIDTH, BIRD_HEIGHT), BIRD_GREY);
    fill(frame, (BIRD_X + 4, top + 1), (2, 2), EYE_GREY);
    fill(frame, (BIRD_X + 5, top + 3), (2, 2), BEAK_GREY);
}

fn draw_pipes(Pipes { x, gap }: Pipes, frame: &mut FrameMut<'_>) {
    let below = gap + GAP;
    fill(frame, (x, 0), (PIPE_WIDTH, gap), PIPE_GREY);
    fill(frame, (x, below), (PIPE_WIDTH, FIELD - below), PIPE_GREY);
    for lip in [gap - LIP_HEIGHT, below] {
        fill(frame, (x - 1, lip), (PIPE_WIDTH + 2, LIP_HEIGHT), LIP_GREY);
    }
}

/// What lies left of the field is cut off here, what lies right of it by [`fill_rect`].
fn fill(frame: &mut FrameMut<'_>, (x, y): (i32, i32), (width, height): (i32, i32), grey: u8) {
    let width = (width + x.min(0)).max(0) as usize;
    let side = FIELD as usize;
    fill_rect(frame, (side, side), Rect { x: x.max(0) as usize, y: y as usize, width, height: height as usize }, grey);
}
