//! A goal altered step by step: what a good reward falls with.

use super::objects::{Object, Scene, paint};
use crate::{Error, Frame, FrameView, Goal};

/// What was done to a goal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Alteration {
    /// A thing lies elsewhere; the level is how far, in pixels.
    Displaced,
    /// A thing is gone.
    Absent,
    /// A thing is smaller or larger; the level counts the sizes, the nearest to its own first.
    Scaled,
    /// A thing is partly covered; the level is how much of it, in quarters.
    Occluded,
    /// Noise lies over all; the level counts its strengths.
    Noisy,
}

/// An altered goal.
#[derive(Clone, Debug)]
pub(super) struct Probe {
    pub(super) alteration: Alteration,
    /// Which object was altered.
    pub(super) object: usize,
    /// Probes of one series differ in their level alone, and the reward should fall with it.
    pub(super) series: usize,
    pub(super) level: usize,
    pub(super) frame: Frame,
}

/// An object is moved by up to its own larger side, but not less than this far, in pixels.
const LEAST_REACH: usize = 3;
/// Nor farther than this.
const MOST_REACH: usize = 16;
const SHRUNK: [f32; 3] = [0.8, 0.6, 0.4];
const GROWN: [f32; 3] = [1.25, 1.6, 2.0];
/// Amplitudes of noise, in greys.
const NOISE: [u32; 3] = [8, 24, 72];

/// A goal on a canvas, ready to be altered.
struct Stage {
    canvas: Frame,
    scene: Scene,
    /// How far the goal lies from the canvas's border.
    margin: usize,
    probes: Vec<Probe>,
    series: usize,
}

/// The goal altered in all ways. With a `margin` it lies on a larger canvas, over which a window can be looked for.
///
/// # Errors
///
/// [`Error::NothingToAlter`] when the goal shows nothing.
pub(super) fn probes(goal: &Goal, has_margin: bool) -> Result<Vec<Probe>, Error> {
    let picture = goal.seen();
    let scene = Scene::of(picture.view());
    if scene.objects.is_empty() {
        return Err(Error::NothingToAlter);
    }
    let margin = if has_margin { scene.objects.iter().map(reach).max().unwrap_or(0) } else { 0 };
    let canvas = surround(picture.view(), margin, (!scene.has_scenery).then_some(scene.background));
    let mut stage = Stage { canvas, scene, margin, probes: Vec::new(), series: 0 };
    for index in 0..stage.scene.objects.len() {
        stage.displace(index);
        stage.remove(index);
        stage.scale(index);
        stage.occlude(index);
    }
    stage.disturb();
    Ok(stage.probes)
}

fn reach(object: &Object) -> usize {
    object.rect.width.max(object.rect.height).clamp(LEAST_REACH, MOST_REACH)
}

/// The picture with a border of this width around it: of one grey, or of what the picture's own border shows, where
/// that goes on beyond it.
fn surround(picture: FrameView<'_>, margin: usize, grey: Option<u8>) -> Frame {
    let (width, height) = (picture.width(), picture.height());
    let mut canvas = Frame::new(width + 2 * margin, height + 2 * margin);
    for y in 0..canvas.height() {
        for x in 0..canvas.width() {
            let inside = [x, y].iter().zip([width, height]).all(|(&at, side)| (margin..margin + side).contains(&at));
            let nearest = |at: usize, side: usize| at.saturating_sub(margin).min(side - 1);
            canvas.row_mut(y)[x] = match grey {
                Some(grey) if !inside => grey,
                _ => picture.row(nearest(y, height))[nearest(x, width)],
            };
        }
    }
    canvas
}

impl Stage {
    fn displace(&mut self, index: usize) {
        for direction in [[1, 0], [-1, 0], [0, 1], [0, -1]] {
            let object = &self.scene.objects[index];
            let frames: Vec<Frame> = (1..=reach(object) as isize)
                .map_while(|px| self.moved(object, direction.map(|step: isize| step * px)))
                .collect();
            self.series(Alteration::Displaced, index, frames);
        }
    }

    /// `None` where the object would leave the canvas.
    fn moved(&self, object: &Object, by: [isize; 2]) -> Option<Frame> {
        let sides = [self.canvas.width(), self.canvas.height()];
        let place = |at: usize, by: isize, len: usize, side: usize| {
            (at + self.margin).checked_add_signed(by).filter(|at| at + len <= side)
        };
        let x = place(object.rect.x, by[0], object.rect.width, sides[0])?;
        let y = place(object.rect.y, by[1], object.rect.height, sides[1])?;
        let mut frame = self.without(object);
        paint(&mut frame, object, [x, y]);
        Some(frame)
    }

    fn without(&self, object: &Object) -> Frame {
        let mut frame = self.canvas.clone();
        for (x, y, _) in object.lit() {
            frame.row_mut(object.rect.y + self.margin + y)[object.rect.x + self.margin + x] = self.scene.background;
        }
        frame
    }

    fn remove(&mut self, index: usize) {
        let frame = self.without(&self.scene.objects[index]);
        self.series(Alteration::Absent, index, vec![frame]);
    }

    fn scale(&mut self, index: usize) {
        for factors in [SHRUNK, GROWN] {
            let frames = factors.iter().map(|&factor| self.scaled(&self.scene.objects[index], factor)).collect();
            self.series(Alteration::Scaled, index, frames);
        }
    }

    /// The object `factor` times as large around its own middle, as far as it fits.
    fn scaled(&self, object: &Object, factor: f32) -> Frame {
        let mut frame = self.without(object);
        let [width, height] = [object.rect.width, object.rect.height].map(|side| side as f32 / 2.0);
        let middle = [object.rect.x, object.rect.y].map(|at| (at + self.margin) as f32);
        let middle = [middle[0] + width, middle[1] + height];
        for y in 0..frame.height() {
            for x in 0..frame.width() {
                let source_x = ((x as f32 + 0.5 - middle[0]) / factor + width).floor();
                let source_y = ((y as f32 + 0.5 - middle[1]) / factor + height).floor();
                let inside = |at: f32, side: usize| at >= 0.0 && at < side as f32;
                if inside(source_x, object.rect.width) && inside(source_y, object.rect.height) {
                    let place = source_y as usize * object.rect.width + source_x as usize;
                    if let Some(value) = object.pixels[place] {
                        frame.row_mut(y)[x] = value;
                    }
                }
            }
        }
        frame
    }

    fn occlude(&mut self, index: usize) {
        for across in [true, false] {
            let frames = (1..=3).map(|quarters| self.occluded(&self.scene.objects[index], quarters, across)).collect();
            self.series(Alteration::Occluded, index, frames);
        }
    }

    /// The object without its first quarters, from the left or from the top.
    fn occluded(&self, object: &Object, quarters: usize, across: bool) -> Frame {
        let side = if across { object.rect.width } else { object.rect.height };
        let hidden = (side * quarters).div_ceil(4);
        let mut frame = self.canvas.clone();
        for (x, y, _) in object.lit().filter(|&(x, y, _)| (if across { x } else { y }) < hidden) {
            frame.row_mut(object.rect.y + self.margin + y)[object.rect.x + self.margin + x] = self.scene.background;
        }
        frame
    }

    fn disturb(&mut self) {
        let frames = NOISE.iter().map(|&amplitude| disturbed(&self.canvas, amplitude)).collect();
        self.series(Alteration::Noisy, 0, frames);
    }

    fn series(&mut self, alteration: Alteration, object: usize, frames: Vec<Frame>) {
        let series = self.series;
        self.probes.extend((1..).zip(frames).map(|(level, frame)| Probe { alteration, object, series, level, frame }));
        self.series += 1;
    }
}

/// The same noise each time, between −amplitude and +amplitude: a hash of each pixel's place.
fn disturbed(canvas: &Frame, amplitude: u32) -> Frame {
    let mut frame = canvas.clone();
    for (place, pixel) in frame.as_mut_slice().iter_mut().enumerate() {
        let mut hash = place as u32 ^ 0x9e37_79b9;
        for _ in 0..2 {
            hash = (hash ^ (hash >> 16)).wrapping_mul(0x45d9_f3b5);
        }
        let shift = ((hash >> 8) % (2 * amplitude + 1)) as i32 - amplitude as i32;
        *pixel = (i32::from(*pixel) + shift).clamp(0, 255) as u8;
    }
    frame
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A bird in the middle of a gap between two pipes that the border cuts off.
    fn gap() -> Goal {
        let mut picture = Frame::new(20, 32);
        for y in (0..4).chain(28..32) {
            picture.row_mut(y)[2..18].fill(120);
        }
        (13..18).for_each(|y| picture.row_mut(y)[7..13].fill(220));
        Goal::from(picture)
    }

    fn of(probes: &[Probe], alteration: Alteration) -> Vec<&Probe> {
        probes.iter().filter(|probe| probe.alteration == alteration).collect()
    }

    #[test]
    fn the_bird_is_moved_and_the_pipes_go_on_beyond_the_window() {
        let probes = probes(&gap(), true).expect("there is a bird");
        let displaced = of(&probes, Alteration::Displaced);
        assert_eq!(displaced.len(), 4 * 6, "4 directions, 6 px: the bird's width");
        let frame = &displaced[2].frame; // 3 px to the right
        assert_eq!((frame.width(), frame.height()), (20 + 12, 32 + 12));
        let row = frame.row(6 + 15);
        assert_eq!(row.iter().position(|&v| v == 220), Some(6 + 7 + 3));
        assert_eq!(row.iter().filter(|&&v| v == 220).count(), 6);
        assert_eq!(frame.row(0)[6 + 10], 120, "the pipe above goes on");
        assert_eq!(frame.row(6 + 15)[0], 0);
    }

    #[test]
    fn an_absent_bird_leaves_the_gap_empty() {
        let probes = probes(&gap(), false).expect("there is a bird");
        let absent = of(&probes, Alteration::Absent);
        assert_eq!(absent.len(), 1);
        assert!(absent[0].frame.as_slice().iter().all(|&v| v != 220));
        assert!(absent[0].frame.as_slice().contains(&120));
    }

    #[test]
    fn sizes_covers_and_noise_grow_with_their_level() {
        let probes = probes(&gap(), false).expect("there is a bird");
        let bird = |probe: &Probe| probe.frame.as_slice().iter().filter(|&&v| v == 220).count();
        let scaled: Vec<usize> = of(&probes, Alteration::Scaled).into_iter().map(bird).collect();
        assert!(30 > scaled[0] && scaled[0] > scaled[1] && scaled[1] > scaled[2], "{scaled:?}");
        assert!(30 < scaled[3] && scaled[3] < scaled[4] && scaled[4] < scaled[5], "{scaled:?}");
        let occluded: Vec<usize> = of(&probes, Alteration::Occluded).into_iter().map(bird).collect();
        assert_eq!(occluded, [20, 15, 5, 18, 12, 6]);
        let noisy = of(&probes, Alteration::Noisy);
        let change = |probe: &Probe| {
            let pairs = probe.frame.as_slice().iter().zip(gap().picture.as_slice().to_vec());
            pairs.map(|(&a, b)| usize::from(a.abs_diff(b))).sum::<usize>()
        };
        assert!(change(noisy[0]) < change(noisy[1]) && change(noisy[1]) < change(noisy[2]));
    }

    #[test]
    fn what_stands_alone_is_moved_over_its_background() {
        let mut picture = Frame::new(6, 6);
        picture.fill(9);
        picture.row_mut(0)[0..3].fill(200);
        picture.row_mut(1)[0..3].fill(100);
        let probes = probes(&Goal::from(picture), true).expect("there is a thing");
        assert!(probes.iter().all(|probe| probe.alteration == Alteration::Noisy || probe.frame.row(0)[0] == 9));
    }

    #[test]
    fn an_even_goal_has_nothing_to_alter() {
        assert!(matches!(probes(&Goal::from(Frame::new(9, 9)), true), Err(Error::NothingToAlter)));
    }
}
