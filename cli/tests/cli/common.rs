//! Runs the built binary in a folder of its own.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use serde_json::Value;

/// An empty folder, removed at the end.
pub(crate) struct Folder(PathBuf);

impl Folder {
    pub(crate) fn new(name: &str) -> Self {
        let path =
            Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("{name}-{}", std::process::id()));
        let _ = fs::remove_dir_all(&path);
        fs::create_dir_all(&path).unwrap();
        Self(path)
    }

    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.0.join(name)
    }

    pub(crate) fn write(&self, name: &str, contents: &str) {
        fs::write(self.path(name), contents).unwrap();
    }

    /// Names of everything in the folder, hidden files included.
    pub(crate) fn names(&self) -> Vec<String> {
        let entries = fs::read_dir(&self.0).unwrap();
        let mut names: Vec<String> = entries
            .map(|e| e.unwrap().file_name().to_string_lossy().into_owned())
            .collect();
        names.sort();
        names
    }

    /// A picture's pixels; files also say what they are of.
    pub(crate) fn pixels(&self, name: &str) -> Vec<u8> {
        image::open(self.path(name)).unwrap().to_rgba8().into_raw()
    }

    /// Runs `gnomon` here; arguments are separated by blanks.
    pub(crate) fn gnomon(&self, arguments: &str) -> Run {
        self.gnomon_with(arguments, &[])
    }

    /// The same with environment variables.
    pub(crate) fn gnomon_with(&self, arguments: &str, variables: &[(&str, &str)]) -> Run {
        let mut command = Command::new(env!("CARGO_BIN_EXE_gnomon"));
        command.args(arguments.split_whitespace());
        self.run(command.envs(variables.iter().copied()), arguments)
    }

    /// The same with no more than `kib` KiB of addresses, as `ulimit -v` gives.
    pub(crate) fn gnomon_within(&self, arguments: &str, kib: u32) -> Run {
        let mut command = Command::new("sh");
        let line = r#"ulimit -v "$1" && shift && exec "$@""#;
        let limit = kib.to_string();
        command.args(["-c", line, "sh", &limit, env!("CARGO_BIN_EXE_gnomon")]);
        command.args(arguments.split_whitespace());
        self.run(&mut command, arguments)
    }

    fn run(&self, command: &mut Command, arguments: &str) -> Run {
        let output = command.current_dir(&self.0).output().unwrap();
        Run {
            arguments: arguments.to_owned(),
            output,
        }
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

/// A finished run.
pub(crate) struct Run {
    arguments: String,
    output: Output,
}

impl Run {
    pub(crate) fn stdout(&self) -> String {
        String::from_utf8(self.output.stdout.clone()).unwrap()
    }

    /// Stdout as it is.
    pub(crate) fn bytes(&self) -> &[u8] {
        &self.output.stdout
    }

    pub(crate) fn stderr(&self) -> String {
        String::from_utf8(self.output.stderr.clone()).unwrap()
    }

    pub(crate) fn code(&self) -> i32 {
        self.output.status.code().expect("no signal")
    }

    /// Asserts exit code 0.
    pub(crate) fn fine(self) -> Self {
        assert_eq!(
            self.output.status.code(),
            Some(0),
            "{}\n{}",
            self.arguments,
            self.stderr()
        );
        self
    }

    /// Asserts exit code 0, or 2 with `message`.
    pub(crate) fn fine_or_refused(self, message: &str) {
        if self.output.status.code() == Some(0) {
            return;
        }
        self.refused(&[message]);
    }

    /// Asserts exit code 2, an empty stdout, no panic, and `parts` in the message.
    pub(crate) fn refused(self, parts: &[&str]) {
        let message = self.stderr();
        assert_eq!(
            self.output.status.code(),
            Some(2),
            "{}\n{message}",
            self.arguments
        );
        assert!(self.stdout().is_empty(), "{}", self.arguments);
        assert!(
            message.starts_with("error: ") && !message.contains("panicked"),
            "{message}"
        );
        for part in parts {
            assert!(
                message.contains(part),
                "{}: no `{part}` in: {message}",
                self.arguments
            );
        }
    }

    /// Stdout as one JSON document.
    pub(crate) fn json(self) -> Value {
        let run = self.fine();
        serde_json::from_str(&run.stdout()).unwrap_or_else(|e| panic!("{}: {e}", run.arguments))
    }
}
