//! Files that appear whole or not at all.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use gnomon_pipeline::world::files::temporary_name;

use crate::error::CliError;

/// Files written under temporary names, renamed together by [`Batch::commit`].
/// Dropped without it, a batch leaves nothing behind.
#[derive(Debug, Default)]
pub(crate) struct Batch {
    staged: Vec<Staged>,
    made_folders: Vec<PathBuf>,
}

#[derive(Debug)]
struct Staged {
    temporary: PathBuf,
    target: PathBuf,
}

impl Batch {
    /// Writes `bytes` beside `target`, making its folder where there is none.
    pub(crate) fn stage(&mut self, target: &Path, bytes: &[u8]) -> Result<(), CliError> {
        let failed = |source| CliError::Write {
            path: target.to_owned(),
            source,
        };
        check_target(target)?;
        self.check_new(target)?;
        self.make_folder(folder_of(target)).map_err(failed)?;
        let temporary = temporary_name(target);
        let staged = Staged {
            temporary: temporary.clone(),
            target: target.to_owned(),
        };
        self.staged.push(staged);
        fs::write(&temporary, bytes).map_err(failed)
    }

    /// Renames all files to their targets.
    pub(crate) fn commit(mut self) -> Result<(), CliError> {
        let total = self.staged.len();
        for written in 0..total {
            let Staged { temporary, target } = &self.staged[written];
            fs::rename(temporary, target).map_err(|source| match written {
                0 => CliError::Write {
                    path: target.clone(),
                    source,
                },
                _ => CliError::Rename {
                    path: target.clone(),
                    source,
                    written,
                    total,
                },
            })?;
        }
        self.staged.clear();
        self.made_folders.clear();
        Ok(())
    }

    /// One of two files of a name would be lost.
    fn check_new(&self, target: &Path) -> Result<(), CliError> {
        if self.staged.iter().all(|s| s.target != target) {
            return Ok(());
        }
        Err(CliError::Write {
            path: target.to_owned(),
            source: io::Error::other("two files would have this name"),
        })
    }

    fn make_folder(&mut self, folder: &Path) -> io::Result<()> {
        let missing: Vec<&Path> = folder
            .ancestors()
            .take_while(|f| !f.as_os_str().is_empty() && !f.exists())
            .collect();
        for folder in missing.into_iter().rev() {
            match fs::create_dir(folder) {
                Ok(()) => self.made_folders.push(folder.to_owned()),
                // Another program may have been faster.
                Err(_) if folder.is_dir() => (),
                Err(error) => return Err(error),
            }
        }
        Ok(())
    }
}

impl Drop for Batch {
    fn drop(&mut self) {
        // Best effort: an error has been reported already.
        for staged in &self.staged {
            let _ = fs::remove_file(&staged.temporary);
        }
        for folder in self.made_folders.iter().rev() {
            let _ = fs::remove_dir(folder);
        }
    }
}

/// Refuses targets that can be told to be wrong before any work is done.
pub(crate) fn check_target(target: &Path) -> Result<(), CliError> {
    let wrong = |kind, what: &str| CliError::Write {
        path: target.to_owned(),
        source: io::Error::new(kind, what.to_owned()),
    };
    if target.file_name().is_none() {
        return Err(wrong(io::ErrorKind::InvalidInput, "it names no file"));
    }
    if target.is_dir() {
        return Err(wrong(io::ErrorKind::IsADirectory, "it is a folder"));
    }
    if target.exists() && !target.is_file() {
        let what = "it is no regular file, and would be replaced by one";
        return Err(wrong(io::ErrorKind::InvalidInput, what));
    }
    let nearest = folder_of(target).ancestors().find(|f| f.exists());
    match nearest {
        Some(found) if !found.is_dir() => Err(wrong(
            io::ErrorKind::NotADirectory,
            &format!("{} is not a folder", found.display()),
        )),
        Some(found) => probe(found).map_err(|source| CliError::Write {
            path: target.to_owned(),
            source,
        }),
        None => Ok(()),
    }
}

/// Whether a file can be made in a folder: it is, and removed again.
fn probe(folder: &Path) -> io::Result<()> {
    let place = temporary_name(&folder.join("probe"));
    fs::write(&place, b"")?;
    fs::remove_file(&place)
}

/// Refuses a target of another kind of file.
pub(crate) fn check_extension(
    flag: &'static str,
    target: &Path,
    extension: &str,
) -> Result<(), CliError> {
    check_extensions(flag, target, &[extension])
}

/// The same of several kinds.
pub(crate) fn check_extensions(
    flag: &'static str,
    target: &Path,
    extensions: &[&str],
) -> Result<(), CliError> {
    let given = target.extension().unwrap_or_default();
    if extensions.iter().any(|e| given.eq_ignore_ascii_case(e)) {
        return check_target(target);
    }
    Err(CliError::Flag {
        flag,
        value: target.display().to_string(),
        valid: format!(
            "expected a file name that ends in .{}",
            extensions.join(" or .")
        ),
    })
}

/// Refuses a folder that is a file, or that is called like a picture.
pub(crate) fn check_folder(flag: &'static str, folder: &Path) -> Result<(), CliError> {
    let extension = folder.extension().unwrap_or_default();
    if folder.is_file() || extension.eq_ignore_ascii_case("png") {
        return Err(CliError::Flag {
            flag,
            value: folder.display().to_string(),
            valid: "expected the name of a folder".to_owned(),
        });
    }
    check_target(&folder.join("frame-0000.png"))
}

fn folder_of(target: &Path) -> &Path {
    match target.parent() {
        Some(p) if !p.as_os_str().is_empty() => p,
        _ => Path::new("."),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scratch(name: &str) -> PathBuf {
        let folder = std::env::temp_dir().join(format!("gnomon-{}-{name}", std::process::id()));
        let _ = fs::remove_dir_all(&folder);
        folder
    }

    #[test]
    fn a_dropped_batch_leaves_nothing() {
        let folder = scratch("dropped");
        let mut batch = Batch::default();
        batch.stage(&folder.join("a/b.txt"), b"x").unwrap();
        assert!(folder.join("a").is_dir() && !folder.join("a/b.txt").exists());
        drop(batch);
        assert!(!folder.exists());
    }

    #[test]
    fn a_committed_batch_leaves_the_targets_only() {
        let folder = scratch("committed");
        let mut batch = Batch::default();
        batch.stage(&folder.join("b.txt"), b"x").unwrap();
        batch.stage(&folder.join("c.txt"), b"y").unwrap();
        batch.commit().unwrap();
        assert_eq!(fs::read(folder.join("c.txt")).unwrap(), b"y");
        assert_eq!(fs::read_dir(&folder).unwrap().count(), 2);
        fs::remove_dir_all(&folder).unwrap();
    }

    #[test]
    fn names_of_any_length_are_written_whole() {
        let folder = scratch("long");
        let target = folder.join(format!("{}.png", "n".repeat(251)));
        let mut batch = Batch::default();
        batch.stage(&target, b"x").unwrap();
        batch.commit().unwrap();
        assert_eq!(fs::read(&target).unwrap(), b"x");
        fs::remove_dir_all(&folder).unwrap();
    }

    #[test]
    fn one_name_is_not_taken_twice() {
        let folder = scratch("twice");
        let mut batch = Batch::default();
        batch.stage(&folder.join("a.png"), b"x").unwrap();
        let message = batch.stage(&folder.join("a.png"), b"y").unwrap_err();
        assert!(message.to_string().contains("two files"), "{message}");
        drop(batch);
        assert!(!folder.exists());
    }

    /// The rest is not left under temporary names, and what is there is told.
    #[test]
    fn a_commit_that_fails_says_how_far_it_came() {
        let folder = scratch("half");
        let mut batch = Batch::default();
        for name in ["a", "b", "c"] {
            batch.stage(&folder.join(name), b"x").unwrap();
        }
        fs::create_dir_all(folder.join("b/full")).unwrap();
        let message = batch.commit().unwrap_err().to_string();
        assert!(message.contains("1 of 3"), "{message}");
        let mut names: Vec<_> = fs::read_dir(&folder)
            .unwrap()
            .map(|e| e.unwrap().file_name())
            .collect();
        names.sort();
        assert_eq!(names, ["a", "b"]);
        fs::remove_dir_all(&folder).unwrap();
    }

    #[test]
    fn folders_and_wrong_kinds_are_refused() {
        assert!(check_target(&std::env::temp_dir()).is_err());
        let message = check_extension("--out", Path::new("a.jpg"), "png")
            .unwrap_err()
            .to_string();
        assert!(message.contains("a.jpg") && message.contains(".png"));
        assert!(check_extension("--out", Path::new("a.PNG"), "png").is_ok());
    }
}
