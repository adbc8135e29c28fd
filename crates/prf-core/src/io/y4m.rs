//! YUV4MPEG2, the plainest form of a video: a line of text, then frames of bytes.
//!
//! Only the luma is used. A video's black is 16 and its white 235 unless it says `XCOLORRANGE=FULL`;
//! here they become 0 and 255, since black has to be black for a crop.

use std::io::{self, BufRead, ErrorKind, Read};

use super::source::{Stream, Timed};
use super::{Limits, pixels};
use crate::{Frame, PictureProblem};

/// What every file of this format begins with.
pub(super) const MAGIC: &[u8] = b"YUV4MPEG2 ";

const NAME: &str = "y4m";
const MAX_LINE: u64 = 1024;

/// Which bytes stand for black and white.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Range {
    /// 0 and 255.
    Full,
    /// 16 and 235.
    Limited,
}

pub(super) struct Y4m<R> {
    reader: R,
    header: Header,
    line: Vec<u8>,
    /// How many frames were read.
    count: u64,
}

#[derive(Debug, PartialEq)]
struct Header {
    width: u32,
    height: u32,
    /// Bytes of a frame's colours, behind its luma.
    chroma_len: u64,
    /// Frames and the seconds that they take.
    rate: Option<(u32, u32)>,
    range: Range,
}

impl<R: BufRead> Y4m<R> {
    /// Reads the header. `range` is that of a video that doesn't say which it has.
    pub(super) fn new(mut reader: R, limits: Limits, range: Range) -> Result<Y4m<R>, PictureProblem> {
        let mut line = Vec::new();
        if read_line(&mut reader, &mut line)? == 0 {
            return Err(truncated());
        }
        if !line.starts_with(MAGIC) {
            return Err(misplaced(&line, "YUV4MPEG2"));
        }
        let header = Header::parse(&String::from_utf8_lossy(&line), limits, range)?;
        Ok(Y4m { reader, header, line, count: 0 })
    }

    fn read_into(&mut self, frame: &mut Frame) -> Result<(), PictureProblem> {
        let Header { width, height, chroma_len, range, .. } = self.header;
        let pixels = pixels::reshape(frame, width as usize, height as usize);
        self.reader.read_exact(pixels).map_err(problem)?;
        let skipped = io::copy(&mut self.reader.by_ref().take(chroma_len), &mut io::sink()).map_err(problem)?;
        if skipped < chroma_len {
            return Err(truncated());
        }
        if range == Range::Limited {
            pixels.iter_mut().for_each(|luma| *luma = FULL[usize::from(*luma)]);
        }
        Ok(())
    }

    fn time_s(&self) -> Option<f64> {
        let (frames, seconds) = self.header.rate?;
        Some(self.count as f64 * f64::from(seconds) / f64::from(frames))
    }
}

impl<R: BufRead> Stream for Y4m<R> {
    fn next_into(&mut self, frame: &mut Frame) -> Result<Option<Timed>, PictureProblem> {
        if read_line(&mut self.reader, &mut self.line)? == 0 {
            return Ok(None);
        }
        if self.line != b"FRAME" && !self.line.starts_with(b"FRAME ") {
            return Err(misplaced(&self.line, "FRAME"));
        }
        self.read_into(frame)?;
        let time_s = self.time_s();
        self.count += 1;
        Ok(Some(Timed { time_s }))
    }
}

impl Header {
    fn parse(line: &str, limits: Limits, range: Range) -> Result<Header, PictureProblem> {
        let mut header = Header { width: 0, height: 0, chroma_len: 0, rate: None, range };
        let mut colours = "420";
        for field in line.split(' ').skip(1) {
            let (tag, value) = field.split_at_checked(1).unwrap_or_default();
            match (tag, value) {
                ("W", _) => header.width = value.parse().unwrap_or(0),
                ("H", _) => header.height = value.parse().unwrap_or(0),
                ("F", _) => header.rate = rate(value),
                ("C", _) => colours = value,
                ("X", "COLORRANGE=FULL") => header.range = Range::Full,
                ("X", "COLORRANGE=LIMITED") => header.range = Range::Limited,
                _ => {}
            }
        }
        limits.check_size(NAME, header.width, header.height)?;
        header.chroma_len = chroma_len(colours, header.width.into(), header.height.into())
            .ok_or_else(|| PictureProblem::Pixels { colours: colours.to_owned() })?;
        Ok(header)
    }
}

/// Frames and seconds, as in `30000:1001`. `0:0` stands for unknown.
fn rate(value: &str) -> Option<(u32, u32)> {
    let (frames, seconds) = value.split_once(':')?;
    let (frames, seconds) = (frames.parse().ok()?, seconds.parse().ok()?);
    (frames > 0 && seconds > 0).then_some((frames, seconds))
}

/// Bytes of both planes of colour, if these are colours of 8 bits that are known.
fn chroma_len(colours: &str, width: u64, height: u64) -> Option<u64> {
    let plane: u64 = match colours {
        "mono" => 0,
        "420" | "420jpeg" | "420mpeg2" | "420paldv" => width.div_ceil(2) * height.div_ceil(2),
        "422" => width.div_ceil(2) * height,
        "444" => width * height,
        _ => return None,
    };
    Some(plane.saturating_mul(2))
}

/// Reads a line without its end; its length with it, 0 at the end of the file.
fn read_line(reader: &mut impl BufRead, line: &mut Vec<u8>) -> Result<usize, PictureProblem> {
    line.clear();
    let len = reader.take(MAX_LINE).read_until(b'\n', line).map_err(problem)?;
    match line.pop() {
        Some(b'\n') | None => Ok(len),
        Some(_) if len as u64 == MAX_LINE => {
            Err(PictureProblem::damaged(NAME, format!("a line of more than {MAX_LINE} bytes")))
        }
        Some(_) => Err(truncated()),
    }
}

/// What a luma of limited range is in the full one.
const FULL: [u8; 256] = {
    let mut full = [0; 256];
    let mut luma = 16;
    while luma < 256 {
        let stretched = ((luma - 16) * 255 + 219 / 2) / 219;
        full[luma] = if stretched < 255 { stretched as u8 } else { 255 };
        luma += 1;
    }
    full
};

fn problem(error: io::Error) -> PictureProblem {
    if error.kind() == ErrorKind::UnexpectedEof { truncated() } else { PictureProblem::Io(error) }
}

/// A line that doesn't begin as it should.
fn misplaced(line: &[u8], expected: &str) -> PictureProblem {
    let start = line[..line.len().min(8)].escape_ascii();
    PictureProblem::damaged(NAME, format!("\"{start}\" stands where {expected} should"))
}

fn truncated() -> PictureProblem {
    PictureProblem::Truncated { format: NAME.to_owned() }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn header(line: &str) -> Result<Header, PictureProblem> {
        Header::parse(line, Limits::default(), Range::Limited)
    }

    #[test]
    fn a_header_is_read_in_any_order() {
        let chroma_len = 2 * 3 * 2;
        let expected = Header { width: 5, height: 3, chroma_len, rate: Some((30_000, 1001)), range: Range::Full };
        let line = "YUV4MPEG2 H3 F30000:1001 Ip A1:1 C420mpeg2 XYSCSS=420MPEG2 XCOLORRANGE=FULL W5";
        assert_eq!(header(line).expect("whole"), expected);
        let plain = header("YUV4MPEG2 W5 H3 F0:0").expect("the rest may be left out");
        assert_eq!(plain, Header { rate: None, range: Range::Limited, ..expected });
    }

    #[test]
    fn colours_take_as_many_bytes_as_their_kind_says() {
        for (colours, len) in [("mono", 0), ("420jpeg", 12), ("420paldv", 12), ("422", 18), ("444", 30)] {
            assert_eq!(chroma_len(colours, 5, 3), Some(len), "{colours}");
        }
        for colours in ["420p10", "mono16", "444alpha", "", "rgb"] {
            assert_eq!(chroma_len(colours, 5, 3), None, "{colours}");
        }
    }

    #[test]
    fn limited_range_becomes_full() {
        let got = [0, 15, 16, 17, 126, 234, 235, 236, 255].map(|luma: usize| FULL[luma]);
        assert_eq!(got, [0, 0, 0, 1, 128, 254, 255, 255, 255]);
        assert!(FULL.is_sorted());
    }

    #[test]
    fn a_header_that_makes_no_sense_is_refused() {
        assert!(matches!(header("YUV4MPEG2 W5"), Err(PictureProblem::Damaged { .. })));
        assert!(matches!(header("YUV4MPEG2 W-5 H3"), Err(PictureProblem::Damaged { .. })));
        assert!(matches!(header("YUV4MPEG2 W99999 H3"), Err(PictureProblem::TooLarge { .. })));
        let error = header("YUV4MPEG2 W5 H3 C420p10").expect_err("10 bits").to_string();
        assert!(error.contains("420p10") && error.contains("8 bits"), "{error}");
    }
}
