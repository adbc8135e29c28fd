//! What commands about runs share: networks, devices, and the learner's errors in the words of the command line.

use std::io::ErrorKind;
use std::path::Path;

use prf_dqn::checkpoint::{FORMAT, Model};
use prf_dqn::network::QNetwork;
use prf_dqn::record::TimeShares;
use prf_dqn::trainer::architecture;
use prf_envs::Task;

use crate::args::Device;
use crate::error::{CliError, Result};
use crate::settings::LoadedRun;

pub(super) fn open_device(device: Device) -> Result<tch::Device> {
    let device = match device {
        Device::Cpu => prf_dqn::device::Device::Cpu,
        Device::Cuda => prf_dqn::device::Device::Cuda,
        Device::Mps => prf_dqn::device::Device::Mps,
    };
    device.open().map_err(|error| CliError::failed(error.to_string()).into())
}

/// The network in the file `model`, if it fits the run's task.
pub(crate) fn load_network(loaded: &LoadedRun, model: &Path, device: tch::Device) -> Result<QNetwork> {
    let load = || -> prf_dqn::Result<QNetwork> {
        let task = Task::new(&loaded.config.task(), loaded.goal.as_ref())?;
        let found = Model::read(model)?;
        found.check(&architecture(&task, loaded.config.train.dueling)?, model)?;
        found.network(&loaded.config.train.compute(device)?)
    };
    load().map_err(|error| explain(error.into(), None))
}

/// Adds what to do about an error of the learner.
pub(super) fn explain(error: anyhow::Error, resume: Option<&str>) -> anyhow::Error {
    let resume = resume.map_or(String::new(), |command| format!(", then go on with\n  {command}"));
    match error.downcast_ref::<prf_dqn::Error>() {
        Some(prf_dqn::Error::Io { source, path, .. }) => match source.kind() {
            ErrorKind::AlreadyExists => {
                CliError::misuse(format!("the run folder {} is there already and not empty", path.display()))
                    .hint("go on with it by --resume, or name another by --out")
                    .into()
            }
            ErrorKind::StorageFull | ErrorKind::QuotaExceeded | ErrorKind::FileTooLarge => {
                CliError::failed(error.to_string())
                    .hint(format!("what was saved before is whole; make room{resume}"))
                    .into()
            }
            ErrorKind::PermissionDenied | ErrorKind::ReadOnlyFilesystem => {
                CliError::failed(error.to_string()).hint("name a folder you can write to with --out").into()
            }
            _ => error,
        },
        Some(prf_dqn::Error::Checkpoint { path, .. }) => {
            let folder = path.ancestors().find(|folder| is_checkpoint(folder));
            let hint = folder.map_or("start anew with another --out".to_owned(), |folder| {
                format!("remove the folder {} to fall back on the checkpoint before it", folder.display())
            });
            CliError::failed(error.to_string()).hint(hint).into()
        }
        Some(prf_dqn::Error::Format { writer, .. }) => {
            let hint = match writer {
                Some(writer) if writer.format > FORMAT => {
                    format!("use prf {} or a newer one, which can read it", writer.prf_version)
                }
                Some(writer) => {
                    format!(
                        "train anew with another --out, or use prf {} as it was then: nothing was changed",
                        writer.prf_version
                    )
                }
                None => "name a run folder, or a checkpoint, that `prf train` wrote".to_owned(),
            };
            CliError::failed(error.to_string()).hint(hint).into()
        }
        Some(prf_dqn::Error::Busy { .. }) => {
            CliError::failed(error.to_string()).hint("wait until it has ended, or name another folder by --out").into()
        }
        Some(prf_dqn::Error::Mismatch { .. }) => {
            CliError::failed(error.to_string()).hint("use it with the config.toml of its own run").into()
        }
        Some(prf_dqn::Error::Diverged { saved, .. }) => {
            let look = match saved {
                Ok(dir) => format!("{} has the network and the batch of that moment, to look at", dir.display()),
                Err(error) => format!("the network and the batch of that moment are lost: {error}"),
            };
            let hint = format!(
                "start anew with a lower train.learning_rate, or with a train.reward_scale that brings sums of rewards near 1; {look}"
            );
            CliError::failed(error.to_string()).hint(hint).into()
        }
        Some(prf_dqn::Error::Reward { .. }) => CliError::failed(error.to_string())
            .hint("the world or its reward is at fault; the checkpoints written before are whole")
            .into(),
        _ => error,
    }
}

fn is_checkpoint(folder: &Path) -> bool {
    folder.file_name().is_some_and(|name| name.to_string_lossy().starts_with("step-")) && folder.is_dir()
}

/// Where the time of a run went, in one line.
pub(super) fn time_line(time: &TimeShares) -> String {
    let share = |seconds: f64| 100.0 * seconds / time.total_s().max(f64::EPSILON);
    format!(
        "{} in all: updates {:.0}%, acting {:.0}%, worlds and rewards {:.0}%, replay {:.0}%, evaluation {:.0}%, \
         checkpoints {:.0}%, records {:.1}%",
        duration(time.total_s()),
        share(time.updates_s),
        share(time.acting_s),
        share(time.worlds_s),
        share(time.replay_s),
        share(time.evaluation_s),
        share(time.checkpoints_s),
        share(time.records_s),
    )
}

/// A time for people.
pub(crate) fn duration(seconds: f64) -> String {
    let total = seconds.round() as u64;
    match (total / 3600, total / 60 % 60, total % 60) {
        (0, 0, seconds) => format!("{seconds} s"),
        (0, minutes, seconds) => format!("{minutes} min {seconds} s"),
        (hours, minutes, _) => format!("{hours} h {minutes} min"),
    }
}
