//! Tasks side by side do what each would do alone.

use prf_core::{Frame, Goal, MotionParams, MotionTemplate};
use prf_envs::{
    Command, EnvConfig, Error, Results, RewardConfig, StateConfig, StateKind, Status, Task, TaskConfig, VectorTask,
};

const COUNT: usize = 11;
const PIXELS: usize = 84 * 84;

/// What a call writes to.
struct Buffers {
    observations: Vec<u8>,
    rewards: [f64; COUNT],
    scores: [f64; COUNT],
    terminated: [bool; COUNT],
    truncated: [bool; COUNT],
}

impl Buffers {
    /// Full of what no task writes.
    fn new() -> Buffers {
        Buffers {
            observations: vec![7; COUNT * PIXELS],
            rewards: [-9.0; COUNT],
            scores: [-9.0; COUNT],
            terminated: [true; COUNT],
            truncated: [true; COUNT],
        }
    }

    fn results(&mut self) -> Results<'_> {
        Results {
            observations: &mut self.observations,
            rewards: &mut self.rewards,
            scores: &mut self.scores,
            terminated: &mut self.terminated,
            truncated: &mut self.truncated,
        }
    }

    fn observation(&self, index: usize) -> &[u8] {
        &self.observations[index * PIXELS..][..PIXELS]
    }

    fn row(&self, index: usize) -> (f64, f64, bool, bool) {
        (self.rewards[index], self.scores[index], self.terminated[index], self.truncated[index])
    }
}

fn run(tasks: &mut VectorTask, commands: &[Command]) -> Result<Buffers, Error> {
    let mut buffers = Buffers::new();
    tasks.run(commands, &mut buffers.results())?;
    Ok(buffers)
}

fn breakout(limit_steps: u32) -> (TaskConfig, Option<Goal>) {
    let env = EnvConfig { limit_steps, ..EnvConfig::new("breakout") };
    let config = TaskConfig { env, reward: RewardConfig::variable(), state: StateConfig::default() };
    (config, None)
}

/// A task that remembers movement in its reward and in what the agent sees.
fn face() -> (TaskConfig, Option<Goal>) {
    let mut motion = MotionTemplate::new(MotionParams::default()).expect("valid");
    let mut world = prf_envs::registry::make(&EnvConfig::new("kobian-happy")).expect("the registry has it");
    let mut frame = Frame::new(84, 84);
    world.reset(0);
    for _ in 0..8 {
        world.draw_into(&mut frame);
        motion.observe(frame.view()).expect("one size");
        world.step(world.oracle_action()).expect("the oracle's actions exist");
    }
    motion.history_into(&mut frame);
    let reward = RewardConfig::perceptual("happy").with_descriptor(prf_core::DescriptorKind::Motion);
    let state = StateConfig { kind: StateKind::Motion, ..StateConfig::default() };
    (TaskConfig { env: EnvConfig::new("kobian-happy"), reward, state }, Some(frame.into()))
}

fn action(index: usize, step: usize, count: usize) -> usize {
    (index * 5 + step * 3 + step * step) % count
}

fn seeds(first: u64) -> [Command; COUNT] {
    std::array::from_fn(|index| Command::Reset(first + index as u64))
}

#[test]
fn each_does_what_it_would_do_alone_with_any_number_of_threads() -> Result<(), Error> {
    for (config, goal) in [breakout(30), face()] {
        for threads in [1, 2, 3, 50] {
            let mut tasks = VectorTask::new(&config, goal.as_ref(), COUNT)?.with_threads(threads);
            let mut alone = (0..COUNT).map(|_| Task::new(&config, goal.as_ref())).collect::<Result<Vec<_>, _>>()?;
            let mut commands = seeds(5);
            let mut ends = 0;
            for step in 0..70 {
                let got = run(&mut tasks, &commands)?;
                for (index, (task, command)) in alone.iter_mut().zip(&mut commands).enumerate() {
                    let next = Command::Step(action(index, step, task.spec().actions.len()));
                    match *command {
                        Command::Step(action) => {
                            let step = task.step(action)?;
                            let (reward, score) = (f64::from(step.reward), f64::from(step.score));
                            let (terminated, truncated) = (got.terminated[index], got.truncated[index]);
                            assert_eq!((got.rewards[index], got.scores[index]), (reward, score));
                            assert_eq!(terminated, step.status == Status::Terminated);
                            assert_eq!(terminated || truncated, step.status.is_over());
                            ends += usize::from(step.status.is_over());
                            *command = if step.status.is_over() { Command::Reset(step.score as u64) } else { next };
                        }
                        Command::Reset(seed) => {
                            task.reset(seed);
                            assert_eq!(got.row(index), (0.0, 0.0, false, false));
                            *command = next;
                        }
                        Command::Keep => unreachable!("nothing is kept here"),
                    }
                    assert_eq!(got.observation(index), task.observation(), "task {index}, step {step}");
                }
            }
            assert!(ends > COUNT, "{ends} episodes came to their end");
        }
    }
    Ok(())
}

#[test]
fn what_is_kept_shows_what_it_showed() -> Result<(), Error> {
    let (config, goal) = face();
    let mut tasks = VectorTask::new(&config, goal.as_ref(), COUNT)?;
    run(&mut tasks, &seeds(0))?;
    let before = run(&mut tasks, &[Command::Step(7); COUNT])?;
    let mut commands = [Command::Keep; COUNT];
    commands[4] = Command::Reset(0);
    let after = run(&mut tasks, &commands)?;
    for index in 0..COUNT {
        assert_eq!(after.row(index), (0.0, 0.0, false, false));
        assert_eq!(after.observation(index) == before.observation(index), index != 4);
    }
    assert_eq!(run(&mut tasks, &[Command::Step(9); COUNT])?.scores[4], -7.0);
    Ok(())
}

#[test]
fn an_end_on_the_last_allowed_step_is_both() -> Result<(), Error> {
    // The ball that nobody is there for is lost after some steps.
    let lost = |limit| -> Result<(usize, Buffers), Error> {
        let (config, _) = breakout(limit);
        let mut tasks = VectorTask::new(&config, None, COUNT)?;
        run(&mut tasks, &[Command::Reset(3); COUNT])?;
        for step in 1.. {
            let got = run(&mut tasks, &[Command::Step(1); COUNT])?;
            if got.terminated[0] || got.truncated[0] {
                return Ok((step, got));
            }
        }
        unreachable!("the limit comes")
    };
    let (steps, got) = lost(1000)?;
    assert_eq!((got.terminated[0], got.truncated[0]), (true, false));
    let (last, got) = lost(steps as u32)?;
    assert_eq!((last, got.terminated[0], got.truncated[0]), (steps, true, true));
    let (last, got) = lost(steps as u32 - 1)?;
    assert_eq!((last, got.terminated[0], got.truncated[0]), (steps - 1, false, true));
    Ok(())
}

#[test]
fn what_can_not_be_done_changes_nothing() -> Result<(), Error> {
    let (config, _) = breakout(3);
    let mut tasks = VectorTask::new(&config, None, COUNT)?;
    let refused = |tasks: &mut VectorTask, commands: [Command; COUNT]| {
        let before = tasks.save_state();
        let error = run(tasks, &commands).map(drop).expect_err("it can't be done");
        assert_eq!(tasks.save_state(), before);
        error
    };
    let mut commands = seeds(0);
    commands[COUNT - 1] = Command::Step(0);
    assert!(matches!(refused(&mut tasks, commands), Error::NotReset { .. }));
    run(&mut tasks, &seeds(0))?;
    let mut commands = [Command::Step(0); COUNT];
    commands[6] = Command::Step(3);
    assert!(matches!(refused(&mut tasks, commands), Error::UnknownAction { got: 3, last: 2, .. }));
    for _ in 0..3 {
        run(&mut tasks, &[Command::Step(0); COUNT])?;
    }
    let mut commands = seeds(9);
    commands[10] = Command::Step(0);
    assert!(matches!(refused(&mut tasks, commands), Error::EpisodeOver { .. }));
    Ok(())
}

#[test]
fn saved_tasks_go_on_and_damaged_states_change_nothing() -> Result<(), Error> {
    for (config, goal) in [breakout(6), face()] {
        let mut tasks = VectorTask::new(&config, goal.as_ref(), COUNT)?;
        let mut commands = seeds(1);
        commands[2] = Command::Keep;
        run(&mut tasks, &commands)?;
        let steps: [Command; COUNT] =
            std::array::from_fn(|index| if index == 2 { Command::Keep } else { Command::Step(index % 3) });
        for _ in 0..4 {
            run(&mut tasks, &steps)?;
        }
        let state = tasks.save_state();
        let mut restored = VectorTask::new(&config, goal.as_ref(), COUNT)?;
        restored.load_state(&state)?;
        assert_eq!(restored.save_state(), state);
        for _ in 0..2 {
            let (went_on, resumed) = (run(&mut tasks, &steps)?, run(&mut restored, &steps)?);
            assert_eq!(went_on.observations, resumed.observations);
            for index in 0..COUNT {
                assert_eq!(went_on.row(index), resumed.row(index));
            }
        }
        let mut commands = [Command::Keep; COUNT];
        commands[2] = Command::Step(0);
        assert!(matches!(run(&mut restored, &commands), Err(Error::NotReset { .. })));
        commands[2] = Command::Keep;
        commands[0] = Command::Step(0);
        assert_eq!(run(&mut restored, &commands).is_ok(), goal.is_some(), "only a face has steps left");

        let before = restored.save_state();
        let longer = [state.as_slice(), &[0]].concat();
        for bytes in (0..state.len()).step_by(101).map(|len| &state[..len]).chain([&longer[..]]) {
            assert!(matches!(restored.load_state(bytes), Err(Error::BadState { .. })), "{} bytes", bytes.len());
            assert_eq!(restored.save_state(), before);
        }
    }
    Ok(())
}

#[test]
fn drawings_of_any_size_are_the_world_s() -> Result<(), Error> {
    for (config, goal) in [breakout(50), face()] {
        let mut tasks = VectorTask::new(&config, goal.as_ref(), COUNT)?;
        let mut alone = Task::new(&config, goal.as_ref())?;
        run(&mut tasks, &seeds(4))?;
        alone.reset(4 + 8);
        for size in [(84, 84), (200, 168), (84, 84), (1, 3)] {
            let (mut got, mut expected) = (Frame::new(size.0, size.1), Frame::new(size.0, size.1));
            let step = Command::Step(1);
            run(&mut tasks, &[step; COUNT])?;
            alone.step(1)?;
            tasks.draw_into(3, &mut got);
            tasks.draw_into(8, &mut got);
            alone.environment().draw_into(&mut expected);
            assert_eq!(got, expected);
        }
    }
    Ok(())
}
