//! The C++ compiler that `torch-sys` needs.

use std::ffi::OsStr;
use std::process::Command;

use anyhow::{Result, bail};

use crate::find_in;

/// Compilers to look for, the one that `torch-sys` tries by itself first.
const NAMES: [&str; 3] = ["c++", "g++", "clang++"];

/// A C++ compiler that is there.
#[derive(Debug, PartialEq, Eq)]
pub enum Compiler {
    /// The build finds it by itself.
    Usual,
    /// The build must be told its name.
    Named(&'static str),
}

impl Compiler {
    /// Looks for a compiler on `path`; `cxx` is the user's own choice (`$CXX`), which wins.
    ///
    /// # Errors
    /// If there is none.
    pub fn find(path: &OsStr, cxx: Option<&OsStr>) -> Result<Compiler> {
        if cxx.is_some_and(|name| !name.is_empty()) {
            return Ok(Compiler::Usual);
        }
        match NAMES.into_iter().find(|name| find_in(path, name).is_some()) {
            Some(name) if name == NAMES[0] => Ok(Compiler::Usual),
            Some(name) => Ok(Compiler::Named(name)),
            None => bail!(
                "there is no C++ compiler on PATH, and the libtorch bindings need one: install one \
                 (Debian, Ubuntu: `apt install g++`; Fedora: `dnf install gcc-c++`; macOS: \
                 `xcode-select --install`) or set CXX"
            ),
        }
    }

    /// Tells `command`, a cargo that builds, about the compiler.
    pub fn configure(&self, command: &mut Command) {
        if let Compiler::Named(name) = self {
            command.env("CXX", name);
        }
    }
}
