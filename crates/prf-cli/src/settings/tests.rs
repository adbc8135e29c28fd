#![expect(clippy::unwrap_used)]

use std::path::{Path, PathBuf};

use serde::Deserialize;

use super::source::Source;
use crate::error::render;

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Config {
    #[serde(default)]
    seed: u64,
    train: Train,
    #[serde(default)]
    kind: Kind,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Train {
    steps: u32,
    gamma: f32,
    #[serde(default)]
    double: bool,
    #[serde(default)]
    epsilon: Epsilon,
    goal: Option<PathBuf>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
struct Epsilon {
    start: f32,
}

#[derive(Debug, Default, PartialEq, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum Kind {
    #[default]
    Ema,
    Mirror,
    Window(u32),
}

const GOOD: &str = "seed = 1\n\n[train]\nsteps = 10\ngamma = 0.5\n";

fn source(text: &str, sets: &[&str]) -> Source {
    let sets: Vec<String> = sets.iter().map(ToString::to_string).collect();
    Source::new("a/b.toml".into(), text.to_owned(), &sets).unwrap()
}

fn read(text: &str, sets: &[&str]) -> Config {
    source(text, sets).deserialize().unwrap()
}

/// What the user is told about a config that does not fit.
fn complaint(text: &str, sets: &[&str]) -> String {
    let error = source(text, sets).deserialize::<Config>().unwrap_err();
    render(&error.into())
}

#[test]
fn set_changes_keys_of_every_type() {
    let sets = [
        "seed = 7",
        "train.steps=20",
        "train.gamma=0.25",
        "train.double=true",
        "train.epsilon.start=0.5",
        "kind=mirror",
        "train.goal=my goal.png",
    ];
    let config = read(GOOD, &sets);
    assert_eq!((config.seed, config.train.steps, config.train.gamma), (7, 20, 0.25));
    assert!(config.train.double);
    assert_eq!(config.train.epsilon.start, 0.5);
    assert_eq!(config.kind, Kind::Mirror);
    assert_eq!(config.train.goal.as_deref(), Some(Path::new("my goal.png")));
}

#[test]
fn the_last_set_wins() {
    assert_eq!(read(GOOD, &["seed=7", "seed=8"]).seed, 8);
}

#[test]
fn a_set_inline_table_replaces_the_table() {
    let config = read(GOOD, &["train={ steps = 3, gamma = 0.0 }"]);
    assert_eq!(config.train.steps, 3);
}

#[test]
fn unknown_keys_are_named_with_their_neighbours() {
    assert_eq!(
        complaint("[train]\nsteps = 1\n  gama = 0.5\n", &[]),
        "error: a/b.toml:3:3: unknown key `train.gama`\n  \
         hint: did you mean `gamma`? known keys here: steps, gamma, double, epsilon, goal\n"
    );
}

#[test]
fn unknown_tables_are_pointed_at() {
    let told = complaint("[trian]\nsteps = 1\n", &[]);
    assert!(told.starts_with("error: a/b.toml:1:2: unknown key `trian`"), "{told}");
    assert!(told.contains("did you mean `train`?"), "{told}");
}

#[test]
fn wrong_types_say_got_and_expected() {
    assert_eq!(
        complaint("[train]\nsteps = \"12\"\ngamma = 0.5\n", &[]),
        "error: a/b.toml:2:9: `train.steps`: got string \"12\", expected a whole number, 0 or more\n  \
         hint: write numbers without quotes\n"
    );
    assert_eq!(
        complaint("[train]\nsteps = -1\ngamma = 0.5\n", &[]),
        "error: a/b.toml:2:9: `train.steps`: got integer -1, expected a whole number, 0 or more\n"
    );
    assert_eq!(complaint("train = 3\n", &[]), "error: a/b.toml:1:9: `train`: got integer 3, expected a table\n");
}

#[test]
fn unknown_choices_are_listed() {
    assert_eq!(
        complaint("kind = \"mirrow\"\n[train]\nsteps = 1\ngamma = 0.5\n", &[]),
        "error: a/b.toml:1:8: `kind`: got \"mirrow\", expected \"ema\" or \"mirror\" or \"window\"\n  \
         hint: did you mean \"mirror\"?\n"
    );
}

#[test]
fn choices_with_a_value_are_keys() {
    assert_eq!(read("kind = { window = 3 }\n[train]\nsteps = 1\ngamma = 0.5\n", &[]).kind, Kind::Window(3));
    let told = complaint("kind = { windwo = 3 }\n", &[]);
    assert!(told.starts_with("error: a/b.toml:1:10: unknown key `kind.windwo`\n"), "{told}");
}

#[test]
fn missing_keys_point_at_their_table() {
    let told = complaint("seed = 1\n\n[train]\nsteps = 1\n", &[]);
    assert!(told.starts_with("error: a/b.toml:3:1: the key `train.gamma` is missing\n"), "{told}");
    let told = complaint("", &[]);
    assert!(told.starts_with("error: a/b.toml:1:1: the key `train` is missing\n"), "{told}");
}

#[test]
fn syntax_errors_have_a_place() {
    let told = complaint("seed = 1\n[train\nsteps = 1\n", &[]);
    assert!(told.starts_with("error: a/b.toml:2:7: this is not TOML: "), "{told}");
    let told = complaint("seed = 1\nseed = 2\n", &[]);
    assert!(told.starts_with("error: a/b.toml:2:1: this is not TOML: duplicate key"), "{told}");
}

#[test]
fn columns_count_characters() {
    let told = complaint("train = { steps = 1, gamma = 0.5, goal = \"äöü\", x = 1 }", &[]);
    assert!(told.starts_with("error: a/b.toml:1:49: unknown key `train.x`"), "{told}");
}

#[test]
fn errors_in_a_set_show_it_as_typed() {
    assert_eq!(
        complaint(GOOD, &["seed=2", "train.steps=abc"]),
        "error: --set train.steps=abc: `train.steps`: got string \"abc\", expected a whole number, 0 or more\n"
    );
    let told = complaint(GOOD, &["train.stepz=5"]);
    assert!(told.starts_with("error: --set train.stepz=5: unknown key `train.stepz`\n"), "{told}");
    let told = complaint(GOOD, &["trian.steps=5"]);
    assert!(told.starts_with("error: --set trian.steps=5: unknown key `trian`\n"), "{told}");
    let told = complaint(GOOD, &["seed.a.b=5"]);
    assert_eq!(told, "error: --set seed.a.b=5: `seed` is a value and has no keys of its own\n");
    let told = complaint(GOOD, &["train.steps="]);
    assert!(told.contains("got string \"\""), "{told}");
    let told = complaint(GOOD, &["train={ steps = 1, gamma = true }"]);
    assert!(told.contains("`train.gamma`: got boolean true, expected a number"), "{told}");
}

#[test]
fn sets_without_key_or_value_are_refused() {
    for set in ["train.steps", "=5", "train..steps=5", ""] {
        let refused = Source::new("b.toml".into(), String::new(), &[set.to_owned()]);
        let told = render(&refused.unwrap_err().into());
        assert!(told.starts_with(&format!("error: --set {set}: ")), "{told}");
        assert!(told.contains("hint: "), "{told}");
    }
}

#[test]
fn values_out_of_range_are_pointed_at() {
    let from_file = source(GOOD, &[]);
    let told = from_file.explain("train.gamma", "0.5", "1").to_string();
    assert_eq!(told, "a/b.toml:5:9: `train.gamma`: got 0.5, expected 1");
    let missing = from_file.explain("train.epsilon.start", "nothing", "1").to_string();
    assert!(missing.starts_with("a/b.toml:3:1: "), "{missing}");
    let set = source(GOOD, &["train.gamma=2"]).explain("train.gamma", "2", "1").to_string();
    assert_eq!(set, "--set train.gamma=2: `train.gamma`: got 2, expected 1");
}

#[test]
fn paths_start_at_the_config_or_where_they_were_typed() {
    let text = "[train]\nsteps = 1\ngamma = 0.5\ngoal = \"g.png\"\n";
    let goal = Path::new("g.png");
    assert_eq!(source(text, &[]).resolve("train.goal", goal), Path::new("a/g.png"));
    assert_eq!(source(text, &["train.goal=g.png"]).resolve("train.goal", goal), goal);
    let absolute = Path::new("/g.png");
    assert_eq!(source(text, &[]).resolve("train.goal", absolute), absolute);
}
