//! What `cases.json` says.

use std::fs;
use std::path::Path;

use prf_core::{DescriptorKind, Frame, HogParams, MatchMethod, MotionParams};
use serde::Deserialize;

use crate::Result;

/// One piece of work, on a few pictures.
#[derive(Deserialize)]
pub(crate) struct Case {
    pub(crate) name: String,
    pub(crate) frames: Pictures,
    #[serde(flatten)]
    pub(crate) work: Work,
}

#[derive(Deserialize)]
#[serde(tag = "work", rename_all = "kebab-case")]
pub(crate) enum Work {
    Hog { hog: HogParams },
    Scores { template: Pictures, method: MatchMethod },
    Best { template: Pictures, method: MatchMethod },
    Motion { motion: MotionParams },
    Reward { descriptor: DescriptorKind, goal: Pictures, hog: HogParams, motion: MotionParams },
}

/// Pictures of one size in a file, one after the other.
#[derive(Deserialize)]
pub(crate) struct Pictures {
    file: String,
    width: usize,
    height: usize,
    pub(crate) count: usize,
}

impl Pictures {
    pub(crate) fn read(&self, folder: &Path) -> Result<Vec<Frame>> {
        let pixels = fs::read(folder.join(&self.file))?;
        let frames = pixels.chunks(self.width * self.height);
        let frames = frames.map(|pixels| Frame::from_vec(self.width, self.height, pixels.to_vec()));
        Ok(frames.collect::<std::result::Result<_, _>>()?)
    }

    pub(crate) fn first(&self, folder: &Path) -> Result<Frame> {
        Ok(self.read(folder)?.into_iter().next().ok_or("an empty picture")?)
    }
}
