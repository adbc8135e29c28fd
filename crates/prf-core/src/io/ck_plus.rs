//! The Extended Cohn-Kanade data set (CK+) as its licence holders get it: sequences of faces, from neutral to the peak of an
//! expression.
//!
//! ```text
//! cohn-kanade-images/S005/001/S005_001_00000001.png     a frame of subject S005 in session 001
//! Emotion/S005/001/S005_001_00000011_emotion.txt        3.0000000e+00; many sequences have none
//! ```
//!
//! [`list`] finds the sequences; [`read_motion`](super::read_motion) makes a goal of one's folder.

use std::fmt;
use std::fs::{self, File};
use std::io::Read;
use std::path::{Path, PathBuf};

use super::{Limits, folder, natural, picture_error, sequence_error};
use crate::{Error, PictureProblem, SequenceProblem};

/// What a sequence shows at its end, in the order of the data set's numbers from 0 to 7.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[expect(missing_docs, reason = "the names are the data set's own")]
pub enum Emotion {
    Neutral,
    Anger,
    Contempt,
    Disgust,
    Fear,
    Happy,
    Sadness,
    Surprise,
}

impl Emotion {
    /// All of them; the place of each is its number.
    pub const ALL: [Emotion; 8] = [
        Emotion::Neutral,
        Emotion::Anger,
        Emotion::Contempt,
        Emotion::Disgust,
        Emotion::Fear,
        Emotion::Happy,
        Emotion::Sadness,
        Emotion::Surprise,
    ];

    /// The data set's word for it, in lower case.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Emotion::Neutral => "neutral",
            Emotion::Anger => "anger",
            Emotion::Contempt => "contempt",
            Emotion::Disgust => "disgust",
            Emotion::Fear => "fear",
            Emotion::Happy => "happy",
            Emotion::Sadness => "sadness",
            Emotion::Surprise => "surprise",
        }
    }

    /// The emotion of a label's text, such as `   3.0000000e+00`.
    fn of_label(text: &str) -> Option<Emotion> {
        let number: f64 = text.trim().parse().ok()?;
        (0..Emotion::ALL.len()).find(|&code| code as f64 == number).map(|code| Emotion::ALL[code])
    }
}

impl fmt::Display for Emotion {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// A sequence of frames of one face.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Sequence {
    /// Who is seen, such as `S005`.
    pub subject: String,
    /// Which sequence of the subject, such as `001`.
    pub session: String,
    /// Where the frames are.
    pub folder: PathBuf,
    /// How many frames there are, at least 1.
    pub frames: u64,
    /// What is shown, if there is a label.
    pub emotion: Option<Emotion>,
}

/// Which sequences are wanted; all of them by default.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Selection {
    /// Only of this subject, in upper or lower case.
    pub subject: Option<String>,
    /// Only of this session.
    pub session: Option<String>,
    /// Only with this label.
    pub emotion: Option<Emotion>,
}

/// The selected sequences in the order of subjects and sessions. `root` is the folder that holds `cohn-kanade-images`, and
/// `Emotion` if there are labels, or it is `cohn-kanade-images` itself.
///
/// Only the labels of selected subjects and sessions are read. What isn't named like a subject or a session is passed over,
/// and so are sessions without pictures.
///
/// # Errors
///
/// [`Error::Sequence`] when `root` is laid out in another way or there are no pictures, or with the file of a label that is
/// no number from 0 to 7; [`Error::Picture`] when a folder or a label can't be read.
pub fn list(root: impl AsRef<Path>, selection: &Selection) -> Result<Vec<Sequence>, Error> {
    let root = root.as_ref();
    let (images, labels) = parts_of(root)?;
    let mut sequences = Vec::new();
    let mut without = None;
    for subject in folders(&images, is_subject, selection.subject.as_deref())? {
        for session in folders(&images.join(&subject), is_session, selection.session.as_deref())? {
            let folder = images.join(&subject).join(&session);
            match folder::pictures(&folder, Limits::default()) {
                Ok(pictures) => {
                    let (frames, emotion) = (pictures.len() as u64, label_of(&labels.join(&subject).join(&session))?);
                    sequences.push(Sequence { subject: subject.clone(), session, folder, frames, emotion });
                }
                Err(PictureProblem::NoPictures) => without = without.or(Some(folder)),
                Err(problem) => return Err(picture_error(&folder, problem)),
            }
        }
    }
    let is_narrowed = selection.subject.is_some() || selection.session.is_some();
    if sequences.is_empty() && (without.is_some() || !is_narrowed) {
        return Err(not_ck_plus(without.as_deref().unwrap_or(&images)));
    }
    sequences.retain(|sequence| selection.emotion.is_none_or(|wanted| sequence.emotion == Some(wanted)));
    Ok(sequences)
}

const IMAGES: &str = "cohn-kanade-images";
const LABELS: &str = "Emotion";

/// The folders of the frames and of the labels.
fn parts_of(root: &Path) -> Result<(PathBuf, PathBuf), Error> {
    let below = root.join(IMAGES);
    if below.is_dir() {
        return Ok((below, root.join(LABELS)));
    }
    if root.is_dir() && !folders(root, is_subject, None)?.is_empty() {
        return Ok((root.to_owned(), root.join("..").join(LABELS)));
    }
    Err(not_ck_plus(root))
}

/// The names of the folders in `folder` that are such as wanted, in natural order.
fn folders(folder: &Path, is_such: fn(&str) -> bool, wanted: Option<&str>) -> Result<Vec<String>, Error> {
    let failed = |error| picture_error(folder, PictureProblem::Io(error));
    let mut names = Vec::new();
    for entry in fs::read_dir(folder).map_err(failed)? {
        let entry = entry.map_err(failed)?;
        let Ok(name) = entry.file_name().into_string() else { continue };
        if is_such(&name) && wanted.is_none_or(|wanted| name.eq_ignore_ascii_case(wanted)) && entry.path().is_dir() {
            names.push(name);
        }
    }
    names.sort_by(|a, b| natural::compare(a.as_bytes(), b.as_bytes()));
    Ok(names)
}

fn is_subject(name: &str) -> bool {
    name.strip_prefix(['S', 's']).is_some_and(is_session)
}

fn is_session(name: &str) -> bool {
    !name.is_empty() && name.bytes().all(|byte| byte.is_ascii_digit())
}

/// The emotion that a sequence's folder of labels names, if there is such a folder with a file.
fn label_of(folder: &Path) -> Result<Option<Emotion>, Error> {
    let Ok(entries) = fs::read_dir(folder) else { return Ok(None) };
    let is_label = |path: &PathBuf| {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        !name.starts_with('.') && name.ends_with("_emotion.txt")
    };
    // There is one at most, named after the last frame; of more, the last is.
    let Some(path) = entries.flatten().map(|entry| entry.path()).filter(is_label).max() else { return Ok(None) };
    let text = read_start(&path).map_err(|error| picture_error(&path, PictureProblem::Io(error)))?;
    match Emotion::of_label(&text) {
        Some(emotion) => Ok(Some(emotion)),
        None => Err(sequence_error(&path, SequenceProblem::Emotion { got: words(&text) })),
    }
}

/// As much of a file as a label can be long.
fn read_start(path: &Path) -> std::io::Result<String> {
    const LEN: u64 = 256;
    let mut bytes = Vec::new();
    File::open(path)?.take(LEN).read_to_end(&mut bytes)?;
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}

/// A label's text, short and printable.
fn words(text: &str) -> String {
    const LEN: usize = 24;
    let text = text.trim();
    match text.chars().nth(LEN) {
        _ if text.is_empty() => "an empty file".to_owned(),
        None => format!("{text:?}"),
        Some(_) => format!("{:?} and more", text.chars().take(LEN).collect::<String>()),
    }
}

fn not_ck_plus(path: &Path) -> Error {
    sequence_error(path, SequenceProblem::NotCkPlus { got: found_at(path) })
}

/// What lies at a path, in words.
fn found_at(path: &Path) -> String {
    const SHOWN: usize = 4;
    let Ok(entries) = fs::read_dir(path) else {
        return if path.exists() { "a file" } else { "nothing at this path" }.to_owned();
    };
    let mut names: Vec<String> =
        entries.flatten().map(|entry| entry.file_name().to_string_lossy().into_owned()).collect();
    names.sort_by(|a, b| natural::compare(a.as_bytes(), b.as_bytes()));
    let more = names.len().saturating_sub(SHOWN);
    names.truncate(SHOWN);
    match (names.join(", "), more) {
        (names, _) if names.is_empty() => "an empty folder".to_owned(),
        (names, 0) => format!("a folder with {names}"),
        (names, more) => format!("a folder with {names} and {more} more"),
    }
}
