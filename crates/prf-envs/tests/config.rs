//! The tables of a task in a config file.

use prf_core::{CellSize, DeltaSchedule, DescriptorKind, DescriptorParams, DistanceScale, MatchMethod, Norm};
use prf_envs::{EnvConfig, RewardConfig, RewardForm, RewardSource, StateConfig, StateKind, TaskConfig};

const PERCEPTUAL: &str = r#"
    [env]
    name = "breakout"

    [reward]
    source = "perceptual"
    descriptor = "direct"
    goal = "goals/black.png"
"#;

const VARIABLE: &str = "env.name = \"breakout\"\nreward.source = \"variable\"\n";

fn parse(text: &str) -> TaskConfig {
    toml::from_str(text).expect("the text is a task")
}

fn parse_error(text: &str) -> String {
    toml::from_str::<TaskConfig>(text).expect_err("the text is wrong").to_string()
}

fn complaint(config: &TaskConfig) -> String {
    config.validate().expect_err("a value is wrong").to_string()
}

#[test]
fn what_a_file_leaves_out_has_defaults() {
    let config = parse(PERCEPTUAL);
    config.validate().expect("the config is valid");
    assert_eq!(config.env, EnvConfig { name: "breakout".to_owned(), limit_steps: 100, solved_within: None });
    assert_eq!(config.reward, RewardConfig::perceptual("goals/black.png"));
    assert_eq!(config.state, StateConfig { kind: StateKind::Ema, lambda: 0.7 });
    assert_eq!((config.reward.scale, config.reward.hog.norm), (DistanceScale::SqrtBlocks, Norm::L2));
    assert_eq!(parse(VARIABLE).reward, RewardConfig::variable());
}

#[test]
fn every_key_is_read() {
    let config = parse(
        r#"
        [env]
        name = "breakout"
        limit_steps = 5000
        [reward]
        source = "perceptual"
        descriptor = "direct"
        goal = "goal.png"
        scale = "none"
        [reward.hog]
        orientations = 6
        signed = true
        cell = { px = 8 }
        block_cells = 2
        norm = "l2-hys"
        [state]
        kind = "mirror"
        lambda = 0.5
        "#,
    );
    config.validate().expect("the config is valid");
    assert_eq!(config.env.limit_steps, 5000);
    assert_eq!(
        (config.reward.source, config.reward.descriptor),
        (RewardSource::Perceptual, Some(DescriptorKind::Direct))
    );
    assert_eq!(config.reward.scale, DistanceScale::None);
    let hog = config.reward.params().hog;
    assert_eq!(
        (hog.orientations, hog.signed, hog.cell, hog.block_cells, hog.norm),
        (6, true, CellSize::Px(8), 2, Norm::L2Hys)
    );
    assert_eq!(config.state, StateConfig { kind: StateKind::Mirror, lambda: 0.5 });
}

#[test]
fn each_descriptor_has_its_table_and_its_cells() {
    let text = |descriptor: &str, more: &str| {
        format!(
            "env.name = \"breakout\"\n[reward]\nsource = \"perceptual\"\ndescriptor = \"{descriptor}\"\ngoal = \"g.png\"\n{more}"
        )
    };
    let window = parse(&text("window", "window = { method = \"ccoeff-normed\", mask = \"mask.png\" }"));
    window.validate().expect("the config is valid");
    let Some(DescriptorParams::Window(params)) = window.reward.descriptor_params() else { panic!("{window:?}") };
    assert_eq!(params.method, MatchMethod::CcoeffNormed);
    assert_eq!(window.reward.hog.cell, CellSize::Fraction(0.1));

    let motion = parse(&text("motion", "motion = { tau_step = 0.3, delta = { divisor = 4 } }"));
    motion.validate().expect("the config is valid");
    let Some(DescriptorParams::Motion(params)) = motion.reward.descriptor_params() else { panic!("{motion:?}") };
    assert_eq!((params.tau_start, params.tau_step, params.delta), (0.1, 0.3, DeltaSchedule::Divisor(4.0)));
    assert_eq!(motion.reward.hog.cell, CellSize::Fraction(0.05));
    assert_eq!(parse(&text("motion", "hog.cell.px = 7")).reward.hog.cell, CellSize::Px(7));

    // Written out, nothing is left to be filled in.
    for config in [window, motion, parse(&text("window", "")), parse(&text("motion", ""))] {
        let written = toml::to_string(&config).expect("a config can be written");
        assert_eq!(parse(&written), config, "{written}");
        assert_eq!(written.contains("method"), written.contains("\"window\""), "{written}");
        assert_eq!(written.contains("tau_step"), written.contains("\"motion\""), "{written}");
    }
    for (descriptor, more, expected) in [
        ("direct", "window = {}", "reward.window: got a value, expected nothing, because reward.descriptor is not"),
        ("window", "motion.threshold = 3", "reward.motion: got a value, expected nothing"),
        ("motion", "motion.tau_step = 0", "reward.motion.tau_step: got 0, expected "),
        ("direct", "form = \"potential\"", "reward.form: got no discount, expected a learner's discount"),
    ] {
        let complaint = complaint(&parse(&text(descriptor, more)));
        assert!(complaint.starts_with(expected), "{complaint}");
    }
}

#[test]
fn a_written_config_is_complete_and_reads_back_the_same() {
    for text in [PERCEPTUAL, VARIABLE, &format!("{PERCEPTUAL}hog.cell.px = 3\n")] {
        let config = parse(text);
        let written = toml::to_string(&config).expect("a config can be written");
        assert_eq!(parse(&written), config, "{written}");
        for key in
            ["limit_steps = 100", "scale = \"sqrt-blocks\"", "orientations = 9", "kind = \"ema\"", "lambda = 0.7\n"]
        {
            assert!(written.contains(key), "{key} is missing from\n{written}");
        }
        assert_eq!(written.contains("goal"), config.reward.goal.is_some(), "{written}");
    }
}

#[test]
fn unknown_keys_and_words_are_refused() {
    for (text, word) in [
        ("env.name = \"breakout\"\nreward.sorce = \"variable\"", "sorce"),
        ("env.name = \"breakout\"\nenv.limit = 3\nreward.source = \"variable\"", "limit"),
        ("env.name = \"breakout\"\nreward.source = \"vrf\"", "vrf"),
        ("env.name = \"breakout\"\nreward.source = \"variable\"\nstate.kind = \"stack\"", "stack"),
        ("env.name = \"breakout\"\nreward.source = \"variable\"\nstate.decay = 1", "decay"),
        ("env.name = \"breakout\"\nreward.source = \"variable\"\nreward.hog.cells = 1", "cells"),
        ("env.name = \"breakout\"\nreward.source = \"variable\"\nextra = 1", "extra"),
        ("env.name = 3\nreward.source = \"variable\"", "expected a string"),
        ("env.limit_steps = 3\nreward.source = \"variable\"", "name"),
        ("env.name = \"breakout\"\nenv.limit_steps = -1\nreward.source = \"variable\"", "-1"),
    ] {
        let error = parse_error(text);
        assert!(error.contains(word), "{text}\n{error}");
    }
}

#[test]
fn values_out_of_range_are_named_by_their_full_key() {
    let check = |change: fn(&mut TaskConfig), expected: &str| {
        let mut config = parse(PERCEPTUAL);
        change(&mut config);
        assert_eq!(complaint(&config), expected);
    };
    check(
        |c| c.env = EnvConfig::new("pong"),
        "env.name: got \"pong\", expected \"breakout\" or \"flappy\" or \"kobian-happy\" or \"kobian-surprise\"",
    );
    check(|c| c.env.limit_steps = 0, "env.limit_steps: got 0, expected at least 1");
    check(
        |c| c.reward.descriptor = None,
        "reward.descriptor: got nothing, expected \"direct\", \"window\" or \"motion\"",
    );
    check(|c| c.reward.goal = None, "reward.goal: got nothing, expected the path of a picture of the finished task");
    check(
        |c| c.env.solved_within = Some(1),
        "env.solved_within: got 1, expected nothing, because \"breakout\" has no end by success: remove it",
    );
    check(
        |c| c.env = EnvConfig { solved_within: Some(8), ..EnvConfig::new("kobian-happy") },
        "env.solved_within: got 8, expected 0 to 7, fewer than are missing at the beginning",
    );
    check(
        |c| {
            c.reward.form = RewardForm::Potential;
            c.reward.gamma = Some(1.0);
        },
        "reward.form: got the discount 1, expected a learner's discount from 0 up to, but not including, 1, for \
         \"potential\"",
    );
    check(
        |c| c.reward = RewardConfig { form: RewardForm::Potential, gamma: Some(0.9), ..RewardConfig::variable() },
        "reward.form: got a value, expected nothing, because reward.source is \"variable\": remove it, or ask for \
         \"perceptual\"",
    );
    check(|c| c.reward.hog.orientations = 0, "reward.hog.orientations: got 0, expected 1 to 64");
    check(|c| c.state.lambda = 1.0, "state.lambda: got 1, expected 0 or more, and below 1");
    check(|c| c.state.lambda = f32::NAN, "state.lambda: got NaN, expected 0 or more, and below 1");
    check(
        |c| c.reward.source = RewardSource::Variable,
        "reward.descriptor: got a value, expected nothing, because reward.source is \"variable\": remove it, or ask \
         for \"perceptual\"",
    );
    check(
        |c| {
            c.reward.source = RewardSource::Variable;
            c.reward.descriptor = None;
        },
        "reward.goal: got a value, expected nothing, because reward.source is \"variable\": remove it, or ask for \
         \"perceptual\"",
    );
}
