//! Which episodes are recorded step by step, and how their steps become events.

use prf_envs::{Task, TaskStep};
use serde::{Deserialize, Serialize};

use super::Trainer;
use crate::error::Result;
use crate::evaluate::Episode;
use crate::record::{EpisodeKind, Event, Recorder, Records, StepRecord, timed};

/// Which training episodes are recorded: one at a time, so that a recording shows one after another.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct Recording {
    /// Training episodes begun so far.
    begun: u64,
    /// No episode before this one is recorded any more.
    next: u64,
    /// The lane whose episode is being recorded, and the episode's number.
    current: Option<(usize, u64)>,
}

impl Recording {
    /// An episode begins in `lane`: whether it is recorded is decided now.
    pub(super) fn begin(&mut self, lane: usize, every: u64) {
        if self.current.is_some_and(|(recorded, _)| recorded == lane) {
            self.current = None;
        }
        let episode = self.begun;
        self.begun += 1;
        if every > 0 && self.current.is_none() && episode >= self.next {
            self.current = Some((lane, episode));
            self.next = (episode / every + 1) * every;
        }
    }

    /// The number of the episode in `lane`, if it is recorded.
    pub(super) fn episode(&self, lane: usize) -> Option<u64> {
        self.current.filter(|(recorded, _)| *recorded == lane).map(|(_, episode)| episode)
    }
}

/// Where events go: into the run directory, and to whoever watches.
pub(super) fn tell(records: &mut Records, recorder: &mut dyn Recorder, event: &Event<'_>) -> Result<()> {
    records.record(event)?;
    recorder.record(event)
}

/// The episode that a step belongs to.
#[derive(Debug, Clone, Copy)]
pub(super) struct Place {
    pub(super) kind: EpisodeKind,
    pub(super) trained_steps: u64,
    pub(super) episode: u64,
    pub(super) epsilon: f32,
}

/// The record of the step that `task` has just taken by `action`; `so_far` has counted it.
pub(super) fn step_record<'a>(
    task: &'a Task,
    action: usize,
    step: &TaskStep,
    so_far: &Episode,
    place: Place,
) -> StepRecord<'a> {
    let Place { kind, trained_steps, episode, epsilon } = place;
    StepRecord {
        kind,
        trained_steps,
        episode,
        step: so_far.steps,
        mirror: task.mirror().view(),
        explanation: task.explain(),
        action,
        action_name: task.spec().actions[action],
        reward: step.reward,
        score: step.score,
        epsilon,
        last: step.status.is_over(),
    }
}

impl Trainer {
    /// Tells everyone.
    pub(super) fn tell(&mut self, recorder: &mut dyn Recorder, event: &Event<'_>) -> Result<()> {
        timed(&mut self.time.records_s, || tell(&mut self.records, recorder, event))
    }

    /// Records evaluation episodes: each is played again from the actions that were taken in it, one after another.
    pub(super) fn record_evaluation(&mut self, recorder: &mut dyn Recorder, taken: &[Vec<usize>]) -> Result<()> {
        let (task, records) = (&mut self.evaluation_tasks[0], &mut self.records);
        let trained_steps = self.counters.steps;
        timed(&mut self.time.records_s, || {
            for ((episode, actions), &seed) in (0..).zip(taken).zip(&self.evaluation_seeds) {
                let place = Place { kind: EpisodeKind::Evaluation, trained_steps, episode, epsilon: 0.0 };
                let mut so_far = Episode::default();
                task.reset(seed);
                for &action in actions {
                    let step = task.step(action)?;
                    so_far.add(&step);
                    let record = step_record(task, action, &step, &so_far, place);
                    tell(records, recorder, &Event::Step(&record))?;
                }
            }
            Ok(())
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The episodes that are recorded when they begin in these lanes.
    fn recorded(lanes: &[usize], every: u64) -> Vec<u64> {
        let mut recording = Recording::default();
        let begun = lanes.iter().map(|&lane| {
            let before = recording.current;
            recording.begin(lane, every);
            recording.current.filter(|current| before != Some(*current)).map(|(_, episode)| episode)
        });
        begun.flatten().collect()
    }

    #[test]
    fn every_so_many_episodes_one_is_recorded() {
        assert_eq!(recorded(&[0; 8], 3), [0, 3, 6]);
        assert_eq!(recorded(&[0; 3], 1), [0, 1, 2]);
        assert_eq!(recorded(&[0, 1, 0, 1], 0), [0; 0]);
    }

    #[test]
    fn an_episode_that_is_being_recorded_is_recorded_to_its_end_first() {
        // Episode 0 goes on in lane 0 while 1 to 3 begin; 2 would have been due.
        assert_eq!(recorded(&[0, 1, 1, 1, 0, 1], 2), [0, 4]);
        assert_eq!(recorded(&[0, 1, 1, 1, 1, 0, 1, 1], 4), [0, 5]);
    }

    #[test]
    fn only_the_lane_of_the_recorded_episode_is_watched() {
        let mut recording = Recording::default();
        recording.begin(0, 10);
        recording.begin(1, 10);
        assert_eq!((recording.episode(0), recording.episode(1)), (Some(0), None));
        recording.begin(0, 10);
        assert_eq!(recording.episode(0), None);
    }
}
