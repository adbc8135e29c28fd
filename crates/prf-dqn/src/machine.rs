//! What a run was computed on, in words.

use std::env::consts::{ARCH, OS};
use std::fs;
use std::thread::available_parallelism;

/// System, architecture and cores that this process may use, and the processor's name where the system tells it:
/// `linux x86_64, 2 cores, AMD EPYC 9B14`.
pub fn describe() -> String {
    let cores = available_parallelism().map_or(1, usize::from);
    let plural = if cores == 1 { "" } else { "s" };
    let name = fs::read_to_string("/proc/cpuinfo").ok().and_then(|text| processor(&text));
    let name = name.map_or(String::new(), |name| format!(", {name}"));
    format!("{OS} {ARCH}, {cores} core{plural}{name}")
}

/// The first processor's name in Linux's `/proc/cpuinfo`.
fn processor(cpuinfo: &str) -> Option<String> {
    let named = cpuinfo.lines().filter_map(|line| line.split_once(':'));
    let mut names = named.filter(|(key, _)| key.trim() == "model name").map(|(_, name)| name.trim().to_owned());
    names.find(|name| !name.is_empty())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_processor_is_named_where_it_can_be() {
        let cpuinfo = "processor\t: 0\nmodel\t\t: 85\nmodel name\t: Some CPU @ 2.00GHz\n\nprocessor\t: 1\n";
        assert_eq!(processor(cpuinfo).as_deref(), Some("Some CPU @ 2.00GHz"));
        assert_eq!(processor("processor : 0\nBogoMIPS : 50.00\n"), None);
        assert!(describe().starts_with(OS) && describe().contains(" core"), "{}", describe());
    }
}
