//! What can be wrong with a glTF file.

use thiserror::Error;

use crate::world::files::FileError;

/// Why a glTF file could not be used. Displays as `file: place: problem`.
#[derive(Debug, Error)]
#[error("{file}: {}{problem}", before(.place))]
pub struct GltfError {
    /// File as given by the caller.
    pub file: String,
    /// Place in the JSON, such as `meshes[0].primitives[1]`; empty for the whole file.
    pub place: String,
    /// What is wrong.
    #[source]
    pub problem: GltfProblem,
}

fn before(place: &str) -> String {
    if place.is_empty() {
        String::new()
    } else {
        format!("{place}: ")
    }
}

/// What is wrong with a glTF file, with the value met and what would be valid.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum GltfProblem {
    /// A file could not be read.
    #[error(transparent)]
    File(#[from] FileError),
    /// A `.glb` that is none.
    #[error("{what}; expected a binary glTF of version 2, whole")]
    BadContainer {
        /// What is wrong.
        what: String,
    },
    /// Not the JSON of a glTF file.
    #[error("the JSON is not valid: {0}")]
    Json(#[from] serde_json::Error),
    /// JSON that would take far more memory than its bytes.
    #[error(
        "the JSON has {count} bytes that are '{{' or ','; valid is at most {limit}: \
         put numbers into a buffer"
    )]
    TooMuchJson {
        /// How many it has.
        count: usize,
        /// The most that is read.
        limit: usize,
    },
    /// A version that is not read.
    #[error("version is '{version}'; version 2 is read")]
    Version {
        /// As written.
        version: String,
    },
    /// The file says that it cannot be drawn without it.
    #[error("the file requires the extension '{name}', which is not supported; supported are {}", super::SUPPORTED.join(", "))]
    Extension {
        /// Its name.
        name: String,
    },
    /// A number of something that there is not.
    #[error("{index} is none of the {count} {what}, counted from 0")]
    NoSuch {
        /// `accessors`, `nodes` and so on.
        what: &'static str,
        /// As written.
        index: usize,
        /// How many there are.
        count: usize,
    },
    /// A value that is not valid.
    #[error("{what} is {value}; valid is {valid}")]
    Bad {
        /// Name of the value.
        what: &'static str,
        /// As written.
        value: String,
        /// What would be valid.
        valid: &'static str,
    },
    /// Something that must be there.
    #[error("{what} is missing")]
    Missing {
        /// What.
        what: &'static str,
    },
    /// Bytes that lie outside their buffer or view.
    #[error("bytes up to {end} are wanted of {of}, which has {length}")]
    TooShort {
        /// What is too short.
        of: &'static str,
        /// End of the bytes wanted.
        end: u64,
        /// Bytes there are.
        length: u64,
    },
    /// A node with two parents, or that is its own ancestor.
    #[error("the node is met twice; nodes form a forest")]
    NotATree,
    /// More than is drawn of one file.
    #[error("the file has more than {limit} {what} where all its nodes are drawn")]
    TooMuch {
        /// `vertices` or `triangles`.
        what: &'static str,
        /// The most that is drawn.
        limit: u64,
    },
    /// No triangles at all.
    #[error("no triangles; expected a node with a mesh that has some")]
    NoFaces,
}

/// A problem, and where it is in the JSON.
#[derive(Debug)]
pub(super) struct Located {
    pub(super) place: String,
    pub(super) problem: GltfProblem,
}

/// What may go wrong at a place.
pub(super) type Checked<T> = Result<T, Located>;

impl GltfProblem {
    pub(super) fn at(self, place: impl Into<String>) -> Located {
        Located {
            place: place.into(),
            problem: self,
        }
    }
}

/// Element `index` of a list of the file called `what`, which `place` names.
pub(super) fn element<'a, T>(
    list: &'a [T],
    index: usize,
    what: &'static str,
    place: &str,
) -> Checked<&'a T> {
    list.get(index).ok_or_else(|| {
        GltfProblem::NoSuch {
            what,
            index,
            count: list.len(),
        }
        .at(place)
    })
}
