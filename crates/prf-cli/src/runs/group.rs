//! Runs of the same config, apart from the seed, are one group.

use std::collections::BTreeMap;
use std::fs;

use prf_dqn::config::RunConfig;
use toml::Value;

use super::Run;
use crate::printer::Printer;

/// Of so many keys or fewer, a name tells the values.
const NAMED_KEYS: usize = 2;

/// Runs that differ by their seeds alone, in the order of these.
#[derive(Debug)]
pub(crate) struct Group {
    pub(crate) name: String,
    pub(crate) runs: Vec<Run>,
}

/// What the runs of a group have in common: config and the files of the goal.
#[derive(PartialEq)]
struct Key {
    config: RunConfig,
    goal: Vec<Vec<u8>>,
}

impl Key {
    fn of(run: &Run) -> Key {
        let config = RunConfig { seed: 0, ..run.config.without_paths() };
        // One that can't be read is not the same as any other, which the run's own name then shows.
        let read = |path| fs::read(path).unwrap_or_else(|_| run.shown().into_bytes());
        Key { config, goal: run.dir.goal_paths().map(read).collect() }
    }
}

/// Puts runs into groups, in the order of each group's first run. Of runs with the same seed only the first counts.
pub(crate) fn groups(runs: Vec<Run>, printer: &mut Printer) -> Vec<Group> {
    let mut found: Vec<(Key, Vec<Run>)> = Vec::new();
    for run in runs {
        let key = Key::of(&run);
        match found.iter_mut().find(|(known, _)| *known == key) {
            None => found.push((key, vec![run])),
            Some((_, group)) => match group.iter().find(|known| known.config.seed == run.config.seed) {
                None => group.push(run),
                Some(known) => printer.warning(
                    format_args!(
                        "{} has the config and the seed of {} and is left out: it would count twice",
                        run.shown(),
                        known.shown()
                    ),
                    None,
                ),
            },
        }
    }
    let names = names(&found);
    let group = |((_, mut runs), name): ((Key, Vec<Run>), String)| {
        runs.sort_by_key(|run| run.config.seed);
        Group { name, runs }
    };
    found.into_iter().zip(names).map(group).collect()
}

/// What to call each group: what differs in the configs, where that is short; otherwise what the folders are called.
fn names(groups: &[(Key, Vec<Run>)]) -> Vec<String> {
    let folders: Vec<String> = groups.iter().map(|(_, runs)| folder_name(runs)).collect();
    let values: Vec<_> = groups.iter().map(|(key, _)| flat(&key.config)).collect();
    let differing = differing(&values);
    if groups.len() > 1 && (1..=NAMED_KEYS).contains(&differing.len()) {
        let named: Vec<String> = values.iter().map(|values| in_words(&differing, values)).collect();
        // Goals can differ as well, and have no words.
        if are_distinct(&named) {
            return named;
        }
    }
    if are_distinct(&folders) {
        return folders;
    }
    groups.iter().map(|(_, runs)| runs[0].shown()).collect()
}

fn are_distinct(names: &[String]) -> bool {
    names.iter().enumerate().all(|(index, name)| !names[..index].contains(name))
}

/// The name of the runs' folders without the seed behind it, if all have the same; otherwise the first folder's.
fn folder_name(runs: &[Run]) -> String {
    let name = |run: &Run| {
        let name = run.name();
        let stem = name.strip_suffix(&run.config.seed.to_string()).map(|stem| stem.trim_end_matches(['-', '_', '.']));
        stem.filter(|stem| !stem.is_empty()).map(str::to_owned).unwrap_or(name)
    };
    name(&runs[0])
}

/// Dotted keys with their values as TOML has them.
fn flat(config: &RunConfig) -> BTreeMap<String, String> {
    let mut values = BTreeMap::new();
    // By way of text, in which an f32 has no more digits than it was given.
    let text = toml::to_string(config).expect("a configuration is plain tables");
    let table = text.parse().expect("it was written as TOML");
    let mut open = vec![(String::new(), Value::Table(table))];
    while let Some((key, value)) = open.pop() {
        match value {
            Value::Table(table) => {
                let prefix = if key.is_empty() { key } else { key + "." };
                open.extend(table.into_iter().map(|(name, value)| (format!("{prefix}{name}"), value)));
            }
            // `n_step = 3.0` would look like another setting.
            Value::String(text) => drop(values.insert(key, text)),
            value => drop(values.insert(key, value.to_string())),
        }
    }
    values
}

/// The keys whose values are not the same everywhere.
fn differing(groups: &[BTreeMap<String, String>]) -> Vec<String> {
    let mut keys: Vec<&String> = groups.iter().flat_map(BTreeMap::keys).collect();
    keys.sort();
    keys.dedup();
    let differs = |key: &&&String| groups.iter().any(|group| group.get(**key) != groups[0].get(**key));
    keys.iter().filter(differs).map(|key| (*key).clone()).collect()
}

fn in_words(keys: &[String], values: &BTreeMap<String, String>) -> String {
    let short = |key: &str| key.rsplit('.').next().unwrap_or_default().to_owned();
    let is_known_by_its_end = |key: &str| keys.iter().filter(|other| short(other) == short(key)).count() == 1;
    let word = |key: &String| {
        let name = if is_known_by_its_end(key) { short(key) } else { key.clone() };
        match values.get(key) {
            Some(value) => format!("{name} = {value}"),
            None => format!("no {name}"),
        }
    };
    keys.iter().map(word).collect::<Vec<_>>().join(", ")
}

#[cfg(test)]
mod tests {
    use super::super::fixture::{CONFIG, run};
    use super::*;
    use crate::printer::Format;

    fn grouped(runs: Vec<Run>) -> Vec<(String, Vec<u64>)> {
        let groups = groups(runs, &mut Printer::new(Format::Text));
        groups
            .iter()
            .map(|group| (group.name.clone(), group.runs.iter().map(|run| run.config.seed).collect()))
            .collect()
    }

    fn with(seed: u64, more: &str) -> String {
        CONFIG.replace("seed = 1", &format!("seed = {seed}")) + more
    }

    #[test]
    fn seeds_make_a_group_named_by_its_folders() {
        let runs = [3, 1, 2].map(|seed| run(&format!("runs/ball-{seed}"), &with(seed, ""), &[]));
        assert_eq!(grouped(runs.into()), [("ball".to_owned(), vec![1, 2, 3])]);
        let one = vec![run("runs/ball", &with(1, ""), &[])];
        assert_eq!(grouped(one), [("ball".to_owned(), vec![1])]);
    }

    #[test]
    fn groups_are_named_by_what_differs() {
        let run = |folder: &str, seed, more: &str| run(folder, &with(seed, more), &[]);
        let runs = vec![run("a-1", 1, "n_step = 1"), run("a-2", 2, "n_step = 1"), run("b-1", 1, "n_step = 3")];
        assert_eq!(grouped(runs), [("n_step = 1".to_owned(), vec![1, 2]), ("n_step = 3".to_owned(), vec![1])]);
        let runs = vec![run("a", 1, ""), run("b", 1, "final_learning_rate = 1e-5")];
        let names: Vec<String> = grouped(runs).into_iter().map(|(name, _)| name).collect();
        assert_eq!(names, ["no final_learning_rate", "final_learning_rate = 0.00001"]);
    }

    #[test]
    fn groups_that_differ_in_much_are_named_by_their_folders() {
        let run = |folder: &str, seed, more: &str| run(folder, &with(seed, more), &[]);
        let much = "n_step = 5\ngamma = 0.9\nbatch_size = 8";
        let runs = vec![run("x/plain-1", 1, ""), run("x/new-1", 1, much), run("x/new-2", 2, much)];
        assert_eq!(grouped(runs), [("plain".to_owned(), vec![1]), ("new".to_owned(), vec![1, 2])]);
        // Folders that are called the same are told apart by their paths.
        let runs = vec![run("x/new-1", 1, ""), run("y/new-1", 1, much)];
        assert_eq!(grouped(runs), [("x/new-1".to_owned(), vec![1]), ("y/new-1".to_owned(), vec![1])]);
    }

    #[test]
    fn the_same_seed_counts_once() {
        let runs = vec![run("a", &with(1, ""), &[]), run("b", &with(1, ""), &[]), run("c", &with(2, ""), &[])];
        assert_eq!(grouped(runs), [("a".to_owned(), vec![1, 2])]);
    }

    #[test]
    fn other_goals_are_other_groups() {
        let folder = tempfile::tempdir().expect("dir");
        let made = |name: &str, goal: &str, seed| {
            let path = folder.path().join(name);
            fs::create_dir_all(&path).expect("dir");
            fs::write(path.join("goal.png"), goal).expect("write");
            run(&path.display().to_string(), &with(seed, ""), &[])
        };
        let runs = vec![made("black-1", "black", 1), made("white-1", "white", 1), made("black-2", "black", 2)];
        assert_eq!(grouped(runs), [("black".to_owned(), vec![1, 2]), ("white".to_owned(), vec![1])]);
    }
}
