//! A world joined with a source of reward and a state representation: what an agent learns.

mod config;
mod state;

use std::cell::{Cell, OnceCell};

use prf_core::{Error as CoreError, Explanation, Frame, FrameMut, Goal, TaskDescriptor};

pub use self::config::{
    EnvConfig, RewardConfig, RewardForm, RewardSource, StateConfig, StateKind, TaskConfig, WindowConfig,
};
use self::state::Representation;
use crate::bytes::Reader;
use crate::{Environment, Error, Spec, Status, registry};

/// Marks a task's state and the version of its layout.
const TAG: &[u8] = b"task2";

/// What one step of a task brought.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TaskStep {
    /// The reward of the chosen source: F in (0, 1] of the frame after the action, by [`RewardForm::Potential`] what became of it
    /// (in (−1, 1)), or the world's own.
    pub reward: f32,
    /// The world's score so far in this episode.
    pub score: f32,
    /// Where the episode stands.
    pub status: Status,
}

/// A world, its reward and what the agent sees of it.
///
/// ```
/// use prf_core::{Frame, Goal};
/// use prf_envs::{EnvConfig, RewardConfig, StateConfig, Task, TaskConfig};
///
/// let config = TaskConfig {
///     env: EnvConfig::new("breakout"),
///     reward: RewardConfig::perceptual("black.png"),
///     state: StateConfig::default(),
/// };
/// let mut task = Task::new(&config, Some(&Goal::from(Frame::new(84, 84))))?;
/// task.reset(1);
/// let step = task.step(0)?;
/// assert!(step.reward > 0.0 && step.reward < 1.0);
/// assert_eq!(task.observation().len(), 84 * 84);
/// # Ok::<(), prf_envs::Error>(())
/// ```
pub struct Task {
    environment: Box<dyn Environment>,
    reward: Reward,
    mirror: Mirror,
    state: Representation,
}

/// The world's picture, drawn when it is asked for: a state or a reward may need it or not.
struct Mirror {
    frame: OnceCell<Frame>,
    /// An old one, whose memory is kept.
    spare: Cell<Option<Frame>>,
}

impl Mirror {
    fn new() -> Mirror {
        Mirror { frame: OnceCell::new(), spare: Cell::new(None) }
    }

    /// What `world` looks like now.
    fn of(&self, world: &dyn Environment) -> &Frame {
        self.frame.get_or_init(|| {
            let &Spec { width, height, .. } = world.spec();
            let mut frame = self.spare.take().unwrap_or_else(|| Frame::new(width, height));
            world.draw_into(&mut frame);
            frame
        })
    }

    /// The world has changed.
    fn forget(&mut self) {
        if let Some(frame) = self.frame.take() {
            self.spare.set(Some(frame));
        }
    }
}

enum Reward {
    Variable,
    Perceptual { descriptor: Box<dyn TaskDescriptor>, potential: Option<Potential> },
}

/// What [`RewardForm::Potential`] remembers.
struct Potential {
    gamma: f32,
    /// F of the frame before the next step; 0 before the first reset.
    now: f32,
}

impl Potential {
    /// The reward of a step to a frame whose F is `next`.
    fn step(&mut self, next: f32) -> f32 {
        self.gamma * next - std::mem::replace(&mut self.now, next)
    }
}

impl Task {
    /// The task of `config` before its first episode.
    ///
    /// `goal` holds the pictures that `reward.goal` and `reward.window.mask` name; a perceptual reward needs it, a
    /// variable one takes none.
    ///
    /// # Errors
    /// As [`TaskConfig::validate`]; a missing or superfluous goal; a goal that the descriptor can't use or that is larger
    /// than the world's picture.
    pub fn new(config: &TaskConfig, goal: Option<&Goal>) -> Result<Task, Error> {
        config.validate()?;
        let environment = registry::make(&config.env)?;
        let &Spec { width, height, .. } = environment.spec();
        Ok(Task {
            environment,
            reward: Reward::new(&config.reward, goal, [height, width])?,
            mirror: Mirror::new(),
            state: Representation::new(config, width, height)?,
        })
    }

    /// The world's fixed facts.
    pub fn spec(&self) -> &Spec {
        self.environment.spec()
    }

    /// Begins the episode of `seed`; [`observation`](Task::observation) then holds the first state.
    pub fn reset(&mut self, seed: u64) {
        self.environment.reset(seed);
        if let Reward::Perceptual { descriptor, .. } = &mut self.reward {
            descriptor.reset();
        }
        self.state.reset();
        self.look();
        if let Reward::Perceptual { descriptor, potential } = &mut self.reward {
            let mirror = self.mirror.of(self.environment.as_ref()).view();
            let taken = match potential {
                None => descriptor.pass(mirror),
                Some(potential) => descriptor.observe(mirror).map(|score| potential.now = score.reward),
            };
            taken.expect("a new episode takes frames of the size it was prepared for");
        }
    }

    /// Plays one step with `action`, an index into [`Spec::actions`].
    ///
    /// # Errors
    /// As [`Environment::step`].
    pub fn step(&mut self, action: usize) -> Result<TaskStep, Error> {
        let step = self.environment.step(action)?;
        self.look();
        let reward = match &mut self.reward {
            Reward::Variable => step.reward,
            Reward::Perceptual { descriptor, potential } => {
                let value = descriptor.observe(self.mirror.of(self.environment.as_ref()).view())?.reward;
                potential.as_mut().map_or(value, |potential| potential.step(value))
            }
        };
        Ok(TaskStep { reward, score: step.score, status: step.status })
    }

    /// What the agent sees now: height × width grey values, row by row. All black before the first reset.
    pub fn observation(&self) -> &[u8] {
        self.state.observation().unwrap_or_else(|| self.mirror().as_slice())
    }

    /// Writes [`observation`](Task::observation) to `pixels`. A picture that nothing else has asked for is drawn there and nowhere else.
    ///
    /// # Panics
    /// If there are more or fewer than height × width of them.
    pub fn observation_into(&self, pixels: &mut [u8]) {
        match self.state.observation().or(self.mirror.frame.get().map(Frame::as_slice)) {
            Some(observation) => pixels.copy_from_slice(observation),
            None => {
                let &Spec { width, height, .. } = self.spec();
                let mut frame = FrameMut::new(width, height, pixels).expect("as many pixels as the world has");
                self.environment.draw(&mut frame);
            }
        }
    }

    /// The world's picture now.
    pub fn mirror(&self) -> &Frame {
        self.mirror.of(self.environment.as_ref())
    }

    /// Where the reward of the last step came from; none for a variable reward.
    pub fn explain(&self) -> Option<Explanation<'_>> {
        match &self.reward {
            Reward::Variable => None,
            Reward::Perceptual { descriptor, .. } => Some(descriptor.explain(self.mirror().view())),
        }
    }

    /// The world.
    pub fn environment(&self) -> &dyn Environment {
        self.environment.as_ref()
    }

    /// Everything that decides how the episode goes on, to the last bit.
    pub fn save_state(&self) -> Vec<u8> {
        let world = self.environment.save_state();
        let mut bytes = TAG.to_vec();
        bytes.extend((world.len() as u32).to_le_bytes());
        bytes.extend(world);
        self.state.save_into(&mut bytes);
        bytes.extend(self.reward.save());
        bytes
    }

    /// Continues where [`save_state`](Task::save_state) was called, on this task or one of the same config.
    ///
    /// # Errors
    /// [`Error::BadState`] if the bytes are damaged or of another kind of task; the task is as it was before.
    pub fn load_state(&mut self, bytes: &[u8]) -> Result<(), Error> {
        let mut reader = Reader::new("a task", bytes);
        reader.tag(TAG)?;
        let world_len = reader.u32()? as usize;
        let world = reader.take(world_len)?;
        let state = self.state.restored(&mut reader)?;
        self.reward.load(reader.rest(), || self.environment.load_state(world))?;
        self.mirror.forget();
        self.state = state;
        Ok(())
    }

    /// The world has changed: takes its picture in, where the state remembers.
    fn look(&mut self) {
        self.mirror.forget();
        if self.state.remembers() {
            self.state.update(self.mirror.of(self.environment.as_ref()).view());
        }
    }
}

impl Reward {
    fn new(config: &RewardConfig, goal: Option<&Goal>, shape: [usize; 2]) -> Result<Reward, Error> {
        let Some(params) = config.descriptor_params() else {
            return match goal {
                None => Ok(Reward::Variable),
                Some(_) => Err(Error::param("reward.goal", "a picture", "none for a variable reward")),
            };
        };
        let goal = goal.ok_or_else(|| Error::param("reward.goal", "no picture", "one for a perceptual reward"))?;
        let describe = || {
            let mut descriptor = params.describe(goal, config.params())?;
            descriptor.prepare(shape)?;
            Ok::<_, CoreError>(descriptor)
        };
        let descriptor = describe().map_err(|error| error.within("reward"))?;
        let potential = match config.form {
            RewardForm::State => None,
            RewardForm::Potential => config.gamma.map(|gamma| Potential { gamma, now: 0.0 }),
        };
        Ok(Reward::Perceptual { descriptor, potential })
    }

    /// What it remembers of the episode.
    fn save(&self) -> Vec<u8> {
        match self {
            Reward::Variable => Vec::new(),
            Reward::Perceptual { descriptor, potential } => {
                let now = potential.iter().flat_map(|potential| potential.now.to_le_bytes());
                now.chain(descriptor.save_state()).collect()
            }
        }
    }

    /// Takes up what [`save`](Reward::save) gave, if `others` can be loaded as well.
    fn load(&mut self, bytes: &[u8], others: impl FnOnce() -> Result<(), Error>) -> Result<(), Error> {
        let before = self.save();
        self.restore(bytes)?;
        others().inspect_err(|_| self.restore(&before).expect("it gave these bytes itself"))
    }

    fn restore(&mut self, bytes: &[u8]) -> Result<(), Error> {
        let Reward::Perceptual { descriptor, potential } = self else {
            let fits = bytes.is_empty();
            return if fits {
                Ok(())
            } else {
                Err(bad_state(format!("{} bytes too many", bytes.len()), "none for this reward"))
            };
        };
        let mut reader = Reader::new("a task", bytes);
        let now = match potential {
            None => 0.0,
            Some(_) => f32::from_le_bytes(reader.array()?),
        };
        if !(0.0..=1.0).contains(&now) {
            return Err(reader.bad(format!("a reward of {now}"), "one from 0 to 1"));
        }
        descriptor.load_state(reader.rest()).map_err(|error| match error {
            CoreError::Restore { got, expected } => bad_state(got, expected),
            other => other.into(),
        })?;
        if let Some(potential) = potential {
            potential.now = now;
        }
        Ok(())
    }
}

fn bad_state(got: impl Into<String>, expected: impl Into<String>) -> Error {
    Error::BadState { what: "a task", got: got.into(), expected: expected.into() }
}
