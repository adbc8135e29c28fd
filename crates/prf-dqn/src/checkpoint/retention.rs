//! Which checkpoints of a run stay.

use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

/// A file of the replay: the rows that were new at one checkpoint.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct Segment {
    pub(super) file: String,
    /// Rows written by each environment up to the end of this segment.
    pub(super) end: Vec<u64>,
}

/// A checkpoint that stays, and the files of the replay that it needs.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct Kept {
    pub(super) step: u64,
    pub(super) segments: Vec<Segment>,
}

/// The newest checkpoints, oldest first. The model of the best evaluation has a place of its own and stays besides.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(transparent)]
pub(crate) struct Retention(Vec<Kept>);

impl Retention {
    /// What stays, `keep` checkpoints at most, once the one of `step` has been written.
    #[must_use]
    pub(crate) fn with(&self, step: u64, segments: Vec<Segment>, keep: usize) -> Self {
        let mut kept = self.0.clone();
        kept.push(Kept { step, segments });
        kept.drain(..kept.len().saturating_sub(keep));
        Self(kept)
    }

    /// The replay of the newest checkpoint; nothing before the first.
    pub(crate) fn newest(&self) -> &[Segment] {
        self.0.last().map_or(&[], |kept| &kept.segments)
    }

    /// Of the checkpoints that were found, those that may go.
    pub(super) fn superfluous<'a>(&self, found: &'a [PathBuf]) -> impl Iterator<Item = &'a Path> + use<'a, '_> {
        let stays = |path: &Path| self.0.iter().any(|kept| path.ends_with(checkpoint_name(kept.step)));
        found.iter().map(PathBuf::as_path).filter(move |path| !stays(path))
    }

    /// Whether the file `name` of the replay is part of a checkpoint that stays.
    pub(super) fn needs(&self, name: &str) -> bool {
        self.0.iter().flat_map(|kept| &kept.segments).any(|segment| segment.file == name)
    }
}

/// Name of a checkpoint's directory. In the order of their names they are in the order of steps.
pub(super) fn checkpoint_name(step: u64) -> String {
    format!("step-{step:012}")
}

/// Whether `name` is one that [`checkpoint_name`] gives.
pub(super) fn is_checkpoint_name(name: &str) -> bool {
    let step = name.strip_prefix("step-").and_then(|digits| digits.parse().ok());
    step.is_some_and(|step| checkpoint_name(step) == name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_names_that_are_given_are_names_of_checkpoints() {
        assert!(is_checkpoint_name(&checkpoint_name(0)) && is_checkpoint_name(&checkpoint_name(20_000)));
        for other in ["best", "step-", "step-12", "step-000000020000-damaged", "step-+00000020000"] {
            assert!(!is_checkpoint_name(other), "{other}");
        }
    }

    fn segment(step: u64) -> Segment {
        Segment { file: format!("{step}.lz4"), end: vec![step] }
    }

    #[test]
    fn the_newest_stay_with_all_that_they_need() {
        for keep in 1..=4 {
            let mut retention = Retention::default();
            for step in 1..=5 {
                // Each checkpoint shares the segment of the one before.
                retention = retention.with(step, vec![segment(step - 1), segment(step)], keep);
            }
            assert_eq!(retention.newest(), [segment(4), segment(5)]);
            let found: Vec<PathBuf> = (1..=5).map(|step| Path::new("run").join(checkpoint_name(step))).collect();
            let gone = found.len() - keep;
            assert_eq!(retention.superfluous(&found).collect::<Vec<_>>(), found[..gone]);
            let needed: Vec<bool> = (0..=5).map(|step| retention.needs(&segment(step).file)).collect();
            assert_eq!(needed, (0..=5).map(|step| step >= gone).collect::<Vec<_>>());
        }
    }
}
