//! The command line: arguments, progress, exit codes; the work is done by the
//! other packages.

mod args;
mod draw;
mod error;
mod output;
mod overlay;
mod verbs;

use std::process::ExitCode;

use clap::Parser;

use args::{Cli, Verb};
use error::CliError;

fn main() -> ExitCode {
    match run(&Cli::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::from(error.exit_code())
        }
    }
}

fn run(cli: &Cli) -> Result<(), CliError> {
    match &cli.verb {
        Verb::Compare(args) => verbs::compare::run(args),
        Verb::Demo(args) => verbs::demo::run(args),
        Verb::Render(args) => verbs::render::run(args),
        Verb::Reproduce(args) => verbs::reproduce::run(args),
        Verb::Scenes(args) => verbs::scenes::run(args),
        Verb::Techniques(args) => verbs::techniques::run(args),
    }
}
