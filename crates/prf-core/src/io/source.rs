//! Whatever has frames, behind one face.

use std::fmt;
use std::io::BufReader;
use std::path::{Path, PathBuf};
use std::vec::IntoIter;

use super::animation::Animation;
use super::ffmpeg::{self, Video};
use super::sniff::{self, Start};
use super::y4m::{Range, Y4m};
use super::{Limits, folder, picture, picture_error};
use crate::{Error, Frame, PictureProblem};

/// The frames of one path, in order: a picture has one, an animation (GIF, APNG, WebP) and a y4m as
/// many as they hold, and a folder one for each of its pictures, in natural order (`frame2` before
/// `frame10`). Any other file goes to the program `ffmpeg`, if there is one on `PATH`, which reads
/// videos of every kind; of more than one video in the file it takes the first.
///
/// Frames are read one by one, so memory doesn't grow with their number; only the names of a folder's
/// pictures are all kept. A y4m (8 bits: mono, 4:2:0, 4:2:2 or 4:4:4) and a video give the luma that
/// they hold, with black at 0 and white at 255: from 16 and 235 in a y4m that doesn't say
/// `XCOLORRANGE=FULL`. A video whose frames are not equally far apart is brought to one rate by ffmpeg.
///
/// In a folder every file counts that is named like a picture or begins like one. Hidden files, folders
/// and other files are left out.
///
/// ```
/// use prf_core::{Frame, io};
/// # let folder = std::env::temp_dir().join(format!("prf-frames-{}", std::process::id()));
/// # std::fs::create_dir_all(&folder)?;
/// for (name, grey) in [("frame10.png", 10), ("frame2.png", 2)] {
///     io::write_frame(prf_core::FrameView::new(1, 1, &[grey])?, folder.join(name))?;
/// }
/// let mut frames = io::FrameSource::open(&folder)?;
/// let mut frame = Frame::new(1, 1);
/// let mut seen = Vec::new();
/// while let Some(read) = frames.next_into(&mut frame) {
///     seen.push((read?.index, frame.as_slice()[0]));
/// }
/// assert_eq!(seen, [(0, 2), (1, 10)]);
/// # std::fs::remove_dir_all(&folder)?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct FrameSource {
    path: PathBuf,
    limits: Limits,
    frames: Frames,
    /// Of the next frame.
    index: u64,
}

/// Where a frame came from.
#[derive(Clone, Debug, PartialEq)]
pub struct FrameInfo {
    /// Its place in the source, from 0. Damaged pictures of a folder have theirs too.
    pub index: u64,
    /// When it is shown, in seconds after the first frame; unknown of a picture, and where the file
    /// doesn't say.
    pub time_s: Option<f64>,
    /// The file that it is in.
    pub path: PathBuf,
}

enum Frames {
    /// Files with one each.
    Pictures(IntoIter<PathBuf>),
    /// One file with all of them.
    Stream(Box<dyn Stream + Send>),
}

/// Frames of one size, one after the other.
pub(super) trait Stream {
    /// Reads the next one; `None` behind the last. After an error no more is asked for.
    fn next_into(&mut self, frame: &mut Frame) -> Result<Option<Timed>, PictureProblem>;
}

/// When the frame that was read is shown.
pub(super) struct Timed {
    pub(super) time_s: Option<f64>,
}

impl FrameSource {
    /// Opens a path with the default [`Limits`].
    ///
    /// # Errors
    ///
    /// As [`FrameSource::open_within`].
    pub fn open(path: impl AsRef<Path>) -> Result<FrameSource, Error> {
        FrameSource::open_within(path, Limits::default())
    }

    /// Opens a path whose frames keep to `limits`.
    ///
    /// # Errors
    ///
    /// [`Error::Picture`], which names the path and says what is wrong: nothing is there, it holds no
    /// picture or video, ffmpeg is needed and missing or refuses the file, a header asks for more than
    /// the limits allow, or a folder holds no picture or too many.
    pub fn open_within(path: impl AsRef<Path>, limits: Limits) -> Result<FrameSource, Error> {
        let path = path.as_ref();
        let frames = frames_of(path, limits).map_err(|problem| picture_error(path, problem))?;
        Ok(FrameSource { path: path.to_owned(), limits, frames, index: 0 })
    }

    /// Reads the next frame into `frame`, which takes on its size; nothing is left behind the last.
    /// Frames of one file have one size, pictures of a folder may differ.
    ///
    /// # Errors
    ///
    /// [`Error::Picture`], which names the file. After a damaged picture of a folder the next one can
    /// be read; in any other file the first error is the end, and `frame` may then hold anything.
    pub fn next_into(&mut self, frame: &mut Frame) -> Option<Result<FrameInfo, Error>> {
        let (path, read) = match &mut self.frames {
            Frames::Pictures(paths) => {
                let path = paths.next()?;
                let read = picture::read_into(&path, self.limits, frame).map(|()| Timed { time_s: None });
                (path, read)
            }
            Frames::Stream(stream) => {
                let read = next_within(&mut **stream, self.index, self.limits, frame);
                if !matches!(read, Ok(Some(_))) {
                    // Files are closed, and a video's process ends.
                    self.frames = Frames::Pictures(Vec::new().into_iter());
                }
                (self.path.clone(), read.transpose()?)
            }
        };
        let index = self.index;
        self.index += 1;
        let error = |problem| picture_error(&path, problem);
        Some(read.map_err(error).map(|Timed { time_s }| FrameInfo { index, time_s, path }))
    }

    /// What was opened.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// How many frames are still to come, damaged pictures of a folder included. `None` of animations
    /// and videos: only reading them tells.
    #[must_use]
    pub fn len_hint(&self) -> Option<u64> {
        match &self.frames {
            Frames::Pictures(paths) => Some(paths.len() as u64),
            Frames::Stream(_) => None,
        }
    }
}

impl Iterator for FrameSource {
    type Item = Result<(FrameInfo, Frame), Error>;

    /// The next frame in memory of its own; see [`FrameSource::next_into`].
    fn next(&mut self) -> Option<Self::Item> {
        let mut frame = Frame::new(1, 1);
        let read = self.next_into(&mut frame)?;
        Some(read.map(|info| (info, frame)))
    }
}

impl fmt::Debug for FrameSource {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("FrameSource").field("path", &self.path).field("index", &self.index).finish_non_exhaustive()
    }
}

fn frames_of(path: &Path, limits: Limits) -> Result<Frames, PictureProblem> {
    if path.is_dir() {
        return Ok(Frames::Pictures(folder::pictures(path, limits)?.into_iter()));
    }
    let mut file = sniff::open(path)?;
    let start = Start::of(&mut file)?;
    if let Some(format) = start.picture() {
        return Ok(match Animation::open(&file, format, limits)? {
            Some(animation) => Frames::Stream(Box::new(animation)),
            None => Frames::Pictures(vec![path.to_owned()].into_iter()),
        });
    }
    Ok(Frames::Stream(if start.is_y4m() {
        Box::new(Y4m::new(BufReader::new(file), limits, Range::Limited)?)
    } else {
        Box::new(Video::open(ffmpeg::PROGRAM, path, &start, limits)?)
    }))
}

/// The next frame of a stream that has given `index` of them.
fn next_within(
    stream: &mut dyn Stream,
    index: u64,
    limits: Limits,
    frame: &mut Frame,
) -> Result<Option<Timed>, PictureProblem> {
    match stream.next_into(frame)? {
        Some(_) if index >= limits.max_frames => limits.check_count(index + 1).map(|()| None),
        None if index == 0 => Err(PictureProblem::NoFrames),
        next => Ok(next),
    }
}
