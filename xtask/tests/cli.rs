//! The program itself, in an empty workspace.

use std::error::Error;
use std::fs;
use std::os::unix::fs::symlink;
use std::path::{Path, PathBuf};
use std::process::Command;

use tempfile::TempDir;

type TestResult = Result<(), Box<dyn Error>>;

/// A workspace with nothing in it, and a folder of programs that is all of `PATH`.
struct Bench {
    folder: TempDir,
}

/// What the program printed, and its exit code.
struct Ended {
    code: Option<i32>,
    stdout: String,
    stderr: String,
}

impl Bench {
    fn new() -> Result<Bench, Box<dyn Error>> {
        let bench = Bench { folder: TempDir::new()? };
        fs::create_dir(bench.at("bin"))?;
        Ok(bench)
    }

    fn at(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn has(&self, program: &str, stub: &str) -> TestResult {
        let stubs = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/stubs");
        Ok(symlink(stubs.join(stub), self.at("bin").join(program))?)
    }

    /// A folder that looks like a libtorch.
    fn own_libtorch(&self) -> Result<PathBuf, Box<dyn Error>> {
        fs::create_dir_all(self.at("own/lib"))?;
        fs::create_dir_all(self.at("own/include"))?;
        Ok(self.at("own"))
    }

    fn command(&self, args: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_xtask"));
        command.args(args).env_clear().env("PATH", self.at("bin")).current_dir(self.folder.path());
        command.env("CARGO_MANIFEST_DIR", self.at("xtask"));
        command
    }

    /// Whether nothing was made in the workspace.
    fn is_untouched(&self) -> bool {
        !self.at(".libtorch").exists() && !self.at(".libtorch.partial").exists()
    }
}

fn end(mut command: Command) -> Result<Ended, Box<dyn Error>> {
    let output = command.output()?;
    Ok(Ended {
        code: output.status.code(),
        stdout: String::from_utf8(output.stdout)?,
        stderr: String::from_utf8(output.stderr)?,
    })
}

/// Runs `setup`, which must fail with one sentence, and returns the sentence.
fn complaint(bench: &Bench) -> Result<String, Box<dyn Error>> {
    let ended = end(bench.command(&["setup"]))?;
    assert_eq!(ended.code, Some(1));
    assert_eq!(ended.stdout, "");
    assert_eq!(ended.stderr.lines().count(), 1, "{}", ended.stderr);
    assert!(bench.is_untouched());
    Ok(ended.stderr)
}

#[test]
fn no_python() -> TestResult {
    let said = complaint(&Bench::new()?)?;
    assert!(said.starts_with("error: there is no python3 on PATH"), "{said}");
    Ok(())
}

#[test]
fn an_old_python() -> TestResult {
    let bench = Bench::new()?;
    bench.has("python3", "python3-old")?;
    let said = complaint(&bench)?;
    assert!(said.contains("is Python 3.9, and 3.10 or newer is needed"), "{said}");
    Ok(())
}

#[test]
fn a_python_without_pip() -> TestResult {
    let bench = Bench::new()?;
    bench.has("python3", "python3-bare")?;
    let said = complaint(&bench)?;
    assert!(said.contains("has no pip"), "{said}");
    Ok(())
}

#[test]
fn the_users_own_libtorch_wins() -> TestResult {
    let bench = Bench::new()?;
    let own = bench.own_libtorch()?;
    let mut setup = bench.command(&["setup"]);
    setup.env("LIBTORCH", &own);
    let ended = end(setup)?;
    assert_eq!(ended.code, Some(0), "{}", ended.stderr);
    assert!(ended.stderr.contains("using your own libtorch"), "{}", ended.stderr);
    assert!(bench.is_untouched());
    Ok(())
}

#[test]
fn the_users_python_wins() -> TestResult {
    let bench = Bench::new()?;
    let mut setup = bench.command(&["setup"]);
    setup.env("LIBTORCH_USE_PYTORCH", "1").env("LIBTORCH", bench.at(".libtorch"));
    let ended = end(setup)?;
    assert_eq!(ended.code, Some(0), "{}", ended.stderr);
    assert!(bench.is_untouched());
    Ok(())
}

#[test]
fn an_own_libtorch_that_is_none() -> TestResult {
    let bench = Bench::new()?;
    let mut setup = bench.command(&["setup"]);
    setup.env("LIBTORCH", bench.at("nowhere"));
    let ended = end(setup)?;
    assert_eq!(ended.code, Some(1));
    assert!(ended.stderr.contains("which has no lib/ and include/"), "{}", ended.stderr);
    Ok(())
}

#[test]
fn the_variable_that_cargo_sets_is_not_the_users() -> TestResult {
    let bench = Bench::new()?;
    let mut setup = bench.command(&["setup"]);
    setup.env("LIBTORCH", bench.at(".libtorch"));
    let ended = end(setup)?;
    assert!(ended.stderr.contains("there is no python3"), "{}", ended.stderr);
    Ok(())
}

#[test]
fn no_compiler() -> TestResult {
    let bench = Bench::new()?;
    let mut prf = bench.command(&["prf"]);
    prf.env("LIBTORCH", bench.own_libtorch()?);
    let ended = end(prf)?;
    assert_eq!(ended.code, Some(1));
    assert!(ended.stderr.contains("no C++ compiler on PATH"), "{}", ended.stderr);
    Ok(())
}

#[test]
fn prf_gets_its_arguments_and_gives_its_exit_code() -> TestResult {
    let bench = Bench::new()?;
    bench.has("cargo", "cargo")?;
    bench.has("c++", "cargo")?;
    let own = bench.own_libtorch()?;
    fs::create_dir(bench.at("elsewhere"))?;
    let mut prf = bench.command(&["prf", "score", "a b", "--help"]);
    prf.env("PATH", format!("{}:/usr/bin:/bin", bench.at("bin").display()));
    prf.env("LIBTORCH", &own).current_dir(bench.at("elsewhere"));
    let ended = end(prf)?;
    assert_eq!(ended.code, Some(130), "{}", ended.stderr);
    let start = format!("{} {} run", bench.at("elsewhere").display(), own.display());
    assert!(ended.stdout.starts_with(&start), "{}", ended.stdout);
    assert!(ended.stdout.ends_with("Cargo.toml -- score a b --help\n"), "{}", ended.stdout);
    Ok(())
}

#[test]
fn an_unknown_command_is_misuse() -> TestResult {
    let bench = Bench::new()?;
    for args in [
        &["tset"][..],
        &[],
        &["test", "extra"],
        &["compare", "speed"],
        &["compare", "perception", "extra"],
        &["compare", "python", "extra"],
    ] {
        let ended = end(bench.command(args))?;
        assert_eq!(ended.code, Some(2));
        assert!(ended.stderr.starts_with("usage: cargo xtask"), "{}", ended.stderr);
    }
    Ok(())
}

/// Runs a comparison, which must fail before it measures anything, and returns why.
fn no_comparison(bench: &Bench) -> Result<String, Box<dyn Error>> {
    let ended = end(bench.command(&["compare"]))?;
    assert_eq!(ended.code, Some(1));
    assert_eq!(ended.stdout, "");
    assert_eq!(ended.stderr.lines().count(), 1, "{}", ended.stderr);
    Ok(ended.stderr)
}

#[test]
fn a_comparison_wants_a_document_to_write_to() -> TestResult {
    let bench = Bench::new()?;
    let said = no_comparison(&bench)?;
    assert!(said.starts_with("error: can't read docs/results/perception.md"), "{said}");
    fs::create_dir_all(bench.at("docs/results"))?;
    fs::write(bench.at("docs/results/perception.md"), "no place for tables")?;
    let said = no_comparison(&bench)?;
    assert!(said.contains("it has no line `<!-- begin"), "{said}");
    Ok(())
}

#[test]
fn a_comparison_wants_a_python() -> TestResult {
    let bench = Bench::new()?;
    fs::create_dir_all(bench.at("docs/results"))?;
    let document = "<!-- begin: written by cargo xtask compare -->old<!-- end -->";
    fs::write(bench.at("docs/results/perception.md"), document)?;
    let said = no_comparison(&bench)?;
    assert!(said.starts_with("error: there is no python3 on PATH"), "{said}");
    fs::create_dir_all(bench.at("tests/compare"))?;
    fs::write(bench.at("tests/compare/requirements.txt"), "toy==1.0")?;
    bench.has("python3", "python3-bare")?;
    let said = no_comparison(&bench)?;
    assert!(said.contains("can't make virtual environments"), "{said}");
    assert_eq!(fs::read_to_string(bench.at("docs/results/perception.md"))?, document);
    Ok(())
}
