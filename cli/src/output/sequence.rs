//! Files that are put in their places one after the other, as they are done.

use std::path::{Path, PathBuf};

use super::files::{Batch, check_target};
use crate::error::CliError;

/// Files to come. Each appears whole; of those behind one that fails none appears.
pub(crate) struct Sequence {
    targets: Vec<PathBuf>,
    written: usize,
}

impl Sequence {
    /// Checks all targets before anything is made.
    ///
    /// # Errors
    /// One cannot be written, or two are one.
    pub(crate) fn new<'a>(targets: impl IntoIterator<Item = &'a Path>) -> Result<Self, CliError> {
        let targets: Vec<PathBuf> = targets.into_iter().map(Path::to_owned).collect();
        for (number, target) in targets.iter().enumerate() {
            check_target(target)?;
            if targets[..number].contains(target) {
                return Err(CliError::Write {
                    path: target.clone(),
                    source: std::io::Error::other("two files would have this name"),
                });
            }
        }
        Ok(Self {
            targets,
            written: 0,
        })
    }

    /// Puts the next file, which is one of the targets, in its place.
    ///
    /// # Errors
    /// It cannot be written: the error says how many are there.
    pub(crate) fn put(&mut self, target: &Path, bytes: &[u8]) -> Result<(), CliError> {
        let mut batch = Batch::default();
        let put = batch.stage(target, bytes).and_then(|()| batch.commit());
        put.map_err(|error| self.told(error))?;
        self.written += 1;
        Ok(())
    }

    /// What went wrong, with what is written.
    fn told(&self, error: CliError) -> CliError {
        match error {
            CliError::Write { path, source } if self.written > 0 => CliError::Rename {
                path,
                source,
                written: self.written,
                total: self.targets.len(),
            },
            other => other,
        }
    }
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    #[test]
    fn files_appear_one_by_one_and_what_is_there_is_told() {
        let name = format!("gnomon-sequence-{}", std::process::id());
        let folder = std::env::temp_dir().join(name);
        let _ = fs::remove_dir_all(&folder);
        let paths = ["a", "b", "c"].map(|n| folder.join(n));
        let twice = [&paths[0], &paths[1], &paths[0]].map(PathBuf::as_path);
        let refused = Sequence::new(twice).err().unwrap().to_string();
        assert!(
            refused.contains("two files") && refused.contains("nothing was"),
            "{refused}"
        );
        let mut files = Sequence::new(paths.iter().map(PathBuf::as_path)).unwrap();
        assert!(!folder.exists());
        files.put(&paths[0], b"x").unwrap();
        assert_eq!(fs::read(&paths[0]).unwrap(), b"x");
        fs::create_dir(&paths[1]).unwrap();
        let message = files.put(&paths[1], b"y").unwrap_err().to_string();
        assert!(message.contains("1 of 3 files were written"), "{message}");
        assert_eq!(
            fs::read_dir(&folder).unwrap().count(),
            2,
            "no half file is left"
        );
        fs::remove_dir_all(&folder).unwrap();
    }
}
