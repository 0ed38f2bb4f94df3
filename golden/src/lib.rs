//! Bit-exact tests of frames, for whoever renders with `gnomon-raster`.
//!
//! [`assert_frame!`] draws a [`Recording`] and compares every attachment and every
//! counter with files that are committed beside the tests: `NAME.golden`, hashes and
//! counters as text, which decides, and a PNG of each result, which people look at.
//!
//! * Where something differs the test fails and shows the first draw and the first tile
//!   of 64×64 pixels that do, the first pixel with its history, and where expected,
//!   difference and actual pictures lie.
//! * Where there is no golden the test fails.
//! * With `GNOMON_BLESS=1` the files are written and the test fails all the same, so that
//!   no run is green that compared nothing. Where `CI` is set nothing is ever written.
//!
//! A golden does not depend on threads, execution tile, SIMD level or build profile:
//! neither do frames. Frames of closures can be tested as well as those of named shaders.
//!
//! # Finding the first draw
//!
//! A golden holds, for every draw, 32 bits for each tile of 64×64 pixels that it wrote:
//! a hash of what its events left in the blocks. A recorded trace would tell more, but is
//! megabytes where this is kilobytes, needs the shaders to be named, and changes whenever
//! its format does. These bits find a place; equality is decided by 256 bits of every
//! image and by the counters in full.

mod compare;
mod counters;
mod describe;
mod measure;
mod picture;
mod text;

pub use measure::content_hash;

use std::fs;
use std::path::{Path, PathBuf};

use gnomon_raster::{Error, Recording};
use gnomon_traces::history::HistoryError;

use measure::Measured;

/// Draws a frame and compares it with the golden of that name in `tests/golden` of the
/// crate that is tested.
///
/// ```no_run
/// # use gnomon_raster::Recording;
/// # fn my_frame() -> Recording { Recording::default() }
/// gnomon_golden::assert_frame!("triangle", &my_frame());
/// ```
///
/// A GPU of your own is a recording too: `let mut frame = gpu.save()?; frame.list = list;`.
#[macro_export]
macro_rules! assert_frame {
    ($name:expr, $recording:expr) => {
        $crate::assert_golden(
            concat!(env!("CARGO_MANIFEST_DIR"), "/tests/golden"),
            option_env!("CARGO_TARGET_TMPDIR"),
            $name,
            $recording,
        )
    };
}

/// What [`assert_frame!`] calls: folders of goldens and of pictures of failures.
///
/// # Panics
/// The frame is not the golden, there is none, or it was written just now.
#[track_caller]
pub fn assert_golden(folder: &str, scratch: Option<&str>, name: &str, recording: &Recording) {
    let scratch = scratch.map_or_else(std::env::temp_dir, PathBuf::from);
    let golden = Golden {
        folder: folder.into(),
        scratch: scratch.join("golden"),
        mode: Mode::of_environment(),
    };
    if let Err(error) = golden.check(name, recording) {
        panic!("{error}");
    }
}

/// Whether goldens may be written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mode {
    /// Compare.
    Compare,
    /// Write what differs, and fail.
    Bless,
    /// Fail: asked to write where nobody looks at what is written.
    BlessInCi,
}

impl Mode {
    /// By `GNOMON_BLESS` and `CI`.
    #[must_use]
    pub fn of_environment() -> Self {
        let is_on = |name| std::env::var_os(name).is_some_and(|v| !v.is_empty() && v != "0");
        match (is_on("GNOMON_BLESS"), is_on("CI")) {
            (false, _) => Self::Compare,
            (true, false) => Self::Bless,
            (true, true) => Self::BlessInCi,
        }
    }
}

/// Where goldens lie, and what is done about them.
#[derive(Clone, Debug)]
pub struct Golden {
    /// The committed files.
    pub folder: PathBuf,
    /// Pictures of failures.
    pub scratch: PathBuf,
    /// Whether files may be written.
    pub mode: Mode,
}

/// Why a test fails.
#[derive(Debug, thiserror::Error)]
pub enum GoldenError {
    /// Nothing to compare with.
    #[error("{}: there is no golden; write it with GNOMON_BLESS=1, look at its pictures, and commit them", .0.display())]
    Missing(PathBuf),
    /// Written just now.
    #[error("{}: blessed; this run fails so that none passes that compared nothing: look at the pictures, and run again without GNOMON_BLESS", .0.display())]
    Blessed(PathBuf),
    /// Asked to write where `CI` is set.
    #[error(
        "GNOMON_BLESS is set together with CI: goldens are written by people who look at them; nothing was written"
    )]
    BlessInCi,
    /// The frame is another one.
    #[error("{0}")]
    Differs(String),
    /// The golden cannot be read as one.
    #[error("{}: line {line}: {what}", .path.display())]
    Malformed {
        /// The file.
        path: PathBuf,
        /// Its line, from 1.
        line: usize,
        /// What is wrong, and what would be right.
        what: String,
    },
    /// A file.
    #[error("{}: {source}", .path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
    /// The frame cannot be drawn.
    #[error(transparent)]
    Gpu(#[from] Error),
    /// There is no history of the first pixel.
    #[error(transparent)]
    History(#[from] HistoryError),
}

impl Golden {
    /// Draws `recording` and compares it with the golden `name`.
    ///
    /// # Errors
    /// Anything but an equal golden.
    pub fn check(&self, name: &str, recording: &Recording) -> Result<(), GoldenError> {
        if self.mode == Mode::BlessInCi {
            return Err(GoldenError::BlessInCi);
        }
        let path = self.folder.join(format!("{name}.golden"));
        let actual = Measured::of(recording)?;
        let text = text::write(&actual.frame);
        match read_if_there(&path)? {
            Some(golden) if golden == text => return Ok(()),
            None if self.mode == Mode::Compare => return Err(GoldenError::Missing(path)),
            Some(golden) if self.mode == Mode::Compare => {
                let expected = text::read(&path, &golden)?;
                let difference = compare::first_difference(&expected, &actual.frame);
                let told = self.describe(name, recording, &actual, &difference)?;
                return Err(GoldenError::Differs(told));
            }
            _ => (),
        }
        self.bless(name, &path, &text, &actual)?;
        Err(GoldenError::Blessed(path))
    }

    /// Pictures first: a golden without its pictures would compare as whole.
    fn bless(
        &self,
        name: &str,
        path: &Path,
        text: &str,
        actual: &Measured,
    ) -> Result<(), GoldenError> {
        make_folder(&self.folder)?;
        for shown in &actual.shown {
            let png = self.picture(name, &shown.name);
            picture::write(&png, &shown.picture)?;
        }
        fs::write(path, text).map_err(|source| failed(path, source))
    }

    /// The committed picture of a result.
    fn picture(&self, name: &str, result: &str) -> PathBuf {
        self.folder.join(format!("{name}-{result}.png"))
    }
}

fn read_if_there(path: &Path) -> Result<Option<String>, GoldenError> {
    match fs::read_to_string(path) {
        Ok(text) => Ok(Some(text)),
        Err(e) if e.kind() == std::io::ErrorKind::NotFound => Ok(None),
        Err(source) => Err(failed(path, source)),
    }
}

fn make_folder(folder: &Path) -> Result<(), GoldenError> {
    fs::create_dir_all(folder).map_err(|source| failed(folder, source))
}

fn failed(path: &Path, source: std::io::Error) -> GoldenError {
    GoldenError::File {
        path: path.to_owned(),
        source,
    }
}
