//! Run folders that are made up, so that no test need train.

use std::fs;
use std::path::{Path, PathBuf};

/// A config of a run with the world's own reward, without its seed.
pub(crate) const CONFIG: &str = "\
[env]
name = \"breakout\"
limit_steps = 40
[reward]
source = \"variable\"
[train]
steps = 1000
";

/// A safetensors file without tensors.
const EMPTY_TENSORS: &[u8] = b"\x02\0\0\0\0\0\0\0{}";

/// Makes the folder `name` of a run in `folder`, with the scores of its evaluations at steps.
pub(crate) fn make_run(folder: &Path, name: &str, (seed, config): (u64, &str), scores: &[(u64, f64)]) -> PathBuf {
    let run = folder.join(name);
    fs::create_dir_all(&run).expect("the folder is ours");
    fs::write(run.join("config.toml"), format!("seed = {seed}\n{config}")).expect("the folder is ours");
    let evaluation = |(step, score): &(u64, f64)| {
        format!(
            "{{\"kind\":\"evaluation\",\"step\":{step},\"episode\":{},\"episodes\":5,\"mean_score\":{score},\"std_score\":0.5,\
             \"mean_reward\":{score},\"mean_steps\":20.0,\"time_s\":{}}}\n",
            step / 20,
            step / 100
        )
    };
    fs::write(run.join("metrics.jsonl"), scores.iter().map(evaluation).collect::<String>())
        .expect("the folder is ours");
    run
}

/// Saves a checkpoint of a made-up run, with nothing in it, and a manifest.
pub(crate) fn save(run: &Path, steps: u64, finished: bool) {
    let checkpoint = run.join(format!("checkpoints/step-{steps:012}"));
    fs::create_dir_all(&checkpoint).expect("the folder is ours");
    for name in ["model.safetensors", "state.safetensors"] {
        fs::write(checkpoint.join(name), EMPTY_TENSORS).expect("the folder is ours");
    }
    let manifest = format!(
        "{{\"prf_version\":\"0.1.0\",\"git_revision\":null,\"libtorch_version\":\"2.11.0\",\"seed\":1,\"device\":\"cpu\",\
         \"threads\":1,\"steps\":{steps},\"finished\":{finished},\"time\":{{\"acting_s\":1.0,\"worlds_s\":1.0,\"replay_s\":1.0,\
         \"updates_s\":61.0,\"evaluation_s\":0.0,\"checkpoints_s\":0.0}}}}"
    );
    fs::write(run.join("manifest.json"), manifest).expect("the folder is ours");
}
