//! Videos of every kind, by way of the program ffmpeg.
//!
//! It runs as a process of its own and writes grey frames into a pipe, as y4m.

use std::ffi::{OsStr, OsString};
use std::io::{self, BufRead, BufReader, ErrorKind, Read};
use std::path::Path;
use std::process::{Child, ChildStderr, ChildStdout, Command, Stdio};
use std::thread::JoinHandle;

use super::Limits;
use super::sniff::Start;
use super::source::{Stream, Timed};
use super::y4m::{Range, Y4m};
use crate::{Frame, PictureProblem};

/// Looked for on `PATH`.
pub(super) const PROGRAM: &str = "ffmpeg";

/// So much of ffmpeg's words is quoted.
const MAX_COMPLAINT: u64 = 1024;

/// A video of which some frames have been read.
pub(super) struct Video {
    frames: Y4m<BufReader<ChildStdout>>,
    process: Process,
}

impl Video {
    /// Has `program` open the file, which begins with `start`.
    pub(super) fn open(
        program: impl AsRef<OsStr>,
        path: &Path,
        start: &Start,
        limits: Limits,
    ) -> Result<Video, PictureProblem> {
        // ffmpeg would take a playlist for a video, and some texts for drawings.
        if start.is_text() {
            return Err(start.not_a_picture());
        }
        let refused = |detail| PictureProblem::NotAVideo { start: start.quoted(), detail };
        let (mut process, stdout) = match Process::start(program.as_ref(), path, limits) {
            Ok(started) => started,
            Err(error) if error.kind() == ErrorKind::NotFound => {
                return Err(PictureProblem::NoFfmpeg { start: start.quoted() });
            }
            Err(error) => return Err(refused(format!("it can't be started: {error}"))),
        };
        match Y4m::new(BufReader::new(stdout), limits, Range::Full) {
            Ok(frames) => Ok(Video { frames, process }),
            Err(problem @ PictureProblem::TooLarge { .. }) => Err(problem),
            Err(PictureProblem::Truncated { .. }) => {
                Err(refused(process.finish().unwrap_or_else(|| "it wrote nothing".to_owned())))
            }
            Err(problem) => Err(refused(problem.to_string())),
        }
    }
}

impl Stream for Video {
    fn next_into(&mut self, frame: &mut Frame) -> Result<Option<Timed>, PictureProblem> {
        let next = self.frames.next_into(frame);
        if !matches!(next, Ok(None) | Err(PictureProblem::Truncated { .. })) {
            return next;
        }
        // Nothing more will come. What went wrong before stands on stderr, even if ffmpeg went on.
        match self.process.finish() {
            Some(complaint) => Err(PictureProblem::damaged("video", complaint)),
            None => next,
        }
    }
}

/// A running ffmpeg. It is ended with this.
struct Process {
    child: Child,
    /// Reads stderr all along, so that the process never waits for it.
    complaint: Option<JoinHandle<String>>,
}

impl Process {
    fn start(program: &OsStr, path: &Path, limits: Limits) -> io::Result<(Process, ChildStdout)> {
        let mut child = Command::new(program)
            .args(arguments(path, limits))
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()?;
        let (stdout, stderr) = (child.stdout.take(), child.stderr.take());
        let complaint = stderr.map(|stderr| std::thread::spawn(|| first_line(stderr)));
        let process = Process { child, complaint };
        let stdout = stdout.ok_or_else(|| io::Error::other("it has no stdout"))?;
        Ok((process, stdout))
    }

    /// Waits for its end, once it has closed stdout; what went wrong, if anything did.
    fn finish(&mut self) -> Option<String> {
        let status = self.child.wait();
        let complaint = self.complaint.take().and_then(|thread| thread.join().ok());
        complaint.filter(|line| !line.is_empty()).or_else(|| match status {
            Ok(status) if status.success() => None,
            Ok(status) => Some(format!("it ended with {status}")),
            Err(error) => Some(error.to_string()),
        })
    }
}

impl Drop for Process {
    fn drop(&mut self) {
        // Both fail only when it has ended already.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// One video of the file, brought to grey with black at 0 and white at 255, as y4m on stdout. The name
/// can't be taken for an option or a URL, nor can the file lead ffmpeg to any other place.
fn arguments(path: &Path, limits: Limits) -> Vec<OsString> {
    let mut input = OsString::from("file:");
    input.push(path);
    let max_pixels = limits.max_pixels.min(i32::MAX as u64).to_string();
    let before = ["-nostdin", "-v", "error", "-protocol_whitelist", "file", "-max_pixels", &max_pixels, "-i"];
    let after = "-map 0:v:0 -vf scale=out_range=full -pix_fmt gray -strict -1 -f yuv4mpegpipe -";
    let words = |words: &[&str]| words.iter().map(OsString::from).collect::<Vec<_>>();
    [words(&before), vec![input], words(&after.split(' ').collect::<Vec<_>>())].concat()
}

/// The first line, which names the cause; ffmpeg's later ones tell of the consequences.
fn first_line(stderr: ChildStderr) -> String {
    let mut stderr = BufReader::new(stderr);
    let mut line = Vec::new();
    // A pipe that breaks has no more to say.
    let _ = stderr.by_ref().take(MAX_COMPLAINT).read_until(b'\n', &mut line);
    let _ = io::copy(&mut stderr, &mut io::sink());
    without_origin(&String::from_utf8_lossy(&line)).to_owned()
}

/// Without the part of ffmpeg that speaks, and its address in memory: `[h264 @ 0x5581] no frame!`.
fn without_origin(line: &str) -> &str {
    let line = line.trim();
    match line.strip_prefix('[').and_then(|rest| rest.split_once("] ")) {
        Some((_, words)) => without_origin(words),
        None => line,
    }
}

#[cfg(all(test, unix))]
mod tests;
