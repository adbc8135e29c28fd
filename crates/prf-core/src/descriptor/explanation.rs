//! Where a score came from.

use crate::{Frame, FrameView, HogLayout, Match, Rect, RewardParams, Score};

/// Everything that went into a score, borrowed from the descriptor that gave it.
#[derive(Clone, Copy, Debug)]
pub struct Explanation<'a> {
    /// The score itself.
    pub score: Score,
    /// The goal's template, `T_G`.
    pub goal: FrameView<'a>,
    /// The part of `goal` that was compared: what is not black.
    pub goal_box: Rect,
    /// The picture that the agent's template `T_A` was found in: the mirror frame, or its motion template.
    pub agent: FrameView<'a>,
    /// Where in `agent` the window of a window descriptor was found.
    pub matched: Option<Match>,
    /// The part of `agent` that was compared, in its pixels: what is not black, within the window if there is one.
    pub agent_box: Rect,
    /// Of a window goal that is no rectangle: what counts of the window, which is where this picture of its size isn't black.
    pub mask: Option<FrameView<'a>>,
    /// How templates are compared.
    pub params: RewardParams,
    /// Cells and blocks, at the common size of the two boxes.
    pub layout: HogLayout,
    /// `H(T_A)`, in the order of [`HogLayout::len`].
    pub agent_features: &'a [f32],
    /// `H(T_G)`, in the same order.
    pub goal_features: &'a [f32],
}

impl Explanation<'_> {
    /// The agent's template `T_A` as it was compared: [`agent_box`](Explanation::agent_box) of
    /// [`agent`](Explanation::agent), black where a mask says that it doesn't count.
    #[must_use]
    pub fn agent_template(&self) -> Frame {
        let Rect { x, y, width, height } = self.agent_box;
        let mut template = Frame::new(width, height);
        for row in 0..height {
            let pixels = template.row_mut(row);
            pixels.copy_from_slice(&self.agent.row(y + row)[x..x + width]);
            if let (Some(mask), Some(Match { rect: window, .. })) = (self.mask, self.matched) {
                let counts = &mask.row(y + row - window.y)[x - window.x..];
                pixels.iter_mut().zip(counts).filter(|(_, counts)| **counts == 0).for_each(|(pixel, _)| *pixel = 0);
            }
        }
        template
    }

    /// How much each cell adds to the squared distance of the features, at least 0: `[rows, columns]` as
    /// [`HogLayout::cells`] has them, row by row. Their sum is `‖H(T_A) − H(T_G)‖²`, before the scale divides its root: a cell
    /// that lies in several blocks gets its share of each.
    #[must_use]
    pub fn cell_differences(&self) -> Vec<f32> {
        let ([rows, columns], [_, block_columns]) = (self.layout.cells(), self.layout.blocks());
        let (orientations, block_cells) = (self.layout.orientations(), self.layout.block_cells());
        let mut differences = vec![0.0; rows * columns];
        let histograms =
            self.agent_features.chunks_exact(orientations).zip(self.goal_features.chunks_exact(orientations));
        for (index, (agent, goal)) in histograms.enumerate() {
            let (block, cell) = (index / (block_cells * block_cells), index % (block_cells * block_cells));
            let row = block / block_columns + cell / block_cells;
            let column = block % block_columns + cell % block_cells;
            differences[row * columns + column] += agent.iter().zip(goal).map(|(a, g)| (a - g) * (a - g)).sum::<f32>();
        }
        differences
    }
}

#[cfg(test)]
mod tests {
    use crate::{CellSize, DirectDescriptor, Frame, HogParams, RewardParams, TaskDescriptor};

    fn frame(seed: usize) -> Frame {
        let pixels = (0..24 * 18).map(|i| ((i * (seed + 3) * 2_654_435_761) >> 11) as u8).collect();
        Frame::from_vec(24, 18, pixels).expect("24 x 18")
    }

    #[test]
    fn cell_differences_add_up_to_the_squared_distance() {
        for block_cells in 1..=3 {
            let hog = HogParams { cell: CellSize::Px(3), block_cells, ..HogParams::default() };
            let params = RewardParams { hog, scale: crate::DistanceScale::None };
            let mut descriptor = DirectDescriptor::new(&frame(1), params).expect("valid");
            let score = descriptor.observe(frame(2).view()).expect("any frame will do");
            let frame = frame(2);
            let explanation = descriptor.explain(frame.view());
            let differences = explanation.cell_differences();
            assert_eq!(differences.len(), 8 * 6);
            let distance = differences.iter().sum::<f32>().sqrt();
            assert!((distance - score.distance).abs() < 1e-4 * distance, "{distance}, not {}", score.distance);
        }
    }

    #[test]
    fn what_differs_is_found_where_it_lies() {
        let (goal, mut frame) = (frame(1), frame(1));
        frame.row_mut(13)[19] ^= 0x80;
        let hog = HogParams { cell: CellSize::Px(6), ..HogParams::default() };
        let mut descriptor =
            DirectDescriptor::new(&goal, RewardParams { hog, ..RewardParams::default() }).expect("valid");
        descriptor.observe(frame.view()).expect("any frame will do");
        let differences = descriptor.explain(frame.view()).cell_differences();
        let changed: Vec<usize> = (0..differences.len()).filter(|&cell| differences[cell] > 1e-9).collect();
        // Pixel (19, 13) lies in column 3 and row 2 of 4 columns of cells; its lower and upper neighbours do, too.
        assert_eq!(changed, [2 * 4 + 3]);
    }
}
