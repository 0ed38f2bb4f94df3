//! Typed errors: each carries the value met and says what would be right.

use thiserror::Error;

/// Why positions and triangles do not make a [`crate::mesh::Mesh`].
#[derive(Clone, Debug, Error, PartialEq)]
pub enum MeshError {
    /// A coordinate is NaN or infinite.
    #[error("vertex {vertex} is {value:?}; every coordinate must be a finite number")]
    NonFinitePosition {
        /// Index of the vertex.
        vertex: usize,
        /// Its coordinates.
        value: [f32; 3],
    },
    /// A triangle names a vertex that does not exist.
    #[error("triangle {triangle} uses vertex {index}, but there are {vertices} vertices (0-based)")]
    IndexOutOfRange {
        /// Index of the triangle.
        triangle: usize,
        /// The vertex index it uses.
        index: u32,
        /// Number of vertices.
        vertices: usize,
    },
    /// Too many vertices for 32-bit indices of a shadow volume.
    #[error("{count} vertices; at most {limit} fit the 32-bit indices of a shadow volume")]
    TooManyVertices {
        /// Vertices given.
        count: usize,
        /// Vertices allowed.
        limit: usize,
    },
}

/// A built-in scene name that does not exist.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[error("no built-in scene is called '{name}'{}; there are: {}", suggestion(.nearest), .known.join(", "))]
pub struct UnknownScene {
    /// The name asked for.
    pub name: String,
    /// The closest known name, when one is close.
    pub nearest: Option<&'static str>,
    /// All known names.
    pub known: Vec<&'static str>,
}

fn suggestion(nearest: &Option<&'static str>) -> String {
    nearest.map_or(String::new(), |n| format!(" (did you mean '{n}'?)"))
}
