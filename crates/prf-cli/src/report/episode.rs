//! The agent playing, and what the reward says of the frames.

use prf_core::{Comparison, Frame, Score, draw_comparison};
use prf_dqn::learner::greedy_actions;
use prf_dqn::network::QNetwork;
use prf_envs::{Status, Task, registry};

use crate::error::Result;
use crate::gif::GreyGif;
use crate::settings::LoadedRun;

/// Steps that are played at most; what is ranked is among them.
const MOST_STEPS: usize = 3000;
/// Frames of the moving picture at most.
const GIF_FRAMES: usize = 450;
/// Frames a second where the world goes on by itself, and where it waits for each action.
const REAL_TIME_FPS: u32 = 15;
const TURN_BASED_FPS: u32 = 4;
/// How many frames are shown of the best and of the worst.
const RANKED: usize = 3;

/// An episode that was played.
pub(crate) struct Episode {
    /// The start, then the frame after each step.
    frames: Vec<Frame>,
    pub(crate) steps: usize,
    pub(crate) score: f32,
    pub(crate) reward: f64,
    pub(crate) status: Status,
    frames_per_second: u32,
    /// The frames of the highest rewards and of the lowest, the extreme ones first; none for a reward without a picture.
    pub(crate) best: Vec<RankedFrame>,
    pub(crate) worst: Vec<RankedFrame>,
}

/// A frame with what it was scored by.
pub(crate) struct RankedFrame {
    pub(crate) frame: Frame,
    /// The step it comes after.
    pub(crate) step: usize,
    pub(crate) score: Score,
    /// The world's score by then.
    pub(crate) points: f32,
    /// What was compared, drawn.
    pub(crate) comparison: Comparison,
    pub(crate) matched: Option<f32>,
}

/// The world's own score after each step, and the reward.
struct Step {
    points: f32,
    reward: f32,
}

impl Episode {
    /// Plays the episode of `seed` greedily.
    ///
    /// # Errors
    ///
    /// The network or the task fails.
    pub(crate) fn play(network: &QNetwork, loaded: &LoadedRun, seed: u64) -> Result<Episode> {
        let mut task = Task::new(&loaded.config.task(), loaded.goal.as_ref())?;
        let actions = task.spec().actions.len();
        task.reset(seed);
        let (mut frames, mut steps, mut status) = (vec![task.mirror().clone()], Vec::new(), Status::Running);
        while status == Status::Running && steps.len() < MOST_STEPS {
            let values = network.q_values(task.observation(), 1)?;
            for action in greedy_actions(&values, actions) {
                let step = task.step(action)?;
                status = step.status;
                steps.push(Step { points: step.score, reward: step.reward });
            }
            frames.push(task.mirror().clone());
        }
        let is_real_time =
            registry::controls(&loaded.config.env.name).is_some_and(|controls| controls.pace.is_real_time());
        let (best, worst) = rank(loaded, &frames, &steps)?;
        Ok(Episode {
            steps: steps.len(),
            score: steps.last().map_or(0.0, |step| step.points),
            reward: steps.iter().map(|step| f64::from(step.reward)).sum(),
            status,
            frames_per_second: if is_real_time { REAL_TIME_FPS } else { TURN_BASED_FPS },
            frames,
            best,
            worst,
        })
    }

    /// The beginning as a moving picture, at the world's own size.
    pub(crate) fn gif(&self) -> Result<Vec<u8>> {
        let first = self.first();
        let mut gif = GreyGif::new(first.width(), first.height(), self.frames_per_second)?;
        self.frames.iter().take(GIF_FRAMES).try_for_each(|frame| gif.add(frame.view()))?;
        gif.finish()
    }

    /// How long the part is that the moving picture leaves out, in steps.
    pub(crate) fn left_out(&self) -> usize {
        self.frames.len().saturating_sub(GIF_FRAMES)
    }

    pub(crate) fn first(&self) -> &Frame {
        &self.frames[0]
    }
}

/// Frames of which no two look the same, by their rewards; how each was compared is found out by going through the episode
/// once more, since a reward may depend on the frames before.
fn rank(loaded: &LoadedRun, frames: &[Frame], steps: &[Step]) -> Result<(Vec<RankedFrame>, Vec<RankedFrame>)> {
    let (Some(params), Some(goal)) = (loaded.config.reward.descriptor_params(), &loaded.goal) else {
        return Ok((Vec::new(), Vec::new()));
    };
    let mut order: Vec<usize> = (0..steps.len()).collect();
    order.sort_by(|&a, &b| steps[b].reward.total_cmp(&steps[a].reward));
    let best = different(order.iter().copied(), &frames[1..]);
    let worst = different(order.iter().rev().copied(), &frames[1..]);

    let mut descriptor = params.describe(goal, loaded.config.reward.params())?;
    descriptor.pass(frames[0].view())?;
    let mut drawn = Vec::new();
    for (index, (frame, step)) in frames[1..].iter().zip(steps).enumerate() {
        let score = descriptor.observe(frame.view())?;
        if best.contains(&index) || worst.contains(&index) {
            let explanation = descriptor.explain(frame.view());
            drawn.push(RankedFrame {
                frame: frame.clone(),
                step: index + 1,
                score,
                points: step.points,
                comparison: draw_comparison(&explanation),
                matched: explanation.matched.map(|matched| matched.score),
            });
        }
    }
    let (mut highest, mut lowest) = (Vec::new(), Vec::new());
    for ranked in drawn {
        let is_best = best.contains(&(ranked.step - 1));
        if is_best { highest.push(ranked) } else { lowest.push(ranked) }
    }
    highest.sort_by(|a: &RankedFrame, b| b.score.reward.total_cmp(&a.score.reward));
    lowest.sort_by(|a: &RankedFrame, b| a.score.reward.total_cmp(&b.score.reward));
    Ok((highest, lowest))
}

/// The first few frames of which no two look the same.
fn different(order: impl Iterator<Item = usize>, frames: &[Frame]) -> Vec<usize> {
    let mut shown: Vec<usize> = Vec::new();
    for index in order {
        if shown.len() == RANKED {
            break;
        }
        if shown.iter().all(|&other| frames[other] != frames[index]) {
            shown.push(index);
        }
    }
    shown
}
