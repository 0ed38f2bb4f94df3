//! Reading files that a user names, and files that those name in turn; writing them whole.
//!
//! Only regular files are read, and never more than a limit: a device has no end,
//! and a pipe may never answer. What a scene or a model names must lie in the
//! folder of the file that the user named, links followed, unless the user allows
//! more: a scene from elsewhere must not show what else is on the machine.

use std::fs::{File, Metadata, OpenOptions};
use std::io::{self, Read as _, Write as _};
use std::path::{Component, Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};

use thiserror::Error;

/// Why a file was not read.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum FileError {
    /// The system does not give it.
    #[error("cannot be read: {0}")]
    Unreadable(#[from] io::Error),
    /// Not a file of bytes on a disk.
    #[error("is a {kind}; only regular files are read")]
    NotRegular {
        /// What it is.
        kind: &'static str,
    },
    /// Longer than what makes sense.
    #[error("is longer than {limit} bytes, the most that is read of such a file")]
    TooLong {
        /// Bytes that are read at most.
        limit: u64,
    },
    /// Not in the folder of the file that names it.
    #[error(
        "lies outside the folder '{}' of the file that the user named; allow it with --allow-outside",
        .folder.display()
    )]
    Outside {
        /// The folder.
        folder: PathBuf,
    },
}

/// Whether files may lie outside the folder of the scene that names them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Outside {
    /// They are not opened.
    #[default]
    Refused,
    /// They are read like others.
    Allowed,
}

/// The folder of a scene, in which what it names must lie.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SceneFolder {
    path: PathBuf,
    outside: Outside,
}

impl SceneFolder {
    /// The folder at `path`.
    pub fn new(path: impl Into<PathBuf>, outside: Outside) -> Self {
        Self {
            path: path.into(),
            outside,
        }
    }

    /// The folder that holds `file`.
    pub fn of(file: &Path, outside: Outside) -> Self {
        Self::new(file.parent().unwrap_or(Path::new("")), outside)
    }

    /// The path of what a file in this folder calls `name`.
    pub fn join(&self, name: &str) -> PathBuf {
        self.path.join(name)
    }

    /// At most `limit` bytes of the file at `path`.
    ///
    /// # Errors
    /// See [`FileError`].
    pub fn read(&self, path: &Path, limit: u64) -> Result<Vec<u8>, FileError> {
        self.check(path)?;
        read(path, limit)
    }

    /// Refuses what is not in the folder. A path that leads out by its own words is
    /// not even looked at.
    ///
    /// # Errors
    /// See [`FileError`].
    pub fn check(&self, path: &Path) -> Result<(), FileError> {
        if self.outside == Outside::Allowed {
            return Ok(());
        }
        let outside = || FileError::Outside {
            folder: self.path.clone(),
        };
        let folder = if self.path.as_os_str().is_empty() {
            Path::new(".")
        } else {
            &self.path
        };
        let whole = std::fs::canonicalize(folder)?;
        let words = plain(&std::path::absolute(path)?);
        let own = plain(&std::path::absolute(folder)?);
        if !words.starts_with(own) && !words.starts_with(&whole) {
            return Err(outside());
        }
        if std::fs::canonicalize(path)?.starts_with(whole) {
            Ok(())
        } else {
            Err(outside())
        }
    }
}

/// An absolute path without `.` and `..`, by its words alone.
fn plain(path: &Path) -> PathBuf {
    let mut plain = PathBuf::new();
    for component in path.components() {
        match component {
            Component::CurDir => {}
            Component::ParentDir => {
                plain.pop();
            }
            other => plain.push(other),
        }
    }
    plain
}

/// At most `limit` bytes of the regular file at `path`.
///
/// # Errors
/// See [`FileError`].
pub fn read(path: &Path, limit: u64) -> Result<Vec<u8>, FileError> {
    // Opening a pipe may wait, and opening a device may do something.
    let expected = check(&std::fs::metadata(path)?, limit)?;
    let file = open(path)?;
    check(&file.metadata()?, limit)?;
    let mut bytes = Vec::new();
    bytes
        .try_reserve_exact(expected as usize)
        .map_err(|_| io::Error::from(io::ErrorKind::OutOfMemory))?;
    // Files may grow, and those of some file systems say that they are empty.
    file.take(limit + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > limit {
        return Err(FileError::TooLong { limit });
    }
    Ok(bytes)
}

/// The length of a regular file.
fn check(metadata: &Metadata, limit: u64) -> Result<u64, FileError> {
    if !metadata.is_file() {
        return Err(FileError::NotRegular {
            kind: kind(metadata),
        });
    }
    if metadata.len() > limit {
        return Err(FileError::TooLong { limit });
    }
    Ok(metadata.len())
}

#[cfg(unix)]
fn kind(metadata: &Metadata) -> &'static str {
    use std::os::unix::fs::FileTypeExt as _;
    let kind = metadata.file_type();
    match () {
        () if kind.is_dir() => "folder",
        () if kind.is_fifo() => "pipe",
        () if kind.is_socket() => "socket",
        () if kind.is_char_device() || kind.is_block_device() => "device",
        () => "special file",
    }
}

#[cfg(not(unix))]
fn kind(metadata: &Metadata) -> &'static str {
    if metadata.is_dir() {
        "folder"
    } else {
        "special file"
    }
}

/// Opens without waiting for a pipe's other end, should one have taken the place
/// of the file since it was looked at.
#[cfg(all(
    target_os = "linux",
    any(
        target_arch = "x86_64",
        target_arch = "x86",
        target_arch = "aarch64",
        target_arch = "riscv64"
    )
))]
fn open(path: &Path) -> io::Result<File> {
    use std::os::unix::fs::OpenOptionsExt as _;
    /// As these systems' <fcntl.h> has it.
    const O_NONBLOCK: i32 = 0o4000;
    OpenOptions::new()
        .read(true)
        .custom_flags(O_NONBLOCK)
        .open(path)
}

#[cfg(not(all(
    target_os = "linux",
    any(
        target_arch = "x86_64",
        target_arch = "x86",
        target_arch = "aarch64",
        target_arch = "riscv64"
    )
)))]
fn open(path: &Path) -> io::Result<File> {
    OpenOptions::new().read(true).open(path)
}

/// Writes the file at `path`. It appears whole or not at all, whoever else writes it.
///
/// # Errors
/// What the system says. Nothing is left behind then.
pub fn write(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let part = temporary_name(path);
    let written = File::create_new(&part)
        .and_then(|mut file| file.write_all(bytes))
        .and_then(|()| std::fs::rename(&part, path));
    if written.is_err() {
        // The first error is the one to report.
        let _ = std::fs::remove_file(&part);
    }
    written
}

/// A name beside `target` that nobody else has, another thread neither; the target's own
/// might be too long to add to.
pub fn temporary_name(target: &Path) -> PathBuf {
    static NUMBER: AtomicUsize = AtomicUsize::new(0);
    let number = NUMBER.fetch_add(1, Ordering::Relaxed);
    target.with_file_name(format!(".gnomon-{}-{number}.part", std::process::id()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::world::scratch::Scratch;
    use std::fs;

    struct Folder(Scratch);

    impl Folder {
        fn new(name: &str) -> Self {
            let path = Scratch::new(&format!("files-{name}"));
            fs::create_dir_all(path.join("scene/parts")).unwrap();
            fs::write(path.join("out.txt"), "secret").unwrap();
            fs::write(path.join("scene/in.txt"), "text").unwrap();
            Self(path)
        }

        fn scene(&self, outside: Outside) -> SceneFolder {
            SceneFolder::new(self.0.join("scene"), outside)
        }
    }

    #[test]
    fn only_regular_files_up_to_the_limit_are_read() {
        let folder = Folder::new("limit");
        let file = folder.0.join("scene/in.txt");
        assert_eq!(read(&file, 4).unwrap(), b"text");
        let long = read(&file, 3).unwrap_err().to_string();
        assert!(long.contains("longer than 3 bytes"), "{long}");
        let folder = read(&folder.0, 100).unwrap_err().to_string();
        assert!(folder.contains("is a folder"), "{folder}");
        let sparse = file.with_extension("big");
        File::create(&sparse).unwrap().set_len(1 << 40).unwrap();
        assert!(matches!(
            read(&sparse, 1 << 30),
            Err(FileError::TooLong { .. })
        ));
    }

    #[test]
    fn threads_write_whole_files_beside_each_other() {
        let folder = Scratch::made("files-threads");
        // As long as names may be.
        let file = folder.join("n".repeat(255));
        std::thread::scope(|s| {
            for letter in *b"abcd" {
                let file = &file;
                s.spawn(move || {
                    for _ in 0..50 {
                        write(file, &[letter; 5000]).unwrap();
                    }
                });
            }
        });
        let bytes = fs::read(&file).unwrap();
        assert_eq!(bytes.len(), 5000);
        assert!(bytes.iter().all(|b| *b == bytes[0]));
        fs::remove_file(&file).unwrap();
        fs::create_dir_all(file.join("full")).unwrap();
        write(&file, b"x").unwrap_err();
        let left = fs::read_dir(&*folder).unwrap().count();
        assert_eq!(left, 1, "the folder alone");
    }

    #[test]
    fn what_is_outside_is_not_opened() {
        let folder = Folder::new("outside");
        let scene = folder.scene(Outside::Refused);
        let outcome = |name: &str| scene.read(&scene.join(name), 100);
        for inside in ["in.txt", "./parts/../in.txt", "parts/../../scene/in.txt"] {
            assert_eq!(outcome(inside).unwrap(), b"text", "{inside}");
        }
        let absolute = folder.0.join("scene/in.txt").display().to_string();
        assert_eq!(outcome(&absolute).unwrap(), b"text");
        // Whether such a file exists makes no difference.
        for outside in [
            "../out.txt",
            "../none.txt",
            "/etc/passwd",
            "/no/such/file",
            "/dev/zero",
        ] {
            let error = outcome(outside).unwrap_err().to_string();
            assert!(error.contains("--allow-outside"), "{outside}: {error}");
        }
        let allowed = folder.scene(Outside::Allowed);
        assert_eq!(
            allowed.read(&allowed.join("../out.txt"), 100).unwrap(),
            b"secret"
        );
    }

    #[cfg(unix)]
    #[test]
    fn links_are_followed_before_they_are_judged() {
        let folder = Folder::new("links");
        let scene = folder.scene(Outside::Refused);
        let link = |to: &str, at: &str| {
            std::os::unix::fs::symlink(folder.0.join(to), folder.0.join(at)).unwrap();
        };
        link("out.txt", "scene/leads-out.txt");
        link("scene/in.txt", "scene/stays.txt");
        link("scene", "other");
        assert!(matches!(
            scene.read(&scene.join("leads-out.txt"), 100),
            Err(FileError::Outside { .. })
        ));
        assert_eq!(scene.read(&scene.join("stays.txt"), 100).unwrap(), b"text");
        let by_link = SceneFolder::new(folder.0.join("other"), Outside::Refused);
        assert_eq!(by_link.read(&by_link.join("in.txt"), 100).unwrap(), b"text");
    }

    #[cfg(unix)]
    #[test]
    fn devices_and_sockets_are_named() {
        let device = read(Path::new("/dev/zero"), 100).unwrap_err().to_string();
        assert!(device.contains("is a device"), "{device}");
        let folder = Folder::new("socket");
        let path = folder.0.join("s");
        let _listener = std::os::unix::net::UnixListener::bind(&path).unwrap();
        let socket = read(&path, 100).unwrap_err().to_string();
        assert!(socket.contains("is a socket"), "{socket}");
    }
}
