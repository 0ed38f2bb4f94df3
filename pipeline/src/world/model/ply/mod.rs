//! Meshes from PLY files: ASCII, and binary of both byte orders.
//!
//! What a file declares is what it has: any elements and properties in any order, lists of
//! any type; those that are not drawn are stepped over. Points are `vertex` with `x`, `y`
//! and `z`; faces are lists `vertex_indices` or `vertex_index` of `face`, or strips of
//! `tristrips`. Normals, colours and texture coordinates of vertices are not used.
//!
//! A value of ASCII is rounded to the type that its property declares, so that a file has
//! the same bits in all three encodings. Coordinates stay in f64 until the model has its
//! place in a scene.

mod body;
mod error;
mod header;
mod values;

use std::path::Path;

use super::piece::MOST;
use crate::world::faces::{Triangles, compact, first_equals};
use crate::world::files::{self, FileError, SceneFolder};
use crate::world::shape::Shape;
use crate::world::warning::SceneWarning;
use body::{Body, Polygon};
pub use error::{PlyError, PlyProblem};
use header::Header;

/// Bytes of a model that are read at most.
pub const MAX_PLY_BYTES: u64 = 256 << 20;

/// A mesh read from a PLY file, and what was amiss without stopping it.
#[derive(Clone, Debug, PartialEq)]
pub struct PlyMesh {
    /// All faces as one solid; points in order of first use, no two of them equal.
    pub shape: Shape,
    /// Codes `crossing-polygons`, `repeated-corners`, `degenerate-faces`,
    /// `skipped-faces`, `ignored-elements`, `ignored-colours`, `trailing-data`.
    pub warnings: Vec<SceneWarning>,
}

/// Reads a PLY file that the user names.
///
/// # Errors
/// See [`PlyProblem`].
pub fn load_given(path: &Path) -> Result<PlyMesh, PlyError> {
    of_bytes(files::read(path, MAX_PLY_BYTES), path)
}

/// Reads a PLY file that a scene in `folder` names.
///
/// # Errors
/// See [`PlyProblem`].
pub fn load_from(path: &Path, folder: &SceneFolder) -> Result<PlyMesh, PlyError> {
    of_bytes(folder.read(path, MAX_PLY_BYTES), path)
}

fn of_bytes(bytes: Result<Vec<u8>, FileError>, path: &Path) -> Result<PlyMesh, PlyError> {
    let file = path.display().to_string();
    let bytes = bytes.map_err(|e| PlyError::new(&file, e.into()))?;
    parse(&bytes, &file)
}

/// Reads a PLY file's bytes; `file` names it in messages. Any bytes are accepted or refused
/// with an error, never a panic.
///
/// # Errors
/// See [`PlyProblem`].
pub fn parse(bytes: &[u8], file: &str) -> Result<PlyMesh, PlyError> {
    parse_at_most(bytes, file, MOST)
}

/// The same of a file with at most so many vertices and triangles.
fn parse_at_most(bytes: &[u8], file: &str, most: u64) -> Result<PlyMesh, PlyError> {
    let read = || {
        let (header, rest) = Header::of(bytes)?;
        let body = Body::of(&header, rest, most)?;
        mesh(&header, &body)
    };
    read().map_err(|problem| PlyError::new(file, problem))
}

fn mesh(header: &Header, body: &Body) -> Result<PlyMesh, PlyProblem> {
    let triangles = triangles(body)?;
    if triangles.corners.is_empty() {
        return Err(PlyProblem::NoFaces {
            points: body.points.len(),
        });
    }
    Ok(PlyMesh {
        shape: compact(&body.points, &triangles.corners),
        warnings: warnings(header, body, &triangles),
    })
}

fn triangles(body: &Body) -> Result<Triangles, PlyProblem> {
    let first = first_equals(&body.points);
    let mut triangles = Triangles::default();
    let mut rest = &body.corners[..];
    for polygon in &body.polygons {
        let (own, after) = rest.split_at(polygon.corners);
        rest = after;
        check(polygon, own, body.points.len())?;
        let mut corners = own.iter().map(|c| first[*c as usize]).collect();
        let place = || format!("{} {}", polygon.of, polygon.number);
        triangles.face(&mut corners, &body.points, place);
    }
    Ok(triangles)
}

/// Vertices may follow the faces that use them, so only the end tells which indices are
/// too high.
fn check(polygon: &Polygon, corners: &[u32], vertices: usize) -> Result<(), PlyProblem> {
    match corners.iter().find(|c| **c as usize >= vertices) {
        None => Ok(()),
        Some(&index) => Err(PlyProblem::OutOfRange {
            element: polygon.of,
            number: polygon.number,
            index,
            vertices,
        }),
    }
}

fn warnings(header: &Header, body: &Body, triangles: &Triangles) -> Vec<SceneWarning> {
    let own = [
        body.skipped.warning(
            "skipped-faces",
            "faces with fewer than three corners were skipped",
        ),
        header.ignored().warning(
            "ignored-elements",
            "elements were ignored; only vertices, faces and strips are read",
        ),
        header.colours().warning(
            "ignored-colours",
            "colours were ignored; the model has one material",
        ),
        body.left_over.warning(
            "trailing-data",
            "bytes behind the last element were left out",
        ),
    ];
    triangles
        .warnings()
        .chain(own.into_iter().flatten())
        .collect()
}

#[cfg(test)]
mod tests;
