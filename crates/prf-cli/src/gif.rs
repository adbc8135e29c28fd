//! Moving pictures in which every grey stays what it is.

use std::borrow::Cow;

use gif::{Encoder, Frame as Patch, Repeat};
use prf_core::FrameView;

use crate::error::{CliError, Result};

/// A GIF's unit of time.
const UNITS_PER_SECOND: u64 = 100;

/// An endlessly repeated GIF that grows frame by frame. Its one palette is all 256 greys, so nothing is quantised.
pub(crate) struct GreyGif {
    encoder: Encoder<Vec<u8>>,
    size: [u16; 2],
    frames_per_second: u64,
    frames: u64,
}

impl GreyGif {
    /// A GIF without frames yet, shown at `frames_per_second`: at most 50, since programs slow down what is faster.
    ///
    /// # Errors
    ///
    /// A side is longer than a GIF's can be.
    pub(crate) fn new(width: usize, height: usize, frames_per_second: u32) -> Result<GreyGif> {
        let (Ok(columns), Ok(rows)) = (u16::try_from(width), u16::try_from(height)) else {
            let message =
                format!("a GIF of {width}x{height} px cannot be written: got more than {} px a side", u16::MAX);
            return Err(CliError::failed(message).hint("choose a smaller --scale").into());
        };
        let greys: Vec<u8> = (0..=255).flat_map(|grey| [grey; 3]).collect();
        let mut encoder = Encoder::new(Vec::new(), columns, rows, &greys)?;
        encoder.set_repeat(Repeat::Infinite)?;
        Ok(GreyGif { encoder, size: [columns, rows], frames_per_second: frames_per_second.into(), frames: 0 })
    }

    /// Adds a frame of the GIF's own size.
    ///
    /// # Errors
    ///
    /// There is no memory left for it.
    pub(crate) fn add(&mut self, frame: FrameView<'_>) -> Result<()> {
        let [width, height] = self.size;
        debug_assert_eq!((frame.width(), frame.height()), (width.into(), height.into()));
        // Each frame ends where it should, rounded, so that what is lost by one is made good by the next.
        let end = |frames: u64| (frames * UNITS_PER_SECOND + self.frames_per_second / 2) / self.frames_per_second;
        let delay = (end(self.frames + 1) - end(self.frames)) as u16;
        let buffer = Cow::Borrowed(frame.as_slice());
        self.encoder.write_frame(&Patch { width, height, delay, buffer, ..Patch::default() })?;
        self.frames += 1;
        Ok(())
    }

    /// The file.
    pub(crate) fn finish(self) -> Result<Vec<u8>> {
        Ok(self.encoder.into_inner()?)
    }
}

#[cfg(test)]
mod tests {
    use prf_core::Frame;

    use super::*;

    fn decoded(bytes: &[u8]) -> gif::Decoder<&[u8]> {
        let mut options = gif::DecodeOptions::new();
        options.set_color_output(gif::ColorOutput::RGBA);
        options.read_info(bytes).expect("it is a GIF")
    }

    #[test]
    fn all_256_greys_survive() {
        let frame = Frame::from_vec(32, 8, (0..=255).collect()).expect("that is its size");
        let mut gif = GreyGif::new(32, 8, 10).expect("it is small");
        gif.add(frame.view()).expect("there is memory");
        let bytes = gif.finish().expect("it is complete");
        let mut decoder = decoded(&bytes);
        let shown = decoder.read_next_frame().expect("it is whole").expect("there is one");
        let expected: Vec<u8> = (0..=255).flat_map(|grey| [grey, grey, grey, 255]).collect();
        assert_eq!(shown.buffer, expected);
    }

    #[test]
    fn delays_add_up_to_the_speed() {
        for fps in [1, 7, 15, 24, 30, 50] {
            let mut gif = GreyGif::new(1, 1, fps).expect("it is small");
            (0..fps).for_each(|_| gif.add(Frame::new(1, 1).view()).expect("there is memory"));
            let bytes = gif.finish().expect("it is complete");
            let mut decoder = decoded(&bytes);
            let mut delays = Vec::new();
            while let Some(frame) = decoder.read_next_frame().expect("it is whole") {
                delays.push(frame.delay);
            }
            assert_eq!(delays.iter().sum::<u16>(), 100, "{fps} frames last a second");
            let (least, most) = (delays.iter().min(), delays.iter().max());
            assert!(most.zip(least).is_some_and(|(most, least)| most - least <= 1), "{fps}: {delays:?}");
        }
    }

    #[test]
    fn a_side_that_no_gif_can_have_is_refused() {
        let error = GreyGif::new(65_536, 1, 15).map(|_| ()).expect_err("it is too wide");
        assert_eq!(error.to_string(), "a GIF of 65536x1 px cannot be written: got more than 65535 px a side");
    }
}
