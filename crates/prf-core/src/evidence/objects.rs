//! What a goal shows, taken apart: separate things on an even background.

use crate::{Frame, FrameView, Rect};

/// A grey that differs from the background by no more than this belongs to it.
const NEXT_TO_BACKGROUND: u8 = 12;
/// Smaller things are specks, in pixels.
const LEAST_AREA: usize = 4;
/// The largest things are enough to judge by.
const MOST_OBJECTS: usize = 6;

/// A thing in a picture: pixels that hang together.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Object {
    /// The box around it.
    pub(super) rect: Rect,
    /// The thing in its box; `None` where something else shows.
    pub(super) pixels: Vec<Option<u8>>,
}

impl Object {
    /// Its pixels with their place in the box, `(x, y, value)`.
    pub(super) fn lit(&self) -> impl Iterator<Item = (usize, usize, u8)> {
        let width = self.rect.width;
        self.pixels.iter().enumerate().filter_map(move |(i, pixel)| pixel.map(|value| (i % width, i / width, value)))
    }

    fn area(&self) -> usize {
        self.pixels.iter().flatten().count()
    }
}

/// A picture taken apart.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Scene {
    /// The grey between the things: the most frequent one.
    pub(super) background: u8,
    /// The largest first.
    pub(super) objects: Vec<Object>,
    /// Whether things that the border cuts off were left out of `objects`: they go on beyond it.
    pub(super) has_scenery: bool,
}

impl Scene {
    pub(super) fn of(picture: FrameView<'_>) -> Scene {
        let background = most_frequent(picture.as_slice());
        let all = components(picture, background);
        let (cut_off, whole): (Vec<_>, Vec<_>) = all.into_iter().partition(|object| touches_border(object, picture));
        // Where nothing is whole, what the border cuts off is all there is.
        let (mut objects, has_scenery) = match whole.is_empty() {
            true => (cut_off, false),
            false => (whole, !cut_off.is_empty()),
        };
        objects.sort_by_key(|object| std::cmp::Reverse(object.area()));
        objects.truncate(MOST_OBJECTS);
        Scene { background, objects, has_scenery }
    }
}

fn most_frequent(pixels: &[u8]) -> u8 {
    let mut counts = [0usize; 256];
    pixels.iter().for_each(|&pixel| counts[usize::from(pixel)] += 1);
    // Of equal counts the darkest.
    (0..=255).rev().max_by_key(|&value| counts[usize::from(value)]).unwrap_or(0)
}

fn touches_border(object: &Object, picture: FrameView<'_>) -> bool {
    let Rect { x, y, width, height } = object.rect;
    x == 0 || y == 0 || x + width == picture.width() || y + height == picture.height()
}

/// Groups of pixels that are not background, neighbours in any of eight directions.
fn components(picture: FrameView<'_>, background: u8) -> Vec<Object> {
    let (width, height) = (picture.width(), picture.height());
    let mut open: Vec<bool> =
        picture.as_slice().iter().map(|pixel| pixel.abs_diff(background) > NEXT_TO_BACKGROUND).collect();
    let (mut objects, mut pending, mut found) = (Vec::new(), Vec::new(), Vec::new());
    for start in 0..open.len() {
        if !open[start] {
            continue;
        }
        open[start] = false;
        pending.push(start);
        found.clear();
        while let Some(at) = pending.pop() {
            found.push(at);
            let (x, y) = (at % width, at / width);
            for near_y in y.saturating_sub(1)..(y + 2).min(height) {
                for near_x in x.saturating_sub(1)..(x + 2).min(width) {
                    let near = near_y * width + near_x;
                    if std::mem::take(&mut open[near]) {
                        pending.push(near);
                    }
                }
            }
        }
        if found.len() >= LEAST_AREA {
            objects.push(cut_out(picture, &found));
        }
    }
    objects
}

fn cut_out(picture: FrameView<'_>, places: &[usize]) -> Object {
    let width = picture.width();
    let mut rect = Rect { x: usize::MAX, y: usize::MAX, width: 0, height: 0 };
    let (mut right, mut bottom) = (0, 0);
    for place in places {
        let (x, y) = (place % width, place / width);
        (rect.x, rect.y) = (rect.x.min(x), rect.y.min(y));
        (right, bottom) = (right.max(x), bottom.max(y));
    }
    (rect.width, rect.height) = (right - rect.x + 1, bottom - rect.y + 1);
    let mut pixels = vec![None; rect.width * rect.height];
    for &place in places {
        let (x, y) = (place % width - rect.x, place / width - rect.y);
        pixels[y * rect.width + x] = Some(picture.as_slice()[place]);
    }
    Object { rect, pixels }
}

/// Draws an object so that its box begins at this `[x, y]`, where it has to fit.
pub(super) fn paint(frame: &mut Frame, object: &Object, [x, y]: [usize; 2]) {
    for (column, row, value) in object.lit() {
        frame.row_mut(y + row)[x + column] = value;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn picture(rows: &[&str]) -> Frame {
        let pixels = rows.iter().flat_map(|row| row.bytes()).map(|byte| if byte == b'.' { 5 } else { byte });
        Frame::from_vec(rows[0].len(), rows.len(), pixels.collect()).expect("rows of one length")
    }

    #[test]
    fn what_hangs_together_is_one_thing() {
        let scene = Scene::of(picture(&["........", ".aa..b..", ".aa.b.b.", ".....b..", "........"]).view());
        assert_eq!(scene.background, 5);
        assert_eq!(scene.objects.len(), 2);
        let Object { rect, pixels } = &scene.objects[1];
        assert_eq!(*rect, Rect { x: 4, y: 1, width: 3, height: 3 });
        let b = Some(b'b');
        assert_eq!(*pixels, [None, b, None, b, None, b, None, b, None]);
    }

    #[test]
    fn what_the_border_cuts_off_is_scenery_unless_there_is_nothing_else() {
        let both = Scene::of(picture(&["aa......", "aa..bb..", "aa..bb..", "........"]).view());
        assert_eq!((both.objects.len(), both.has_scenery), (1, true));
        assert_eq!(both.objects[0].rect, Rect { x: 4, y: 1, width: 2, height: 2 });
        let alone = Scene::of(picture(&["aa......", "aa......", "aa......", "........"]).view());
        assert_eq!((alone.objects.len(), alone.has_scenery), (1, false));
    }

    #[test]
    fn specks_and_near_greys_are_background() {
        let mut speckled = picture(&["........", "..a.....", "........"]);
        speckled.row_mut(1)[5..7].fill(5 + NEXT_TO_BACKGROUND);
        assert_eq!(Scene::of(speckled.view()).objects, []);
    }
}
