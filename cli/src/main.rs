//! The program `gnomon`.

use std::process::ExitCode;

fn main() -> ExitCode {
    gnomon::run(std::env::args_os())
}
