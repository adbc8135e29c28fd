//! The tasks behind the environments of `prf.envs`

use numpy::ndarray::Dimension;
use numpy::{
    Element, PyArray, PyArray1, PyArray3, PyArray4, PyArrayMethods, PyReadonlyArray, PyReadonlyArray1,
    PyReadwriteArray, PyUntypedArrayMethods,
};
use prf_core::{DescriptorParams, Error as CoreError, Frame};
use prf_envs::{Command, Error, Results, RewardConfig, Spec, StateConfig, TaskConfig, VectorTask, WindowConfig};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};

use crate::batch::Threads;
use crate::choice::choice;
use crate::error::value_error;
use crate::exclusive::Exclusive;
use crate::goal::{GoalParts, goal_parts};
use crate::limits::{MAX_SIDE, check_tasks};
use crate::options::Options;
use crate::presets::Preset;

/// More than anybody steps together. Each takes up to some hundred kB.
const MAX_TASKS: usize = 4096;

/// Tasks of one kind, each with an episode of its own.
///
/// ``num_envs`` tasks in the world of a preset. Without ``goal`` the reward is the world's own; without ``state`` the
/// agent sees what the preset's does; without ``max_episode_steps`` episodes have no limit; without ``threads`` there are
/// as many as pay off, up to the number of cores.
///
/// Results are written into C-contiguous arrays of the caller's. Other threads run meanwhile; where another one is just
/// using the same tasks, methods raise RuntimeError rather than wait.
#[pyclass(frozen, module = "prf._native")]
pub(crate) struct Tasks {
    recipe: Recipe,
    inner: Exclusive<Inner>,
}

/// The arguments that give the same tasks again.
struct Recipe {
    preset: String,
    num_envs: usize,
    goal: Option<Py<PyAny>>,
    state: Option<String>,
    max_episode_steps: Option<usize>,
    threads: Option<usize>,
}

struct Inner {
    tasks: VectorTask,
    commands: Vec<Command>,
    /// What was drawn last.
    canvas: Frame,
}

#[pymethods]
impl Tasks {
    #[new]
    #[pyo3(
        signature = (preset, **options),
        text_signature = "(preset, *, num_envs=1, goal=None, state=None, max_episode_steps=None, threads=None)"
    )]
    fn new(py: Python<'_>, preset: String, options: Option<Bound<'_, PyDict>>) -> PyResult<Tasks> {
        let options = Options::new("Tasks", options);
        let recipe = Recipe {
            preset,
            num_envs: options.get("num_envs")?.unwrap_or(1),
            goal: options.raw("goal")?.filter(|goal| !goal.is_none()).map(Bound::unbind),
            state: options.get_optional("state")?,
            max_episode_steps: options.get_optional("max_episode_steps")?,
            threads: Threads::read(&options)?.most(),
        };
        options.finish()?;
        let inner = Exclusive::new(Inner {
            tasks: recipe.tasks(py)?,
            commands: Vec::with_capacity(recipe.num_envs),
            canvas: Frame::new(1, 1),
        });
        Ok(Tasks { recipe, inner })
    }

    /// tuple of str: What the actions are called.
    #[getter]
    fn actions(&self) -> PyResult<&'static [&'static str]> {
        Ok(self.inner.lock()?.tasks.spec().actions)
    }

    /// tuple of int: Height and width of an observation.
    #[getter]
    fn shape(&self) -> PyResult<(usize, usize)> {
        let Spec { width, height, .. } = *self.inner.lock()?.tasks.spec();
        Ok((height, width))
    }

    /// Begins the episode of ``seeds[i]`` where ``mask[i]`` is set.
    ///
    /// Parameters
    /// ----------
    /// mask : (N,) ndarray of bool
    /// seeds : (N,) ndarray of uint64
    /// observations : (N, H, W) ndarray of uint8
    ///     Gets what each agent sees now, whether its episode is new or not.
    fn reset(
        &self,
        py: Python<'_>,
        mask: &Bound<'_, PyArray1<bool>>,
        seeds: &Bound<'_, PyArray1<u64>>,
        observations: &Bound<'_, PyArray3<u8>>,
    ) -> PyResult<()> {
        let count = self.recipe.num_envs;
        let (mask, seeds) = (input("mask", mask, count)?, input("seeds", seeds, count)?);
        let mut inner = self.inner.lock()?;
        let mut observations = output("observations", observations, &inner.observation_shape(count))?;
        inner.commands.clear();
        inner.commands.extend(mask.as_slice()?.iter().zip(seeds.as_slice()?).map(|(&begins, &seed)| match begins {
            true => Command::Reset(seed),
            false => Command::Keep,
        }));
        let (mut rewards, mut scores) = (vec![0.0; count], vec![0.0; count]);
        let (mut terminated, mut truncated) = (vec![false; count], vec![false; count]);
        let mut results = Results {
            observations: observations.as_slice_mut()?,
            rewards: &mut rewards,
            scores: &mut scores,
            terminated: &mut terminated,
            truncated: &mut truncated,
        };
        inner.run(py, &mut results)
    }

    /// Plays a step of each task; or begins the episode of ``seeds[i]`` where ``restart[i]`` is set.
    ///
    /// Where an action is none or an episode has to begin first, nothing is played.
    ///
    /// Parameters
    /// ----------
    /// actions : (N,) ndarray of int64
    /// restart : (N,) ndarray of bool, or None
    ///     None where no episode is to begin.
    /// seeds : (N,) ndarray of uint64
    ///     Ignored without ``restart``.
    /// observations : (N, H, W) ndarray of uint8
    /// rewards, scores : (N,) ndarray of float64
    ///     Both are 0 where an episode begins.
    /// terminated, truncated : (N,) ndarray of bool
    ///     A step that ends the episode by itself and is the last one that the limit allows is both.
    ///
    /// Returns
    /// -------
    /// int
    ///     How many episodes ended.
    ///
    /// Raises
    /// ------
    /// gymnasium.error.InvalidAction
    ///     An action is out of range.
    /// gymnasium.error.ResetNeeded
    ///     An episode has not begun, or is over.
    #[expect(clippy::too_many_arguments, reason = "a result has many parts")]
    fn step(
        &self,
        py: Python<'_>,
        actions: &Bound<'_, PyArray1<i64>>,
        restart: Option<&Bound<'_, PyArray1<bool>>>,
        seeds: &Bound<'_, PyArray1<u64>>,
        observations: &Bound<'_, PyArray3<u8>>,
        rewards: &Bound<'_, PyArray1<f64>>,
        scores: &Bound<'_, PyArray1<f64>>,
        terminated: &Bound<'_, PyArray1<bool>>,
        truncated: &Bound<'_, PyArray1<bool>>,
    ) -> PyResult<usize> {
        let count = self.recipe.num_envs;
        let (actions, seeds) = (input("actions", actions, count)?, input("seeds", seeds, count)?);
        let restart = restart.map(|restart| input("restart", restart, count)).transpose()?;
        let restart = restart.as_ref().map(PyReadonlyArray::as_slice).transpose()?;
        let mut inner = self.inner.lock()?;
        let known = inner.tasks.spec().actions.len();
        inner.commands.clear();
        for (index, (&action, &seed)) in actions.as_slice()?.iter().zip(seeds.as_slice()?).enumerate() {
            inner.commands.push(match restart {
                Some(restart) if restart[index] => Command::Reset(seed),
                _ => Command::Step(self.action(py, index, action, known)?),
            });
        }
        let mut observations = output("observations", observations, &inner.observation_shape(count))?;
        let (mut rewards, mut scores) = (output("rewards", rewards, &[count])?, output("scores", scores, &[count])?);
        let mut terminated = output("terminated", terminated, &[count])?;
        let mut truncated = output("truncated", truncated, &[count])?;
        let mut results = Results {
            observations: observations.as_slice_mut()?,
            rewards: rewards.as_slice_mut()?,
            scores: scores.as_slice_mut()?,
            terminated: terminated.as_slice_mut()?,
            truncated: truncated.as_slice_mut()?,
        };
        inner.run(py, &mut results)?;
        Ok(results.terminated.iter().zip(&*results.truncated).filter(|&(&ended, &cut)| ended | cut).count())
    }

    /// Draws every world as it looks now, at the size of ``frames``.
    ///
    /// Parameters
    /// ----------
    /// frames : (N, H, W, 3) ndarray of uint8
    ///     Gets red, green and blue, which are equal.
    fn render(&self, py: Python<'_>, frames: &Bound<'_, PyArray4<u8>>) -> PyResult<()> {
        let [height, width] = [1, 2].map(|axis| frames.shape()[axis].clamp(1, MAX_SIDE));
        let mut frames = output("frames", frames, &[self.recipe.num_envs, height, width, 3])?;
        let frames = frames.as_slice_mut()?;
        let mut inner = self.inner.lock()?;
        let Inner { tasks, canvas, .. } = &mut *inner;
        py.detach(move || {
            if [canvas.height(), canvas.width()] != [height, width] {
                *canvas = Frame::new(width, height);
            }
            for (index, frame) in frames.chunks_exact_mut(3 * width * height).enumerate() {
                tasks.draw_into(index, canvas);
                for (pixel, &grey) in frame.as_chunks_mut().0.iter_mut().zip(canvas.as_slice()) {
                    *pixel = [grey; 3];
                }
            }
        });
        Ok(())
    }

    fn __getnewargs_ex__<'py>(&self, py: Python<'py>) -> PyResult<((&str,), Bound<'py, PyDict>)> {
        let Recipe { preset, num_envs, goal, state, max_episode_steps, threads } = &self.recipe;
        let options = PyDict::new(py);
        options.set_item("num_envs", num_envs)?;
        options.set_item("goal", goal)?;
        options.set_item("state", state)?;
        options.set_item("max_episode_steps", max_episode_steps)?;
        options.set_item("threads", threads)?;
        Ok(((preset,), options))
    }

    fn __getstate__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        let inner = self.inner.lock()?;
        Ok(PyBytes::new(py, &inner.tasks.save_state()))
    }

    fn __setstate__(&self, state: &[u8]) -> PyResult<()> {
        self.inner.lock()?.tasks.load_state(state).map_err(|error| PyValueError::new_err(format!("state: {error}")))
    }
}

impl Tasks {
    /// The action of task `index`, if there is such an action.
    fn action(&self, py: Python<'_>, index: usize, action: i64, known: usize) -> PyResult<usize> {
        match usize::try_from(action) {
            Ok(action) if action < known => Ok(action),
            _ => {
                let name = if self.recipe.num_envs == 1 { "action".to_owned() } else { format!("actions[{index}]") };
                let message = format!("{name}: got {action}, expected 0 to {}", known - 1);
                Err(gymnasium_error(py, "InvalidAction", message))
            }
        }
    }
}

impl Inner {
    fn observation_shape(&self, count: usize) -> [usize; 3] {
        let Spec { width, height, .. } = *self.tasks.spec();
        [count, height, width]
    }

    fn run(&mut self, py: Python<'_>, results: &mut Results<'_>) -> PyResult<()> {
        let Inner { tasks, commands, .. } = self;
        py.detach(|| tasks.run(commands, results)).map_err(|error| match error {
            Error::NotReset { .. } | Error::EpisodeOver { .. } => gymnasium_error(py, "ResetNeeded", error.to_string()),
            other => PyValueError::new_err(other.to_string()),
        })
    }
}

impl Recipe {
    fn tasks(&self, py: Python<'_>) -> PyResult<VectorTask> {
        if !(1..=MAX_TASKS).contains(&self.num_envs) {
            return Err(out_of_range("num_envs", self.num_envs, 1, MAX_TASKS));
        }
        let goal = self.goal.as_ref().map(|goal| goal_parts(goal.bind(py))).transpose()?;
        let config = self.config(py, goal.as_ref())?;
        let picture = goal.as_ref().map(|parts| &parts.goal);
        let make = |count| py.detach(|| VectorTask::new(&config, picture, count)).map_err(|error| task_error(&error));
        // One of them tells their size, before there is more than fits into memory.
        let one = make(1)?;
        if let Some(GoalParts { goal, params, .. }) = &goal {
            let goal = [goal.picture.height(), goal.picture.width()];
            let frame = [one.spec().height, one.spec().width];
            check_tasks(&params.hog, &[goal, frame], self.num_envs)?;
        }
        let tasks = match self.num_envs {
            1 => one,
            count => make(count)?,
        };
        Ok(match self.threads {
            Some(threads) => tasks.with_threads(threads),
            None => tasks,
        })
    }

    fn config(&self, py: Python<'_>, goal: Option<&GoalParts>) -> PyResult<TaskConfig> {
        let mut config = Preset::find(py, &self.preset)?.config()?;
        config.reward = goal.map_or_else(RewardConfig::variable, reward_config);
        if let Some(state) = &self.state {
            config.state = StateConfig { kind: choice(py, "state", state)?, ..config.state };
        }
        config.env.limit_steps = match self.max_episode_steps {
            None => u32::MAX,
            Some(steps) => match u32::try_from(steps) {
                Ok(steps @ 1..) => steps,
                _ => return Err(out_of_range("max_episode_steps", steps, 1, u32::MAX as usize)),
            },
        };
        Ok(config)
    }
}

/// The reward of a goal that is at hand.
fn reward_config(parts: &GoalParts) -> RewardConfig {
    let mut config = RewardConfig::perceptual("goal").with_descriptor(parts.descriptor.kind());
    match parts.descriptor {
        DescriptorParams::Direct => {}
        DescriptorParams::Window(window) => config.window = Some(WindowConfig { method: window.method, mask: None }),
        DescriptorParams::Motion(motion) => config.motion = Some(motion),
    }
    RewardConfig { scale: parts.params.scale, hog: parts.params.hog, ..config }
}

fn task_error(error: &Error) -> PyErr {
    match error {
        Error::Core(error @ CoreError::TemplateTooLarge { .. }) => value_error("goal", error),
        other => PyValueError::new_err(other.to_string()),
    }
}

fn out_of_range(name: &str, got: usize, least: usize, most: usize) -> PyErr {
    PyValueError::new_err(format!("{name}: got {got}, expected {least} to {most}"))
}

/// Only environments come here, so Gymnasium is there.
fn gymnasium_error(py: Python<'_>, class: &str, message: String) -> PyErr {
    let error = py.import("gymnasium.error").and_then(|module| module.getattr(class)?.call1((message,)));
    error.map_or_else(|error| error, PyErr::from_value)
}

fn input<'py, T: Element>(
    name: &str,
    array: &Bound<'py, PyArray1<T>>,
    len: usize,
) -> PyResult<PyReadonlyArray1<'py, T>> {
    check(name, array, &[len])?;
    Ok(array.try_readonly()?)
}

fn output<'py, T: Element, D: Dimension>(
    name: &str,
    array: &Bound<'py, PyArray<T, D>>,
    shape: &[usize],
) -> PyResult<PyReadwriteArray<'py, T, D>> {
    check(name, array, shape)?;
    Ok(array.try_readwrite()?)
}

fn check<T: Element, D: Dimension>(name: &str, array: &Bound<'_, PyArray<T, D>>, shape: &[usize]) -> PyResult<()> {
    if array.shape() == shape {
        return Ok(());
    }
    Err(PyValueError::new_err(format!("{name}: got shape {:?}, expected {shape:?}", array.shape())))
}
