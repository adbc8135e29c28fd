//! Flappy Bird as its users meet it.

use prf_core::{Footage, Label};
use prf_envs::players::{Oracle, Random, mean_score, play_episode};
use prf_envs::survey::survey;
use prf_envs::{EnvConfig, Environment, Error, check, registry};

fn make(limit_steps: u32) -> Result<Box<dyn Environment>, Error> {
    registry::make(&EnvConfig { limit_steps, ..EnvConfig::new("flappy") })
}

#[test]
fn it_conforms() -> Result<(), Error> {
    check::conformance(&make)
}

#[test]
fn the_oracle_never_crashes() {
    let mut world = make(5_000).expect("flappy exists");
    for seed in 0..300 {
        let episode = play_episode(world.as_mut(), &mut Oracle, seed).expect("the oracle's actions exist");
        assert_eq!((episode.steps, episode.score), (5_000, 166.0), "seed {seed}");
    }
}

#[test]
fn ceiling_and_floor_are_far_apart() {
    let mut world = make(5_000).expect("flappy exists");
    let random = mean_score(world.as_mut(), &mut Random::new(), 0..1_000).expect("random actions exist");
    assert!(random <= 0.2, "random {random}");
}

#[test]
fn a_survey_shows_what_a_reward_has_to_tell_apart() {
    let mut footage = Footage::new(None, 1_000).expect("above 0");
    survey(&EnvConfig::new("flappy"), 1, 300, |label| label, &mut footage).expect("the world is there");
    let count = |holds: &dyn Fn(&Label) -> bool| footage.labels().iter().filter(|label| holds(label)).count();
    assert!(count(&|label| label.success == Some(true)) > 20);
    assert!(count(&|label| label.success == Some(false)) > 100);
    assert!(count(&|label| label.score.is_some_and(|score| score <= -10.5)) > 5, "crashes are shown");
    assert!(count(&|label| label.score.is_none()) > 50);
}

#[test]
fn its_defaults_are_those_of_the_paper() {
    assert_eq!(EnvConfig::new("flappy").limit_steps, 5_000);
    let unknown = registry::make(&EnvConfig::new("flapy")).map(|_| ()).expect_err("no such world");
    assert_eq!(
        unknown.to_string(),
        "env.name: got \"flapy\", expected \"breakout\" or \"flappy\" or \"kobian-happy\" or \"kobian-surprise\""
    );
}
