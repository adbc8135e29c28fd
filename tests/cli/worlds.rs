//! `prf worlds`, run as a user runs it.

use predicates::prelude::*;
use predicates::str::{contains, is_empty};
use prf_envs::{EnvConfig, registry};
use serde_json::Value;

mod common;

use common::prf;

fn records() -> Vec<Value> {
    let output = prf(".".as_ref()).args(["worlds", "--format", "json"]).assert().success().stderr(is_empty());
    let text = String::from_utf8(output.get_output().stdout.clone()).expect("it is text");
    text.lines().map(|line| serde_json::from_str(line).expect("each line is an object")).collect()
}

#[test]
fn every_world_is_a_line_of_json() {
    let records = records();
    let names: Vec<_> = records.iter().map(|record| record["name"].as_str().expect("it is a name")).collect();
    assert_eq!(names, registry::names().collect::<Vec<_>>());
    for record in &records {
        let name = record["name"].as_str().expect("it is a name");
        let spec = *registry::make(&EnvConfig::new(name)).expect("it is registered").spec();
        assert_eq!(record["actions"], serde_json::json!(spec.actions));
        assert_eq!([&record["width"], &record["height"]], [&Value::from(spec.width), &Value::from(spec.height)]);
        assert_eq!(record["limit_steps"], spec.limit_steps);
        assert_eq!(record["summary"].as_str(), registry::summary(name));
        let [oracle, random] =
            ["oracle_score", "random_score"].map(|key| record[key].as_f64().expect("it is a number"));
        assert!(oracle > random, "{name}: {oracle} {random}");
    }
}

#[test]
fn scores_are_those_of_the_worlds_page() {
    let breakout = &records()[0];
    let score = |key: &str| breakout[key].as_f64().expect("it is a number");
    // The page has 1,000 episodes, `prf worlds` the first 100 of them.
    assert!((score("oracle_score") - 3.43).abs() < 0.1 && (score("random_score") - 0.37).abs() < 0.1);
    assert_eq!(breakout["page"], "docs/worlds/breakout.md");
}

#[test]
fn people_read_the_same() {
    prf(".".as_ref()).arg("worlds").assert().success().stderr(is_empty()).stdout(
        contains("breakout: a paddle")
            .and(contains("  actions  3: stay, left, right\n"))
            .and(contains("  frame    84x84 px\n  limit    100 steps\n"))
            .and(contains("\n\nflappy: a bird"))
            .and(contains("  page     docs/worlds/flappy.md\n")),
    );
}
