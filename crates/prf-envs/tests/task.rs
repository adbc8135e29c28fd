//! A world with its reward and state representation.

use prf_core::{
    DescriptorKind, DirectDescriptor, EmaState, Frame, Goal, MotionDescriptor, MotionParams, MotionTemplate,
    TaskDescriptor,
};
use prf_envs::{EnvConfig, Error, RewardConfig, RewardForm, StateConfig, StateKind, Status, Task, TaskConfig};
use proptest::prelude::*;

fn config(reward: RewardConfig, kind: StateKind) -> TaskConfig {
    TaskConfig { env: EnvConfig::new("breakout"), reward, state: StateConfig { kind, ..StateConfig::default() } }
}

fn perceptual(kind: StateKind) -> Task {
    let config = config(RewardConfig::perceptual("black.png"), kind);
    Task::new(&config, Some(&black().into())).expect("the config is valid")
}

fn variable(kind: StateKind) -> Task {
    Task::new(&config(RewardConfig::variable(), kind), None).expect("the config is valid")
}

fn black() -> Frame {
    Frame::new(84, 84)
}

fn oracle(task: &Task) -> usize {
    task.environment().oracle_action()
}

#[test]
fn the_perceptual_reward_is_that_of_the_frame_after_the_action() -> Result<(), Error> {
    let mut task = perceptual(StateKind::Ema);
    let params = RewardConfig::perceptual("black.png").params();
    let mut descriptor = DirectDescriptor::new(&black(), params)?;
    let mut frame = black();
    task.reset(4);
    for _ in 0..100 {
        let step = task.step(oracle(&task))?;
        task.environment().draw_into(&mut frame);
        assert_eq!(step.reward, descriptor.observe(frame.view())?.reward);
        assert_eq!(task.mirror(), &frame);
    }
    Ok(())
}

/// Breakout by its black picture, rewarded by potential with γ = 0.9 and by the state, with the same descriptor.
fn potential_and_state(kind: DescriptorKind) -> Result<(Task, Task), Error> {
    let mut config = config(RewardConfig::perceptual("black.png").with_descriptor(kind), StateKind::Mirror);
    let striped = || Frame::from_vec(84, 84, (0..84 * 84).map(|at| at as u8).collect());
    let goal = if kind == DescriptorKind::Direct { black() } else { striped()? };
    let state = Task::new(&config, Some(&goal.clone().into()))?;
    config.reward.form = RewardForm::Potential;
    config.reward.gamma = Some(0.9);
    Ok((Task::new(&config, Some(&goal.into()))?, state))
}

#[test]
fn rewards_by_potential_come_to_how_an_episode_begins_and_ends() -> Result<(), Error> {
    for kind in [DescriptorKind::Direct, DescriptorKind::Motion] {
        let (mut potential, mut state) = potential_and_state(kind)?;
        for seed in [4, 5] {
            potential.reset(seed);
            state.reset(seed);
            let mut last = None::<f32>;
            let (mut sum, mut discount, mut first) = (0.0, 1.0, 0.0);
            // An idle player loses the ball: the episode terminates, and F of its last frame counts.
            let status = loop {
                let (step, f) = (potential.step(0)?, state.step(0)?.reward);
                match last {
                    Some(last) => assert_eq!(step.reward, 0.9 * f - last),
                    None => first = 0.9 * f - step.reward,
                }
                sum += discount * f64::from(step.reward);
                discount *= f64::from(0.9f32);
                last = Some(f);
                if step.status.is_over() {
                    break step.status;
                }
            };
            assert_eq!(status, Status::Terminated);
            if kind == DescriptorKind::Direct {
                let mut world = prf_envs::registry::make(&EnvConfig::new("breakout"))?;
                let mut frame = black();
                world.reset(seed);
                world.draw_into(&mut frame);
                let mut descriptor = DirectDescriptor::new(&black(), RewardConfig::perceptual("").params())?;
                assert!((first - descriptor.observe(frame.view())?.reward).abs() < 1e-6);
            }
            let (first, last) = (f64::from(first), f64::from(last.expect("at least one step")));
            assert!(first > 0.0 && first < 1.0, "F of the first frame: {first}");
            assert!((sum - (discount * last - first)).abs() < 1e-5, "{sum}, {discount} · {last} − {first}");
        }
    }
    Ok(())
}

#[test]
fn a_task_rewarded_by_potential_goes_on_where_it_was_saved() -> Result<(), Error> {
    let (mut whole, mut state) = potential_and_state(DescriptorKind::Motion)?;
    let (mut resumed, _) = potential_and_state(DescriptorKind::Motion)?;
    whole.reset(4);
    state.reset(4);
    for _ in 0..8 {
        whole.step(oracle(&whole))?;
        state.step(oracle(&state))?;
        resumed.load_state(&whole.save_state())?;
        let mut ahead = potential_and_state(DescriptorKind::Motion)?.0;
        ahead.load_state(&whole.save_state())?;
        assert_eq!(ahead.step(0)?, resumed.step(0)?);
    }
    // A state of the other form does not fit, and changes nothing.
    let before = whole.save_state();
    assert!(matches!(whole.load_state(&state.save_state()), Err(Error::BadState { .. })));
    assert_eq!(whole.save_state(), before);
    Ok(())
}

#[test]
fn the_variable_reward_counts_bricks() -> Result<(), Error> {
    let mut task = variable(StateKind::Mirror);
    task.reset(4);
    let mut total = 0.0;
    loop {
        let step = task.step(oracle(&task))?;
        total += step.reward;
        assert_eq!(step.score, total);
        if step.status.is_over() {
            assert_eq!(step.status, Status::Truncated);
            assert!(total >= 2.0);
            return Ok(());
        }
    }
}

#[test]
fn the_average_begins_anew_with_each_episode() -> Result<(), Error> {
    let mut task = variable(StateKind::Ema);
    assert_eq!(task.observation(), black().as_slice());
    for seed in [1, 2] {
        let mut ema = EmaState::new(84, 84, 0.7)?;
        task.reset(seed);
        assert_eq!(task.observation(), ema.update(task.mirror().view()));
        assert_eq!(task.observation(), task.mirror().as_slice());
        for _ in 0..20 {
            task.step(oracle(&task))?;
            assert_eq!(task.observation(), ema.update(task.mirror().view()));
        }
        assert_ne!(task.observation(), task.mirror().as_slice());
    }
    Ok(())
}

#[test]
fn the_mirror_state_is_the_frame() -> Result<(), Error> {
    let mut task = variable(StateKind::Mirror);
    assert_eq!(task.observation(), black().as_slice());
    task.reset(1);
    task.step(0)?;
    assert_eq!(task.observation(), task.mirror().as_slice());
    assert_ne!(task.observation(), black().as_slice());
    Ok(())
}

/// A face that learns from motion, whose goal is what the oracle's whole episode moves.
fn face() -> Task {
    let mut world = prf_envs::registry::make(&EnvConfig::new("kobian-happy")).expect("it exists");
    let mut template = MotionTemplate::new(resting()).expect("valid");
    let mut frame = black();
    world.reset(0);
    for _ in 0..9 {
        world.draw_into(&mut frame);
        template.observe(frame.view()).expect("one size");
        world.step(world.oracle_action()).expect("the action exists");
    }
    template.history_into(&mut frame);
    let mut reward = RewardConfig::perceptual("goal.gif").with_descriptor(DescriptorKind::Motion);
    reward.motion = Some(resting());
    let state = StateConfig { kind: StateKind::Motion, ..StateConfig::default() };
    let config = TaskConfig { env: EnvConfig::new("kobian-happy"), reward, state };
    Task::new(&config, Some(&frame.into())).expect("the config is valid")
}

fn resting() -> MotionParams {
    MotionParams { skip_still: true, ..MotionParams::default() }
}

/// The paper's `T_A`: of all frames of the episode, the first one included.
#[test]
fn the_motion_state_is_the_template_that_is_rewarded() -> Result<(), Error> {
    let mut task = face();
    assert_eq!(task.observation(), black().as_slice());
    for _ in 0..2 {
        task.reset(0);
        let mut template = MotionTemplate::new(resting())?;
        let mut picture = Frame::new(1, 1);
        template.observe(task.mirror().view())?;
        assert_eq!(task.observation(), black().as_slice());
        let mut rewards = Vec::new();
        for count in 0..10 {
            rewards.push(task.step(oracle(&task))?.reward);
            template.observe(task.mirror().view())?;
            template.history_into(&mut picture);
            assert_eq!(task.observation(), picture.as_slice(), "step {count}");
            let goal = MotionDescriptor::new(&picture, resting(), RewardConfig::perceptual("").params());
            assert!(goal.is_ok(), "the first step moves something already");
        }
        assert_eq!(rewards[7..], [1.0; 3], "made in 8 steps, and resting changes nothing: {rewards:?}");
        assert!(rewards[..7].iter().all(|&reward| reward < 1.0));
    }
    Ok(())
}

#[test]
fn a_motion_state_goes_on_where_it_was_saved() -> Result<(), Error> {
    let (mut whole, mut resumed) = (face(), face());
    whole.reset(0);
    for cut in 0..10 {
        resumed.load_state(&whole.save_state())?;
        assert_eq!(whole.observation(), resumed.observation());
        let action = if cut == 4 { 0 } else { oracle(&whole) };
        assert_eq!(whole.step(action)?, resumed.step(action)?);
        assert_eq!(whole.save_state(), resumed.save_state());
    }
    let state = whole.save_state();
    for len in (0..state.len()).step_by(97) {
        assert!(matches!(resumed.load_state(&state[..len]), Err(Error::BadState { .. })), "{len} bytes");
    }
    // Whatever a byte becomes, a state that is taken can be played on.
    whole.reset(0);
    for _ in 0..5 {
        whole.step(oracle(&whole))?;
    }
    let state = whole.save_state();
    for at in 0..state.len().min(400) {
        for byte in [0, 0x7f, 0xff] {
            let mut damaged = state.clone();
            damaged[at] = byte;
            if resumed.load_state(&damaged).is_ok() {
                resumed.step(1)?;
            }
        }
    }
    resumed.load_state(&state)?;
    assert_eq!(resumed.save_state(), state);
    Ok(())
}

#[test]
fn a_refused_step_changes_nothing() -> Result<(), Error> {
    let mut task = perceptual(StateKind::Ema);
    assert!(matches!(task.step(0), Err(Error::NotReset { .. })));
    task.reset(1);
    let before = (task.save_state(), task.observation().to_vec());
    assert!(matches!(task.step(3), Err(Error::UnknownAction { got: 3, last: 2, .. })));
    assert_eq!((task.save_state(), task.observation().to_vec()), before);
    Ok(())
}

#[test]
fn goals_must_fit_the_source() {
    let complaint = |reward, goal: Option<&Goal>| {
        let error = Task::new(&config(reward, StateKind::Ema), goal).map(|_| ()).expect_err("the goal doesn't fit");
        error.to_string()
    };
    assert_eq!(
        complaint(RewardConfig::perceptual("black.png"), None),
        "reward.goal: got no picture, expected one for a perceptual reward"
    );
    assert_eq!(
        complaint(RewardConfig::variable(), Some(&black().into())),
        "reward.goal: got a picture, expected none for a variable reward"
    );
    let window = RewardConfig::perceptual("goal.png").with_descriptor(DescriptorKind::Window);
    let larger = Frame::from_vec(85, 40, vec![9; 85 * 40]).expect("85 x 40");
    let error = complaint(window, Some(&larger.into()));
    assert!(error.contains("85x40") && error.contains("84x84"), "{error}");
}

#[test]
fn every_descriptor_rewards_and_resumes() -> Result<(), Error> {
    // The goal: the first frame's paddle, or how it moves.
    let mut world = variable(StateKind::Mirror);
    world.reset(3);
    let goal = Goal::from(world.mirror().clone());
    for kind in [DescriptorKind::Direct, DescriptorKind::Window, DescriptorKind::Motion] {
        let config = config(RewardConfig::perceptual("goal.png").with_descriptor(kind), StateKind::Ema);
        let (mut whole, mut resumed) = (Task::new(&config, Some(&goal))?, Task::new(&config, Some(&goal))?);
        whole.reset(3);
        let play = |task: &mut Task, steps: usize| {
            (0..steps).map(|_| task.step(oracle(task)).map(|step| step.reward)).collect::<Result<Vec<_>, _>>()
        };
        let rewards = play(&mut whole, 12)?;
        assert!(rewards.iter().all(|&reward| reward > 0.0 && reward <= 1.0), "{kind:?}: {rewards:?}");
        resumed.load_state(&whole.save_state())?;
        assert_eq!(play(&mut whole, 12)?, play(&mut resumed, 12)?, "{kind:?}");
        let mut other = variable(StateKind::Ema);
        other.reset(3);
        if kind == DescriptorKind::Motion {
            assert!(matches!(other.load_state(&whole.save_state()), Err(Error::BadState { .. })));
        }
    }
    Ok(())
}

#[test]
fn states_of_other_tasks_are_refused() -> Result<(), Error> {
    let (mut ema, mut mirror) = (variable(StateKind::Ema), variable(StateKind::Mirror));
    ema.reset(1);
    mirror.reset(2);
    let before = (mirror.save_state(), ema.save_state());
    assert!(matches!(mirror.load_state(&before.1), Err(Error::BadState { .. })));
    let shortened = &before.1[..before.1.len() - 4];
    assert!(matches!(ema.load_state(shortened), Err(Error::BadState { .. })));
    let mut nan = before.1.clone();
    let at = nan.len() - 4;
    nan[at..].copy_from_slice(&f32::NAN.to_le_bytes());
    assert!(matches!(ema.load_state(&nan), Err(Error::BadState { .. })));
    assert_eq!((mirror.save_state(), ema.save_state()), before);
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(48) })]

    #[test]
    fn a_restored_task_goes_on_bit_by_bit(seed: u64, cut in 0..99usize, mirror: bool, actions in prop::collection::vec(0..4usize, 100)) {
        let kind = if mirror { StateKind::Mirror } else { StateKind::Ema };
        let (mut task, mut restored) = (perceptual(kind), perceptual(kind));
        task.reset(seed);
        restored.reset(seed.wrapping_add(1));
        for (count, action) in actions.into_iter().enumerate() {
            if count == cut {
                restored.load_state(&task.save_state())?;
            }
            let action = if action == 3 { oracle(&task) } else { action };
            let step = task.step(action)?;
            if count >= cut {
                prop_assert_eq!(step, restored.step(action)?);
                prop_assert_eq!(task.observation(), restored.observation());
                prop_assert_eq!(task.save_state(), restored.save_state());
            }
            if step.status.is_over() {
                break;
            }
        }
    }

    #[test]
    fn damaged_states_never_panic(seed: u64, mirror: bool, at in 0..28_400usize, byte: u8, keep in 0..28_400usize) {
        let mut task = variable(if mirror { StateKind::Mirror } else { StateKind::Ema });
        task.reset(seed);
        let mut bytes = task.save_state();
        let at = at.min(bytes.len() - 1) % 200;
        bytes[at.min(60)] = byte;
        bytes.truncate(keep.max(1000));
        if task.load_state(&bytes).is_ok() && task.step(oracle(&task)).is_ok() {
            prop_assert_eq!(task.observation().len(), 84 * 84);
        }
    }
}
