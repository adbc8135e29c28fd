//! The faces as their users meet them.

use prf_core::{Footage, Frame};
use prf_envs::kobian::{Expression, Face, Kobian, VERTICES};
use prf_envs::players::{Oracle, Random, mean_score, play_episode};
use prf_envs::survey::survey;
use prf_envs::{EnvConfig, Environment, Error, Status, check, registry};

const EXPRESSIONS: [Expression; 2] = [Expression::Happy, Expression::Surprise];

fn started(expression: Expression) -> Kobian {
    let mut world = Kobian::new(expression, 10).expect("above 0");
    world.reset(0);
    world
}

#[test]
fn they_conform() -> Result<(), Error> {
    for expression in EXPRESSIONS {
        check::conformance(&|limit_steps| {
            registry::make(&EnvConfig { limit_steps, ..EnvConfig::new(expression.name()) })
        })?;
    }
    Ok(())
}

fn solved_within(expression: Expression, actions: u32, limit_steps: u32) -> Result<Box<dyn Environment>, Error> {
    registry::make(&EnvConfig { limit_steps, solved_within: Some(actions), ..EnvConfig::new(expression.name()) })
}

#[test]
fn they_conform_with_an_end_by_success() -> Result<(), Error> {
    for expression in EXPRESSIONS {
        check::conformance(&|limit_steps| solved_within(expression, 1, limit_steps))?;
    }
    Ok(())
}

#[test]
fn an_episode_ends_by_success_as_soon_as_the_face_is_near_enough() -> Result<(), Error> {
    for (actions, steps) in [(0, 8), (1, 7), (7, 1)] {
        for limit_steps in [steps, 40] {
            let mut world = solved_within(Expression::Happy, actions, limit_steps)?;
            let episode = play_episode(world.as_mut(), &mut Oracle, 0)?;
            assert_eq!((episode.steps, episode.score), (steps, -(actions as f32)));
            assert!(matches!(world.step(0), Err(Error::EpisodeOver { .. })));
            let mut again = solved_within(Expression::Happy, actions, limit_steps)?;
            again.load_state(&world.save_state())?;
            assert_eq!(again.save_state(), world.save_state());
        }
        // One step fewer, and the limit comes first.
        if steps > 1 {
            let mut world = solved_within(Expression::Happy, actions, steps - 1)?;
            assert!(play_episode(world.as_mut(), &mut Oracle, 0)?.score < -(actions as f32));
            assert!(matches!(
                solved_within(Expression::Happy, 7, steps)?.load_state(&world.save_state()),
                Err(Error::BadState { .. })
            ));
        }
    }
    Ok(())
}

#[test]
fn the_oracle_makes_the_face_with_steps_to_spare() {
    for expression in EXPRESSIONS {
        assert_eq!(Expression::of_world(expression.name()), Some(expression));
        assert!(Face::default().actions_to(expression.target()) <= 9);
        let mut world = registry::make(&EnvConfig::new(expression.name())).expect("it exists");
        let episode = play_episode(world.as_mut(), &mut Oracle, 0).expect("the oracle's actions exist");
        assert_eq!((episode.score, episode.steps), (0.0, 10), "{expression:?}");
        let random = mean_score(world.as_mut(), &mut Random::new(), 0..1_000).expect("random actions exist");
        assert!(random < -6.0, "{expression:?}: {random}");
    }
}

#[test]
fn the_variable_reward_is_1_at_the_target_and_0_at_the_neutral_face() -> Result<(), Error> {
    for expression in EXPRESSIONS {
        let mut world = started(expression);
        assert_eq!(world.step(0)?.reward, 0.0);
        let mut last = 0.0;
        for count in 1..10 {
            let step = world.step(world.oracle_action())?;
            assert!(step.reward > last || step.reward == 1.0, "{expression:?}: {} after {last}", step.reward);
            assert_eq!(step.status, if count == 9 { Status::Truncated } else { Status::Running });
            last = step.reward;
        }
        assert_eq!((last, world.face()), (1.0, Some(expression.target())));
    }
    Ok(())
}

/// What the paper says of both expressions.
#[test]
fn targets_have_their_characteristic_features() {
    let happy = Expression::Happy.target().displacement();
    assert!(happy.mouth_wider > 8.0 && happy.mouth_opener > 1.0 && happy.corners_up > 2.0, "{happy:?}");
    let surprise = Expression::Surprise.target().displacement();
    assert!(surprise.brows_up > 5.0 && surprise.mouth_opener > 8.0 && surprise.mouth_wider < 0.0, "{surprise:?}");
}

/// Each action but resting moves something, and the opposite one undoes it.
#[test]
fn actions_move_vertices_and_can_be_undone() -> Result<(), Error> {
    let neutral = Face::default().vertices();
    assert_eq!(neutral.len(), VERTICES);
    let mut sets = std::collections::HashSet::new();
    for action in (1..13).step_by(2) {
        let mut world = started(Expression::Happy);
        world.step(0)?;
        assert_eq!(world.face(), Some(Face::default()));
        world.step(action)?;
        let moved = world.face().expect("an episode").vertices();
        sets.insert((0..VERTICES).map(|vertex| moved[vertex] != neutral[vertex]).collect::<Vec<_>>());
        world.step(action + 1)?;
        assert_eq!(world.face(), Some(Face::default()), "action {action}");
    }
    assert!(sets.len() >= 5, "different actions move different vertices");
    let mut closed = started(Expression::Happy);
    closed.step(12)?;
    assert_eq!(closed.face(), Some(Face::default()), "a closed mouth can't be closed further");
    Ok(())
}

#[test]
fn pictures_are_mirror_images_of_themselves_at_any_scale() -> Result<(), Error> {
    for side in [84, 85, 168, 251] {
        let mut world = started(Expression::Surprise);
        let mut frame = Frame::new(side, side);
        for action in [1, 11, 3, 11, 8, 5] {
            world.step(action)?;
            world.draw_into(&mut frame);
            for y in 0..side {
                let row = frame.view().row(y);
                let off = row.iter().zip(row.iter().rev()).map(|(a, b)| a.abs_diff(*b)).max();
                assert!(off <= Some(1), "row {y} of {side}: {off:?}");
            }
        }
    }
    Ok(())
}

/// What was drawn before leaves no trace: pictures that are kept are those of a new world.
#[test]
fn a_picture_depends_on_the_face_and_the_size_alone() -> Result<(), Error> {
    let mut world = started(Expression::Happy);
    for (count, side) in [84, 120, 84, 84, 400, 84].into_iter().enumerate() {
        world.step(2 * count + 1)?;
        let (mut kept, mut new) = (Frame::new(side, side), Frame::new(side, side));
        world.draw_into(&mut kept);
        let mut other = started(Expression::Happy);
        other.load_state(&world.save_state())?;
        other.draw_into(&mut new);
        assert!(kept == new, "{side} px after {count} steps");
    }
    Ok(())
}

#[test]
fn a_survey_shows_faces_on_their_way_and_arrived() {
    let mut footage = Footage::new(None, 2_000).expect("above 0");
    survey(&EnvConfig::new("kobian-happy"), 1, 600, |label| label, &mut footage).expect("the world is there");
    let arrived = footage.labels().iter().filter(|label| label.score == Some(0.0)).count();
    assert!((4..100).contains(&arrived), "{arrived} of {}", footage.frames().len());
    let far = footage.labels().iter().filter(|label| label.score < Some(-2.0)).count();
    assert!(far > 100, "{far}");
}

/// Of few frames too, one of each episode of the oracle is the finished face, at which it rests.
#[test]
fn a_short_survey_shows_the_finished_face() {
    for (face, frames) in [("kobian-happy", 24), ("kobian-surprise", 9)] {
        let mut footage = Footage::new(None, 2_000).expect("above 0");
        survey(&EnvConfig::new(face), 1, frames, |label| label, &mut footage).expect("the world is there");
        let arrived = footage.labels().iter().filter(|label| label.score == Some(0.0)).count();
        assert!(arrived >= 4, "{face}: {arrived} of {}", footage.frames().len());
    }
}

#[test]
fn states_of_another_expression_are_refused() {
    let happy = started(Expression::Happy).save_state();
    let error = started(Expression::Surprise).load_state(&happy).expect_err("another target").to_string();
    assert!(error.contains("kobian-surprise"), "{error}");
}
