//! The replay on disk: immutable files, each with the rows written since the file before it.
//!
//! A checkpoint so costs what is new since the last one, not the whole memory, and a crash while one is written cannot
//! touch those that earlier checkpoints need.

use std::io::{self, Read, Write};
use std::path::Path;

use lz4_flex::frame::{BlockSize, FrameDecoder, FrameEncoder, FrameInfo};

use super::{Outcome, Replay};
use crate::error::{Error, Result};

const MAGIC: &[u8; 8] = b"PRFRPLY1";

impl Replay {
    /// Writes the rows of each lane from `from` on, as far as they are still held.
    pub(crate) fn write_segment(&self, from: &[u64], file: impl Write) -> io::Result<()> {
        let info = FrameInfo::new().content_checksum(true).block_size(BlockSize::Max4MB);
        let mut out = FrameEncoder::with_frame_info(info, file);
        out.write_all(MAGIC)?;
        for number in [self.frame_len, self.rows_per_lane, self.lanes.len()] {
            out.write_all(&(number as u64).to_le_bytes())?;
        }
        for (lane, &from) in self.lanes.iter().zip(from) {
            let first = from.max(lane.written.saturating_sub(self.rows_per_lane as u64));
            out.write_all(&first.to_le_bytes())?;
            out.write_all(&lane.written.to_le_bytes())?;
            for row in first..lane.written {
                let at = (row % self.rows_per_lane as u64) as usize;
                out.write_all(&[lane.actions[at], lane.outcomes[at] as u8])?;
                out.write_all(&lane.rewards[at].to_le_bytes())?;
                out.write_all(&lane.frames[at * self.frame_len..][..self.frame_len])?;
            }
        }
        out.finish()?.flush()
    }

    /// Takes over the rows of a segment; segments are read in the order in which they were written.
    pub(crate) fn read_segment(&mut self, path: &Path, file: impl Read) -> Result<()> {
        let mut input = FrameDecoder::new(file);
        let damaged = |error: io::Error| Error::checkpoint(path, error, "a whole replay segment");
        let mut magic = [0; MAGIC.len()];
        input.read_exact(&mut magic).map_err(damaged)?;
        let mut number = || -> Result<u64> {
            let mut bytes = [0; 8];
            input.read_exact(&mut bytes).map_err(damaged)?;
            Ok(u64::from_le_bytes(bytes))
        };
        let shape = [number()?, number()?, number()?];
        let expected = [self.frame_len as u64, self.rows_per_lane as u64, self.lanes.len() as u64];
        if magic != *MAGIC || shape != expected {
            let expected = format!("{expected:?} (pixels a frame, rows a lane, lanes)");
            return Err(Error::checkpoint(path, format!("a replay of {shape:?}"), expected));
        }
        for lane in 0..self.lanes.len() {
            self.read_lane(lane, &mut input, path)?;
        }
        // Reading to the end makes the decoder compare the checksum of the whole content.
        match input.read(&mut [0]).map_err(damaged)? {
            0 => Ok(()),
            _ => Err(Error::checkpoint(path, "more rows than announced", "a whole replay segment")),
        }
    }

    fn read_lane(&mut self, lane: usize, input: &mut impl Read, path: &Path) -> Result<()> {
        let damaged = |error: io::Error| Error::checkpoint(path, error, "a whole replay segment");
        let mut bounds = [0; 16];
        input.read_exact(&mut bounds).map_err(damaged)?;
        let (first, end) = bounds.split_at(8);
        let bound = |bytes: &[u8]| bytes.iter().rev().fold(0, |sum: u64, byte| sum << 8 | u64::from(*byte));
        let (first, end) = (bound(first), bound(end));
        let (written, rows) = (self.lanes[lane].written, self.rows_per_lane as u64);
        // Rows may be missing before `first` only when they have been overwritten, by later segments or by this one.
        if end < first || first < written || (written > 0 && first > written && end - first < rows) {
            let got = format!("rows {first}..{end} of environment {lane}");
            return Err(Error::checkpoint(path, got, format!("rows from {written} on")));
        }
        self.lanes[lane].written = first;
        let mut state = vec![0; self.frame_len];
        let mut head = [0; 6];
        for _ in first..end {
            input.read_exact(&mut head).map_err(damaged)?;
            input.read_exact(&mut state).map_err(damaged)?;
            let [action, outcome, reward @ ..] = head;
            let outcome = Outcome::from_byte(outcome)
                .ok_or_else(|| Error::checkpoint(path, format!("outcome {outcome}"), "an outcome from 0 to 3"))?;
            self.push(lane, &state, action, f32::from_le_bytes(reward), outcome);
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn push_steps(replay: &mut Replay, from: u8, to: u8) {
        for step in from..to {
            for lane in 0..2 {
                let outcome = if step % 7 == 6 { Outcome::Truncated } else { Outcome::Continued };
                replay.push(lane, &[step, lane as u8, 3], step % 3, f32::from(step), outcome);
                if outcome == Outcome::Truncated && lane == 0 {
                    replay.push_last_state(lane, &[step, 99, 99]);
                }
            }
        }
    }

    fn segment(replay: &Replay, from: &[u64]) -> Vec<u8> {
        let mut bytes = Vec::new();
        replay.write_segment(from, &mut bytes).expect("write");
        bytes
    }

    fn read(replay: &mut Replay, bytes: &[u8]) -> Result<()> {
        replay.read_segment(Path::new("segment"), bytes)
    }

    #[test]
    fn segments_in_order_restore_the_memory() {
        for capacity in [200, 20] {
            let mut original = Replay::new(capacity, 2, 3);
            let mut segments = vec![];
            let mut from = original.written();
            for (start, end) in [(0, 10), (10, 11), (11, 11), (11, 60)] {
                push_steps(&mut original, start, end);
                segments.push(segment(&original, &from));
                from = original.written();
            }
            let mut restored = Replay::new(capacity, 2, 3);
            for bytes in &segments {
                read(&mut restored, bytes).expect("read");
            }
            assert_eq!(restored.written(), original.written());
            assert_eq!(segment(&restored, &[0, 0]), segment(&original, &[0, 0]));
        }
    }

    #[test]
    fn a_gap_between_segments_is_an_error() {
        let mut original = Replay::new(200, 2, 3);
        push_steps(&mut original, 0, 5);
        let early = segment(&original, &[0, 0]);
        push_steps(&mut original, 5, 20);
        let late = segment(&original, &[6, 6]);
        let mut restored = Replay::new(200, 2, 3);
        read(&mut restored, &early).expect("early");
        let error = read(&mut restored, &late).expect_err("gap").to_string();
        assert!(error.contains("rows 6..") && error.contains("rows from 5 on"), "{error}");
    }

    #[test]
    fn a_segment_of_another_shape_is_an_error() {
        let bytes = segment(&Replay::new(200, 2, 3), &[0, 0]);
        let error = read(&mut Replay::new(200, 2, 4), &bytes).expect_err("shape").to_string();
        assert!(error.contains("[3, 100, 2]") && error.contains("[4, 100, 2]"), "{error}");
    }

    proptest! {
        #[test]
        fn damage_is_noticed_unless_every_row_is_intact(position in 0.0f64..1.0, flip in 1u8.., cut in proptest::bool::ANY) {
            let mut original = Replay::new(200, 2, 3);
            push_steps(&mut original, 0, 20);
            let mut bytes = segment(&original, &[0, 0]);
            let at = (position * bytes.len() as f64) as usize;
            if cut { bytes.truncate(at) } else { bytes[at] ^= flip }
            let mut restored = Replay::new(200, 2, 3);
            // A cut may take away no more than the checksum behind the rows.
            if read(&mut restored, &bytes).is_ok() {
                prop_assert_eq!(segment(&restored, &[0, 0]), segment(&original, &[0, 0]));
            }
        }
    }
}
