//! What ends the program early, and with which exit code.

use std::path::PathBuf;

use gnomon_claims::{ReproduceError, UnknownClaim};
use gnomon_pipeline::measure::comparison::CompareError;
use gnomon_pipeline::measure::render::RenderError;
use gnomon_pipeline::measure::visibility_sum::SumError;
use gnomon_pipeline::technique::TechniqueError;
use gnomon_pipeline::truth::metrics::MetricError;
use gnomon_pipeline::world::scene::SceneError;
use gnomon_traces::TraceError;
use gnomon_traces::history::HistoryError;
use gnomon_traces::profile::ProfileError;
use thiserror::Error;

/// Why a verb did not finish.
#[derive(Debug, Error)]
pub(crate) enum CliError {
    /// The scene cannot be had.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// The technique or a parameter is wrong.
    #[error(transparent)]
    Technique(#[from] TechniqueError),
    /// The scene cannot be rendered so.
    #[error(transparent)]
    Render(#[from] RenderError),
    /// There is no truth to compare with.
    #[error(transparent)]
    Compare(#[from] CompareError),
    /// The pictures cannot be compared.
    #[error(transparent)]
    Metric(#[from] MetricError),
    /// There is no such claim.
    #[error(transparent)]
    Claim(#[from] UnknownClaim),
    /// A claim cannot be measured.
    #[error(transparent)]
    Reproduce(#[from] ReproduceError),
    /// A pixel has no history.
    #[error(transparent)]
    History(#[from] HistoryError),
    /// A trace cannot be had, written or replayed.
    #[error(transparent)]
    Trace(#[from] TraceError),
    /// A replay is not what was recorded.
    #[error("{0}")]
    ReplayDiffers(String),
    /// A profile cannot be read.
    #[error(transparent)]
    Profile(#[from] ProfileError),
    /// A flag's value is wrong.
    #[error("{flag} is `{value}`; {valid}")]
    Flag {
        /// The flag.
        flag: &'static str,
        /// What was given.
        value: String,
        /// What would be valid.
        valid: String,
    },
    /// A file cannot be written.
    #[error("{}: cannot be written: {source}; nothing was written", .path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
    /// A file cannot be put in its place, others are already.
    #[error(
        "{}: cannot be written: {source}; {written} of {total} files were written before it",
        .path.display()
    )]
    Rename {
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: std::io::Error,
        /// Files that are in their places.
        written: usize,
        /// Files that should be.
        total: usize,
    },
    /// Worker threads cannot be had.
    #[error("threads cannot be started: {0}")]
    Threads(#[from] rayon::ThreadPoolBuildError),
    /// An environment variable's value is wrong.
    #[error("the environment variable {name} is `{value}`; {valid}")]
    Variable {
        /// The variable.
        name: &'static str,
        /// What it was set to.
        value: String,
        /// What would be valid.
        valid: String,
    },
    /// Standard output cannot be written, other than by a closed pipe.
    #[error("standard output cannot be written: {0}")]
    Stdout(std::io::Error),
    /// There is no terminal to draw on.
    #[error(
        "`view` draws on a terminal, and stdout is none; `gnomon render` takes the same flags \
         and writes the picture to a file"
    )]
    NoTerminal,
    /// The terminal cannot be used.
    #[error("the terminal cannot be used: {0}")]
    Terminal(std::io::Error),
    /// Something of a suite of measurements is wrong, at a flag or a line.
    #[error("{place}: {problem}")]
    Suite {
        /// The flag, or file and line.
        place: String,
        /// What is wrong, and what would be valid.
        problem: String,
    },
    /// Results of measurements cannot be used.
    #[error("{}: {problem}", .path.display())]
    Results {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        problem: String,
    },
    /// Something of a trace cannot be had.
    #[error("{}: {source}", .path.display())]
    InTrace {
        /// The file.
        path: PathBuf,
        /// What.
        source: TraceError,
    },
    /// No cause of a difference is found.
    #[error(transparent)]
    Bisect(#[from] gnomon_traces::BisectError),
    /// A light's visibility is not added up from edges.
    #[error(transparent)]
    Sum(#[from] SumError),
    /// The GPU refuses a frame.
    #[error(transparent)]
    Gpu(#[from] gnomon_raster::Error),
    /// What was compared is different, which has been said.
    #[error("different")]
    Differs,
    /// A check of our own failed: a fault of the program or the machine.
    #[error("check failed: {0}")]
    Check(String),
}

impl CliError {
    /// 1 for a failed check, 2 for bad input.
    pub(crate) fn exit_code(&self) -> u8 {
        match self {
            Self::Check(_)
            | Self::Differs
            | Self::ReplayDiffers(_)
            | Self::History(HistoryError::Broken { .. }) => 1,
            _ => 2,
        }
    }
}
