//! Everything that can go wrong in this crate.

use std::path::PathBuf;

pub use self::sequence::SequenceProblem;
#[cfg(feature = "io")]
pub(crate) use self::sequence::{DIVISOR, DURATION};

mod sequence;

/// An error of this crate. Messages are lower case and say what was got and what was expected.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A parameter has a value outside of its range.
    #[error("{key}: got {got}, expected {expected}")]
    InvalidParam {
        /// Dotted name of the parameter, such as `hog.orientations`.
        key: String,
        /// The value that was given.
        got: String,
        /// The values that are allowed.
        expected: String,
    },

    /// A buffer doesn't hold as many values as its picture needs, or a side is zero.
    #[error("a picture of {width}x{height} needs sides of at least 1 and width x height values, got {len}")]
    Shape {
        /// Width that was asked for, in pixels.
        width: usize,
        /// Height that was asked for, in pixels.
        height: usize,
        /// How many values the buffer holds.
        len: usize,
    },

    /// A float picture holds a value that no arithmetic can be done with.
    #[error("pixel ({x}, {y}) is {value}, expected a finite number of at most 1e6 in size")]
    PixelValue {
        /// Column of the pixel.
        x: usize,
        /// Row of the pixel.
        y: usize,
        /// What it holds.
        value: f32,
    },

    /// A frame has another size than the frames before it.
    #[error(
        "got a frame of {}x{} px, expected {}x{} as the frames before it; bring all frames of a \
         sequence to one size, or reset before a new one", shape[1], shape[0], expected[1], expected[0]
    )]
    FrameSize {
        /// `[h, w]` of the frame.
        shape: [usize; 2],
        /// `[h, w]` of the frames before it.
        expected: [usize; 2],
    },

    /// A picture is too small to hold one block of cells.
    #[error(
        "a picture of {width}x{height} px is too small for {block_cells}x{block_cells} cells of \
         {cell_px} px a block: expected at least {min} px on each side; take smaller cells or \
         fewer cells a block"
    )]
    TooSmall {
        /// Width of the picture, in pixels.
        width: usize,
        /// Height of the picture, in pixels.
        height: usize,
        /// Side of a cell, in pixels.
        cell_px: usize,
        /// Cells on a block's side.
        block_cells: usize,
        /// The least side that would do, in pixels.
        min: usize,
    },

    /// A template is larger than the frames that it should be found in.
    #[error(
        "a template of {}x{} px doesn't fit into a frame of {}x{} px, expected one that is nowhere larger; crop the \
         template or take larger frames",
        template[1], template[0], frame[1], frame[0]
    )]
    TemplateTooLarge {
        /// Shape of the template, `[height, width]` in pixels.
        template: [usize; 2],
        /// Shape of the frame, `[height, width]` in pixels.
        frame: [usize; 2],
    },

    /// A goal shows nothing that could be moved or taken away, so it can't be judged by itself.
    #[error(
        "the goal shows nothing of 4 px or more that differs from its background by more than 12, expected something \
         that can be moved; judge the reward by frames with scores or by a demonstration instead"
    )]
    NothingToAlter,

    /// What is known of the frames tells no two of them apart.
    #[error("{got}, expected {expected}; without that no reward can be judged")]
    NoEvidence {
        /// What is known.
        got: String,
        /// What is needed.
        expected: &'static str,
    },

    /// A saved state doesn't belong to the object that should take it.
    #[error("the saved state holds {got}, expected {expected}")]
    Restore {
        /// What the state holds.
        got: String,
        /// What the object needs.
        expected: String,
    },

    /// A picture can't be read from or written to a file.
    #[error("{}: {problem}", path.display())]
    Picture {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        #[source]
        problem: PictureProblem,
    },

    /// A sequence of frames shows no movement that could be a goal, or a collection of sequences can't be read.
    #[error("{}: {problem}", path.display())]
    Sequence {
        /// The sequence, or the file in it.
        path: PathBuf,
        /// What is wrong with it.
        #[source]
        problem: SequenceProblem,
    },
}

impl Error {
    pub(crate) fn invalid(key: impl Into<String>, got: &impl ToString, expected: impl Into<String>) -> Error {
        Error::InvalidParam { key: key.into(), got: got.to_string(), expected: expected.into() }
    }

    /// The same error with `prefix.` before the key of a parameter, so that it names the place in a
    /// larger configuration. Other errors are returned as they are.
    ///
    /// ```
    /// use prf_core::HogParams;
    /// let params = HogParams { orientations: 0, ..HogParams::default() };
    /// let error = params.validate().unwrap_err().within("reward.hog");
    /// assert_eq!(error.to_string(), "reward.hog.orientations: got 0, expected 1 to 64");
    /// ```
    #[must_use]
    pub fn within(self, prefix: &str) -> Error {
        match self {
            Error::InvalidParam { key, got, expected } => {
                Error::InvalidParam { key: format!("{prefix}.{key}"), got, expected }
            }
            other => other,
        }
    }
}

/// What is wrong with a picture's file; see [`Error::Picture`].
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum PictureProblem {
    /// Nothing lies at this path.
    #[error("no such file, expected a picture; check the path")]
    Missing,
    /// The path leads to a directory or another thing that is no file.
    #[error("not a file, expected a picture; give the path of one")]
    NotAFile,
    /// The file has no bytes.
    #[error("the file is empty (0 bytes), expected a picture; was it saved completely?")]
    Empty,
    /// The file begins like no picture that can be read here.
    #[error(
        "not a picture that can be read (it begins with {start}), expected PNG, JPEG, BMP, WebP or \
         GIF; convert it to PNG"
    )]
    NotAPicture {
        /// The first bytes, printable.
        start: String,
    },
    /// The file ends before its picture does.
    #[error("the {format} is cut short, expected a complete picture; save or copy it again")]
    Truncated {
        /// The format that the file is in.
        format: String,
    },
    /// The file begins as a picture but is damaged.
    #[error("the {format} is damaged ({detail}), expected a complete picture; save it again")]
    Damaged {
        /// The format that the file is in.
        format: String,
        /// The decoder's own words.
        detail: String,
    },
    /// The pixels are of a kind that is not read here.
    #[error(
        "the y4m has pixels of the kind {colours}, expected mono, 420, 422 or 444 with 8 bits a sample; convert it"
    )]
    Pixels {
        /// The kind by its header.
        colours: String,
    },
    /// The picture has more pixels than are allowed; refused from its header.
    #[error(
        "the picture is {width}x{height}, expected at most {max_side} on a side and {max_pixels} \
         pixels; scale it down"
    )]
    TooLarge {
        /// Width by its header, in pixels.
        width: u32,
        /// Height by its header, in pixels.
        height: u32,
        /// The most pixels on a side.
        max_side: u32,
        /// The most pixels in all.
        max_pixels: u64,
    },
    /// Even the picture's header asks for more memory than is allowed.
    #[error("the {format} takes too much memory, expected at most {max_pixels} pixels; scale it down")]
    Memory {
        /// The format that the file is in.
        format: String,
        /// The most pixels in all.
        max_pixels: u64,
    },
    /// There are more frames than are allowed.
    #[error("there are more than {max_frames} frames, expected at most so many; take fewer, or raise the limit")]
    TooManyFrames {
        /// The most frames.
        max_frames: u64,
    },
    /// The file is an animation or a video without a single frame.
    #[error("the file holds no frame, expected at least one; save it again")]
    NoFrames,
    /// The folder holds no file that could be a picture.
    #[error("the folder holds no picture, expected files of PNG, JPEG, BMP, WebP or GIF; check the path")]
    NoPictures,
    /// The file could only be a video, and the program that reads those is missing.
    #[error(
        "not a picture (it begins with {start}), and ffmpeg, which videos need, is not on PATH; install \
         ffmpeg, or convert the file to PNG, GIF or y4m"
    )]
    NoFfmpeg {
        /// The first bytes, printable.
        start: String,
    },
    /// The file is no picture, and ffmpeg can't read it either.
    #[error(
        "not a picture (it begins with {start}), nor a video by ffmpeg ({detail}), expected one of both; \
         convert it to PNG, GIF or y4m"
    )]
    NotAVideo {
        /// The first bytes, printable.
        start: String,
        /// What ffmpeg says.
        detail: String,
    },
    /// The file can't be read or written at all.
    #[error("{0}")]
    Io(#[source] std::io::Error),
}

#[cfg(feature = "io")]
impl PictureProblem {
    pub(crate) fn damaged(format: &str, detail: impl Into<String>) -> PictureProblem {
        PictureProblem::Damaged { format: format.to_owned(), detail: detail.into().trim_end().to_owned() }
    }
}
