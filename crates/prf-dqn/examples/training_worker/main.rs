//! Our side of `cargo xtask compare training`.
//!
//! ```text
//! training_worker CONFIG.toml FOLDER
//! ```
//!
//! CONFIG says what is trained; runs are begun in FOLDER. Says its versions in one line
//! of JSON, then answers each line `time CASE prf TURNS` with the calls made and their nanoseconds:
//!
//! | Case | A turn |
//! |---|---|
//! | `bare-PRECISION-SIDE` | an update from fixed tensors of SIDE×SIDE pixels: target forward, forward, backward, Adam |
//! | `sample-STEPS` | a batch drawn out of a full replay of so many steps |
//! | `train-PRECISION-ENVIRONMENTS` | a step of an environment in a run that goes on from call to call |
//! | `update-PRECISION-ENVIRONMENTS` | an update in the same run, and all that it takes to get there |

use std::collections::HashMap;
use std::error::Error;
use std::io::{BufRead, Write};
use std::path::{Path, PathBuf};
use std::time::Instant;

use prf_dqn::compute::{Compute, Precision};
use prf_dqn::config::RunConfig;
use prf_dqn::learner::Learner;
use prf_dqn::network::Architecture;
use prf_dqn::replay::{Batch, Outcome, Reach, Replay};
use prf_envs::rng::{ChaCha8Rng, stream};
use rand_core::Rng;
use serde_json::json;

mod session;

use session::Session;

/// Side of the worlds' pictures, in pixels.
const SIDE: usize = 84;

fn main() -> Result<(), Box<dyn Error>> {
    let [config, folder] = std::env::args()
        .skip(1)
        .map(PathBuf::from)
        .collect::<Vec<_>>()
        .try_into()
        .map_err(|_| "usage: training_worker CONFIG.toml FOLDER")?;
    let beside = config.parent().unwrap_or(Path::new("")).to_owned();
    let mut config: RunConfig = toml::from_str(&std::fs::read_to_string(config)?)?;
    config.reward.goal = config.reward.goal.map(|goal| beside.join(goal));
    let threads = config.train.compute(tch::Device::Cpu)?.threads();
    say(&json!({ "versions": { "libtorch": prf_dqn::LIBTORCH_VERSION, "threads": threads.to_string() } }))?;
    let mut cases = HashMap::new();
    for line in std::io::stdin().lock().lines() {
        let line = line?;
        let words: Vec<&str> = line.split(' ').collect();
        let ["time", case, _, turns] = words[..] else { return Err(format!("unknown question {line:?}").into()) };
        if !cases.contains_key(case) {
            cases.insert(case.to_owned(), Case::new(case, &config, &folder)?);
        }
        let case = cases.get_mut(case).expect("it was just made");
        let (calls, ns) = case.turns(turns.parse()?)?;
        say(&json!({ "calls": calls, "ns": ns }))?;
    }
    Ok(())
}

fn say(line: &serde_json::Value) -> std::io::Result<()> {
    let mut out = std::io::stdout().lock();
    writeln!(out, "{line}")?;
    out.flush()
}

/// A piece of work that goes on from call to call.
enum Case {
    Bare { learner: Box<Learner>, inputs: prf_dqn::learner::Inputs },
    Sample { replay: Replay, reach: Reach, rng: Box<ChaCha8Rng>, batch: Box<Batch>, size: usize },
    Run { session: Session, of_updates: bool },
}

impl Case {
    fn new(name: &str, config: &RunConfig, folder: &Path) -> Result<Self, Box<dyn Error>> {
        let words: Vec<&str> = name.split('-').collect();
        match words[..] {
            ["bare", precision, side] => Self::bare(config, precision_of(precision)?, side.parse()?),
            ["sample", steps] => Ok(Self::sample(config, steps.parse()?)),
            [kind @ ("train" | "update"), precision, environments] => {
                let mut config = config.clone();
                config.train.precision = precision_of(precision)?;
                config.train.environments = environments.parse()?;
                let session = Session::start(config, &folder.join(name))?;
                Ok(Self::Run { session, of_updates: kind == "update" })
            }
            _ => Err(format!("unknown case {name:?}").into()),
        }
    }

    fn bare(config: &RunConfig, precision: Precision, side: usize) -> Result<Self, Box<dyn Error>> {
        let architecture = Architecture { input: [side as i64; 2], actions: 3, dueling: false };
        let compute = Compute::new(tch::Device::Cpu, precision, config.train.threads)?;
        let mut rng = stream(0, "bare", 0);
        let learner = Learner::new(architecture, config.train.learner(), compute, &mut rng)?;
        let count = config.train.batch_size;
        let mut pictures = || {
            let mut bytes = vec![0; count * side * side];
            rng.fill_bytes(&mut bytes);
            bytes
        };
        let batch = Batch {
            states: pictures(),
            next_states: pictures(),
            actions: (0..count as i64).map(|row| row % 3).collect(),
            rewards: vec![0.5; count],
            discounts: vec![config.train.gamma; count],
            ..Batch::default()
        };
        let inputs = learner.inputs(&batch)?;
        Ok(Self::Bare { learner: Box::new(learner), inputs })
    }

    fn sample(config: &RunConfig, steps: usize) -> Self {
        let mut replay = Replay::new(steps, config.train.environments, SIDE * SIDE);
        let mut frame = vec![0; SIDE * SIDE];
        let mut rng = stream(0, "sample", 0);
        rng.fill_bytes(&mut frame);
        for row in 0..steps {
            let outcome = if row % 997 == 0 { Outcome::Terminated } else { Outcome::Continued };
            replay.push(row % config.train.environments, &frame, 0, 0.5, outcome);
        }
        let reach = Reach { steps: config.train.n_step, gamma: config.train.gamma };
        Self::Sample { replay, reach, rng: Box::new(rng), batch: Box::default(), size: config.train.batch_size }
    }

    /// Calls made and their nanoseconds.
    fn turns(&mut self, turns: u64) -> Result<(u64, u64), Box<dyn Error>> {
        match self {
            Self::Bare { learner, inputs } => {
                let start = Instant::now();
                for _ in 0..turns {
                    learner.update_from(inputs, 1e-4)?;
                }
                Ok((turns, nanoseconds(start)))
            }
            Self::Sample { replay, reach, rng, batch, size } => {
                let start = Instant::now();
                for _ in 0..turns {
                    replay.sample(*size, *reach, rng, batch);
                }
                Ok((turns, nanoseconds(start)))
            }
            Self::Run { session, of_updates } => session.turns(turns, *of_updates),
        }
    }
}

fn nanoseconds(start: Instant) -> u64 {
    start.elapsed().as_nanos() as u64
}

fn precision_of(word: &str) -> Result<Precision, Box<dyn Error>> {
    match word {
        "f32" => Ok(Precision::F32),
        "bf16" => Ok(Precision::Bf16),
        _ => Err(format!("unknown precision {word:?}").into()),
    }
}
