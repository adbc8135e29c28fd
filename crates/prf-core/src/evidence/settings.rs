//! The settings that are worth a try.

use crate::{CellSize, Goal, HogLayout, HogParams, Norm, RewardParams, crop_box};

/// Sides of a cell, as parts of the goal's height.
const CELLS: [f32; 9] = [0.03, 0.05, 0.075, 0.1, 0.15, 0.2, 0.25, 0.3, 0.4];
const NORMS: [Norm; 4] = [Norm::L2, Norm::L2Hys, Norm::L1, Norm::L1Sqrt];
const BLOCKS: [usize; 3] = [1, 2, 3];

/// Settings to choose from for this goal: cell sizes × norms × cells on a block's side, all else as in `params`, whose own
/// setting comes first. Without a norm, blocks change nothing but weights, so there they have one cell.
///
/// Settings whose block doesn't fit the goal are left out, and so are cells that come to the same pixels.
#[must_use]
pub fn settings(goal: &Goal, params: RewardParams) -> Vec<RewardParams> {
    let crop = crop_box(goal.seen().view());
    let fits = |hog: &HogParams| HogLayout::new(hog, crop.width, crop.height).is_ok();
    let mut settings: Vec<RewardParams> = Some(params).filter(|params| fits(&params.hog)).into_iter().collect();
    let kinds = NORMS.iter().flat_map(|&norm| BLOCKS.map(|block_cells| (norm, block_cells))).chain([(Norm::None, 1)]);
    for (norm, block_cells) in kinds {
        for cell in CELLS.map(CellSize::Fraction) {
            let hog = HogParams { cell, norm, block_cells, ..params.hog };
            let same = |other: &RewardParams| {
                let px = |cell: CellSize| cell.cell_px(crop.height);
                HogParams { cell, ..other.hog } == hog && px(other.hog.cell) == px(cell)
            };
            if fits(&hog) && !settings.iter().any(same) {
                settings.push(RewardParams { hog, ..params });
            }
        }
    }
    settings
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Frame;

    #[test]
    fn every_setting_fits_the_goal_and_differs_from_the_others() {
        let mut goal = Frame::new(40, 40);
        (5..15).for_each(|y| goal.row_mut(y)[5..35].fill(100));
        let params = RewardParams::default();
        let settings = settings(&Goal::from(goal), params);
        assert_eq!(settings[0], params);
        let px = |params: &RewardParams| params.hog.cell.cell_px(10);
        for (index, a) in settings.iter().enumerate() {
            assert!(HogLayout::new(&a.hog, 30, 10).is_ok());
            let b = settings[..index]
                .iter()
                .find(|b| (px(a), a.hog.norm, a.hog.block_cells) == (px(b), b.hog.norm, b.hog.block_cells));
            assert_eq!(b, None);
        }
        // Cells of 1, 2, 3 and 4 px; with 3 cells a block, 3 px at most.
        assert_eq!(settings.len(), 4 * (4 + 4 + 3) + 4);
    }

    #[test]
    fn what_does_not_fit_is_left_out_even_if_it_was_given() {
        let hog = HogParams { cell: CellSize::Px(50), ..HogParams::default() };
        let params = RewardParams { hog, ..RewardParams::default() };
        let found = settings(&Goal::from(Frame::new(40, 40)), params);
        assert!(!found.is_empty() && !found.contains(&params));
    }

    #[test]
    fn what_is_not_searched_stays() {
        let hog = HogParams { orientations: 5, signed: true, ..HogParams::default() };
        let params = RewardParams { hog, scale: crate::DistanceScale::None };
        let found = settings(&Goal::from(Frame::new(84, 84)), params);
        assert!(found.iter().all(|s| s.hog.orientations == 5 && s.hog.signed && s.scale == params.scale));
    }
}
