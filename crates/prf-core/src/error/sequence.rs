//! What can be wrong with a sequence that should show a movement.

use super::Error;

/// What is wrong with a sequence of frames, or with a collection of such; see [`Error::Sequence`].
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SequenceProblem {
    /// There are too few frames for anything to move between them.
    #[error(
        "got {}, expected at least 2, as a movement is what differs between frames; give a folder of pictures, an \
         animation or a video",
        frames(*readable, damaged.len())
    )]
    TooFewFrames {
        /// How many frames could be read: 0 or 1.
        readable: u64,
        /// What is wrong with the others.
        damaged: Vec<Error>,
    },

    /// A frame has another size than the frames before it.
    #[error(
        "the frame is {}x{} px, expected {}x{} as the frames before it; bring all frames of the sequence to one size",
        shape[1], shape[0], expected[1], expected[0]
    )]
    FrameSize {
        /// `[h, w]` of the frame.
        shape: [usize; 2],
        /// `[h, w]` of the frames before it.
        expected: [usize; 2],
    },

    /// No pixel changes by more than the threshold.
    #[error(
        "nothing moves: the largest change of a pixel from one frame to the next is {largest}, the threshold \
         {threshold}, expected a change above the threshold; {}", still_advice(*largest)
    )]
    Still {
        /// The largest change that was seen, 0 to 254.
        largest: u8,
        /// What a change has to be above.
        threshold: u8,
    },

    /// Something moved, but the schedule has forgotten all of it by the end.
    #[error(
        "{}, but forgotten by the sequence's end, so the template is black: `{key}` is {got}, expected {} {needed}; \
         change it, or end the sequence with the movement",
        movements_were_seen(*movements), if *key == DIVISOR { "at most" } else { "at least" }
    )]
    Forgotten {
        /// In how many frames something moved.
        movements: u64,
        /// The parameter that decides: `delta.divisor` or `delta.duration`.
        key: &'static str,
        /// Its value.
        got: f64,
        /// The value with which the newest movement is still remembered at the end.
        needed: f64,
    },

    /// A folder isn't laid out as the Extended Cohn-Kanade data set is.
    #[error(
        "got {got}, expected the pictures of CK+, cohn-kanade-images/S005/001/S005_001_00000001.png and so on; give the \
         folder that holds cohn-kanade-images"
    )]
    NotCkPlus {
        /// What is there.
        got: String,
    },

    /// A file that should name an emotion doesn't.
    #[error(
        "got {got}, expected the number of an emotion from 0 (neutral) to 7 (surprise), such as 5.0000000e+00; unpack \
         the file again, or remove it to leave the sequence without a label"
    )]
    Emotion {
        /// What the file holds.
        got: String,
    },
}

/// The key of [`DeltaSchedule::Divisor`](crate::DeltaSchedule::Divisor).
pub(crate) const DIVISOR: &str = "delta.divisor";
/// The key of [`DeltaSchedule::Duration`](crate::DeltaSchedule::Duration).
#[cfg(feature = "io")]
pub(crate) const DURATION: &str = "delta.duration";

fn frames(readable: u64, damaged: usize) -> String {
    let count = match readable {
        0 => "no frame".to_owned(),
        1 => "1 frame".to_owned(),
        more => format!("{more} frames"),
    };
    if damaged == 0 { count } else { format!("{count} that can be read ({damaged} damaged)") }
}

fn movements_were_seen(movements: u64) -> String {
    if movements == 1 { "1 movement was seen".to_owned() } else { format!("{movements} movements were seen") }
}

fn still_advice(largest: u8) -> String {
    match largest {
        0 => "all frames are the same, take a sequence in which something moves".to_owned(),
        _ => format!("lower `threshold` to {} or less, or take a sequence in which something moves", largest - 1),
    }
}
