//! Goals in files: a picture, a cut-out with its mask, or a sequence that shows a movement.

use std::path::Path;

use prf_core::io::{self, FrameSource};
use prf_core::{DescriptorParams, Error, Frame, Goal, MotionParams, MotionTemplate};

/// The goal that the files show to this descriptor. For the motion descriptor a sequence of frames (a folder, an
/// animation, a video) becomes its motion template; a single picture is taken for one that was made before.
///
/// # Errors
///
/// As [`FrameSource`] and [`MotionTemplate::observe`].
pub(crate) fn read_goal(path: &Path, mask: Option<&Path>, descriptor: &DescriptorParams) -> Result<Goal, Error> {
    let picture = match descriptor {
        DescriptorParams::Motion(motion) => read_motion(path, *motion)?,
        DescriptorParams::Direct | DescriptorParams::Window(_) => io::read_frame(path)?,
    };
    Ok(Goal { picture, mask: mask.map(io::read_frame).transpose()? })
}

fn read_motion(path: &Path, params: MotionParams) -> Result<Frame, Error> {
    let mut motion = MotionTemplate::new(params)?;
    let mut frame = Frame::new(1, 1);
    let (mut source, mut frames) = (FrameSource::open(path)?, 0);
    while let Some(info) = source.next_into(&mut frame) {
        info?;
        motion.observe(frame.view())?;
        frames += 1;
    }
    if frames > 1 {
        motion.history_into(&mut frame);
    }
    Ok(frame)
}
