//! What was compared, as pictures without words, for pages that have words of their own.

use super::canvas::{Panel, Picture};
use super::{Differences, draw_frame, heat};
use crate::Explanation;

/// The longer side of a picture, in pixels.
const SIDE: usize = 360;

/// Three pictures whose longer side is 360 px.
#[derive(Clone, Debug)]
pub struct Comparison {
    /// The goal, and in green the part of it that was compared.
    pub goal: Picture,
    /// What the agent's template was found in, with the part that was compared in green and the window in orange.
    pub agent: Picture,
    /// Each cell's share in the squared distance, the brightest the largest; all dark where nothing differs.
    pub differences: Picture,
}

/// Draws what was compared.
///
/// ```
/// use prf_core::{DirectDescriptor, Frame, RewardParams, TaskDescriptor, draw_comparison};
/// let (goal, mut frame) = (Frame::new(84, 42), Frame::new(84, 42));
/// frame.row_mut(30)[20..60].fill(255);
/// let mut descriptor = DirectDescriptor::new(&goal, RewardParams::default())?;
/// descriptor.observe(frame.view())?;
/// let comparison = draw_comparison(&descriptor.explain(frame.view()));
/// assert_eq!((comparison.agent.width(), comparison.agent.height()), (360, 180));
/// # Ok::<(), prf_core::Error>(())
/// ```
#[must_use]
pub fn draw_comparison(explanation: &Explanation<'_>) -> Comparison {
    let drawn = |[width, height]: [usize; 2], draw: &dyn Fn(&mut Picture, Panel)| {
        let fitted = Panel { left: 0, top: 0, width: SIDE, height: SIDE }.fit(width, height);
        let mut picture = Picture::new(fitted.width, fitted.height);
        draw(&mut picture, Panel { left: 0, top: 0, ..fitted });
        picture
    };
    let (goal, agent) = (explanation.goal, explanation.agent);
    let window = explanation.matched.map(|matched| matched.rect);
    let [height, width] = explanation.layout.shape();
    Comparison {
        goal: drawn([goal.width(), goal.height()], &|picture, panel| {
            draw_frame(picture, panel, goal, explanation.goal_box, None);
        }),
        agent: drawn([agent.width(), agent.height()], &|picture, panel| {
            draw_frame(picture, panel, agent, explanation.agent_box, window);
        }),
        differences: drawn([width, height], &|picture, panel| {
            heat::draw(picture, panel, explanation.layout, &Differences::of(explanation).cells);
        }),
    }
}
