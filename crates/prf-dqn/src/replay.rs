//! Replay memory that stores each frame once, one byte a pixel.
//!
//! Every environment writes into a lane of its own, a ring of rows in the order of time. A row is a state, the action
//! taken in it and what came of it; the next state is simply the next row. Only an episode cut off by its step limit
//! needs one row more, for the state that is bootstrapped from but never acted in.

use prf_envs::rng::{ChaCha8Rng, below};

pub(crate) mod segment;

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
    /// The states that followed, n × h × w bytes; after a terminal step, the state itself.
    pub next_states: Vec<u8>,
    /// Actions, n.
    pub actions: Vec<i64>,
    /// Rewards, n.
    pub rewards: Vec<f32>,
    /// 1 where the value of the next state counts, 0 after a terminal step, n.
    pub continues: Vec<f32>,
}

/// The replay memory of all environments.
#[derive(Debug)]
pub struct Replay {
    frame_len: usize,
    rows_per_lane: usize,
    lanes: Vec<Lane>,
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
        Self { frame_len, rows_per_lane, lanes: (0..lanes).map(|_| lane()).collect() }
    }

    /// Memory that [`Replay::new`] will take once it is full, in bytes.
    pub fn memory_bytes(steps: usize, lanes: usize, frame_len: usize) -> u64 {
        let row = frame_len + size_of::<u8>() + size_of::<f32>() + size_of::<Outcome>();
        (steps.div_ceil(lanes) * lanes * row) as u64
    }

    /// Appends a step of environment `lane`: the state acted in, the action, its reward and what followed.
    pub fn push(&mut self, lane: usize, state: &[u8], action: u8, reward: f32, outcome: Outcome) {
        let (rows, frame_len) = (self.rows_per_lane, self.frame_len);
        let lane = &mut self.lanes[lane];
        let at = (lane.written % rows as u64) as usize;
        lane.frames[at * frame_len..][..frame_len].copy_from_slice(state);
        lane.actions[at] = action;
        lane.rewards[at] = reward;
        lane.outcomes[at] = outcome;
        lane.written += 1;
    }

    /// Appends the state in which environment `lane` was cut off.
    pub fn push_last_state(&mut self, lane: usize, state: &[u8]) {
        self.push(lane, state, 0, 0.0, Outcome::LastState);
    }

    /// Fills `batch` with `count` transitions, each drawn uniformly from those in memory.
    ///
    /// At least one transition must be complete, which is so after two steps of any environment.
    pub fn sample(&self, count: usize, rng: &mut ChaCha8Rng, batch: &mut Batch) {
        batch.clear();
        while batch.actions.len() < count {
            let lane = &self.lanes[below(rng, self.lanes.len())];
            let held = lane.written.min(self.rows_per_lane as u64) as usize;
            if held == 0 {
                continue;
            }
            let row = lane.written - 1 - below(rng, held) as u64;
            if let Some(next) = lane.next_row(row) {
                self.copy_into(batch, lane, row, next);
            }
        }
    }

    fn copy_into(&self, batch: &mut Batch, lane: &Lane, row: u64, next: u64) {
        let at = |row: u64| (row % self.rows_per_lane as u64) as usize;
        let frame = |row: u64| &lane.frames[at(row) * self.frame_len..][..self.frame_len];
        batch.states.extend_from_slice(frame(row));
        batch.next_states.extend_from_slice(frame(next));
        batch.actions.push(lane.actions[at(row)].into());
        batch.rewards.push(lane.rewards[at(row)]);
        batch.continues.push(if lane.outcomes[at(row)] == Outcome::Terminated { 0.0 } else { 1.0 });
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

impl Lane {
    /// The row that holds the state after `row`, or none when `row` is no finished transition.
    fn next_row(&self, row: u64) -> Option<u64> {
        let at = (row % self.outcomes.len() as u64) as usize;
        match self.outcomes[at] {
            Outcome::LastState => None,
            Outcome::Terminated => Some(row),
            Outcome::Continued | Outcome::Truncated => (row + 1 < self.written).then_some(row + 1),
        }
    }
}

impl Batch {
    fn clear(&mut self) {
        self.states.clear();
        self.next_states.clear();
        self.actions.clear();
        self.rewards.clear();
        self.continues.clear();
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
        replay.sample(count, &mut stream(0, "test", 0), &mut batch);
        batch
    }

    #[test]
    fn next_state_is_the_next_row_within_an_episode() {
        let batch = draw(&filled(64, 1000, Outcome::Terminated), 500);
        for index in 0..batch.len() {
            assert_eq!(batch.next_states[index], batch.states[index] + 1);
            assert_eq!(i64::from(batch.states[index]), batch.actions[index]);
            assert_eq!(f32::from(batch.states[index]), batch.rewards[index]);
            assert_eq!(batch.continues[index], 1.0);
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
            assert_eq!(batch.continues[index], if terminal { 0.0 } else { 1.0 });
        }
    }

    #[test]
    fn truncated_steps_bootstrap_from_the_state_they_were_cut_off_in() {
        let batch = draw(&filled(64, 5, Outcome::Truncated), 500);
        assert!(batch.states.iter().all(|state| *state < 100), "a last state was drawn as a transition");
        for index in 0..batch.len() {
            let state = batch.states[index];
            assert_eq!(batch.next_states[index], if state % 5 == 4 { 100 + state } else { state + 1 });
            assert_eq!(batch.continues[index], 1.0);
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
