//! Running suites and collecting how they went.

use std::fmt::{self, Display, Formatter};
use std::io::{self, BufRead, BufReader, Write};
use std::process::Command;

use anyhow::{Context, Result, bail};

use super::tally::Tally;

/// Runs one suite: `body` hands its commands to the runner, one after the other. All that they print
/// goes to `sink` as it comes. However it ends, the outcome says so.
pub fn run_suite(
    sink: &mut dyn Write,
    name: &'static str,
    body: impl FnOnce(&mut Runner<'_>) -> Result<()>,
) -> Outcome {
    let mut runner = Runner { sink, tally: Tally::default() };
    let result = body(&mut runner);
    Outcome::new(name, runner.tally, result)
}

/// Runs the commands of one suite.
pub struct Runner<'a> {
    sink: &'a mut dyn Write,
    tally: Tally,
}

impl Runner<'_> {
    /// Runs `command` to its end and counts the tests that it says it ran.
    ///
    /// # Errors
    /// If it does not start, or ends otherwise than well.
    pub fn run(&mut self, mut command: Command) -> Result<()> {
        let shown = shown(&command);
        writeln!(self.sink, "\n$ {shown}")?;
        // One pipe for both, so that the lines keep their order.
        let (reader, writer) = io::pipe()?;
        command.stdout(writer.try_clone()?).stderr(writer);
        let mut child = command.spawn().with_context(|| format!("can't run `{shown}`"))?;
        // It holds the pipe's other end, which must close when the child ends.
        drop(command);
        let mut reader = BufReader::new(reader);
        let mut line = Vec::new();
        while reader.read_until(b'\n', &mut line)? > 0 {
            self.sink.write_all(&line)?;
            self.sink.flush()?;
            self.tally.read_line(&String::from_utf8_lossy(&line));
            line.clear();
        }
        let status = child.wait()?;
        if !status.success() {
            bail!("`{shown}` ended with {status}");
        }
        Ok(())
    }
}

/// How one suite went.
#[derive(Debug)]
pub struct Outcome {
    name: &'static str,
    tally: Tally,
    /// Why it failed, where that is more than a failed test.
    reason: Option<String>,
}

impl Outcome {
    /// A suite that ended badly, or ran nothing, has at least one failure.
    fn new(name: &'static str, counted: Tally, result: Result<()>) -> Outcome {
        let mut tally = counted;
        let crashed = tally.take_crashed();
        let mut reason = (crashed > 0).then(|| format!("{crashed} test programs crashed"));
        if tally.failed == 0 {
            reason = match result {
                Err(error) => Some(format!("{error:#}")),
                Ok(()) if tally.passed == 0 => Some("no test ran".to_owned()),
                Ok(()) => None,
            };
            tally.failed = usize::from(reason.is_some());
        }
        Outcome { name, tally, reason }
    }

    /// Tests that passed and failed.
    pub fn tally(&self) -> Tally {
        self.tally
    }
}

impl Display for Outcome {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.name, self.tally)?;
        match &self.reason {
            Some(reason) => write!(f, " ({reason})"),
            None => Ok(()),
        }
    }
}

fn shown(command: &Command) -> String {
    let program = std::path::Path::new(command.get_program());
    let name = program.file_name().unwrap_or(program.as_os_str());
    let words = std::iter::once(name).chain(command.get_args());
    words.map(|word| word.to_string_lossy()).collect::<Vec<_>>().join(" ")
}
