//! Fetching one wheel with pip, and checking it.

use std::fs::{self, File};
use std::io::{self, BufRead, BufReader, ErrorKind, Read};
use std::path::Path;
use std::process::{Command, ExitStatus};
use std::thread::{sleep, spawn};
use std::time::Duration;

use anyhow::{Context, Result, bail, ensure};
use sha2::{Digest, Sha256};

use super::pins::{VERSION, Wheel};
use super::progress::{Progress, bytes_under};
use super::space;
use crate::python::Python;

/// Time between two looks at a download.
const INTERVAL: Duration = Duration::from_millis(200);

/// Has `wheel` lie in `wheels`, whole and unchanged; one that already does is not fetched again.
pub(super) fn fetch(python: &Python, wheel: &Wheel<'_>, wheels: &Path, scratch: &Path) -> Result<()> {
    let file = wheels.join(wheel.file);
    if file.exists() && verify(&file, wheel).is_ok() {
        return Ok(());
    }
    remove_file(&file)?;
    fs::create_dir_all(wheels)?;
    fs::create_dir_all(scratch)?;
    let (status, said) = download(python, wheel, wheels, scratch)?;
    if !status.success() {
        bail!(explain(&said, wheel, scratch));
    }
    ensure!(file.exists(), "pip fetched another file for {} than {}", wheel.requirement, wheel.file);
    let verified = verify(&file, wheel);
    if verified.is_err() {
        remove_file(&file)?;
    }
    verified
}

/// Returns how pip ended and what it said.
fn download(python: &Python, wheel: &Wheel<'_>, wheels: &Path, scratch: &Path) -> Result<(ExitStatus, String)> {
    let (mut reader, writer) = io::pipe()?;
    let mut pip = pip_download(python, wheel, wheels);
    pip.env("TMPDIR", scratch).stdout(writer.try_clone()?).stderr(writer);
    let mut child = pip.spawn().context("can't run python3")?;
    // It holds the pipe's other end, which must close when the child ends.
    drop(pip);
    let listener = spawn(move || {
        let mut said = Vec::new();
        reader.read_to_end(&mut said).map(|_| String::from_utf8_lossy(&said).into_owned())
    });
    let mut progress = Progress::new(wheel.requirement, wheel.bytes);
    let status = loop {
        if let Some(status) = child.try_wait()? {
            break status;
        }
        progress.update(bytes_under(scratch));
        sleep(INTERVAL);
    };
    progress.finish(status.success());
    let said = listener.join().unwrap_or_else(|_| Ok(String::new()))?;
    Ok((status, said))
}

fn pip_download(python: &Python, wheel: &Wheel<'_>, wheels: &Path) -> Command {
    let mut command = python.command();
    command
        .args(["-m", "pip", "download", "--no-deps", "--only-binary=:all:", "--no-cache-dir"])
        .args(["--progress-bar=off", "--retries=3", "--no-input", "--disable-pip-version-check"])
        // Headers and libraries are the same for every Python: any one will do.
        .args(["--python-version=3.12", "--implementation=cp", "--abi=cp312", "--platform", wheel.tag])
        .arg("--dest")
        .arg(wheels)
        .arg(wheel.requirement)
        // Nothing is installed, so a user's rule against it does not apply.
        .env("PIP_REQUIRE_VIRTUALENV", "0");
    command
}

/// # Errors
/// If the file's SHA-256 is not the pinned one.
fn verify(file: &Path, wheel: &Wheel<'_>) -> Result<()> {
    let got = sha256(file)?;
    ensure!(got == wheel.sha256, wrong_hash(wheel, &got));
    Ok(())
}

fn sha256(file: &Path) -> io::Result<String> {
    let mut hash = Sha256::new();
    let mut reader = BufReader::with_capacity(1 << 20, File::open(file)?);
    loop {
        let bytes = reader.fill_buf()?;
        if bytes.is_empty() {
            return Ok(hash.finalize().iter().map(|byte| format!("{byte:02x}")).collect());
        }
        hash.update(bytes);
        let read = bytes.len();
        reader.consume(read);
    }
}

fn wrong_hash(wheel: &Wheel<'_>, got: &str) -> String {
    format!(
        "{} has the SHA-256 {got}, expected {}: it was damaged or changed on its way and is \
         deleted; run the same command again, and if that does not help, look at which package \
         index pip uses",
        wheel.file, wheel.sha256
    )
}

/// One sentence for why pip failed, from what it wrote.
fn explain(log: &str, wheel: &Wheel<'_>, folder: &Path) -> String {
    let Wheel { requirement, tag, .. } = wheel;
    let has = |words: &[&str]| words.iter().any(|word| log.contains(word));
    if has(&["No space left on device"]) {
        return space::full(folder);
    }
    if has(&["DO NOT MATCH THE HASHES"]) {
        // pip compares with the index's own hash before we see the file.
        let got = log.lines().find_map(|line| line.trim().strip_prefix("Got "));
        return wrong_hash(wheel, got.map_or("unknown", str::trim));
    }
    if has(&["connection broken", "Connection", "timed out", "Timeout", "Max retries", "IncompleteRead", "SSLError"]) {
        return format!(
            "the Python package index can't be reached for {requirement}: check the network (and \
             pip's index and proxy settings), then run the same command again, or set LIBTORCH to a \
             libtorch {VERSION} of your own"
        );
    }
    if has(&["No matching distribution"]) {
        return format!(
            "the package index that pip uses has no {requirement} for {tag}: let pip use pypi.org \
             (PIP_INDEX_URL), or set LIBTORCH to a libtorch {VERSION} of your own"
        );
    }
    let last = log.lines().rfind(|line| !line.trim().is_empty());
    format!("pip could not fetch {requirement}: {}", last.unwrap_or("it gave no reason"))
}

fn remove_file(file: &Path) -> io::Result<()> {
    match fs::remove_file(file) {
        Err(error) if error.kind() != ErrorKind::NotFound => Err(error),
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const WHEEL: Wheel<'_> = Wheel {
        requirement: "toy==1.0",
        tag: "any",
        file: "toy-1.0-py3-none-any.whl",
        sha256: "e0",
        bytes: 1,
        rules: &[],
    };

    fn explained(log: &str) -> String {
        explain(log, &WHEEL, Path::new("scratch"))
    }

    #[test]
    fn a_download_that_pip_found_damaged_gives_both_hashes() {
        let log = "ERROR: THESE PACKAGES DO NOT MATCH THE HASHES FROM THE REQUIREMENTS FILE.\n    toy==1.0:\n        \
                   Expected sha256 e0\n             Got        f1\n";
        assert!(explained(log).starts_with("toy-1.0-py3-none-any.whl has the SHA-256 f1, expected e0"));
    }

    #[test]
    fn a_disk_that_fills_during_the_download() {
        let log = "Traceback (most recent call last):\nOSError: [Errno 28] No space left on device\n";
        assert!(explained(log).starts_with("the disk that holds scratch is full"));
    }

    #[test]
    fn anything_else_ends_with_pips_last_line() {
        let sentence = explained("Looking in indexes: x\nERROR: something new\n\n");
        assert_eq!(sentence, "pip could not fetch toy==1.0: ERROR: something new");
    }
}
