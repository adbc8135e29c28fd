//! The training loop: act, step the worlds, learn, evaluate, save.

use std::time::Instant;

use prf_core::Goal;
use prf_envs::rng::{ChaCha8Rng, below, stream, unit_f32};
use prf_envs::{Status, Task};

use crate::checkpoint::{CheckpointStore, Model, Retention};
use crate::config::RunConfig;
use crate::error::{Error, Result};
use crate::evaluate::{Spread, episode_seeds, play_greedily};
use crate::learner::{Learner, greedy_actions};
use crate::network::Architecture;
use crate::record::{
    EpisodeKind, EvaluationRecord, Event, Loss, Preamble, Progress, Recorder, Records, TimeShares, TrainRecord, timed,
};
use crate::replay::{Batch, Outcome, Replay};
use crate::run_dir::RunDir;
use crate::schedule;

mod divergence;
mod lane;
mod recording;
mod state;

pub use divergence::{Divergence, Figures};
use lane::{Lane, Window, finite};
use recording::{Place, Recording, step_record, tell};
use state::Counters;

/// How [`Trainer::run`] ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ending {
    /// The run is complete.
    Finished,
    /// It was asked to stop, and saved itself.
    Interrupted,
}

/// A run in progress.
pub struct Trainer {
    config: RunConfig,
    lanes: Vec<Lane>,
    evaluation_tasks: Vec<Task>,
    evaluation_seeds: Vec<u64>,
    learner: Learner,
    replay: Replay,
    exploration: ChaCha8Rng,
    sampling: ChaCha8Rng,
    counters: Counters,
    records: Records,
    recording: Recording,
    /// What of the records was damaged when the run was resumed.
    losses: Vec<Loss>,
    checkpoints: CheckpointStore,
    /// The checkpoints on disk.
    retention: Retention,
    /// Steps at the last checkpoint.
    saved_at: Option<u64>,
    /// Reused by every step and update.
    states: Vec<u8>,
    batch: Batch,
    time: TimeShares,
    started: Instant,
    window_started: Instant,
}

/// The network that a task needs, dueling or not.
///
/// # Errors
/// When the pictures of the task are too small for the convolutions.
pub fn architecture(task: &Task, dueling: bool) -> Result<Architecture> {
    let spec = task.spec();
    let least = Architecture::smallest_input() as usize;
    if spec.width < least || spec.height < least {
        return Err(Error::Config(prf_core::Error::InvalidParam {
            key: "env.name".to_owned(),
            got: format!("a world of {}×{} px", spec.width, spec.height),
            expected: format!("at least {least}×{least} px for the network"),
        }));
    }
    Ok(Architecture { input: [spec.height as i64, spec.width as i64], actions: spec.actions.len() as i64, dueling })
}

/// Checks what only the task and this machine can tell: that the network takes the pictures, and that there is memory
/// for the replay.
///
/// # Errors
/// [`Error::Config`] with the key at fault.
pub fn check(config: &RunConfig, task: &Task) -> Result<()> {
    let train = &config.train;
    architecture(task, train.dueling)?;
    let bytes = train.replay_bytes(task.observation().len());
    // Reserved memory is not touched, so this takes no time.
    Vec::<u8>::new().try_reserve_exact(bytes as usize).map_err(|_| {
        Error::Config(prf_core::Error::InvalidParam {
            key: "train.replay_steps".to_owned(),
            got: format!("{}, which take {:.0} GB", train.replay_steps, bytes as f64 / 1e9),
            expected: "as many as fit into the memory of this machine".to_owned(),
        })
    })
}

impl Trainer {
    /// A run in `run`: at its beginning, or where its newest checkpoint left it.
    ///
    /// # Errors
    /// When the task cannot be built, the run directory cannot be written or the checkpoint is damaged.
    pub fn open(config: RunConfig, goal: Option<&Goal>, run: &RunDir, device: tch::Device) -> Result<Self> {
        let mut trainer = Self::new(config, goal, run, device)?;
        trainer.resume(run)?;
        Ok(trainer)
    }

    fn new(config: RunConfig, goal: Option<&Goal>, run: &RunDir, device: tch::Device) -> Result<Self> {
        let seed = config.seed;
        let preamble = Preamble {
            goal: goal.cloned(),
            config: toml::to_string(&config).expect("a configuration is plain tables"),
            provenance: run.provenance(seed, device),
        };
        // First of all: whoever holds the records is alone in the run directory.
        let records = Records::open(run, &config, preamble)?;
        let task = config.task();
        let make = || Ok::<_, Error>(Task::new(&task, goal)?);
        let lanes = (0..config.train.environments)
            .map(|index| Ok(Lane::new(make()?, stream(seed, "episodes", index as u64))))
            .collect::<Result<Vec<_>>>()?;
        let evaluation_tasks = (0..config.evaluation.episodes).map(|_| make()).collect::<Result<Vec<_>>>()?;
        let architecture = architecture(&evaluation_tasks[0], config.train.dueling)?;
        let compute = config.train.compute(device)?;
        let mut recording = Recording::default();
        (0..lanes.len()).for_each(|lane| recording.begin(lane, config.record.training_every_episodes));
        let frame_len = (architecture.input[0] * architecture.input[1]) as usize;
        Ok(Self {
            evaluation_seeds: episode_seeds(0, "evaluation", config.evaluation.episodes),
            learner: Learner::new(architecture, config.train.learner(), compute, &mut stream(seed, "network", 0))?,
            replay: config.train.replay(frame_len),
            exploration: stream(seed, "exploration", 0),
            sampling: stream(seed, "replay", 0),
            counters: Counters::default(),
            records,
            recording,
            losses: Vec::new(),
            checkpoints: CheckpointStore::open(run.path())?,
            retention: Retention::default(),
            saved_at: None,
            states: Vec::new(),
            batch: Batch::default(),
            time: TimeShares::default(),
            started: Instant::now(),
            window_started: Instant::now(),
            lanes,
            evaluation_tasks,
            config,
        })
    }

    /// Trains to the end of the run, or until `stop` says so; then everything is saved, and [`Trainer::open`] goes on.
    ///
    /// # Errors
    /// When something cannot be written; what was written before stays.
    pub fn run(&mut self, recorder: &mut dyn Recorder, stop: &dyn Fn() -> bool) -> Result<Ending> {
        (self.started, self.window_started) = (Instant::now(), Instant::now());
        while !self.is_finished() {
            if stop() {
                self.save(recorder)?;
                self.records.finish()?;
                return Ok(Ending::Interrupted);
            }
            self.step_worlds(recorder)?;
            self.learn()?;
            recorder.record(&Event::Progress(self.progress()))?;
            if self.counters.episodes / self.config.evaluation.every_episodes > self.counters.evaluations_due {
                self.evaluate(recorder)?;
            }
            let checkpoints = self.counters.steps / self.config.train.checkpoint_every_steps;
            // The last checkpoint waits for the last evaluation.
            if checkpoints > self.counters.checkpoints_due && !self.is_finished() {
                self.save(recorder)?;
            }
        }
        if self.counters.evaluated_at != Some(self.counters.steps) {
            self.evaluate(recorder)?;
        }
        self.save(recorder)?;
        self.records.finish()?;
        Ok(Ending::Finished)
    }

    fn is_finished(&self) -> bool {
        self.done() >= 1.0
    }

    fn done(&self) -> f64 {
        schedule::progress(&self.config.train, self.counters.steps, self.counters.episodes)
    }

    fn epsilon(&self) -> f32 {
        schedule::epsilon(&self.config.train.epsilon, self.counters.steps)
    }

    /// One ε-greedy step of every environment.
    fn step_worlds(&mut self, recorder: &mut dyn Recorder) -> Result<()> {
        let epsilon = self.epsilon();
        let actions = self.choose_actions()?;
        // The states acted in: the step overwrites the tasks' own.
        let states = self.states.chunks_exact(self.states.len() / self.lanes.len());
        for (index, ((lane, state), action)) in self.lanes.iter_mut().zip(states).zip(actions).enumerate() {
            let step = timed(&mut self.time.worlds_s, || lane.task.step(action))?;
            let reward = finite(step.reward, index, self.counters.steps + 1)?;
            let outcome = match step.status {
                Status::Running => Outcome::Continued,
                Status::Terminated => Outcome::Terminated,
                Status::Truncated => Outcome::Truncated,
            };
            timed(&mut self.time.replay_s, || {
                self.replay.push(index, state, action as u8, reward, outcome);
                if outcome == Outcome::Truncated {
                    self.replay.push_last_state(index, lane.task.observation());
                }
            });
            self.counters.steps += 1;
            lane.episode.add(&step);
            if let Some(episode) = self.recording.episode(index) {
                let place = Place { kind: EpisodeKind::Training, trained_steps: self.counters.steps, episode, epsilon };
                let record = step_record(&lane.task, action, &step, &lane.episode, place);
                timed(&mut self.time.records_s, || tell(&mut self.records, recorder, &Event::Step(&record)))?;
            }
            if step.status.is_over() {
                self.counters.finish(lane.episode);
                self.recording.begin(index, self.config.record.training_every_episodes);
                timed(&mut self.time.worlds_s, || lane.begin_episode());
            }
        }
        Ok(())
    }

    fn choose_actions(&mut self) -> Result<Vec<usize>> {
        self.states.clear();
        for lane in &self.lanes {
            self.states.extend_from_slice(lane.task.observation());
        }
        let values = timed(&mut self.time.acting_s, || self.learner.online.q_values(&self.states, self.lanes.len()))?;
        let actions = values.len() / self.lanes.len();
        let epsilon = self.epsilon();
        let explore = |greedy| {
            let random = unit_f32(&mut self.exploration) < epsilon;
            if random { below(&mut self.exploration, actions) } else { greedy }
        };
        Ok(greedy_actions(&values, actions).map(explore).collect())
    }

    /// As many updates as the steps taken so far allow.
    fn learn(&mut self) -> Result<()> {
        let train = &self.config.train;
        let due = self.counters.steps.saturating_sub(train.learning_starts) / train.steps_per_update;
        let rate = schedule::learning_rate(train, self.done());
        let (size, reach) = (train.batch_size, train.reach());
        let beta = train.prioritized.map(|config| schedule::beta(&config, self.done()));
        while self.learner.updates < due {
            timed(&mut self.time.replay_s, || match beta {
                None => self.replay.sample(size, reach, &mut self.sampling, &mut self.batch),
                Some(beta) => self.replay.sample_by_priority(size, beta, &mut self.sampling, &mut self.batch),
            });
            let update = timed(&mut self.time.updates_s, || self.learner.update(&self.batch, rate))?;
            if !update.loss.is_finite() {
                return Err(self.diverged(&update)?);
            }
            if beta.is_some() {
                self.replay.set_errors(&self.batch.places, &update.errors()?);
            }
            self.counters.window.add_loss(update.loss);
        }
        Ok(())
    }

    /// Records the training episodes since the last evaluation, then plays the greedy policy.
    fn evaluate(&mut self, recorder: &mut dyn Recorder) -> Result<()> {
        self.tell(recorder, &Event::Train(self.train_record()))?;
        self.counters.window = Window::default();

        let network = &self.learner.online;
        let mut taken = vec![Vec::new(); self.config.record.evaluation_episodes];
        let mut take = |episode: usize, action| taken.get_mut(episode).into_iter().for_each(|taken| taken.push(action));
        let episodes = timed(&mut self.time.evaluation_s, || {
            let q_values = |states: &[u8], count| network.q_values(states, count);
            play_greedily(&mut self.evaluation_tasks, &self.evaluation_seeds, q_values, &mut take)
        })?;
        self.record_evaluation(recorder, &taken)?;
        let score = Spread::of(episodes.iter().map(|episode| f64::from(episode.score)));
        self.tell(
            recorder,
            &Event::Evaluation(EvaluationRecord {
                step: self.counters.steps,
                episode: self.counters.episodes,
                episodes: episodes.len(),
                mean_score: score.mean,
                std_score: score.std,
                mean_reward: Spread::of(episodes.iter().map(|episode| episode.reward)).mean,
                mean_steps: Spread::of(episodes.iter().map(|episode| f64::from(episode.steps))).mean,
                time_s: self.elapsed_s(),
            }),
        )?;
        if self.counters.best_score.is_none_or(|best| score.mean > best) {
            self.counters.best_score = Some(score.mean);
            self.checkpoints.write_best(&Model::of(&self.learner.online)?)?;
        }
        self.counters.last_score = Some(score.mean);
        self.counters.evaluated_at = Some(self.counters.steps);
        self.counters.evaluations_due = self.counters.episodes / self.config.evaluation.every_episodes;
        self.window_started = Instant::now();
        Ok(())
    }

    fn elapsed_s(&self) -> f64 {
        self.counters.elapsed_s + self.started.elapsed().as_secs_f64()
    }

    fn train_record(&self) -> TrainRecord {
        let (counters, window) = (&self.counters, &self.counters.window);
        let seconds = self.window_started.elapsed().as_secs_f64();
        TrainRecord {
            step: counters.steps,
            episode: counters.episodes,
            update: self.learner.updates,
            mean_score: window.mean_score(),
            mean_reward: window.mean_reward(),
            mean_steps: window.mean_steps(),
            mean_loss: window.mean_loss(),
            epsilon: self.epsilon(),
            time_s: self.elapsed_s(),
            steps_per_s: window.steps as f64 / seconds.max(f64::EPSILON),
        }
    }

    fn progress(&self) -> Progress {
        let window = &self.counters.window;
        Progress {
            steps: self.counters.steps,
            episodes: self.counters.episodes,
            done: self.done(),
            epsilon: self.epsilon(),
            recent_score: window.mean_score(),
            recent_reward: window.mean_reward(),
            evaluation_score: self.counters.last_score,
        }
    }

    /// Steps taken so far, over all environments.
    pub fn steps(&self) -> u64 {
        self.counters.steps
    }

    /// Threads that the network computes with.
    pub fn threads(&self) -> usize {
        self.learner.compute().threads()
    }

    /// Memory that the replay takes once it is full, in bytes.
    pub fn replay_bytes(&self) -> u64 {
        self.config.train.replay_bytes(self.lanes[0].task.observation().len())
    }

    /// What of the records was damaged when the run was resumed, and is lost.
    pub fn losses(&self) -> &[Loss] {
        &self.losses
    }

    /// Mean score of the last greedy evaluation.
    pub fn last_score(&self) -> Option<f64> {
        self.counters.last_score
    }

    /// Where the time of the run went so far; what a killed process spent after its last checkpoint is not counted.
    pub fn time(&self) -> TimeShares {
        self.time
    }
}
