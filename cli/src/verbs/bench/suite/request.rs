//! What was asked for, not yet judged.

use std::path::PathBuf;

use gnomon_pipeline::measure::comparison::ReferenceKind;
use gnomon_pipeline::world::files::Outside;

use crate::error::CliError;

/// A value and where it was given: a flag, or a file's line.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Given<T> {
    pub(crate) value: T,
    pub(crate) place: String,
}

impl<T> Given<T> {
    /// Given at `place`.
    pub(crate) fn new(value: T, place: &str) -> Self {
        Self {
            value,
            place: place.to_owned(),
        }
    }

    /// What is wrong with it.
    pub(crate) fn wrong(&self, problem: impl std::fmt::Display) -> CliError {
        CliError::Suite {
            place: self.place.clone(),
            problem: problem.to_string(),
        }
    }
}

/// A suite as it was written.
#[derive(Clone, Debug)]
pub(crate) struct Request {
    pub(crate) name: String,
    /// Built-in names, scene files or models.
    pub(crate) scenes: Vec<Given<String>>,
    /// `NAME:KEY=V1|V2:...`, or `all`.
    pub(crate) techniques: Vec<Given<String>>,
    pub(crate) sizes: Vec<[u32; 2]>,
    /// 0 stands for as many as the program has.
    pub(crate) threads: Vec<usize>,
    pub(crate) repeat: u32,
    pub(crate) light: Given<usize>,
    pub(crate) time: f64,
    pub(crate) reference: ReferenceKind,
    /// Where names of files begin.
    pub(crate) folder: PathBuf,
    pub(crate) outside: Outside,
}
