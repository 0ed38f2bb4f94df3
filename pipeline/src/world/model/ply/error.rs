//! What can be wrong with a PLY file.

use thiserror::Error;

use crate::world::files::FileError;

/// Why a PLY file could not be used. Displays as `file: problem`.
#[derive(Debug, Error)]
#[error("{file}: {problem}")]
pub struct PlyError {
    /// File as given by the caller.
    pub file: String,
    /// What is wrong, with its place.
    #[source]
    pub problem: PlyProblem,
}

impl PlyError {
    pub(super) fn new(file: &str, problem: PlyProblem) -> Self {
        Self {
            file: file.to_owned(),
            problem,
        }
    }
}

/// What is wrong with a PLY file, with the value met and what would be valid.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum PlyProblem {
    /// The file could not be read.
    #[error(transparent)]
    File(#[from] FileError),
    /// Not a PLY file.
    #[error("begins with '{beginning}'; a PLY file begins with a line 'ply'")]
    NoPly {
        /// The first line, or its beginning.
        beginning: String,
    },
    /// No `end_header`.
    #[error("the header has no line 'end_header' in the first {searched} bytes")]
    NoEnd {
        /// Bytes looked through.
        searched: usize,
    },
    /// A line of the header that says nothing valid.
    #[error("line {line} of the header is '{text}'; expected {expected}")]
    BadHeader {
        /// Line, from 1.
        line: usize,
        /// The line met.
        text: String,
        /// What would be valid.
        expected: &'static str,
    },
    /// No element of that name, or not what it must have.
    #[error("{missing}; expected {expected}")]
    Lacks {
        /// What is missing.
        missing: &'static str,
        /// What would be valid.
        expected: &'static str,
    },
    /// More elements declared than there can be.
    #[error("the header declares {count} of '{element}', but only {left} bytes are left for them")]
    TooMany {
        /// Name of the element.
        element: String,
        /// As declared.
        count: u64,
        /// Bytes left.
        left: usize,
    },
    /// More than is drawn of one file.
    #[error(
        "{element} {number} is more than the {limit} {what} that are drawn of a file; valid is a smaller model"
    )]
    TooMuch {
        /// Name of the element.
        element: String,
        /// Its number, from 0.
        number: u64,
        /// `vertices`, `triangles` or `corners of one list`.
        what: &'static str,
        /// The most that is drawn.
        limit: u64,
    },
    /// The data end too early.
    #[error("the data end in {element} {number}, of which the header declares {count}")]
    Truncated {
        /// Name of the element.
        element: String,
        /// Its number, from 0.
        number: u64,
        /// As declared.
        count: u64,
    },
    /// A value that is no number.
    #[error("'{text}' in line {line} of the data is no number ({element} {number}, '{property}')")]
    NoNumber {
        /// The word met.
        text: String,
        /// Line of the data, from 1.
        line: usize,
        /// Name of the element.
        element: String,
        /// Its number, from 0.
        number: u64,
        /// The property.
        property: String,
    },
    /// A list whose length is no whole number.
    #[error(
        "the list '{property}' of {element} {number} has the length {length}; expected a whole number from 0"
    )]
    BadLength {
        /// Name of the element.
        element: String,
        /// Its number, from 0.
        number: u64,
        /// The property.
        property: String,
        /// As read.
        length: f64,
    },
    /// A coordinate that f32 cannot hold as a finite number.
    #[error(
        "vertex {number} has {axis} = {value}; every coordinate must be finite and below 3.4e38"
    )]
    NonFinite {
        /// Number of the vertex, from 0.
        number: usize,
        /// `x`, `y` or `z`.
        axis: char,
        /// As read.
        value: f64,
    },
    /// An index that can be none.
    #[error("{element} {number} uses vertex {index}; expected a whole number from 0")]
    BadIndex {
        /// Name of the element.
        element: String,
        /// Its number, from 0.
        number: u64,
        /// The index as read.
        index: f64,
    },
    /// An index of no vertex.
    #[error("{element} {number} uses vertex {index}, but there are {vertices}, counted from 0")]
    OutOfRange {
        /// `face` or `tristrips`.
        element: &'static str,
        /// Its number, from 0.
        number: u64,
        /// The index as read.
        index: u32,
        /// Vertices of the file.
        vertices: usize,
    },
    /// No face that covers anything.
    #[error(
        "no faces, and {points} points; expected an element 'face' with a list 'vertex_indices'"
    )]
    NoFaces {
        /// Vertices of the file.
        points: usize,
    },
}
