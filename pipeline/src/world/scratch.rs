//! Folders of single tests.

use std::fs;
use std::ops::Deref;
use std::path::{Path, PathBuf};

/// A place for a folder of one test alone, removed at its end.
pub(crate) struct Scratch(PathBuf);

impl Scratch {
    /// Nothing is there yet.
    pub(crate) fn new(test: &str) -> Self {
        let name = format!("gnomon-{}-{test}", std::process::id());
        let path = std::env::temp_dir().join(name);
        let _ = fs::remove_dir_all(&path); // left over from a crash
        Self(path)
    }

    /// An empty folder.
    pub(crate) fn made(test: &str) -> Self {
        let new = Self::new(test);
        fs::create_dir_all(&new.0).unwrap();
        new
    }
}

impl Deref for Scratch {
    type Target = Path;

    fn deref(&self) -> &Path {
        &self.0
    }
}

impl Drop for Scratch {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}
