//! Draws where a score came from: goal and agent side by side, what of them was compared, and what differs.

mod canvas;
mod comparison;
mod glyphs;
mod heat;
mod ranking;

use std::f32::consts::{PI, TAU};

pub use canvas::Picture;
use canvas::{BOX, GREY, INK, Panel, WINDOW};
pub use comparison::{Comparison, draw_comparison};
pub use ranking::{Ranked, draw_ranking};

use crate::{Explanation, FrameView, Norm, Rect};

/// Side of a panel, in pixels.
const PANEL: usize = 360;
const MARGIN: usize = 20;
/// Height of the headline, and of the two lines under a panel.
const HEADLINE: usize = 54;
const CAPTION: usize = 44;

/// Draws an explanation, 1160×882 px: goal, agent and the share of each cell in the distance above, the HOGs of both and the
/// numbers in words below. `name` stands in the headline, such as the frame's file.
///
/// ```
/// use prf_core::{DirectDescriptor, Frame, RewardParams, TaskDescriptor, draw_explanation};
/// let (goal, mut frame) = (Frame::new(84, 84), Frame::new(84, 84));
/// frame.row_mut(40)[20..60].fill(255);
/// frame.row_mut(70)[30..40].fill(255);
/// let mut descriptor = DirectDescriptor::new(&goal, RewardParams::default())?;
/// descriptor.observe(frame.view())?;
/// let picture = draw_explanation(&descriptor.explain(frame.view()), "frame 17");
/// assert_eq!((picture.width(), picture.height()), (1160, 882));
/// assert_eq!(picture.as_rgb().len(), 1160 * 882 * 3);
/// # Ok::<(), prf_core::Error>(())
/// ```
#[must_use]
pub fn draw_explanation(explanation: &Explanation<'_>, name: &str) -> Picture {
    let mut picture = Picture::new(3 * PANEL + 4 * MARGIN, HEADLINE + 2 * (PANEL + CAPTION) + MARGIN);
    headline(&mut picture, explanation, name);
    let differences = Differences::of(explanation);

    let [goal, agent, heat] = [0, 1, 2].map(|column| place(column, 0));
    draw_frame(&mut picture, goal, explanation.goal, explanation.goal_box, None);
    goal.caption(&mut picture, &["goal", &compared(explanation.goal_box)]);
    let window = explanation.matched.map(|matched| matched.rect);
    draw_frame(&mut picture, agent, explanation.agent, explanation.agent_box, window);
    agent.caption(&mut picture, &["agent", &agent_words(explanation)]);
    heat::draw(&mut picture, heat, explanation.layout, &differences.cells);
    heat.caption(&mut picture, &["what differs: each cell's share of D²", &differences.words()]);

    let [goal, agent, words] = [0, 1, 2].map(|column| place(column, 1));
    let strongest = strongest(explanation);
    let span = if explanation.params.hog.signed { TAU } else { PI };
    for (panel, title, features) in
        [(goal, "HOG of the goal", explanation.goal_features), (agent, "HOG of the agent", explanation.agent_features)]
    {
        let merged = glyphs::draw(&mut picture, panel, explanation.layout, features, (strongest, span));
        panel.caption(&mut picture, &[title, &glyph_words(merged)]);
    }
    words.lines(&mut picture, &in_words(explanation, &differences));
    picture
}

fn place(column: usize, row: usize) -> Panel {
    Panel {
        left: MARGIN + column * (PANEL + MARGIN),
        top: HEADLINE + row * (PANEL + CAPTION),
        width: PANEL,
        height: PANEL,
    }
}

fn headline(picture: &mut Picture, explanation: &Explanation<'_>, name: &str) {
    let score = explanation.score;
    let numbers = format!("reward F = {}   distance D = {}", number(score.reward), number(score.distance));
    picture.title(MARGIN, 18, &numbers, INK);
    let left = MARGIN + 10 * (numbers.chars().count() + 3);
    let room = (picture.width() - left - MARGIN) / 9;
    picture.text(left, 22, &shortened(name, room), GREY);
}

fn draw_frame(picture: &mut Picture, panel: Panel, frame: FrameView<'_>, compared: Rect, window: Option<Rect>) {
    let fitted = panel.fit(frame.width(), frame.height());
    picture.grey(fitted, |x, y| frame.row(y)[x], [frame.width(), frame.height()]);
    let part = |rect| fitted.part([frame.width(), frame.height()], rect);
    if let Some(window) = window {
        // Around it, since what is compared often fills the window.
        picture.outline(part(window).grown(2), WINDOW);
    }
    picture.outline(part(compared), BOX);
}

fn compared(rect: Rect) -> String {
    format!("compared (green): {}x{} px at ({}, {})", rect.width, rect.height, rect.x, rect.y)
}

fn agent_words(explanation: &Explanation<'_>) -> String {
    match explanation.matched {
        None => compared(explanation.agent_box),
        Some(matched) => {
            format!("window (orange) at ({}, {}), match {:.3}", matched.rect.x, matched.rect.y, matched.score)
        }
    }
}

fn glyph_words(merged: usize) -> String {
    match merged {
        1 => "one star a cell, strokes along edges".to_owned(),
        n => format!("one star for {n}x{n} cells"),
    }
}

/// The largest feature of both: what is drawn white.
fn strongest(explanation: &Explanation<'_>) -> f32 {
    let features = explanation.agent_features.iter().chain(explanation.goal_features);
    features.copied().fold(0.0, f32::max)
}

/// The cells' parts of the squared distance.
struct Differences {
    /// Shares, which add up to 1; all 0 where nothing differs.
    cells: Vec<f32>,
}

impl Differences {
    fn of(explanation: &Explanation<'_>) -> Differences {
        let mut cells = explanation.cell_differences();
        let sum: f32 = cells.iter().sum();
        if sum > 0.0 {
            cells.iter_mut().for_each(|cell| *cell /= sum);
        }
        Differences { cells }
    }

    fn largest(&self) -> f32 {
        self.cells.iter().copied().fold(0.0, f32::max)
    }

    /// How many cells, the most different first, make up this part of the squared distance.
    fn cells_for(&self, part: f32) -> usize {
        let mut sorted = self.cells.clone();
        sorted.sort_by(|a, b| b.total_cmp(a));
        let sums = sorted.iter().scan(0.0, |sum, cell| {
            let before = *sum;
            *sum += cell;
            Some((before, *cell))
        });
        sums.take_while(|&(before, cell)| before < part && cell > 0.0).count()
    }

    fn words(&self) -> String {
        match self.largest() {
            0.0 => "nothing differs".to_owned(),
            largest => format!("brightest: {:.2} % in one cell", 100.0 * largest),
        }
    }
}

fn in_words(explanation: &Explanation<'_>, differences: &Differences) -> Vec<String> {
    let (layout, score) = (explanation.layout, explanation.score);
    let ([height, width], [rows, columns], [block_rows, block_columns]) =
        (layout.shape(), layout.cells(), layout.blocks());
    let mut lines = vec![
        "in words".to_owned(),
        String::new(),
        format!("both brought to {width}x{height} px"),
        format!("{columns}x{rows} cells of {0}x{0} px", layout.cell_px()),
        format!("{} directions", layout.orientations()),
        format!("{} blocks of {1}x{1} cells", block_rows * block_columns, layout.block_cells()),
        format!("norm {}", norm(explanation.params.hog.norm)),
        String::new(),
        format!("D = {}", number(score.distance)),
        format!("F = exp(-D) = {}", number(score.reward)),
        String::new(),
    ];
    let total = differences.cells.len();
    match differences.cells_for(0.5) {
        0 => lines.push("no cell differs".to_owned()),
        half => {
            lines.push(format!("half of D² comes from {half} of"));
            lines.push(format!("{total} cells"));
        }
    }
    lines
}

fn norm(norm: Norm) -> &'static str {
    match norm {
        Norm::None => "none",
        Norm::L1 => "L1",
        Norm::L1Sqrt => "L1-sqrt",
        Norm::L2 => "L2",
        Norm::L2Hys => "L2-Hys",
    }
}

/// Four digits, also of a very small number.
fn number(value: f32) -> String {
    if value != 0.0 && value < 1e-3 { format!("{value:.2e}") } else { format!("{value:.4}") }
}

/// The end of a long name says more than its beginning.
fn shortened(name: &str, room: usize) -> String {
    let count = name.chars().count();
    if count <= room {
        return name.to_owned();
    }
    let end: String = name.chars().skip(count + 3 - room.max(4)).collect();
    format!("...{end}")
}
