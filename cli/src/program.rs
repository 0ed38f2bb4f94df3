//! The program: arguments in, exit codes out.

use std::ffi::OsString;
use std::io::Write;
use std::process::ExitCode;

use clap::FromArgMatches;
use gnomon_pipeline::technique::Technique;
use gnomon_pipeline::techniques::Registry;

use crate::command_line::Cli;
use crate::error::CliError;
use crate::{help, output, threads};

/// The program with `techniques` beside the built-in ones, on this process's arguments: a
/// `main` of one line. Where they cannot be registered it says why and gives 2.
///
/// ```no_run
/// # use gnomon::pipeline::technique::Technique;
/// # fn mine() -> &'static dyn Technique { unimplemented!() }
/// fn main() -> std::process::ExitCode {
///     gnomon::main_with(&[mine()])
/// }
/// ```
#[must_use]
pub fn main_with(techniques: &[&'static dyn Technique]) -> ExitCode {
    let mut registry = Registry::built_in();
    for technique in techniques {
        if let Err(error) = registry.register(*technique) {
            let _ = writeln!(std::io::stderr().lock(), "error: {error}");
            return ExitCode::from(2);
        }
    }
    run_with(&registry, std::env::args_os())
}

/// Runs the program on `arguments`, the first of which is its own name: 0 fine,
/// 1 differs or a check failed, 2 bad input.
pub fn run(arguments: impl IntoIterator<Item = OsString>) -> ExitCode {
    run_with(&Registry::built_in(), arguments)
}

/// The same with the techniques of `registry` instead of the built-in ones.
pub fn run_with(registry: &Registry, arguments: impl IntoIterator<Item = OsString>) -> ExitCode {
    let mut command = help::command();
    let parsed = command.try_get_matches_from_mut(arguments);
    let cli = match parsed.and_then(|m| Cli::from_arg_matches(&m)) {
        Ok(cli) => cli,
        Err(error) => return print_usage(&error.format(&mut command)),
    };
    output::set_quiet(cli.quiet);
    match threads::start().and_then(|()| cli.verb.run(registry)) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => print_error(&error),
    }
}

/// Prints help, or what is wrong with the command line.
fn print_usage(error: &clap::Error) -> ExitCode {
    // Nobody is left to tell where it cannot be printed.
    let _ = error.print();
    if error.use_stderr() {
        ExitCode::from(2)
    } else {
        ExitCode::SUCCESS
    }
}

fn print_error(error: &CliError) -> ExitCode {
    // What differs has been said on stdout.
    if matches!(error, CliError::Differs) {
        return ExitCode::from(error.exit_code());
    }
    // As above; `eprintln!` would panic.
    let _ = writeln!(std::io::stderr().lock(), "error: {error}");
    ExitCode::from(error.exit_code())
}
