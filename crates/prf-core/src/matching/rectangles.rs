//! Masks as rectangles, over which sums are cheap.

use crate::Frame;

/// So many squares of bytes add up to less than 2³².
const MAX_AREA: usize = 1 << 16;

/// A rectangle of pixels that count, as the rows and columns where it begins and those just behind its end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Patch {
    pub(super) top: usize,
    pub(super) bottom: usize,
    pub(super) left: usize,
    pub(super) right: usize,
}

/// Patches that cover a picture of this size once.
pub(super) fn whole([height, width]: [usize; 2]) -> Vec<Patch> {
    let mut patches = Vec::new();
    push(&mut patches, Patch { top: 0, bottom: height, left: 0, right: width });
    patches
}

/// Patches that cover the pixels of a mask that are not 0, each once: runs of pixels, joined with the same runs in
/// the rows below.
pub(super) fn of_mask(mask: &Frame) -> Vec<Patch> {
    let (mut open, mut done): (Vec<Patch>, Vec<Patch>) = Default::default();
    for y in 0..mask.height() {
        let runs = runs(mask.row(y));
        let (mut kept, ended): (Vec<_>, Vec<_>) =
            open.into_iter().partition(|patch| runs.contains(&(patch.left, patch.right)));
        ended.into_iter().for_each(|patch| push(&mut done, patch));
        kept.iter_mut().for_each(|patch| patch.bottom = y + 1);
        let is_new = |&(left, right): &(usize, usize)| !kept.iter().any(|p| (p.left, p.right) == (left, right));
        let new: Vec<_> = runs.into_iter().filter(is_new).collect();
        kept.extend(new.into_iter().map(|(left, right)| Patch { top: y, bottom: y + 1, left, right }));
        open = kept;
    }
    open.into_iter().for_each(|patch| push(&mut done, patch));
    done
}

/// Begin and end of each run of pixels that are not 0.
fn runs(row: &[u8]) -> Vec<(usize, usize)> {
    let mut runs = Vec::new();
    let mut x = 0;
    for run in row.chunk_by(|a, b| (*a != 0) == (*b != 0)) {
        if run[0] != 0 {
            runs.push((x, x + run.len()));
        }
        x += run.len();
    }
    runs
}

/// Adds a patch, cut into pieces that are not too large.
fn push(patches: &mut Vec<Patch>, patch: Patch) {
    let width = (patch.right - patch.left).min(MAX_AREA);
    let height = MAX_AREA / width;
    for top in (patch.top..patch.bottom).step_by(height) {
        for left in (patch.left..patch.right).step_by(width) {
            let (bottom, right) = ((top + height).min(patch.bottom), (left + width).min(patch.right));
            patches.push(Patch { top, bottom, left, right });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// How often each pixel is covered.
    fn painted(patches: &[Patch], width: usize, height: usize) -> Vec<u8> {
        let mut frame = Frame::new(width, height);
        for patch in patches {
            assert!((patch.bottom - patch.top) * (patch.right - patch.left) <= MAX_AREA);
            (patch.top..patch.bottom)
                .for_each(|y| frame.row_mut(y)[patch.left..patch.right].iter_mut().for_each(|v| *v += 1));
        }
        frame.as_slice().to_vec()
    }

    #[test]
    fn every_pixel_of_a_mask_is_covered_once() {
        let rows = ["#.##.", "#.##.", "####.", "..#.#", "#.#..", "....."];
        let pixels: Vec<u8> = rows.concat().bytes().map(|c| u8::from(c == b'#')).collect();
        let mask = Frame::from_vec(5, 6, pixels.clone()).expect("5 x 6 pixels");
        let patches = of_mask(&mask);
        assert_eq!(painted(&patches, 5, 6), pixels);
        assert!(patches.contains(&Patch { top: 0, bottom: 2, left: 2, right: 4 }), "{patches:?}");
        assert_eq!(patches.len(), 6);
    }

    #[test]
    fn large_areas_are_cut() {
        for [height, width] in [[300, 500], [1, 70_000], [70_000, 1], [256, 256]] {
            assert!(painted(&whole([height, width]), width, height).iter().all(|&times| times == 1));
        }
        assert_eq!(whole([256, 256]).len(), 1);
    }
}
