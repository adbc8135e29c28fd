//! `prf`: train, evaluate and score rewards from pictures.

use std::process::ExitCode;

fn main() -> ExitCode {
    prf_cli::run(std::env::args_os()).into()
}
