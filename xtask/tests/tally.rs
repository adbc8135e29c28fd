//! Counting what runners print, and what a suite that goes wrong adds.

use std::process::Command;

use xtask::test::{Outcome, Runner, Tally, report, run_suite};

type TestResult = anyhow::Result<()>;

fn counted(lines: &str) -> String {
    let mut tally = Tally::default();
    lines.lines().for_each(|line| tally.read_line(line));
    tally.to_string()
}

/// Runs a suite of one shell script; returns what it printed and how it went.
fn suite(script: &str) -> (String, Outcome) {
    let mut printed = Vec::new();
    let outcome = run_suite(&mut printed, "suite", |runner| sh(runner, script));
    (String::from_utf8_lossy(&printed).into_owned(), outcome)
}

fn sh(runner: &mut Runner<'_>, script: &str) -> TestResult {
    let mut command = Command::new("sh");
    command.args(["-c", script]);
    runner.run(command)
}

#[test]
fn sums_the_lines_of_cargo_test() {
    let lines = "running 2 tests
test result: ok. 2 passed; 0 failed; 1 ignored; 0 measured; 0 filtered out; finished in 0.00s
test result: FAILED. 5 passed; 3 failed; 0 ignored; 0 measured; 0 filtered out; finished in 1.20s";
    assert_eq!(counted(lines), "7 passed, 3 failed");
}

#[test]
fn reads_every_form_of_pytests_last_line() {
    for (line, sum) in [
        ("============ 5 passed in 0.12s ============", "5 passed, 0 failed"),
        ("== 1 failed, 2 passed, 1 skipped, 1 warning in 3.45s ==", "2 passed, 1 failed"),
        ("= 2 passed, 1 error in 61.05s (0:01:01) =", "2 passed, 1 failed"),
        ("3 failed, 2 errors in 0.10s", "0 passed, 5 failed"),
        ("============ no tests ran in 0.01s ============", "0 passed, 0 failed"),
    ] {
        assert_eq!(counted(line), sum, "{line}");
    }
}

#[test]
fn other_lines_count_nothing() {
    for line in [
        "test hog::norms ... ok",
        "collected 5 items",
        "tests/test_hog.py .....  [100%]",
        "   Finished `test` profile in 12.3s",
        "all 3 passed in the end",
        "Successfully installed numpy-2.0 pytest-9.0",
    ] {
        assert_eq!(counted(line), "0 passed, 0 failed", "{line}");
    }
}

#[test]
fn both_streams_are_shown_in_order() {
    let (printed, _) = suite("echo one; echo two >&2; echo three");
    assert!(printed.ends_with("one\ntwo\nthree\n"), "{printed}");
}

#[test]
fn a_suite_that_passes() {
    let (_, outcome) = suite("echo 'test result: ok. 4 passed; 0 failed; 0 ignored'");
    assert_eq!(outcome.to_string(), "suite: 4 passed, 0 failed");
}

#[test]
fn a_suite_that_does_not_build_is_one_failure() {
    let (_, outcome) = suite("echo 'error: could not compile `x`' >&2; exit 101");
    let shown = outcome.to_string();
    assert!(shown.starts_with("suite: 0 passed, 1 failed (`sh "), "{shown}");
    assert!(shown.ends_with("ended with exit status: 101)"), "{shown}");
}

#[test]
fn failed_tests_are_not_counted_twice() {
    let script = "echo 'test result: FAILED. 4 passed; 2 failed; 0 ignored'
        echo 'error: test failed, to rerun pass `-p x --lib`'; exit 101";
    assert_eq!(suite(script).1.to_string(), "suite: 4 passed, 2 failed");
}

#[test]
fn a_crashed_program_is_one_failure() {
    let script = "echo 'test result: FAILED. 4 passed; 2 failed; 0 ignored'
        echo 'error: test failed, to rerun pass `-p x --lib`'
        echo 'test boom ... error: test failed, to rerun pass `-p y --lib`'; exit 101";
    assert_eq!(suite(script).1.to_string(), "suite: 4 passed, 3 failed (1 test programs crashed)");
}

#[test]
fn a_suite_without_tests_is_a_failure() {
    assert_eq!(suite("true").1.to_string(), "suite: 0 passed, 1 failed (no test ran)");
}

#[test]
fn a_program_that_is_not_there_is_a_failure() {
    let outcome = run_suite(&mut Vec::new(), "suite", |runner| runner.run(Command::new("no-such-program")));
    assert!(outcome.to_string().contains("can't run `no-such-program`"), "{outcome}");
}

#[test]
fn the_last_line_is_the_sum() -> TestResult {
    let outcomes = [
        suite("echo 'test result: ok. 4 passed; 0 failed; 0 ignored'").1,
        suite("exit 1").1,
        suite("echo '== 1 failed, 3 passed in 0.10s =='; exit 1").1,
    ];
    let mut printed = Vec::new();
    let sum = report(&mut printed, &outcomes)?;
    assert_eq!(sum.failed, 2);
    assert!(String::from_utf8(printed)?.ends_with("\n7 passed, 2 failed\n"));
    Ok(())
}
