//! Files that appear whole or not at all.

use std::ffi::OsString;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

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
        for staged in std::mem::take(&mut self.staged) {
            fs::rename(&staged.temporary, &staged.target).map_err(|source| CliError::Write {
                path: staged.target.clone(),
                source,
            })?;
        }
        self.made_folders.clear();
        Ok(())
    }

    fn make_folder(&mut self, folder: &Path) -> io::Result<()> {
        let missing: Vec<&Path> = folder
            .ancestors()
            .take_while(|f| !f.as_os_str().is_empty() && !f.exists())
            .collect();
        for folder in missing.into_iter().rev() {
            fs::create_dir(folder)?;
            self.made_folders.push(folder.to_owned());
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
    let nearest = folder_of(target).ancestors().find(|f| f.exists());
    match nearest {
        Some(found) if !found.is_dir() => Err(wrong(
            io::ErrorKind::NotADirectory,
            &format!("{} is not a folder", found.display()),
        )),
        _ => Ok(()),
    }
}

/// Refuses a target of another kind of file.
pub(crate) fn check_extension(
    flag: &'static str,
    target: &Path,
    extension: &str,
) -> Result<(), CliError> {
    let given = target.extension().unwrap_or_default();
    if given.eq_ignore_ascii_case(extension) {
        return check_target(target);
    }
    Err(CliError::Flag {
        flag,
        value: target.display().to_string(),
        valid: format!("expected a file name that ends in .{extension}"),
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

fn temporary_name(target: &Path) -> PathBuf {
    let mut name = OsString::from(".");
    name.push(target.file_name().unwrap_or_default());
    name.push(format!(".{}.part", std::process::id()));
    target.with_file_name(name)
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
    fn folders_and_wrong_kinds_are_refused() {
        assert!(check_target(&std::env::temp_dir()).is_err());
        let message = check_extension("--out", Path::new("a.jpg"), "png")
            .unwrap_err()
            .to_string();
        assert!(message.contains("a.jpg") && message.contains(".png"));
        assert!(check_extension("--out", Path::new("a.PNG"), "png").is_ok());
    }
}
