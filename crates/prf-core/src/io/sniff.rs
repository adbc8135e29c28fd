//! What a file holds, by its first bytes.

use std::fs::File;
use std::io::{ErrorKind, Read, Seek};
use std::path::Path;

use image::ImageFormat;

use super::y4m;
use crate::PictureProblem;

/// So many bytes tell every format, and text from a video by all likelihood.
const LEN: u64 = 512;

/// Opens what is a file with something in it.
pub(super) fn open(path: &Path) -> Result<File, PictureProblem> {
    let metadata = std::fs::metadata(path).map_err(|error| match error.kind() {
        ErrorKind::NotFound => PictureProblem::Missing,
        _ => PictureProblem::Io(error),
    })?;
    if !metadata.is_file() {
        return Err(PictureProblem::NotAFile);
    }
    if metadata.len() == 0 {
        return Err(PictureProblem::Empty);
    }
    File::open(path).map_err(PictureProblem::Io)
}

/// The first bytes of a file.
pub(super) struct Start(Vec<u8>);

impl Start {
    /// Reads them; the file is at its beginning again afterwards.
    pub(super) fn of(file: &mut File) -> Result<Start, PictureProblem> {
        let mut bytes = Vec::new();
        file.take(LEN).read_to_end(&mut bytes).map_err(PictureProblem::Io)?;
        file.rewind().map_err(PictureProblem::Io)?;
        Ok(Start(bytes))
    }

    /// The format of the picture or animation that begins so.
    pub(super) fn picture(&self) -> Option<ImageFormat> {
        image::guess_format(&self.0).ok().filter(ImageFormat::reading_enabled)
    }

    pub(super) fn is_y4m(&self) -> bool {
        self.0.starts_with(y4m::MAGIC)
    }

    /// Whether this is UTF-8 with nothing unprintable in it, which no video begins with.
    pub(super) fn is_text(&self) -> bool {
        let text = match std::str::from_utf8(&self.0) {
            Ok(text) => text,
            // The last character may be cut off.
            Err(error) if error.error_len().is_none() => {
                std::str::from_utf8(&self.0[..error.valid_up_to()]).unwrap_or_default()
            }
            Err(_) => return false,
        };
        text.chars().all(|c| !c.is_control() || c.is_whitespace())
    }

    /// The first eight bytes, printable.
    pub(super) fn quoted(&self) -> String {
        format!("\"{}\"", self.0[..self.0.len().min(8)].escape_ascii())
    }

    pub(super) fn not_a_picture(&self) -> PictureProblem {
        PictureProblem::NotAPicture { start: self.quoted() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_is_told_from_bytes() {
        let is_text = |bytes: &[u8]| Start(bytes.to_vec()).is_text();
        assert!(is_text(b"#EXTM3U\r\n\tclip.ts\n") && is_text("Übung".as_bytes()));
        // Cut inside of its last character, and broken inside.
        assert!(is_text(&"Übü".as_bytes()[..4]));
        assert!(!is_text(b"\xc3b"));
        for video in [&b"\0\0\0\x18ftypmp42"[..], b"\x1a\x45\xdf\xa3", b"RIFF\x10\0\0\0AVI "] {
            assert!(!is_text(video), "{}", video.escape_ascii());
        }
    }
}
