//! Prioritized replay (Schaul et al., 2016), proportional: a transition is drawn the more often, the more its value was wrong
//! when it was last learned from.

use prf_envs::rng::ChaCha8Rng;
use rand_core::Rng;

use super::sum_tree::SumTree;
use super::{Batch, Lane, Reach, Replay};

/// What is added to the size of an error, so that a transition without any can still be drawn.
const LEAST_ERROR: f32 = 1e-6;

/// The priorities `pᵅ` of all rows of a replay.
#[derive(Debug)]
pub(super) struct Priorities {
    /// A leaf for each row of each lane; 0 where no transition begins whose future is known.
    tree: SumTree,
    alpha: f32,
    reach: Reach,
    /// The largest `pᵅ` so far, which new transitions get.
    largest: f32,
}

impl Priorities {
    /// The newest row of `lane`, the one of `index`, has been written: what was in its place is gone, and its coming may have
    /// made transitions before it complete.
    pub(super) fn follow(&mut self, index: usize, lane: &Lane) {
        let first = index * lane.rows();
        self.tree.set(first + lane.at(lane.written - 1), 0.0);
        for row in lane.written.saturating_sub(u64::from(self.reach.steps) + 1)..lane.written {
            let leaf = first + lane.at(row);
            if self.tree.get(leaf) == 0.0 && lane.transition(row, self.reach).is_some() {
                self.tree.set(leaf, self.largest);
            }
        }
    }
}

impl Replay {
    /// This memory, empty, with priorities: transitions that reach so far are drawn in proportion to `pᵅ`, where `p` is the size of
    /// the error when it was last learned from, plus 1e-6. New ones get the largest `pᵅ` so far, 1 at first.
    #[must_use]
    pub fn with_priorities(self, alpha: f32, reach: Reach) -> Self {
        let tree = SumTree::new(&vec![0.0; self.lanes.len() * self.rows_per_lane]);
        Self { priorities: Some(Priorities { tree, alpha, reach, largest: 1.0 }), ..self }
    }

    /// Memory that the priorities of `steps` steps of `lanes` environments take, in bytes.
    pub fn priorities_bytes(steps: usize, lanes: usize) -> u64 {
        (steps.div_ceil(lanes) * lanes * 2 * size_of::<f64>()) as u64
    }

    /// Fills `batch` with `count` transitions drawn by their priorities, one from each of `count` equal parts of the total, and with
    /// the weights `(N·P)^−β`, divided by the largest of the batch, that make up for it.
    ///
    /// At least one transition must be complete, as for [`Replay::sample`].
    ///
    /// # Panics
    /// If the memory has no priorities.
    pub fn sample_by_priority(&self, count: usize, beta: f32, rng: &mut ChaCha8Rng, batch: &mut Batch) {
        let Priorities { tree, reach, .. } = self.priorities.as_ref().expect("made with priorities");
        batch.clear();
        for part in 0..count {
            let leaf = tree.find((part as f64 + unit_f64(rng)) / count as f64 * tree.total());
            let lane = &self.lanes[leaf / self.rows_per_lane];
            let row = lane.newest_at(leaf % self.rows_per_lane);
            let transition = lane.transition(row, *reach).expect("only complete transitions have a priority");
            self.copy_into(batch, lane, row, transition);
            batch.places.push(leaf);
        }
        // N and the total cancel out: the largest weight is that of the smallest priority.
        let smallest = batch.places.iter().map(|&leaf| tree.get(leaf)).fold(f32::INFINITY, f32::min);
        batch.weights.extend(batch.places.iter().map(|&leaf| (smallest / tree.get(leaf)).powf(beta)));
    }

    /// Takes note of how wrong the values of a batch's transitions were: `errors` δ, one for each of its `places`.
    ///
    /// # Panics
    /// If the memory has no priorities.
    pub fn set_errors(&mut self, places: &[usize], errors: &[f32]) {
        let priorities = self.priorities.as_mut().expect("made with priorities");
        for (&leaf, error) in places.iter().zip(errors) {
            let priority = (error.abs() + LEAST_ERROR).powf(priorities.alpha);
            priorities.tree.set(leaf, priority);
            priorities.largest = priorities.largest.max(priority);
        }
    }

    /// `pᵅ` of every row, lane by lane, 0 where there is none, and the largest so far; nothing without priorities.
    pub(crate) fn priorities(&self) -> Option<(Vec<f32>, f32)> {
        let Priorities { tree, largest, .. } = self.priorities.as_ref()?;
        Some(((0..tree.len()).map(|leaf| tree.get(leaf)).collect(), *largest))
    }

    /// Takes up what [`Replay::priorities`] gave when this memory held the same rows.
    ///
    /// # Errors
    /// What is wrong with them, if they cannot be those of these rows.
    pub(crate) fn set_priorities(&mut self, values: &[f32], largest: f32) -> Result<(), String> {
        let Some(priorities) = &mut self.priorities else { return Err("priorities, and no use for them".to_owned()) };
        if values.len() != priorities.tree.len() {
            return Err(format!("{} priorities for {} rows", values.len(), priorities.tree.len()));
        }
        if !(largest > 0.0 && largest.is_finite()) {
            return Err(format!("a largest priority of {largest}"));
        }
        for (leaf, &value) in values.iter().enumerate() {
            let fits = if priorities.tree.get(leaf) > 0.0 { value > 0.0 && value <= largest } else { value == 0.0 };
            if !fits {
                return Err(format!("a priority of {value} for row {leaf}"));
            }
        }
        priorities.tree = SumTree::new(values);
        priorities.largest = largest;
        Ok(())
    }
}

/// A number in [0, 1), of 53 bits.
fn unit_f64(rng: &mut ChaCha8Rng) -> f64 {
    (rng.next_u64() >> 11) as f64 / (1u64 << 53) as f64
}

#[cfg(test)]
mod tests {
    use super::super::Outcome;
    use super::*;
    use prf_envs::rng::stream;

    const REACH: Reach = Reach { steps: 1, gamma: 0.5 };

    /// Two lanes of 8 rows each; the pixel counts the steps, with 100 more in lane 1.
    fn filled(steps: u8, alpha: f32, reach: Reach) -> Replay {
        let mut replay = Replay::new(16, 2, 1).with_priorities(alpha, reach);
        for step in 0..steps {
            for lane in 0..2 {
                replay.push(lane, &[step + 100 * lane as u8], 0, f32::from(step), Outcome::Continued);
            }
        }
        replay
    }

    fn draw(replay: &Replay, count: usize, beta: f32) -> Batch {
        let mut batch = Batch::default();
        replay.sample_by_priority(count, beta, &mut stream(0, "test", 0), &mut batch);
        batch
    }

    fn priority(replay: &Replay, leaf: usize) -> f32 {
        replay.priorities().expect("it has priorities").0[leaf]
    }

    #[test]
    fn transitions_are_drawn_in_proportion_to_their_priorities_to_the_power_of_alpha() {
        let mut replay = filled(4, 0.5, REACH);
        // Rows 0, 1, 2 of both lanes are complete; row 3 waits for its next state.
        let errors = [1.0, -4.0, 9.0, 16.0, 0.0, 25.0];
        replay.set_errors(&[0, 1, 2, 8, 9, 10], &errors);
        let expected = [1.0, 2.0, 3.0, 4.0, 1e-3, 5.0];
        for (leaf, expected) in [0, 1, 2, 8, 9, 10].into_iter().zip(expected) {
            assert!((priority(&replay, leaf) - expected).abs() < 1e-5, "{leaf}: {}", priority(&replay, leaf));
        }
        assert_eq!([3, 4, 11, 15].map(|leaf| priority(&replay, leaf)), [0.0; 4]);

        let batch = draw(&replay, 30_002, 0.0);
        let count = |state: u8| batch.states.iter().filter(|&&other| other == state).count() as f64;
        for (state, expected) in [0, 1, 2, 100, 101, 102].into_iter().zip(expected) {
            // One mark for each 30,002nd part of the total, 15.001: at most one drawing too many or too few at either end.
            let expected = 30_002.0 * f64::from(expected) / 15.001;
            assert!((count(state) - expected).abs() <= 2.0, "{state}: {} in place of {expected}", count(state));
        }
        assert!(batch.next_states.iter().zip(&batch.states).all(|(next, state)| *next == state + 1));
    }

    #[test]
    fn weights_make_up_for_the_priorities() {
        let mut replay = filled(4, 1.0, REACH);
        let places = [0, 1, 2, 8, 9, 10];
        replay.set_errors(&places, &[1.0, 2.0, 4.0, 1.0, 2.0, 4.0].map(|error: f32| error - LEAST_ERROR));
        for (beta, weights) in [(0.0, [1.0, 1.0, 1.0]), (0.5, [1.0, 0.5f32.sqrt(), 0.5]), (1.0, [1.0, 0.5, 0.25])] {
            let batch = draw(&replay, 64, beta);
            assert_eq!(batch.weights.len(), 64);
            for (state, weight) in batch.states.iter().zip(&batch.weights) {
                let expected = weights[usize::from(state % 100)];
                assert!((weight - expected).abs() < 1e-5, "β = {beta}, state {state}: {weight}");
            }
        }
        // Drawn by priority and weighted with β = 1, every transition counts alike in the end.
        let batch = draw(&replay, 14_000, 1.0);
        let mut sums = [0.0; 6];
        for (place, weight) in batch.places.iter().zip(&batch.weights) {
            sums[places.iter().position(|other| other == place).expect("a complete one")] += weight;
        }
        assert!(sums.iter().all(|sum| (sum - 1000.0).abs() < 2.0), "{sums:?}");
    }

    #[test]
    fn new_transitions_get_the_largest_priority_so_far_and_overwritten_ones_lose_theirs() {
        let mut replay = filled(4, 1.0, REACH);
        assert_eq!(priority(&replay, 0), 1.0);
        replay.set_errors(&[1], &[7.0]);
        replay.set_errors(&[1], &[0.5]);
        let push = |replay: &mut Replay, step| replay.push(0, &[step], 0, 0.0, Outcome::Continued);
        (4..8).for_each(|step| push(&mut replay, step));
        let largest = 7.0 + LEAST_ERROR;
        assert_eq!([0, 2, 3, 6, 7].map(|leaf| priority(&replay, leaf)), [1.0, 1.0, largest, largest, 0.0]);
        // The next row takes the place of row 0, whose priority goes with it.
        push(&mut replay, 8);
        assert_eq!([0, 7].map(|leaf| priority(&replay, leaf)), [0.0, largest]);
        let drawn: std::collections::BTreeSet<u8> = draw(&replay, 2000, 1.0).states.into_iter().collect();
        assert_eq!(drawn, [1, 2, 3, 4, 5, 6, 7, 100, 101, 102].into());
    }

    #[test]
    fn a_transition_enters_when_its_future_is_known() {
        let reach = Reach { steps: 3, gamma: 0.5 };
        let mut replay = Replay::new(32, 1, 1).with_priorities(0.6, reach);
        let mut entered = Vec::new();
        let mut push = |replay: &mut Replay, outcome| {
            replay.push(0, &[0], 0, 0.0, outcome);
            if outcome == Outcome::Truncated {
                replay.push_last_state(0, &[0]);
            }
            entered.push(replay.priorities().expect("it has them").0.iter().filter(|&&p| p > 0.0).count());
        };
        for outcome in [Outcome::Continued; 5].into_iter().chain([Outcome::Terminated]) {
            push(&mut replay, outcome);
        }
        for outcome in [Outcome::Continued, Outcome::Truncated, Outcome::Continued] {
            push(&mut replay, outcome);
        }
        assert_eq!(entered, [0, 0, 0, 1, 2, 6, 6, 8, 8]);
        assert_eq!(priority(&replay, 8), 0.0, "the last state of a truncated episode");
    }

    #[test]
    fn restored_priorities_draw_the_same() {
        let mut original = filled(20, 0.6, REACH);
        original.set_errors(&[0, 2, 9, 14], &[0.3, 1.7, 11.0, 1e-5]);
        let mut restored = filled(20, 0.6, REACH);
        let (values, largest) = original.priorities().expect("it has them");
        restored.set_priorities(&values, largest).expect("they are of these rows");
        let (a, b) = (draw(&original, 500, 0.4), draw(&restored, 500, 0.4));
        assert_eq!((a.places, a.weights), (b.places, b.weights));
        original.push(0, &[20], 0, 0.0, Outcome::Continued);
        restored.push(0, &[20], 0, 0.0, Outcome::Continued);
        assert_eq!(original.priorities(), restored.priorities());
    }

    #[test]
    fn priorities_of_other_rows_are_refused() {
        let mut replay = filled(5, 0.6, REACH);
        let (values, largest) = replay.priorities().expect("it has them");
        let wrong = |change: &dyn Fn(&mut Vec<f32>)| {
            let mut values = values.clone();
            change(&mut values);
            values
        };
        for values in [
            wrong(&|v| v.truncate(15)),
            wrong(&|v| v[0] = 0.0),
            wrong(&|v| v[0] = f32::NAN),
            wrong(&|v| v[0] = -1.0),
            wrong(&|v| v[0] = 2.0 * largest),
            wrong(&|v| v[5] = 1.0),
        ] {
            assert!(replay.set_priorities(&values, largest).is_err(), "{values:?}");
        }
        assert!(replay.set_priorities(&values, f32::INFINITY).is_err());
        assert_eq!(replay.priorities(), Some((values, largest)));
    }
}
