//! Fetching and unpacking, with the real pip, small wheels made here and no network.

use std::error::Error;
use std::fs;
use std::os::unix::fs::symlink;
use std::path::{Path, PathBuf};
use std::process::Command;

use tempfile::TempDir;
use xtask::libtorch::Install;
use xtask::libtorch::pins::{PINS, Pin, VERSION, Wheel};
use xtask::python::Python;

type TestResult = Result<(), Box<dyn Error>>;

/// Makes a wheel `toy-1.0` with the files that the rules below speak of, and prints its SHA-256.
const MAKE_WHEEL: &str = r#"
import hashlib, sys, zipfile
with zipfile.ZipFile(sys.argv[1], "w", zipfile.ZIP_DEFLATED) as archive:
    archive.writestr("toy/lib/libtoy.so", "library")
    archive.writestr("toy/lib/libtoy_cuda.so", "not wanted")
    archive.writestr("toy/include/deep/er.h", "header")
    archive.writestr("toy/__init__.py", "")
    archive.writestr("toy-1.0.dist-info/METADATA", "Metadata-Version: 2.1\nName: toy\nVersion: 1.0\n")
    archive.writestr("toy-1.0.dist-info/WHEEL", "Wheel-Version: 1.0\nRoot-Is-Purelib: false\nTag: py3-none-any\n")
    archive.writestr("toy-1.0.dist-info/RECORD", "")
print(hashlib.sha256(open(sys.argv[1], "rb").read()).hexdigest())
"#;

const FILE: &str = "toy-1.0-py3-none-any.whl";
const RULES: &[&str] = &["toy/include/=include/", "toy/lib/=lib/", "!toy/lib/libtoy_cuda"];

/// A folder with a package index, a `python3` that knows no other, and a place for libtorch.
struct Bench {
    folder: TempDir,
    sha256: String,
}

impl Bench {
    fn new() -> Result<Bench, Box<dyn Error>> {
        Bench::with_python("python3-offline")
    }

    fn with_python(stub: &str) -> Result<Bench, Box<dyn Error>> {
        let folder = TempDir::new()?;
        let stubs = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/stubs");
        symlink(stubs.join(stub), folder.path().join("python3"))?;
        if stub != "python3-offline" {
            symlink(stubs.join("python3-offline"), folder.path().join("python3-offline"))?;
        }
        fs::create_dir(folder.path().join("index"))?;
        let wheel = folder.path().join("index").join(FILE);
        let made = Command::new("python3").args(["-c", MAKE_WHEEL]).arg(wheel).output()?;
        let sha256 = String::from_utf8(made.stdout)?.trim().to_owned();
        Ok(Bench { folder, sha256 })
    }

    /// Lets an earlier call have fetched the wheel already.
    fn fetched(self) -> Result<Bench, Box<dyn Error>> {
        fs::create_dir_all(self.at("libtorch.partial/wheels"))?;
        fs::copy(self.at("index").join(FILE), self.at("libtorch.partial/wheels").join(FILE))?;
        Ok(self)
    }

    fn at(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn wheel(&self) -> Wheel<'_> {
        let tag = "manylinux_2_28_x86_64";
        Wheel { requirement: "toy==1.0", tag, file: FILE, sha256: &self.sha256, bytes: 1_000, rules: RULES }
    }

    fn install(&self, wheel: Wheel<'_>) -> anyhow::Result<()> {
        self.install_needing(1, wheel)
    }

    fn install_needing(&self, space_mb: u64, wheel: Wheel<'_>) -> anyhow::Result<()> {
        let pin = Pin { platform: "toy", wheels: &[wheel], space_mb };
        Install::new(&self.at("libtorch"), &pin).run(|| Python::find(self.folder.path().as_os_str()))
    }

    /// The sentence with which an installation fails.
    fn complaint(&self, wheel: Wheel<'_>) -> String {
        self.install(wheel).map_or_else(|error| format!("{error:#}"), |()| "it worked".to_owned())
    }

    fn downloads(&self) -> usize {
        fs::read_to_string(self.at("calls")).map_or(0, |calls| calls.lines().count())
    }
}

#[test]
fn takes_what_the_rules_name_and_nothing_else() -> TestResult {
    let bench = Bench::new()?;
    bench.install(bench.wheel())?;

    assert_eq!(fs::read_to_string(bench.at("libtorch/lib/libtoy.so"))?, "library");
    assert_eq!(fs::read_to_string(bench.at("libtorch/include/deep/er.h"))?, "header");
    assert_eq!(fs::read_to_string(bench.at("libtorch/build-version"))?, VERSION);
    assert_eq!(fs::read_dir(bench.at("libtorch/lib"))?.count(), 1);
    assert!(!bench.at("libtorch.partial").exists());
    Ok(())
}

#[test]
fn is_done_once() -> TestResult {
    let bench = Bench::new()?;
    bench.install(bench.wheel())?;
    bench.install(bench.wheel())?;
    assert_eq!(bench.downloads(), 1);
    Ok(())
}

#[test]
fn another_pin_is_installed_anew() -> TestResult {
    let bench = Bench::new()?.fetched()?;
    bench.install(bench.wheel())?;
    let bench = bench.fetched()?;
    bench.install(Wheel { rules: &["toy/lib/=lib/"], ..bench.wheel() })?;
    assert!(bench.at("libtorch/lib/libtoy_cuda.so").exists());
    assert!(!bench.at("libtorch/include").exists());
    Ok(())
}

#[test]
fn two_at_once_fetch_once() -> TestResult {
    let bench = Bench::new()?;
    std::thread::scope(|scope| {
        let both = [(); 2].map(|()| scope.spawn(|| bench.install(bench.wheel())));
        both.into_iter().try_for_each(|one| one.join().expect("no panic"))
    })?;
    assert_eq!(bench.downloads(), 1);
    Ok(())
}

#[test]
fn a_wrong_hash_names_the_file_and_both_hashes() -> TestResult {
    let bench = Bench::new()?;
    let expected = "0".repeat(64);
    let complaint = bench.complaint(Wheel { sha256: &expected, ..bench.wheel() });
    for part in [FILE, &bench.sha256, &expected] {
        assert!(complaint.contains(part), "no {part} in: {complaint}");
    }
    assert!(!bench.at("libtorch").exists());
    assert!(!bench.at("libtorch.partial/wheels").join(FILE).exists());
    Ok(())
}

#[test]
fn leftovers_of_an_interrupted_call_are_cleared_away() -> TestResult {
    let bench = Bench::new()?;
    for folder in ["unpacked/lib", "scratch", "wheels"] {
        fs::create_dir_all(bench.at("libtorch.partial").join(folder))?;
    }
    fs::write(bench.at("libtorch.partial/unpacked/lib/half.so"), "ha")?;
    fs::write(bench.at("libtorch.partial/scratch/half.whl"), "ha")?;
    fs::write(bench.at("libtorch.partial/wheels").join(FILE), "PK")?;

    bench.install(bench.wheel())?;
    assert_eq!(fs::read_to_string(bench.at("libtorch/lib/libtoy.so"))?, "library");
    assert!(!bench.at("libtorch/lib/half.so").exists());
    assert!(!bench.at("libtorch.partial").exists());
    Ok(())
}

#[test]
fn a_whole_wheel_that_was_left_behind_is_used() -> TestResult {
    let bench = Bench::new()?.fetched()?;
    bench.install(bench.wheel())?;
    assert_eq!(bench.downloads(), 0);
    Ok(())
}

#[test]
fn a_link_is_replaced_and_what_it_points_to_is_kept() -> TestResult {
    let bench = Bench::new()?.fetched()?;
    fs::create_dir_all(bench.at("elsewhere/lib"))?;
    symlink(bench.at("elsewhere"), bench.at("libtorch"))?;
    bench.install(bench.wheel())?;
    assert!(bench.at("elsewhere/lib").exists());
    assert!(bench.at("libtorch").symlink_metadata()?.is_dir());
    Ok(())
}

#[test]
fn a_failure_keeps_what_was_there() -> TestResult {
    let bench = Bench::with_python("python3-disk-full")?.fetched()?;
    fs::create_dir(bench.at("libtorch"))?;
    fs::write(bench.at("libtorch/mine"), "kept")?;
    let complaint = bench.complaint(bench.wheel());
    assert!(complaint.contains("is full: free some space"), "{complaint}");
    assert_eq!(fs::read_to_string(bench.at("libtorch/mine"))?, "kept");
    Ok(())
}

#[test]
fn too_little_space_says_how_much_is_needed() -> TestResult {
    let bench = Bench::new()?;
    let result = bench.install_needing(1_000_000_000, bench.wheel());
    let complaint = result.map_or_else(|error| error.to_string(), |()| "it worked".to_owned());
    assert!(complaint.contains("libtorch needs 1000000000 MB"), "{complaint}");
    assert_eq!(bench.downloads(), 0);
    Ok(())
}

#[test]
fn no_network_says_what_to_do() -> TestResult {
    let bench = Bench::new()?;
    fs::remove_dir_all(bench.at("index"))?;
    let complaint = bench.complaint(bench.wheel());
    assert!(complaint.contains("can't be reached for toy==1.0: check the network"), "{complaint}");
    assert_eq!(complaint.lines().count(), 1);
    Ok(())
}

#[test]
fn an_index_without_the_wheel_says_so() -> TestResult {
    let bench = Bench::new()?;
    let complaint = bench.complaint(Wheel { requirement: "toy==2.0", ..bench.wheel() });
    assert!(complaint.contains("has no toy==2.0"), "{complaint}");
    Ok(())
}

#[test]
fn a_wheel_without_what_a_rule_names_is_an_error() -> TestResult {
    let bench = Bench::new()?.fetched()?;
    let complaint = bench.complaint(Wheel { rules: &["toy/lib/libgone=lib/"], ..bench.wheel() });
    assert!(complaint.contains("it has no toy/lib/libgone"), "{complaint}");
    assert!(!bench.at("libtorch").exists());
    Ok(())
}

#[test]
fn the_pins_are_of_one_version_and_well_formed() {
    for pin in &PINS {
        assert!(pin.wheels.iter().any(|wheel| wheel.requirement == format!("torch=={VERSION}")));
        for wheel in pin.wheels {
            assert!(wheel.sha256.len() == 64 && wheel.sha256.bytes().all(|digit| digit.is_ascii_hexdigit()));
            assert!(wheel.file.contains(wheel.tag), "{}", wheel.file);
        }
    }
}
