//! What the records of a group's runs say, claim by claim.

use prf_core::spearman;
use prf_dqn::evaluate::Spread;
use prf_envs::RewardSource;

use crate::runs::group::Group;
use crate::runs::players::Players;
use crate::runs::standing::{Standing, State};

/// From this share of the way between the random player and the best, an agent is close to the best.
const CLOSE: f64 = 0.9;
/// So much of that way may be lost again before an agent has forgotten.
const FORGOTTEN: f64 = 0.1;
/// From this rank correlation on, reward and score go together.
const TOGETHER: f64 = 0.5;

/// Something that is true of the runs or not.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Claim {
    pub(crate) words: &'static str,
    pub(crate) verdict: Verdict,
    /// The figures it was checked by.
    pub(crate) figures: String,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Verdict {
    Holds,
    Fails,
    /// The figures that it needs are not there.
    Open,
}

impl Verdict {
    fn of(holds: bool) -> Verdict {
        if holds { Verdict::Holds } else { Verdict::Fails }
    }
}

/// What a group's runs came to.
#[derive(Clone, Debug)]
pub(crate) struct Outcome {
    /// Of the runs with an evaluation.
    seeds: Vec<Seed>,
    players: Players,
    runs: usize,
    finished: usize,
    is_perceptual: bool,
}

/// What one run came to: the scores of its greedy evaluations.
#[derive(Clone, Debug)]
struct Seed {
    seed: u64,
    step: u64,
    first: f64,
    best: f64,
    last: f64,
    /// Over the episodes of the last evaluation.
    std: f64,
    episodes: usize,
    /// Of reward and score over the evaluations, if it can be told.
    correlation: Option<f64>,
}

impl Outcome {
    pub(crate) fn of(group: &Group, standings: &[Standing], players: Players) -> Outcome {
        let seed = |run: &crate::runs::Run| {
            let evaluations = &run.metrics.evaluations;
            let (first, last) = (evaluations.first()?, evaluations.last()?);
            let scores: Vec<f64> = evaluations.iter().map(|record| record.mean_score).collect();
            let rewards: Vec<f64> = evaluations.iter().map(|record| record.mean_reward).collect();
            Some(Seed {
                seed: run.config.seed,
                step: last.step,
                first: first.mean_score,
                best: scores.iter().copied().fold(f64::NEG_INFINITY, f64::max),
                last: last.mean_score,
                std: last.std_score,
                episodes: last.episodes,
                correlation: spearman(&rewards, &scores),
            })
        };
        Outcome {
            seeds: group.runs.iter().filter_map(seed).collect(),
            players,
            runs: group.runs.len(),
            finished: standings.iter().filter(|standing| standing.state == State::Finished).count(),
            is_perceptual: group.runs[0].config.reward.source == RewardSource::Perceptual,
        }
    }

    /// The result in a sentence.
    pub(crate) fn headline(&self, name: &str) -> String {
        let Players { oracle, random, .. } = self.players;
        let step = self.seeds.iter().map(|seed| seed.step).max().unwrap_or(0);
        let score = match self.seeds.as_slice() {
            [] => return format!("{name}: nothing is evaluated yet."),
            [one] => format!("{:.2} ± {:.2} over {} episodes of one seed", one.last, one.std, one.episodes),
            _ => format!("{} over {} seeds", spread(self.last()), self.seeds.len()),
        };
        let share = self.players.share(self.last().mean);
        let place = if !share.is_finite() {
            format!("a random player {random:.2}, the best there is {oracle:.2}")
        } else if share < 0.0 {
            format!("less than a random player ({random:.2}); the best there is scores {oracle:.2}")
        } else {
            format!(
                "{} of the way from a random player ({random:.2}) to the best there is ({oracle:.2})",
                percent(share)
            )
        };
        format!("{name}: after {step} steps the agent scores {score}, {place}.")
    }

    /// Mean and standard deviation of the last scores over seeds.
    fn last(&self) -> Spread {
        Spread::of(self.seeds.iter().map(|seed| seed.last))
    }

    /// All claims that make sense for the group.
    pub(crate) fn claims(&self) -> Vec<Claim> {
        let finished = Claim {
            words: "Every run has come to its end.",
            verdict: Verdict::of(self.finished == self.runs),
            figures: format!("{} of {} are finished", self.finished, self.runs),
        };
        let mut claims = vec![finished];
        if self.seeds.is_empty() {
            return claims;
        }
        claims.extend([self.beats_chance(), self.is_close_to_the_best(), self.has_learned(), self.has_kept()]);
        if self.is_perceptual {
            claims.push(self.reward_goes_with_score());
        }
        claims
    }

    fn beats_chance(&self) -> Claim {
        let worst = self.extreme(|seed| seed.last);
        Claim {
            words: "Every seed plays better than chance.",
            verdict: Verdict::of(worst.last > self.players.random),
            figures: format!(
                "the lowest last score is {:.2} (seed {}); a random player's {:.2}",
                worst.last, worst.seed, self.players.random
            ),
        }
    }

    fn is_close_to_the_best(&self) -> Claim {
        let share = self.players.share(self.last().mean);
        Claim {
            words: "The agent is close to the best player: at least 90% of the way from chance to the best.",
            verdict: if share.is_finite() { Verdict::of(share >= CLOSE) } else { Verdict::Open },
            figures: format!(
                "{} of the way: last scores {}, chance {:.2}, best {:.2}",
                percent(share),
                spread(self.last()),
                self.players.random,
                self.players.oracle
            ),
        }
    }

    fn has_learned(&self) -> Claim {
        let least = self.extreme(|seed| seed.last - seed.first);
        Claim {
            words: "Every seed ends better than it began.",
            verdict: Verdict::of(least.last > least.first),
            figures: format!("the least gain is from {:.2} to {:.2} (seed {})", least.first, least.last, least.seed),
        }
    }

    fn has_kept(&self) -> Claim {
        let lost = |seed: &Seed| self.players.share(seed.best) - self.players.share(seed.last);
        let most = self.extreme(|seed| -lost(seed));
        let share = lost(most);
        Claim {
            words: "Every seed ends about as good as it ever was: within 10% of the way from chance to the best.",
            verdict: if share.is_finite() { Verdict::of(share <= FORGOTTEN) } else { Verdict::Open },
            figures: format!(
                "the most lost is {:.1}%: {:.2} after a best of {:.2} (seed {})",
                100.0 * share,
                most.last,
                most.best,
                most.seed
            ),
        }
    }

    fn reward_goes_with_score(&self) -> Claim {
        let known: Option<Vec<f64>> = self.seeds.iter().map(|seed| seed.correlation).collect();
        let least = known.map(|all| all.into_iter().fold(f64::INFINITY, f64::min));
        Claim {
            words: "More reward means more score: over the evaluations of every seed, their rank correlation is at least 0.5.",
            verdict: least.map_or(Verdict::Open, |least| Verdict::of(least >= TOGETHER)),
            figures: match least {
                Some(least) => format!("the least of the seeds' correlations is {least:.2}"),
                None => "a seed has too few evaluations, or all with the same score".to_owned(),
            },
        }
    }

    /// The seed of the least value.
    fn extreme(&self, value: impl Fn(&Seed) -> f64) -> &Seed {
        let least = self.seeds.iter().min_by(|a, b| value(a).total_cmp(&value(b)));
        least.expect("claims are made of seeds that were evaluated")
    }
}

fn spread(Spread { mean, std }: Spread) -> String {
    format!("{mean:.2} ± {std:.2}")
}

fn percent(share: f64) -> String {
    format!("{:.0}%", 100.0 * share)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn seed(seed: u64, first: f64, best: f64, last: f64) -> Seed {
        Seed { seed, step: 500, first, best, last, std: 0.5, episodes: 20, correlation: Some(0.9) }
    }

    fn outcome(seeds: Vec<Seed>) -> Outcome {
        let players = Players { oracle: 10.0, random: 0.0, episodes: [100; 2] };
        Outcome { runs: seeds.len(), finished: seeds.len(), seeds, players, is_perceptual: true }
    }

    fn verdicts(outcome: &Outcome) -> Vec<Verdict> {
        outcome.claims().iter().map(|claim| claim.verdict).collect()
    }

    #[test]
    fn good_runs_hold_every_claim() {
        let good = outcome(vec![seed(1, 0.0, 9.5, 9.0), seed(2, 1.0, 9.4, 9.4)]);
        assert_eq!(verdicts(&good), [Verdict::Holds; 6]);
        let expected = "ball: after 500 steps the agent scores 9.20 ± 0.28 over 2 seeds, 92% of the way from a random \
                        player (0.00) to the best there is (10.00).";
        assert_eq!(good.headline("ball"), expected);
    }

    #[test]
    fn each_claim_fails_by_its_own_figures() {
        let failing = |outcome: &Outcome| -> Vec<usize> {
            let verdicts = verdicts(outcome).into_iter().enumerate();
            verdicts.filter(|(_, verdict)| *verdict == Verdict::Fails).map(|(index, _)| index).collect()
        };
        let good = outcome(vec![seed(1, -2.0, 9.5, 9.5), seed(2, -2.0, 9.5, 9.5)]);
        assert_eq!(failing(&Outcome { finished: 1, ..good.clone() }), [0]);
        // At chance, and so not close to the best: of the mean, 4.75 of 10.
        let mut worse = good.clone();
        worse.seeds[1] = seed(2, -2.0, 0.0, 0.0);
        assert_eq!(failing(&worse), [1, 2]);
        assert!(worse.claims()[1].figures.contains("0.00 (seed 2)"), "{:?}", worse.claims()[1]);
        worse.seeds[1] = seed(2, 9.5, 9.5, 9.5);
        assert_eq!(failing(&worse), [3]);
        worse.seeds[1] = seed(2, 0.0, 9.9, 8.8);
        assert_eq!(failing(&worse), [4]);
        assert!(
            worse.claims()[4].figures.contains("11.0%: 8.80 after a best of 9.90 (seed 2)"),
            "{:?}",
            worse.claims()[4]
        );
        worse.seeds[1] = Seed { correlation: Some(0.4), ..seed(2, 0.0, 9.5, 9.5) };
        assert_eq!(failing(&worse), [5]);
    }

    #[test]
    fn what_cannot_be_told_is_left_open() {
        let mut open = outcome(vec![seed(1, 0.0, 5.0, 5.0)]);
        open.seeds[0].correlation = None;
        open.players = Players { oracle: 1.0, random: 1.0, episodes: [100; 2] };
        assert_eq!(
            verdicts(&open),
            [Verdict::Holds, Verdict::Holds, Verdict::Open, Verdict::Holds, Verdict::Open, Verdict::Open]
        );
        assert!(open.headline("a").contains("5.00 ± 0.50 over 20 episodes of one seed, a random player 1.00"));
        open.is_perceptual = false;
        assert_eq!(open.claims().len(), 5);
        let none = Outcome { runs: 1, finished: 0, ..outcome(Vec::new()) };
        assert_eq!(
            (verdicts(&none), none.headline("a")),
            (vec![Verdict::Fails], "a: nothing is evaluated yet.".to_owned())
        );
    }

    #[test]
    fn worse_than_chance_is_said_so() {
        let bad = outcome(vec![seed(1, -1.0, -1.0, -2.0)]);
        assert!(bad.headline("a").ends_with("less than a random player (0.00); the best there is scores 10.00."));
    }
}
