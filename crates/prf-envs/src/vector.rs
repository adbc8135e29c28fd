//! Tasks side by side, stepped together.

use std::num::NonZero;
use std::sync::{Mutex, PoisonError};
use std::thread;

use prf_core::{Frame, Goal};

use crate::bytes::Reader;
use crate::{Error, Spec, Status, Task, TaskConfig, registry};

/// Marks the state of tasks side by side and the version of its layout.
const TAG: &[u8] = b"vector1";

/// Fewer tasks than this are not worth a thread: to start one costs about as much as these steps.
const PERCEPTUAL_PER_THREAD: usize = 4;
const VARIABLE_PER_THREAD: usize = 512;
/// So many are taken at once by a thread that is done with what it had.
const SHARE: usize = 2;

/// Several tasks of one config, each with an episode of its own.
///
/// What comes out doesn't depend on the number of threads.
///
/// ```
/// use prf_envs::{Command, EnvConfig, Results, RewardConfig, StateConfig, TaskConfig, VectorTask};
///
/// let config = TaskConfig {
///     env: EnvConfig::new("breakout"),
///     reward: RewardConfig::variable(),
///     state: StateConfig::default(),
/// };
/// let mut tasks = VectorTask::new(&config, None, 2)?;
/// let (mut observations, mut rewards, mut scores) = ([0; 2 * 84 * 84], [0.0; 2], [0.0; 2]);
/// let (mut terminated, mut truncated) = ([false; 2], [false; 2]);
/// let mut results = Results {
///     observations: &mut observations,
///     rewards: &mut rewards,
///     scores: &mut scores,
///     terminated: &mut terminated,
///     truncated: &mut truncated,
/// };
/// tasks.run(&[Command::Reset(7), Command::Reset(8)], &mut results)?;
/// tasks.run(&[Command::Step(0), Command::Step(2)], &mut results)?;
/// # Ok::<(), prf_envs::Error>(())
/// ```
pub struct VectorTask {
    lanes: Vec<Lane>,
    threads: usize,
    spec: Spec,
}

/// What to do with one of the tasks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Command {
    /// Play a step with this action.
    Step(usize),
    /// Begin the episode of this seed.
    Reset(u64),
    /// Leave it as it is.
    Keep,
}

/// Where results are written to: one value a task, in their order.
#[derive(Debug)]
pub struct Results<'a> {
    /// What each agent sees now, height × width grey values.
    pub observations: &'a mut [u8],
    /// The reward of the step; 0 where none was played.
    pub rewards: &'a mut [f64],
    /// The score after the step; 0 where none was played.
    pub scores: &'a mut [f64],
    /// Whether the step brought the episode to its own end.
    pub terminated: &'a mut [bool],
    /// Whether the step was the last one that the limit allows, also where the episode came to its own end.
    pub truncated: &'a mut [bool],
}

struct Lane {
    task: Task,
    phase: Phase,
    /// Played in this episode.
    steps: u32,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Phase {
    NotReset,
    Running,
    Over,
}

impl VectorTask {
    /// `count` tasks of `config`, before their first episodes. They use as many threads as there are cores, where that pays.
    ///
    /// # Errors
    /// As [`Task::new`].
    pub fn new(config: &TaskConfig, goal: Option<&Goal>, count: usize) -> Result<VectorTask, Error> {
        let lane = || Ok(Lane { task: Task::new(config, goal)?, phase: Phase::NotReset, steps: 0 });
        let lanes = (0..count).map(|_| lane()).collect::<Result<Vec<_>, Error>>()?;
        let per_thread = if goal.is_some() { PERCEPTUAL_PER_THREAD } else { VARIABLE_PER_THREAD };
        let threads = match count / per_thread {
            0 | 1 => 1,
            // Asking for the cores reads files.
            most => thread::available_parallelism().map_or(1, NonZero::get).min(most),
        };
        Ok(VectorTask { lanes, threads, spec: *registry::make(&config.env)?.spec() })
    }

    /// The same with this number of threads; 0 counts as 1, and more than tasks as one for each.
    #[must_use]
    pub fn with_threads(self, threads: usize) -> VectorTask {
        VectorTask { threads: threads.clamp(1, self.lanes.len().max(1)), ..self }
    }

    /// The world's fixed facts.
    pub fn spec(&self) -> &Spec {
        &self.spec
    }

    /// How many tasks there are.
    pub fn count(&self) -> usize {
        self.lanes.len()
    }

    /// Does with each task what its command says.
    ///
    /// # Errors
    /// As [`Task::step`], of the first task that can't do it; no task has changed then.
    ///
    /// # Panics
    /// If `commands` or a slice of `results` has another length than there are tasks.
    pub fn run(&mut self, commands: &[Command], results: &mut Results<'_>) -> Result<(), Error> {
        let Spec { width, height, .. } = *self.spec();
        results.check(self.lanes.len(), width * height);
        assert_eq!(commands.len(), self.lanes.len(), "there is a command for each task");
        for (lane, &command) in self.lanes.iter().zip(commands) {
            lane.check(command)?;
        }
        let share = if self.threads == 1 { commands.len().max(1) } else { SHARE };
        let shares =
            self.lanes.chunks_mut(share).zip(commands.chunks(share)).zip(results.shares(share, width * height));
        let shares = Mutex::new(shares);
        let work = || {
            loop {
                let next = shares.lock().unwrap_or_else(PoisonError::into_inner).next();
                let Some(((lanes, commands), results)) = next else { return Ok(()) };
                run(lanes, commands, results)?;
            }
        };
        thread::scope(|scope| {
            // A thread that can't be had leaves more to the others.
            let start = |_| thread::Builder::new().spawn_scoped(scope, work).ok();
            let helpers: Vec<_> = (1..self.threads).filter_map(start).collect();
            let own = work();
            let theirs = helpers.into_iter().map(|helper| helper.join().expect("a task doesn't panic"));
            theirs.fold(own, Result::and)
        })
    }

    /// Draws what the world of task `index` looks like now, at the frame's own size. Before the first reset it is black.
    ///
    /// # Panics
    /// If there is no such task.
    pub fn draw_into(&self, index: usize, frame: &mut Frame) {
        self.lanes[index].task.environment().draw_into(frame);
    }

    /// Everything that decides how the episodes go on, to the last bit.
    pub fn save_state(&self) -> Vec<u8> {
        let mut bytes = TAG.to_vec();
        for lane in &self.lanes {
            let task = lane.task.save_state();
            bytes.push(lane.phase as u8);
            bytes.extend(lane.steps.to_le_bytes());
            bytes.extend((task.len() as u32).to_le_bytes());
            bytes.extend(task);
        }
        bytes
    }

    /// Continues where [`save_state`](VectorTask::save_state) was called, on these tasks or as many of the same config.
    ///
    /// # Errors
    /// [`Error::BadState`] if the bytes are damaged or of other tasks; the tasks are as they were before.
    pub fn load_state(&mut self, bytes: &[u8]) -> Result<(), Error> {
        let before = self.save_state();
        self.load(bytes).inspect_err(|_| self.load(&before).expect("the tasks gave these bytes themselves"))
    }

    fn load(&mut self, bytes: &[u8]) -> Result<(), Error> {
        let mut reader = Reader::new("tasks side by side", bytes);
        reader.tag(TAG)?;
        for lane in &mut self.lanes {
            lane.phase = match reader.u8()? {
                0 => Phase::NotReset,
                1 => Phase::Running,
                2 => Phase::Over,
                other => return Err(reader.bad(format!("phase {other}"), "0 to 2")),
            };
            lane.steps = reader.u32()?;
            let len = reader.u32()? as usize;
            lane.task.load_state(reader.take(len)?)?;
        }
        reader.finish()
    }
}

impl<'a> Results<'a> {
    fn check(&self, count: usize, pixels: usize) {
        let Results { observations, rewards, scores, terminated, truncated } = self;
        let lens = [rewards.len(), scores.len(), terminated.len(), truncated.len()];
        assert_eq!((observations.len(), lens), (count * pixels, [count; 4]), "there is a result for each task");
    }

    /// The same, cut into shares of this number of tasks.
    fn shares(&mut self, share: usize, pixels: usize) -> impl Iterator<Item = Results<'_>> {
        let pictures = self.observations.chunks_mut(share * pixels);
        let numbers = self.rewards.chunks_mut(share).zip(self.scores.chunks_mut(share));
        let flags = self.terminated.chunks_mut(share).zip(self.truncated.chunks_mut(share));
        pictures.zip(numbers).zip(flags).map(|((observations, (rewards, scores)), (terminated, truncated))| Results {
            observations,
            rewards,
            scores,
            terminated,
            truncated,
        })
    }
}

fn run(lanes: &mut [Lane], commands: &[Command], results: Results<'_>) -> Result<(), Error> {
    let Results { observations, rewards, scores, terminated, truncated } = results;
    let pictures = observations.chunks_exact_mut(observations.len() / lanes.len());
    for (index, ((lane, &command), picture)) in lanes.iter_mut().zip(commands).zip(pictures).enumerate() {
        (rewards[index], scores[index], terminated[index], truncated[index]) = lane.run(command)?;
        lane.task.observation_into(picture);
    }
    Ok(())
}

impl Lane {
    /// Whether it can do that.
    fn check(&self, command: Command) -> Result<(), Error> {
        let &Spec { name: world, actions, .. } = self.task.spec();
        match (command, self.phase) {
            (Command::Step(got), _) if got >= actions.len() => {
                Err(Error::UnknownAction { world, got, last: actions.len() - 1 })
            }
            (Command::Step(_), Phase::NotReset) => Err(Error::NotReset { world }),
            (Command::Step(_), Phase::Over) => Err(Error::EpisodeOver { world }),
            _ => Ok(()),
        }
    }

    /// The reward, the score, and whether the episode was terminated and truncated.
    fn run(&mut self, command: Command) -> Result<(f64, f64, bool, bool), Error> {
        match command {
            Command::Step(action) => {
                let step = self.task.step(action)?;
                self.steps += 1;
                self.phase = if step.status.is_over() { Phase::Over } else { Phase::Running };
                let truncated = self.steps >= self.task.spec().limit_steps;
                Ok((f64::from(step.reward), f64::from(step.score), step.status == Status::Terminated, truncated))
            }
            Command::Reset(seed) => {
                self.task.reset(seed);
                (self.phase, self.steps) = (Phase::Running, 0);
                Ok((0.0, 0.0, false, false))
            }
            Command::Keep => Ok((0.0, 0.0, false, false)),
        }
    }
}
