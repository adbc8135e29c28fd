//! What the figures of a reward's settings come to.

use super::{Figure, FigureKind};
use crate::goal_check::{NEXT_TO_NOTHING, NEXT_TO_ONE};
use crate::{FrameView, HogLayout, RewardParams, crop_box};

/// Rewards that spread by less than this tell no two frames apart.
const LEAST_SPREAD: f32 = 0.01;
/// Where most rewards spread by less, an agent sees little of their order.
const NARROW: f32 = 0.005;
/// Qualities that differ by less are the same: what a rank correlation of some hundred frames is good for.
const SAME_QUALITY: f64 = 0.01;
/// Spreads of at least this part of another are the same.
const SAME_SPREAD: f32 = 0.95;

/// What a reward's settings are worth.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// Every figure that decides reaches what is needed, and the rewards spread.
    Good,
    /// Right more often than wrong, or right but hardly spread.
    Weak,
    /// A figure says that progress is punished.
    Misleading,
    /// All rewards are the same, or next to nothing.
    Blind,
}

/// How the rewards `F` spread.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rewards {
    /// The least.
    pub least: f32,
    /// A tenth is at most this.
    pub low: f32,
    /// Half is at most this.
    pub median: f32,
    /// Nine tenths are at most this.
    pub high: f32,
    /// The largest.
    pub largest: f32,
    /// The share above 0.99, next to that of the goal itself, in [0, 1].
    pub next_to_one: f32,
    /// The share below 1e-6, too little to learn from, in [0, 1].
    pub next_to_nothing: f32,
}

impl Rewards {
    fn of(distances: &[f32]) -> Rewards {
        let mut rewards: Vec<f32> = distances.iter().map(|distance| (-distance).exp()).collect();
        rewards.sort_by(f32::total_cmp);
        let at = |part: f32| rewards[((rewards.len() - 1) as f32 * part).round() as usize];
        let share = |is_such: &dyn Fn(f32) -> bool| {
            rewards.iter().filter(|&&reward| is_such(reward)).count() as f32 / rewards.len() as f32
        };
        Rewards {
            least: at(0.0),
            low: at(0.1),
            median: at(0.5),
            high: at(0.9),
            largest: at(1.0),
            next_to_one: share(&|reward| reward > NEXT_TO_ONE),
            next_to_nothing: share(&|reward| reward < NEXT_TO_NOTHING),
        }
    }

    /// How far the middle eight tenths lie apart.
    #[must_use]
    pub fn spread(&self) -> f32 {
        self.high - self.low
    }

    /// Whether most of them lie so close together that an agent sees little of their order.
    #[must_use]
    pub fn are_narrow(&self) -> bool {
        self.spread() < NARROW
    }
}

/// Settings of a reward, and how good a reward they make.
#[derive(Clone, Debug, PartialEq)]
pub struct Judgement {
    /// The settings.
    pub params: RewardParams,
    /// The side of a cell on the cropped goal, in pixels.
    pub cell_px: usize,
    /// All figures, the most important first.
    pub figures: Vec<Figure>,
    /// The least strength of the figures that decide, from −1 to 1.
    pub quality: f64,
    /// How the rewards spread.
    pub rewards: Rewards,
    /// What it comes to.
    pub verdict: Verdict,
}

impl Judgement {
    /// Of at least one distance.
    pub(super) fn new(params: RewardParams, goal: FrameView<'_>, figures: Vec<Figure>, distances: &[f32]) -> Judgement {
        let deciding = || figures.iter().filter(|figure| figure.kind.needed().is_some());
        let quality = deciding().map(Figure::strength).fold(f64::INFINITY, f64::min);
        let quality = if quality.is_finite() { quality } else { 0.0 };
        let rewards = Rewards::of(distances);
        let is_good = deciding().all(|figure| figure.value >= figure.kind.needed());
        let verdict = if rewards.largest < NEXT_TO_NOTHING || rewards.largest - rewards.least < LEAST_SPREAD {
            Verdict::Blind
        } else if quality < 0.0 {
            Verdict::Misleading
        } else if is_good && quality > 0.0 && !rewards.are_narrow() {
            Verdict::Good
        } else {
            Verdict::Weak
        };
        let crop = crop_box(goal);
        let cell_px = HogLayout::fitted(&params.hog, [crop.height, crop.width]).cell_px();
        Judgement { params, cell_px, figures, quality, rewards, verdict }
    }

    /// One of its figures.
    #[must_use]
    pub fn figure(&self, kind: FigureKind) -> Option<f64> {
        self.figures.iter().find(|figure| figure.kind == kind)?.value
    }
}

/// Which of these settings is the best: good ones before weak ones, then those of the highest quality, of these those of the widest spread,
/// and of those alike in all the first. None that is blind or misleading is recommended.
pub fn recommend<'a>(judgements: impl IntoIterator<Item = &'a Judgement>) -> Option<usize> {
    let mut best: Vec<(usize, &Judgement)> = judgements.into_iter().enumerate().collect();
    best.retain(|(_, judgement)| matches!(judgement.verdict, Verdict::Good | Verdict::Weak));
    if best.iter().any(|(_, judgement)| judgement.verdict == Verdict::Good) {
        best.retain(|(_, judgement)| judgement.verdict == Verdict::Good);
    }
    let quality = best.iter().map(|(_, judgement)| judgement.quality).fold(f64::NEG_INFINITY, f64::max);
    best.retain(|(_, judgement)| judgement.quality >= quality - SAME_QUALITY);
    let spread = best.iter().map(|(_, judgement)| judgement.rewards.spread()).fold(0.0, f32::max);
    let first = best.into_iter().find(|(_, judgement)| judgement.rewards.spread() >= SAME_SPREAD * spread);
    first.map(|(index, _)| index)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Frame;

    /// Of rewards that spread from exp(-most) to 1.
    fn judged(rank: f64, most: f32) -> Judgement {
        let figures = vec![
            Figure { kind: FigureKind::Rank, value: Some(rank) },
            Figure { kind: FigureKind::EarlyRank, value: Some(-1.0) },
        ];
        let distances: Vec<f32> = (0..=10).map(|i| most * i as f32 / 10.0).collect();
        Judgement::new(RewardParams::default(), Frame::new(60, 50).view(), figures, &distances)
    }

    #[test]
    fn rewards_are_told_by_their_tenths() {
        let judgement = judged(0.9, 10.0);
        let expected = [10.0f32, 9.0, 5.0, 1.0, 0.0].map(|distance| (-distance).exp());
        let Rewards { least, low, median, high, largest, next_to_one, next_to_nothing } = judgement.rewards;
        assert_eq!([least, low, median, high, largest], expected);
        assert_eq!((next_to_one, next_to_nothing), (1.0 / 11.0, 0.0));
        assert_eq!(judgement.cell_px, 1);
    }

    #[test]
    fn a_verdict_is_that_of_the_weakest_figure_that_decides() {
        let verdict = |rank, most| judged(rank, most).verdict;
        assert_eq!(verdict(0.9, 1.0), Verdict::Good);
        assert_eq!(verdict(0.79, 1.0), Verdict::Weak);
        assert_eq!(verdict(-0.1, 1.0), Verdict::Misleading);
        assert_eq!(verdict(0.9, 0.005), Verdict::Blind);
        let far: Vec<f32> = (0..9).map(|i| 30.0 + i as f32).collect();
        let figures = vec![Figure { kind: FigureKind::Rank, value: Some(1.0) }];
        let lost = Judgement::new(RewardParams::default(), Frame::new(9, 9).view(), figures, &far);
        assert_eq!(lost.verdict, Verdict::Blind, "1e-13 and less");
        assert_eq!(lost.rewards.next_to_nothing, 1.0);
        let undecided = Judgement::new(RewardParams::default(), Frame::new(9, 9).view(), Vec::new(), &[0.0, 1.0]);
        assert_eq!((undecided.verdict, undecided.quality), (Verdict::Weak, 0.0));
    }

    #[test]
    fn rewards_that_are_nearly_all_the_same_are_not_good() {
        let figures = vec![Figure { kind: FigureKind::Rank, value: Some(1.0) }];
        let mut distances = vec![0.5; 40];
        distances[0] = 0.1;
        let judgement = Judgement::new(RewardParams::default(), Frame::new(9, 9).view(), figures, &distances);
        assert_eq!(judgement.verdict, Verdict::Weak);
        assert!(judgement.rewards.are_narrow());
    }

    #[test]
    fn of_settings_that_are_alike_the_first_is_recommended() {
        let judged: Vec<Judgement> =
            [(0.9, 0.2), (0.97, 0.1), (0.965, 0.2), (0.969, 0.201), (-0.5, 1.0)].map(|(r, m)| judged(r, m)).to_vec();
        assert_eq!(recommend(&judged), Some(2));
        assert_eq!(recommend(&judged[4..]), None);
        assert_eq!(recommend([]), None);
    }

    #[test]
    fn a_good_setting_goes_before_one_that_is_right_but_narrow() {
        let mut narrow = judged(0.99, 0.02);
        (narrow.rewards.low, narrow.rewards.high) = (0.5, 0.501);
        narrow.verdict = Verdict::Weak;
        assert_eq!(recommend(&[narrow, judged(0.85, 1.0)]), Some(1));
    }
}
