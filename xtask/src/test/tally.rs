//! Counting tests from what the runners print.

use std::fmt::{self, Display, Formatter};
use std::iter::Sum;

/// Numbers of tests.
#[derive(Debug, Default, Clone, Copy, PartialEq, Eq)]
pub struct Tally {
    /// Tests that passed.
    pub passed: usize,
    /// Tests that failed.
    pub failed: usize,
    /// Test programs that ended badly, less those that said which of their tests failed.
    crashed: isize,
}

impl Tally {
    /// Counts what one line of `cargo test` or pytest says.
    pub fn read_line(&mut self, line: &str) {
        let line = line.trim();
        if let Some(result) = line.strip_prefix("test result: ") {
            let (verdict, counts) = result.split_once(". ").unwrap_or((result, ""));
            self.add(counts.split("; "));
            self.crashed -= isize::from(verdict == "FAILED");
        } else if line.contains("test failed, to rerun pass") {
            // Not always at the start: what died may have left half a line.
            self.crashed += 1;
        } else if let Some(counts) = closing_line(line) {
            self.add(counts.split(", "));
        }
    }

    /// Counts each program that crashed as a failure, and returns how many there are.
    pub(super) fn take_crashed(&mut self) -> usize {
        let crashed = usize::try_from(self.crashed).unwrap_or(0);
        self.crashed = 0;
        self.failed += crashed;
        crashed
    }

    fn add<'a>(&mut self, counts: impl Iterator<Item = &'a str>) {
        for (number, word) in counts.filter_map(numbered) {
            match word {
                "passed" => self.passed += number,
                "failed" | "error" | "errors" => self.failed += number,
                _ => {}
            }
        }
    }
}

impl Sum for Tally {
    fn sum<I: Iterator<Item = Tally>>(tallies: I) -> Tally {
        tallies.fold(Tally::default(), |sum, tally| Tally {
            passed: sum.passed + tally.passed,
            failed: sum.failed + tally.failed,
            crashed: sum.crashed + tally.crashed,
        })
    }
}

impl Display for Tally {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        write!(f, "{} passed, {} failed", self.passed, self.failed)
    }
}

/// The counts of pytest's last line, such as `== 3 passed, 1 skipped in 0.12s ==`.
fn closing_line(line: &str) -> Option<&str> {
    let (counts, time) = line.trim_matches(['=', ' ']).rsplit_once(" in ")?;
    let is_time = time.split(' ').next()?.strip_suffix('s')?.parse::<f64>().is_ok();
    let is_count = counts.split(", ").all(|count| numbered(count).is_some());
    (is_time && is_count).then_some(counts)
}

/// `3 passed` as a number and a word.
fn numbered(count: &str) -> Option<(usize, &str)> {
    let (number, word) = count.trim().split_once(' ')?;
    Some((number.parse().ok()?, word))
}
