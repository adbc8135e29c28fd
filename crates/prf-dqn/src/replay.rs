//! Replay memory that stores each frame once, one byte a pixel.
//!
//! Every environment writes into a lane of its own, a ring of rows in the order of time. A row is a state, the action
//! taken in it and what came of it; the next state is simply the next row. Only an episode cut off by its step limit
//! needs one row more, for the state that is bootstrapped from but never acted in.

use prf_envs::rng::{ChaCha8Rng, below};

mod prioritized;
pub(crate) mod segment;
mod sum_tree;

use prioritized::Priorities;

/// What followed the action of a row.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u8)]
pub enum Outcome {
    /// The episode went on; the next row holds the next state.
    Continued = 0,
    /// The episode ended in a terminal state, which is worth nothing.
    Terminated = 1,
    /// The episode was cut off; the next row holds the state it was cut off in.
    Truncated = 2,
    /// No action was taken: the row is the last state of a truncated episode.
    LastState = 3,
}

impl Outcome {
    fn from_byte(byte: u8) -> Option<Self> {
        [Self::Continued, Self::Terminated, Self::Truncated, Self::LastState].into_iter().find(|o| *o as u8 == byte)
    }
}

/// A batch of transitions, stored as the network reads them.
#[derive(Debug, Default)]
pub struct Batch {
    /// States, n × h × w bytes.
    pub states: Vec<u8>,
    /// The states to bootstrap from, n × h × w bytes; where nothing is bootstrapped, the state itself.
    pub next_states: Vec<u8>,
    /// Actions, n.
    pub actions: Vec<i64>,
    /// Discounted sums of the rewards up to the state to bootstrap from, n.
    pub rewards: Vec<f32>,
    /// What the value of that state counts: γ to the power of the steps in between, 0 after a terminal step, n.
    pub discounts: Vec<f32>,
    /// What each transition's loss counts, in (0, 1], n; empty where all count alike.
    pub weights: Vec<f32>,
    /// Where the transitions lie, for [`Replay::set_errors`], n; empty where they were drawn uniformly.
    pub places: Vec<usize>,
}

/// How far a transition reaches.
#[derive(Debug, Clone, Copy)]
pub struct Reach {
    /// Steps whose rewards are summed before the value of a state takes over, at least 1; fewer where an episode ends.
    pub steps: u32,
    /// Discount γ.
    pub gamma: f32,
}

/// The replay memory of all environments.
#[derive(Debug)]
pub struct Replay {
    frame_len: usize,
    rows_per_lane: usize,
    lanes: Vec<Lane>,
    /// By which transitions are drawn, unless they are drawn uniformly.
    priorities: Option<Priorities>,
}

#[derive(Debug)]
struct Lane {
    frames: Vec<u8>,
    actions: Vec<u8>,
    rewards: Vec<f32>,
    outcomes: Vec<Outcome>,
    /// Rows written since the beginning; row `r` lies at `r % rows_per_lane`.
    written: u64,
}

impl Replay {
    /// An empty memory for `steps` steps of `lanes` environments, whose frames have `frame_len` pixels.
    pub fn new(steps: usize, lanes: usize, frame_len: usize) -> Self {
        let rows_per_lane = steps.div_ceil(lanes);
        let lane = || Lane {
            // Zeroed pages are not taken from the machine before they are written.
            frames: vec![0; rows_per_lane * frame_len],
            actions: vec![0; rows_per_lane],
            rewards: vec![0.0; rows_per_lane],
            outcomes: vec![Outcome::LastState; rows_per_lane],
            written: 0,
        };
        Self { frame_len, rows_per_lane, lanes: (0..lanes).map(|_| lane()).collect(), priorities: None }
    }

    /// Memory that [`Replay::new`] will take once it is full, in bytes.
    pub fn memory_bytes(steps: usize, lanes: usize, frame_len: usize) -> u64 {
        let row = frame_len + size_of::<u8>() + size_of::<f32>() + size_of::<Outcome>();
        (steps.div_ceil(lanes) * lanes * row) as u64
    }

    /// Appends a step of environment `lane`: the state acted in, the action, its reward and what followed.
    pub fn push(&mut self, lane: usize, state: &[u8], action: u8, reward: f32, outcome: Outcome) {
        let (index, rows, frame_len) = (lane, self.rows_per_lane, self.frame_len);
        let lane = &mut self.lanes[index];
        let at = (lane.written % rows as u64) as usize;
        lane.frames[at * frame_len..][..frame_len].copy_from_slice(state);
        lane.actions[at] = action;
        lane.rewards[at] = reward;
        lane.outcomes[at] = outcome;
        lane.written += 1;
        if let Some(priorities) = &mut self.priorities {
            priorities.follow(index, lane);
        }
    }

    /// Appends the state in which environment `lane` was cut off.
    pub fn push_last_state(&mut self, lane: usize, state: &[u8]) {
        self.push(lane, state, 0, 0.0, Outcome::LastState);
    }

    /// Fills `batch` with `count` transitions, each drawn uniformly from those in memory.
    ///
    /// At least one transition must be complete: some environment has taken more than `reach.steps` steps.
    pub fn sample(&self, count: usize, reach: Reach, rng: &mut ChaCha8Rng, batch: &mut Batch) {
        batch.clear();
        while batch.actions.len() < count {
            let lane = &self.lanes[below(rng, self.lanes.len())];
            let held = lane.written.min(self.rows_per_lane as u64) as usize;
            if held == 0 {
                continue;
            }
            let row = lane.written - 1 - below(rng, held) as u64;
            if let Some(transition) = lane.transition(row, reach) {
                self.copy_into(batch, lane, row, transition);
            }
        }
    }

    fn copy_into(&self, batch: &mut Batch, lane: &Lane, row: u64, transition: Transition) {
        let frame = |row: u64| &lane.frames[lane.at(row) * self.frame_len..][..self.frame_len];
        batch.states.extend_from_slice(frame(row));
        batch.next_states.extend_from_slice(frame(transition.next));
        batch.actions.push(lane.actions[lane.at(row)].into());
        batch.rewards.push(transition.reward);
        batch.discounts.push(transition.discount);
    }

    /// Number of environments.
    pub fn lanes(&self) -> usize {
        self.lanes.len()
    }

    /// Whether any row before the given ends, one for each environment, is still in memory.
    pub(crate) fn still_holds(&self, ends: &[u64]) -> bool {
        let rows = self.rows_per_lane as u64;
        self.lanes.iter().zip(ends).any(|(lane, end)| *end > lane.written.saturating_sub(rows))
    }

    /// Rows written by each environment since the beginning.
    pub fn written(&self) -> Vec<u64> {
        self.lanes.iter().map(|lane| lane.written).collect()
    }
}

/// Where an action led.
#[derive(Clone, Copy)]
struct Transition {
    next: u64,
    reward: f32,
    discount: f32,
}

impl Lane {
    fn rows(&self) -> usize {
        self.outcomes.len()
    }

    fn at(&self, row: u64) -> usize {
        (row % self.rows() as u64) as usize
    }

    /// The newest row that lies at `at`; one has to.
    fn newest_at(&self, at: usize) -> u64 {
        let newest = self.written - 1;
        newest - ((self.at(newest) + self.rows() - at) % self.rows()) as u64
    }

    /// What came of the action of `row`, or none when `row` has no action or its future is not yet known.
    fn transition(&self, row: u64, reach: Reach) -> Option<Transition> {
        let (mut reward, mut discount) = (0.0, 1.0);
        for next in row..row + u64::from(reach.steps) {
            let outcome = self.outcomes[self.at(next)];
            if outcome == Outcome::LastState {
                return None;
            }
            reward += discount * self.rewards[self.at(next)];
            discount *= reach.gamma;
            match outcome {
                // Any state will do where its value counts nothing.
                Outcome::Terminated => return Some(Transition { next: row, reward, discount: 0.0 }),
                Outcome::Truncated => return Some(Transition { next: next + 1, reward, discount }),
                _ if next + 1 == self.written => return None,
                _ => {}
            }
        }
        Some(Transition { next: row + u64::from(reach.steps), reward, discount })
    }
}

impl Batch {
    fn clear(&mut self) {
        self.states.clear();
        self.next_states.clear();
        self.actions.clear();
        self.rewards.clear();
        self.discounts.clear();
        self.weights.clear();
        self.places.clear();
    }

    /// Number of transitions.
    pub fn len(&self) -> usize {
        self.actions.len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.actions.is_empty()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use prf_envs::rng::stream;

    const REACH: Reach = Reach { steps: 1, gamma: 0.5 };

    /// One-pixel frames; the pixel counts the steps of the lane, so that a next state can be told from any other.
    fn filled(rows: usize, episode: usize, end: Outcome) -> Replay {
        let mut replay = Replay::new(rows, 1, 1);
        for step in 0..30u8 {
            let last = usize::from(step) % episode == episode - 1;
            replay.push(0, &[step], step, f32::from(step), if last { end } else { Outcome::Continued });
            if last && end == Outcome::Truncated {
                replay.push_last_state(0, &[100 + step]);
            }
        }
        replay
    }

    fn draw(replay: &Replay, count: usize) -> Batch {
        let mut batch = Batch::default();
        replay.sample(count, REACH, &mut stream(0, "test", 0), &mut batch);
        batch
    }

    #[test]
    fn next_state_is_the_next_row_within_an_episode() {
        let batch = draw(&filled(64, 1000, Outcome::Terminated), 500);
        for index in 0..batch.len() {
            assert_eq!(batch.next_states[index], batch.states[index] + 1);
            assert_eq!(i64::from(batch.states[index]), batch.actions[index]);
            assert_eq!(f32::from(batch.states[index]), batch.rewards[index]);
            assert_eq!(batch.discounts[index], 0.5);
        }
        // The newest row has no successor yet; every other row is drawn.
        let drawn: std::collections::BTreeSet<u8> = batch.states.iter().copied().collect();
        assert_eq!(drawn, (0..29).collect());
    }

    #[test]
    fn terminal_steps_do_not_continue_into_the_next_episode() {
        let batch = draw(&filled(64, 5, Outcome::Terminated), 500);
        for index in 0..batch.len() {
            let terminal = batch.states[index] % 5 == 4;
            assert_eq!(batch.discounts[index], if terminal { 0.0 } else { 0.5 });
        }
    }

    #[test]
    fn truncated_steps_bootstrap_from_the_state_they_were_cut_off_in() {
        let batch = draw(&filled(64, 5, Outcome::Truncated), 500);
        assert!(batch.states.iter().all(|state| *state < 100), "a last state was drawn as a transition");
        for index in 0..batch.len() {
            let state = batch.states[index];
            assert_eq!(batch.next_states[index], if state % 5 == 4 { 100 + state } else { state + 1 });
            assert_eq!(batch.discounts[index], 0.5);
        }
    }

    #[test]
    fn longer_reaches_sum_discounted_rewards_up_to_the_end_of_the_episode() {
        for (end, last_discount) in [(Outcome::Terminated, 0.0), (Outcome::Truncated, 0.5)] {
            let replay = filled(64, 5, end);
            let mut batch = Batch::default();
            replay.sample(500, Reach { steps: 3, gamma: 0.5 }, &mut stream(0, "test", 0), &mut batch);
            for index in 0..batch.len() {
                let (state, left) = (f32::from(batch.states[index]), 5 - batch.states[index] % 5);
                let (reward, discount) = match left {
                    1 => (state, last_discount),
                    2 => (state + 0.5 * (state + 1.0), last_discount / 2.0),
                    3 => (state + 0.5 * (state + 1.0) + 0.25 * (state + 2.0), last_discount / 4.0),
                    _ => (state + 0.5 * (state + 1.0) + 0.25 * (state + 2.0), 0.125),
                };
                assert_eq!((batch.rewards[index], batch.discounts[index]), (reward, discount));
                if left > 3 {
                    assert_eq!(batch.next_states[index], batch.states[index] + 3);
                } else if end == Outcome::Truncated {
                    assert_eq!(batch.next_states[index], 100 + batch.states[index] + left - 1);
                }
            }
        }
    }

    #[test]
    fn old_rows_give_way_to_new_ones() {
        let batch = draw(&filled(8, 1000, Outcome::Terminated), 300);
        let drawn: std::collections::BTreeSet<u8> = batch.states.iter().copied().collect();
        assert_eq!(drawn, (22..29).collect());
        assert!((0..batch.len()).all(|index| batch.next_states[index] == batch.states[index] + 1));
    }

    #[test]
    fn a_million_steps_of_84_by_84_fit_in_7_2_gb() {
        assert!(Replay::memory_bytes(1_000_000, 16, 84 * 84) < 7_200_000_000);
    }
}
