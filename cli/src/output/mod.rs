//! What leaves the program: files, JSON, tables, progress.

pub(crate) mod csv;
pub(crate) mod draws;
pub(crate) mod files;
pub(crate) mod html;
pub(crate) mod npy;
pub(crate) mod numbers;
pub(crate) mod pause;
pub(crate) mod png;
pub(crate) mod png_text;
pub(crate) mod progress;
pub(crate) mod sequence;
pub(crate) mod shell;
pub(crate) mod tables;
pub(crate) mod textures;
pub(crate) mod warnings;
pub(crate) mod wrap;

use std::io::{self, Write};
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};

use serde::Serialize;

use crate::error::CliError;

/// Whether progress and summaries are left out.
static QUIET: AtomicBool = AtomicBool::new(false);

/// Says whether they are.
pub(crate) fn set_quiet(quiet: bool) {
    QUIET.store(quiet, Ordering::Relaxed);
}

pub(crate) fn is_quiet() -> bool {
    QUIET.load(Ordering::Relaxed)
}

/// Whether a file's name stands for stdout.
pub(crate) fn is_stdout(path: &Path) -> bool {
    path.as_os_str() == "-"
}

/// Writes a file's bytes on stdout. A reader that went away is no error.
pub(crate) fn write_stdout(bytes: &[u8]) -> Result<(), CliError> {
    let mut out = io::stdout().lock();
    match out.write_all(bytes).and_then(|()| out.flush()) {
        Err(e) if e.kind() != io::ErrorKind::BrokenPipe => Err(CliError::Stdout(e)),
        _ => Ok(()),
    }
}

/// Prints `text` and a line end on stdout. A reader that went away is no error.
pub(crate) fn print(text: &str) -> Result<(), CliError> {
    let mut out = io::stdout().lock();
    match writeln!(out, "{}", text.trim_end()).and_then(|()| out.flush()) {
        Err(e) if e.kind() != io::ErrorKind::BrokenPipe => Err(CliError::Stdout(e)),
        _ => Ok(()),
    }
}

/// Prints one JSON document on stdout.
pub(crate) fn print_json(document: &impl Serialize) -> Result<(), CliError> {
    let text = serde_json::to_string_pretty(document).map_err(|e| CliError::Stdout(e.into()))?;
    print(&text)
}

/// Prints for people, unless they want none of it: on stdout, or on stderr where stdout is
/// for a document or a file.
pub(crate) fn print_summary(text: &str, is_taken: bool) -> Result<(), CliError> {
    if is_quiet() {
        return Ok(());
    }
    print_asked(text, is_taken)
}

/// The same where it is what was asked for: quiet or not.
pub(crate) fn print_asked(text: &str, is_taken: bool) -> Result<(), CliError> {
    if is_taken {
        // Words that nobody can read are not worth failing for.
        let _ = writeln!(io::stderr().lock(), "{}", text.trim_end());
        return Ok(());
    }
    print(text)
}
