//! Whole small runs: repeatable, resumable to the bit, and safe against damage.
#![expect(clippy::unwrap_used, reason = "a test may panic")]

use std::cell::Cell;
use std::fs;
use std::path::Path;

use prf_core::{Frame, Goal};
use prf_dqn::checkpoint::{CheckpointStore, FORMAT, Model};
use prf_dqn::compute::Precision;
use prf_dqn::config::{PrioritizedConfig, RunConfig};
use prf_dqn::record::{Event, Recorder};
use prf_dqn::run_dir::RunDir;
use prf_dqn::trainer::{Ending, Trainer};
use prf_envs::RewardForm;
use safetensors::SafeTensors;

/// Small in every respect, but with updates, target copies, evaluations, truncations and a replay that overflows.
const CONFIG: &str = r#"
seed = 7
[env]
name = "breakout"
limit_steps = 30
[reward]
source = "perceptual"
descriptor = "direct"
goal = "black.png"
[train]
steps = 480
environments = 4
batch_size = 8
replay_steps = 200
learning_starts = 100
steps_per_update = 8
target_every_updates = 10
learning_rate = 1e-3
final_learning_rate = 1e-4
threads = 1
checkpoint_every_steps = 120
[train.epsilon]
decay_steps = 300
[evaluation]
every_episodes = 6
episodes = 3
"#;

/// The same with every part that has something of its own to remember.
fn everything_on() -> RunConfig {
    let mut config = config();
    config.reward.form = RewardForm::Potential;
    config.train.dueling = true;
    config.train.threads = 2;
    config.train.n_step = 3;
    config.train.prioritized = Some(PrioritizedConfig::default());
    config
}

struct Silent;

impl Recorder for Silent {
    fn record(&mut self, _event: &Event<'_>) -> prf_dqn::Result<()> {
        Ok(())
    }
}

fn config() -> RunConfig {
    toml::from_str(CONFIG).unwrap()
}

fn open(config: &RunConfig, dir: &Path) -> prf_dqn::Result<Trainer> {
    let goal = Goal::from(Frame::new(84, 84));
    let run =
        if dir.join("config.toml").exists() { RunDir::at(dir) } else { RunDir::create(dir, config, Some(&goal))? };
    Trainer::open(config.clone(), Some(&goal), &run, tch::Device::Cpu)
}

/// Trains until the end, or until the loop has gone round `rounds` times.
fn train(config: &RunConfig, dir: &Path, rounds: usize) -> Ending {
    let left = Cell::new(rounds);
    let stop = || left.replace(left.get().saturating_sub(1)) == 0;
    open(config, dir).unwrap().run(&mut Silent, &stop).unwrap()
}

/// `metrics.jsonl` without what depends on the clock.
fn metrics(dir: &Path) -> Vec<serde_json::Value> {
    let text = fs::read_to_string(dir.join("metrics.jsonl")).unwrap();
    text.lines()
        .map(|line| {
            let mut record: serde_json::Value = serde_json::from_str(line).unwrap();
            let fields = record.as_object_mut().unwrap();
            fields.remove("time_s").unwrap();
            fields.remove("steps_per_s");
            record
        })
        .collect()
}

fn final_model(dir: &Path) -> Vec<u8> {
    fs::read(newest_checkpoint(dir).join("model.safetensors")).unwrap()
}

fn newest_checkpoint(dir: &Path) -> std::path::PathBuf {
    CheckpointStore::list(dir).unwrap().pop().unwrap()
}

#[test]
fn the_same_seed_gives_the_same_run_and_another_seed_another() {
    let (first, second, other) =
        (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
    assert_eq!(train(&config(), first.path(), usize::MAX), Ending::Finished);
    train(&config(), second.path(), usize::MAX);
    train(&RunConfig { seed: 8, ..config() }, other.path(), usize::MAX);
    assert!(metrics(first.path()).len() > 4, "too few records to compare: {:?}", metrics(first.path()));
    assert_eq!(metrics(first.path()), metrics(second.path()));
    assert_eq!(final_model(first.path()), final_model(second.path()));
    assert_ne!(metrics(first.path()), metrics(other.path()));
}

#[test]
fn interrupted_runs_continue_to_the_same_bits() {
    for (precision, mut config) in
        [(Precision::F32, config()), (Precision::Bf16, config()), (Precision::F32, everything_on())]
    {
        config.train.precision = precision;
        let (whole, parts) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
        train(&config, whole.path(), usize::MAX);
        for rounds in [0, 1, 37, 5, 50] {
            assert_eq!(train(&config, parts.path(), rounds), Ending::Interrupted);
        }
        assert_eq!(train(&config, parts.path(), usize::MAX), Ending::Finished);
        assert_eq!(metrics(parts.path()), metrics(whole.path()));
        assert_eq!(final_model(parts.path()), final_model(whole.path()));
    }
}

#[test]
fn each_switch_changes_what_is_learned() {
    let mut short = config();
    short.train.steps = Some(200);
    let trained = |config: &RunConfig| {
        let dir = tempfile::tempdir().unwrap();
        train(config, dir.path(), usize::MAX);
        final_model(dir.path())
    };
    let mut models = vec![trained(&short)];
    let switches: [fn(&mut RunConfig); 4] = [
        |config| config.train.double = false,
        |config| config.train.dueling = true,
        |config| config.train.prioritized = Some(PrioritizedConfig::default()),
        |config| config.reward.form = RewardForm::Potential,
    ];
    for switch in switches {
        let mut config = short.clone();
        switch(&mut config);
        let model = trained(&config);
        assert!(!models.contains(&model));
        models.push(model);
    }
}

#[test]
fn a_killed_run_falls_back_to_its_last_checkpoint_and_loses_nothing_of_it() {
    let (whole, killed) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
    train(&config(), whole.path(), usize::MAX);
    train(&config(), killed.path(), 70);
    // What a kill leaves behind: records after the checkpoint, one of them half written, and unfinished files.
    let metrics_path = killed.path().join("metrics.jsonl");
    let mut text = fs::read_to_string(&metrics_path).unwrap();
    text.push_str("{\"kind\":\"train\",\"step\":9999}\n{\"kind\":\"eval");
    fs::write(&metrics_path, text).unwrap();
    let partial = killed.path().join("checkpoints/.partial-step-000000009999");
    fs::create_dir(&partial).unwrap();
    fs::write(partial.join("model.safetensors"), "half").unwrap();
    fs::write(killed.path().join("replay/.partial-step-000000009999.lz4"), "half").unwrap();

    assert_eq!(train(&config(), killed.path(), usize::MAX), Ending::Finished);
    assert_eq!(metrics(killed.path()), metrics(whole.path()));
    assert_eq!(final_model(killed.path()), final_model(whole.path()));
    assert!(!partial.exists(), "leftovers of the kill are still there");
}

#[test]
fn a_run_killed_before_its_first_checkpoint_starts_over() {
    let (whole, killed) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
    train(&config(), whole.path(), usize::MAX);
    drop(open(&config(), killed.path()).unwrap());
    fs::write(killed.path().join("metrics.jsonl"), "{\"kind\":\"train\"").unwrap();
    train(&config(), killed.path(), usize::MAX);
    assert_eq!(metrics(killed.path()), metrics(whole.path()));
}

#[test]
fn only_the_newest_checkpoints_and_their_replay_are_kept() {
    let whole = tempfile::tempdir().unwrap();
    train(&config(), whole.path(), usize::MAX);
    for keep in [1, 3] {
        let dir = tempfile::tempdir().unwrap();
        let mut config = config();
        config.train.keep_checkpoints = keep;
        train(&config, dir.path(), usize::MAX);
        let kept = CheckpointStore::list(dir.path()).unwrap();
        assert_eq!(kept.len(), keep);
        // Each must still be good to resume from, though its replay has partly been overwritten since.
        for newer in (1..keep).rev() {
            fs::remove_dir_all(&kept[newer]).unwrap();
        }
        assert_eq!(train(&config, dir.path(), usize::MAX), Ending::Finished);
        assert_eq!(CheckpointStore::list(dir.path()).unwrap().len(), keep);
        assert_eq!(final_model(dir.path()), final_model(whole.path()));
    }
}

/// Puts `to` in the place of `from`, of the same length, in the header of a file.
fn patch(path: &Path, from: &str, to: &str) {
    let mut bytes = fs::read(path).unwrap();
    let at = bytes.windows(from.len()).position(|window| window == from.as_bytes()).unwrap();
    bytes[at..at + from.len()].copy_from_slice(to.as_bytes());
    fs::write(path, bytes).unwrap();
}

#[test]
fn checkpoints_of_other_formats_are_refused_and_left_alone() {
    let dir = tempfile::tempdir().unwrap();
    train(&config(), dir.path(), 60);
    let checkpoint = newest_checkpoint(dir.path());
    let ours = format!(r#"\"format\":{FORMAT},"#);
    for file in ["model.safetensors", "state.safetensors"] {
        let path = checkpoint.join(file);
        let whole = fs::read(&path).unwrap();
        for (to, expected) in
            [(r#"\"format\":9,"#, "format 9 of prf 0.1.0"), (r#"\"farmat\":2,"#, "format 1 of prf 0.1.0")]
        {
            patch(&path, &ours, to);
            let found = fs::read(&path).unwrap();
            let error = open(&config(), dir.path()).err().unwrap();
            let text = error.to_string();
            assert!(matches!(error, prf_dqn::Error::Format { .. }), "{text}");
            assert!(
                text.contains(file) && text.contains(expected) && text.contains(&format!("expected format {FORMAT}")),
                "{text}"
            );
            assert_eq!(fs::read(&path).unwrap(), found);
            fs::write(&path, &whole).unwrap();
        }
    }
    let foreign = safetensors::tensor::TensorView::new(safetensors::Dtype::U8, vec![1], &[7]).unwrap();
    fs::write(checkpoint.join("model.safetensors"), safetensors::serialize([("weight", foreign)], None).unwrap())
        .unwrap();
    let error = open(&config(), dir.path()).err().unwrap().to_string();
    assert!(error.contains("a file that prf did not write"), "{error}");
}

#[test]
fn a_checkpoint_of_another_network_is_refused_with_both_networks() {
    let dir = tempfile::tempdir().unwrap();
    train(&config(), dir.path(), 60);
    let mut other = config();
    other.train.dueling = true;
    let error = open(&other, dir.path()).err().unwrap().to_string();
    assert!(error.contains("got a network for") && error.contains("expected a dueling network for"), "{error}");
}

#[test]
fn priorities_that_do_not_fit_the_replay_are_damage() {
    let dir = tempfile::tempdir().unwrap();
    train(&everything_on(), dir.path(), 60);
    let path = newest_checkpoint(dir.path()).join("state.safetensors");
    let mut bytes = fs::read(&path).unwrap();
    let priorities =
        SafeTensors::deserialize(&bytes).unwrap().tensor("replay.priorities").unwrap().data().as_ptr_range();
    let at = priorities.start as usize - bytes.as_ptr() as usize;
    bytes[at..at + 4].copy_from_slice(&(-1.0f32).to_le_bytes());
    fs::write(&path, bytes).unwrap();
    let error = open(&everything_on(), dir.path()).err().unwrap().to_string();
    assert!(error.contains("priority of -1 for row 0") && error.contains("expected"), "{error}");
}

#[test]
fn a_second_trainer_is_refused_before_it_changes_anything() {
    let dir = tempfile::tempdir().unwrap();
    train(&config(), dir.path(), 60);
    let running = open(&config(), dir.path()).unwrap();
    // As if the first were in the middle of a checkpoint, which the second would take for a leftover.
    let partial = dir.path().join("checkpoints/.partial-step-000000009999");
    fs::create_dir(&partial).unwrap();
    let metrics_before = fs::read(dir.path().join("metrics.jsonl")).unwrap();
    assert!(matches!(open(&config(), dir.path()).err().unwrap(), prf_dqn::Error::Busy { .. }));
    assert!(partial.exists());
    assert_eq!(fs::read(dir.path().join("metrics.jsonl")).unwrap(), metrics_before);
    drop(running);
    open(&config(), dir.path()).unwrap();
}

#[test]
fn a_run_that_diverges_stops_and_leaves_its_last_moment_to_be_looked_at() {
    let dir = tempfile::tempdir().unwrap();
    let mut config = RunConfig { reward: config().reward, ..everything_on() };
    (config.train.reward_scale, config.train.learning_rate, config.train.final_learning_rate) = (1e38, 1.0, None);
    let mut trainer = open(&config, dir.path()).unwrap();
    let error = trainer.run(&mut Silent, &|| false).err().unwrap();
    let prf_dqn::Error::Diverged { divergence, saved } = &error else { panic!("{error}") };
    assert!(divergence.step >= 100 && divergence.rewards.not_finite == 0, "{divergence}");
    let text = error.to_string();
    assert!(text.contains(&format!("at step {}", divergence.step)) && text.contains("targets from"), "{text}");

    let saved = saved.as_ref().unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(saved, &dir.path().join("diverged"));
    let report: serde_json::Value = serde_json::from_slice(&fs::read(saved.join("report.json")).unwrap()).unwrap();
    assert_eq!(report["step"], divergence.step);
    assert_eq!(report["rewards"]["count"], 8);
    let batch = fs::read(saved.join("batch.safetensors")).unwrap();
    let batch = SafeTensors::deserialize(&batch).unwrap();
    assert_eq!(batch.tensor("states").unwrap().shape(), [8, 84, 84]);
    for name in ["rewards", "discounts", "weights", "values", "targets"] {
        assert_eq!(batch.tensor(name).unwrap().shape(), [8], "{name}");
    }
    assert!(Model::read(&saved.join("model.safetensors")).unwrap().architecture.dueling);
    assert!(saved.join("state.safetensors").is_file());
}

#[test]
fn damaged_checkpoints_are_refused_by_name_and_left_alone() {
    let dir = tempfile::tempdir().unwrap();
    train(&config(), dir.path(), 60);
    let checkpoint = newest_checkpoint(dir.path());
    let segment = fs::read_dir(dir.path().join("replay")).unwrap().next().unwrap().unwrap().path();
    for path in [checkpoint.join("model.safetensors"), checkpoint.join("state.safetensors"), segment] {
        let whole = fs::read(&path).unwrap();
        fs::write(&path, &whole[..whole.len() / 2]).unwrap();
        let error = open(&config(), dir.path()).err().unwrap().to_string();
        let name = path.file_name().unwrap().to_str().unwrap();
        assert!(error.contains(name) && error.contains("expected"), "{error}");
        assert_eq!(fs::read(&path).unwrap().len(), whole.len() / 2, "the damaged file was changed");
        fs::write(&path, whole).unwrap();
    }
    open(&config(), dir.path()).unwrap();
}

#[test]
fn a_checkpoint_of_another_configuration_is_refused() {
    let dir = tempfile::tempdir().unwrap();
    train(&config(), dir.path(), 40);
    let mut other = config();
    other.train.gamma = 0.5;
    let error = open(&other, dir.path()).err().unwrap().to_string();
    assert!(error.contains("another configuration"), "{error}");
}

#[test]
fn a_beginning_that_was_killed_can_be_begun_again() {
    let dir = tempfile::tempdir().unwrap();
    for name in ["goal.png", "metrics.jsonl", ".partial-config.toml"] {
        fs::write(dir.path().join(name), "").unwrap();
    }
    RunDir::create(dir.path(), &config(), None).unwrap();
    // Records are somebody's.
    let other = tempfile::tempdir().unwrap();
    fs::write(other.path().join("metrics.jsonl"), "{}\n").unwrap();
    RunDir::create(other.path(), &config(), None).unwrap_err();
    assert_eq!(fs::read_dir(other.path()).unwrap().count(), 1);
}

#[test]
fn a_run_folder_is_never_begun_twice() {
    let dir = tempfile::tempdir().unwrap();
    RunDir::create(dir.path(), &config(), None).unwrap();
    let error = RunDir::create(dir.path(), &config(), None).err().unwrap();
    assert!(matches!(&error, prf_dqn::Error::Io { source, .. } if source.kind() == std::io::ErrorKind::AlreadyExists));
}

#[test]
fn the_resolved_configuration_is_complete_and_reads_back_the_same() {
    let dir = tempfile::tempdir().unwrap();
    let goal = Goal::from(Frame::new(84, 84));
    let run = RunDir::create(&dir.path().join("run"), &config(), Some(&goal)).unwrap();
    let text = fs::read_to_string(run.config_path()).unwrap();
    let read: RunConfig = toml::from_str(&text).unwrap();
    let mut expected = config();
    expected.reward.goal = Some("goal.png".into());
    assert_eq!(read, expected);
    assert!(text.contains("gamma") && text.contains("orientations"), "defaults are missing:\n{text}");
    assert_eq!(prf_core::io::read_frame(run.path().join("goal.png")).unwrap(), goal.picture);
}
