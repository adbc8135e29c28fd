//! What the figures were measured on.

use std::process::Command;
use std::{fs, thread};

/// Processor, widest vectors and cores, as the system tells them.
pub(super) fn describe() -> String {
    let cpuinfo = fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let unknown = format!("unknown {} processor", std::env::consts::ARCH);
    let model = cpu_model(&cpuinfo).map_or(unknown, str::to_owned);
    let vectors = widest_vectors(&cpuinfo).map_or(String::new(), |vectors| format!(" with {vectors}"));
    let cores = thread::available_parallelism().map_or(1, usize::from);
    format!("{model}{vectors}, {cores} cores")
}

/// The compiler, as it names itself, such as `rustc 1.95.0`.
pub(super) fn compiler() -> Option<String> {
    let output = Command::new("rustc").arg("--version").output().ok()?;
    let said = String::from_utf8(output.stdout).ok()?;
    Some(said.split_whitespace().take(2).collect::<Vec<_>>().join(" "))
}

/// The first processor's name in the form of `/proc/cpuinfo`.
pub fn cpu_model(cpuinfo: &str) -> Option<&str> {
    field(cpuinfo, "model name")
}

/// The widest vectors that we make use of.
pub fn widest_vectors(cpuinfo: &str) -> Option<&'static str> {
    let has = |flag: &str| field(cpuinfo, "flags").is_some_and(|flags| flags.split(' ').any(|found| found == flag));
    match () {
        () if has("avx512bw") => Some("AVX-512"),
        () if has("avx2") => Some("AVX2"),
        () => None,
    }
}

/// Whether the processor multiplies bf16, which is when the trainer computes in it by itself.
pub(super) fn multiplies_bf16() -> bool {
    let cpuinfo = fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let has = |key: &str, name: &str| field(&cpuinfo, key).is_some_and(|all| all.split(' ').any(|found| found == name));
    has("flags", "avx512_bf16") || has("Features", "bf16")
}

fn field<'a>(cpuinfo: &'a str, name: &str) -> Option<&'a str> {
    let mut fields = cpuinfo.lines().filter_map(|line| line.split_once(':'));
    fields.find(|(key, _)| key.trim() == name).map(|(_, value)| value.trim())
}
