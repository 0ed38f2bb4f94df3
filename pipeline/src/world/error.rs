//! Typed errors: each carries the value met and says what would be right.

use thiserror::Error;

/// Why positions and triangles do not make a [`crate::world::mesh::Mesh`].
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

/// Why points do not make a [`crate::world::light::ConvexPolygon`].
#[derive(Clone, Debug, Error, PartialEq)]
pub enum PolygonError {
    /// Not enough points for an area.
    #[error("{count} vertices; a polygon has at least 3")]
    TooFewVertices {
        /// Vertices given.
        count: usize,
    },
    /// A coordinate is NaN or infinite.
    #[error("vertex {vertex} is {value:?}; every coordinate must be a finite number")]
    NonFinite {
        /// Index of the vertex.
        vertex: usize,
        /// Its coordinates.
        value: [f64; 3],
    },
    /// All points on one line, or too large for their area to be a number.
    #[error("the polygon's area is {area}; it must be above 0 and finite")]
    NoArea {
        /// The area found.
        area: f64,
    },
    /// A vertex is off the plane of the others.
    #[error("vertex {vertex} is {off} off the polygon's plane; a light polygon must be flat")]
    NotFlat {
        /// Index of the vertex.
        vertex: usize,
        /// Distance from the plane, scene units.
        off: f64,
    },
    /// The outline turns back on itself or crosses itself.
    #[error("the outline is not convex at vertex {vertex}; split it into convex polygons")]
    NotConvex {
        /// Index of the vertex.
        vertex: usize,
    },
}

/// A light that cannot be integrated over.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum LightError {
    /// A rectangle whose edges are parallel, a disc without normal or radius.
    #[error("the light's {what} is {value}; it must be above 0 and finite")]
    NoExtent {
        /// What vanishes: `area`, `normal` or `radius`.
        what: &'static str,
        /// Its size.
        value: f64,
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

/// " (did you mean ...?)", or nothing: the end of a message.
pub fn suggestion(nearest: &Option<&'static str>) -> String {
    nearest.map_or(String::new(), |n| format!(" (did you mean '{n}'?)"))
}

/// The known name with the fewest edits from `name`, if few enough to be a
/// slip of the finger.
pub fn nearest(name: &str, known: &[&'static str]) -> Option<&'static str> {
    let close = |known: &&'static str| (edit_distance(name, known), *known);
    let (distance, known) = known.iter().map(close).min_by_key(|(d, _)| *d)?;
    (distance <= 1 + known.len() / 4).then_some(known)
}

/// Levenshtein distance, by characters.
fn edit_distance(a: &str, b: &str) -> usize {
    let b: Vec<char> = b.chars().collect();
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, from) in a.chars().enumerate() {
        let mut diagonal = row[0];
        row[0] = i + 1;
        for (j, to) in b.iter().enumerate() {
            let substituted = diagonal + usize::from(from != *to);
            diagonal = row[j + 1];
            row[j + 1] = substituted.min(row[j] + 1).min(diagonal + 1);
        }
    }
    row[b.len()]
}
