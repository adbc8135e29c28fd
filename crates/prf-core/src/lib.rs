//! From pixels to a reward: crop, rescale, HOG, distance, `F = exp(-D)`.
//!
//! This is the arithmetic of "Perceptual Reward Functions" (Edwards, Isbell and Takanishi, 2016): the
//! reward of a frame says how much it looks like a picture of the finished task. Everything here is
//! deterministic, runs on one thread and draws no random numbers.
//!
//! ```
//! use prf_core::{DirectDescriptor, Frame, RewardParams, TaskDescriptor};
//!
//! let goal = Frame::new(84, 84); // a black picture: nothing is left to do
//! let mut descriptor = DirectDescriptor::new(&goal, RewardParams::default())?;
//!
//! let mut frame = Frame::new(84, 84);
//! assert_eq!(descriptor.observe(frame.view())?.reward, 1.0); // the goal itself
//!
//! frame.row_mut(40)[20..60].fill(255);
//! frame.row_mut(70)[30..40].fill(255);
//! let score = descriptor.observe(frame.view())?;
//! assert!(score.distance > 0.0 && score.reward < 1.0);
//! # Ok::<(), prf_core::Error>(())
//! ```
//!
//! The way of one frame, and where each part lives:
//!
//! | Step | Item |
//! |---|---|
//! | colour to grey | [`luma`] |
//! | grey pictures | [`Frame`], [`FrameView`], [`FrameMut`] (bytes); [`Plane`], [`PlaneView`] (floats) |
//! | box around what is not black | [`crop_box`] |
//! | bring both templates to one size | [`Resizer`] |
//! | histograms of oriented gradients | [`Hog`], [`HogParams`], [`HogLayout`] |
//! | distance and reward | [`RewardParams`], [`Score`] |
//! | the goal, prepared once | [`TaskDescriptor`], [`DirectDescriptor`] |
//! | where and when something moved | [`MotionTemplate`], [`MotionParams`], [`DeltaSchedule`] |
//! | where a picture lies in a larger one | [`TemplateMatcher`], [`MatchMethod`], [`Match`] |
//! | what the network sees | [`EmaState`] |
//! | does a reward order states rightly | [`Footage`], [`Evidence`], [`Judgement`], [`spearman`], [`auc`] |
//! | pictures in files (feature `io`) | `io::read_frame`, `io::write_frame` |
//! | animations, videos, folders (feature `io`) | `io::FrameSource` |
//! | the motion template of a sequence in files (feature `io`) | `io::read_motion` |
//! | the sequences of a CK+ folder (feature `io`) | `io::ck_plus` |
//!
//! `docs/reward.md` in the repository has every formula with a worked example.

mod crop;
mod descriptor;
mod ema;
mod error;
mod evidence;
#[cfg(feature = "explain")]
mod explain;
mod frame;
mod goal_check;
mod hog;
#[cfg(feature = "io")]
pub mod io;
pub mod luma;
mod matching;
mod motion;
mod plane;
mod rank;
mod region;
mod resize;
mod reward;
mod simd;

pub use crop::{Rect, crop_box};
pub use descriptor::{
    DescriptorKind, DescriptorParams, DirectDescriptor, Explanation, Goal, MotionDescriptor, TaskDescriptor,
    WindowDescriptor, WindowParams,
};
pub use ema::EmaState;
pub use error::{Error, PictureProblem, SequenceProblem};
pub use evidence::{
    Alteration, Altered, Evidence, Figure, FigureKind, Footage, Judgement, Label, Rewards, Verdict, recommend,
    settings, windows_around,
};
#[cfg(feature = "explain")]
pub use explain::{Comparison, Picture, Ranked, draw_comparison, draw_explanation, draw_ranking};
pub use frame::{Frame, FrameMut, FrameView};
pub use goal_check::{GoalWarning, check_goal};
pub use hog::{CellSize, Hog, HogLayout, HogParams, Norm};
pub use matching::{Match, MatchMethod, TemplateMatcher};
pub use motion::{DeltaSchedule, MotionParams, MotionState, MotionTemplate};
pub use plane::{Plane, PlaneView};
pub use rank::{auc, spearman};
pub use resize::Resizer;
pub use reward::{DistanceScale, RewardParams, Score};
