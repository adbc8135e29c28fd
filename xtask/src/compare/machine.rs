//! What the figures were measured on.

use std::{fs, thread};

/// The processor's name, as the system tells it.
pub(super) fn model() -> String {
    let found = fs::read_to_string("/proc/cpuinfo").ok().and_then(|text| cpu_model(&text).map(str::to_owned));
    found.unwrap_or_else(|| format!("unknown {} processor", std::env::consts::ARCH))
}

/// How many there are for us.
pub(super) fn cores() -> usize {
    thread::available_parallelism().map_or(1, usize::from)
}

/// The first processor's name in the form of `/proc/cpuinfo`.
pub fn cpu_model(cpuinfo: &str) -> Option<&str> {
    let mut fields = cpuinfo.lines().filter_map(|line| line.split_once(':'));
    fields.find(|(key, _)| key.trim() == "model name").map(|(_, model)| model.trim())
}
