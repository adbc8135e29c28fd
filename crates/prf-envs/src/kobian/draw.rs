//! The face's picture.

use std::ops::Range;
use std::sync::LazyLock;

use prf_core::{Frame, FrameMut, Rect};

use super::curve;
use super::face::{BROW_MOVEMENTS, FIELD, Face, MOUTH_MOVEMENTS, Point};
use crate::coverage::Coverage;

const SHELL: u8 = 186;
const SEAM: u8 = 140;
const EAR: u8 = 105;
const SHADE: u8 = 150;
const WHITE: u8 = 248;
const IRIS: u8 = 100;
const DARK: u8 = 24;
const BROW: u8 = 42;
const LIPS: u8 = 92;
const MOUTH: u8 = 12;

/// The right half of the head's outline, from its top to the chin.
const HEAD: [Point; 8] =
    [[42.0, 2.5], [57.0, 5.0], [69.0, 15.0], [73.5, 33.0], [71.5, 52.0], [64.0, 68.0], [53.0, 78.5], [42.0, 81.5]];
/// The same of the cap's edge on the forehead.
const CAP: [Point; 5] = [[42.0, 2.0], [57.3, 4.4], [67.6, 12.4], [56.0, 9.6], [42.0, 8.4]];
/// The same of the nose's tip, and the left side of its ridge.
const NOSE: [Point; 5] = [[42.0, 50.4], [44.8, 51.0], [46.4, 52.6], [44.2, 53.6], [42.0, 54.4]];
const RIDGE: [Point; 3] = [[39.2, 40.0], [38.9, 46.0], [37.8, 51.4]];
const EYE: Point = [27.0, 37.0];
/// Half the thickness of a brow at each of its vertices, from the outer end to the inner one.
const BROW_HALF: [f32; 4] = [0.5, 1.7, 2.0, 1.5];

/// Draws `face` over the whole `frame`.
pub(super) fn draw(face: Face, frame: &mut FrameMut<'_>) {
    let mut brush = Brush::new(frame.width(), frame.height());
    frame.fill(0);
    draw_portrait(&mut brush, frame);
    draw_brows(&mut brush, face, frame);
    draw_mouth(&mut brush, face, frame);
}

/// All faces at the mirror frame's size: what never moves, and each position of the brows and of the mouth. There are a few hundred of
/// them, so a face is not drawn but put together.
#[derive(Debug)]
pub(super) struct Album {
    portrait: Frame,
    brows: Vec<Patch>,
    mouths: Vec<Patch>,
}

impl Album {
    /// The one for all worlds, which is made with the first of them.
    pub(super) fn get() -> &'static Album {
        static ALBUM: LazyLock<Album> = LazyLock::new(Album::new);
        &ALBUM
    }

    fn new() -> Album {
        let side = FIELD as usize;
        let (mut portrait, mut brush) = (Frame::new(side, side), Brush::new(side, side));
        draw_portrait(&mut brush, &mut portrait.view_mut());
        let mut patches = |movements: Range<usize>, draw: Draw| {
            let faces = Face::all(movements);
            faces.map(|face| Patch::new(&portrait, |frame| draw(&mut brush, face, frame))).collect()
        };
        let (brows, mouths) = (patches(BROW_MOVEMENTS, draw_brows), patches(MOUTH_MOVEMENTS, draw_mouth));
        Album { portrait, brows, mouths }
    }

    /// Draws `face` over the whole `frame`, if this has the mirror frame's size.
    pub(super) fn draw(&self, face: Face, frame: &mut FrameMut<'_>) -> bool {
        if [frame.width(), frame.height()] != [self.portrait.width(), self.portrait.height()] {
            return false;
        }
        frame.as_mut_slice().copy_from_slice(self.portrait.as_slice());
        self.brows[face.position(BROW_MOVEMENTS)].lay_on(frame);
        self.mouths[face.position(MOUTH_MOVEMENTS)].lay_on(frame);
        true
    }
}

type Draw = fn(&mut Brush, Face, &mut FrameMut<'_>);

/// The part of a picture that differs from the portrait.
#[derive(Clone, Debug)]
struct Patch {
    rect: Rect,
    pixels: Vec<u8>,
}

impl Patch {
    fn new(portrait: &Frame, draw: impl FnOnce(&mut FrameMut<'_>)) -> Patch {
        let mut drawn = portrait.clone();
        draw(&mut drawn.view_mut());
        let rect = difference(portrait, &drawn);
        let columns = rect.x..rect.x + rect.width;
        let rows = rect.y..rect.y + rect.height;
        let pixels = rows.flat_map(|y| drawn.view().row(y)[columns.clone()].to_vec()).collect();
        Patch { rect, pixels }
    }

    fn lay_on(&self, frame: &mut FrameMut<'_>) {
        let Rect { x, y, width, .. } = self.rect;
        for (row, pixels) in self.pixels.chunks_exact(width.max(1)).enumerate() {
            frame.row_mut(y + row)[x..x + width].copy_from_slice(pixels);
        }
    }
}

/// The smallest rectangle around the pixels in which two pictures differ; empty if they are the same.
fn difference(one: &Frame, other: &Frame) -> Rect {
    let (mut columns, mut rows) = ((usize::MAX, 0), (usize::MAX, 0));
    for y in 0..one.height() {
        let pixels = one.view().row(y).iter().zip(other.view().row(y));
        for (x, _) in pixels.enumerate().filter(|(_, (a, b))| a != b) {
            columns = (columns.0.min(x), columns.1.max(x + 1));
            rows = (rows.0.min(y), rows.1.max(y + 1));
        }
    }
    let [x, y] = [columns.0.min(columns.1), rows.0.min(rows.1)];
    Rect { x, y, width: columns.1 - x, height: rows.1 - y }
}

fn draw_brows(brush: &mut Brush, face: Face, frame: &mut FrameMut<'_>) {
    for brow in face.vertices()[..8].chunks_exact(4) {
        let edge = |side: f32| -> [Point; 4] {
            std::array::from_fn(|index| [brow[index][0], brow[index][1] + side * BROW_HALF[index]])
        };
        let (upper, mut lower) = (edge(-1.0), edge(1.0));
        lower.reverse();
        brush.fill_between(&upper, &lower, frame, BROW);
    }
}

fn draw_mouth(brush: &mut Brush, face: Face, frame: &mut FrameMut<'_>) {
    for (outline, grey) in face.vertices()[8..].chunks_exact(8).zip([LIPS, MOUTH]) {
        let lower: [Point; 5] = std::array::from_fn(|index| outline[(4 + index) % 8]);
        brush.fill_between(&outline[..5], &lower, frame, grey);
    }
}

/// Draws what never moves.
fn draw_portrait(brush: &mut Brush, frame: &mut FrameMut<'_>) {
    let mirrored = |[x, y]: Point| [FIELD - x, y];
    for ear in [[9.5, 41.0], mirrored([9.5, 41.0])] {
        brush.fill_ellipse(ear, [5.5, 9.0], frame, EAR);
    }
    brush.fill_symmetric(&HEAD, frame, SHELL);
    brush.fill_symmetric(&CAP, frame, SEAM);
    for eye in [EYE, mirrored(EYE)] {
        brush.fill_ellipse([eye[0], eye[1] - 0.9], [8.0, 5.9], frame, SHADE);
        brush.fill_ellipse(eye, [7.2, 5.2], frame, WHITE);
        brush.fill_ellipse(eye, [4.0, 4.4], frame, IRIS);
        brush.fill_ellipse(eye, [2.1, 2.3], frame, DARK);
    }
    let ridge: Vec<Point> = RIDGE.iter().map(|&[x, y]| [x - 0.7, y]).collect();
    let back: Vec<Point> = RIDGE.iter().rev().map(|&[x, y]| [x + 0.5, y]).collect();
    brush.fill_between(&ridge, &back, frame, SHADE);
    let flip = |points: &[Point]| points.iter().map(|&point| mirrored(point)).collect::<Vec<_>>();
    brush.fill_between(&flip(&ridge), &flip(&back), frame, SHADE);
    brush.fill_symmetric(&NOSE, frame, SHADE);
}

/// Fills shapes given in the field's units.
#[derive(Clone, Debug)]
struct Brush {
    scale: Point,
    /// Straight lines from one point of an outline to the next.
    pieces: usize,
    outline: Vec<Point>,
    coverage: Coverage,
}

impl Brush {
    /// For frames of this size.
    fn new(width: usize, height: usize) -> Brush {
        let scale = [width as f32 / FIELD, height as f32 / FIELD];
        // Lines of about 2 pixels.
        let pieces = (3.0 * scale[0].max(scale[1])).clamp(3.0, 32.0) as usize;
        Brush { scale, pieces, outline: Vec::new(), coverage: Coverage::default() }
    }

    /// Between an upper curve and a lower one that leads back.
    fn fill_between(&mut self, upper: &[Point], lower: &[Point], frame: &mut FrameMut<'_>, grey: u8) {
        self.outline.clear();
        curve::through(upper, self.pieces, &mut self.outline);
        self.outline.extend(upper.last());
        curve::through(lower, self.pieces, &mut self.outline);
        self.outline.extend(lower.last());
        self.fill(frame, grey);
    }

    fn fill_around(&mut self, points: &[Point], frame: &mut FrameMut<'_>, grey: u8) {
        self.outline.clear();
        curve::around(points, self.pieces, &mut self.outline);
        self.fill(frame, grey);
    }

    /// The closed shape of which `half` is the right half, from top to bottom.
    fn fill_symmetric(&mut self, half: &[Point], frame: &mut FrameMut<'_>, grey: u8) {
        let inner = &half[1..half.len() - 1];
        let left = inner.iter().rev().map(|&[x, y]| [FIELD - x, y]);
        let points: Vec<Point> = half.iter().copied().chain(left).collect();
        self.fill_around(&points, frame, grey);
    }

    fn fill_ellipse(&mut self, centre: Point, radii: Point, frame: &mut FrameMut<'_>, grey: u8) {
        self.outline.clear();
        curve::ellipse(centre, radii, 3 * self.pieces, &mut self.outline);
        self.fill(frame, grey);
    }

    fn fill(&mut self, frame: &mut FrameMut<'_>, grey: u8) {
        for point in &mut self.outline {
            *point = [point[0] * self.scale[0], point[1] * self.scale[1]];
        }
        self.coverage.fill(frame, &self.outline, grey);
    }
}
