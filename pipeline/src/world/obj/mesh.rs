//! From the statements of a file to the triangles of one solid.

use std::fmt::Write as _;
use std::path::Path;

use glam::DVec3;

use super::ObjProblem;
use super::scan::Scan;
use crate::world::faces::{Triangles, first_equals};
use crate::world::shape::Shape;

/// The triangles of a file.
#[derive(Default)]
pub(super) struct Faces {
    pub(super) triangles: Triangles,
    /// For each face how many triangles it has, and its material.
    pub(super) painted: Vec<(usize, Option<u32>)>,
}

impl Faces {
    /// Cuts the faces of `scan`, equal points being one.
    pub(super) fn of(scan: &Scan) -> Self {
        let first = first_equals(&scan.points);
        let mut out = Self::default();
        let mut rest = &scan.corners[..];
        for face in &scan.faces {
            let (own, after) = rest.split_at(face.corners);
            rest = after;
            let mut corners: Vec<u32> = own.iter().map(|c| first[*c as usize]).collect();
            let place = || format!("line {}", face.line);
            let triangles = out.triangles.face(&mut corners, &scan.points, place);
            out.painted.push((triangles, face.material));
        }
        out
    }

    /// The triangles as `tobj` builds them, points in order of first use.
    pub(super) fn shape(&self, points: &[DVec3]) -> Result<Shape, ObjProblem> {
        if self.triangles.corners.is_empty() {
            return Err(ObjProblem::NoFaces);
        }
        let text = canonical(points, &self.triangles.corners);
        let options = tobj::LoadOptions {
            single_index: false,
            ..tobj::LoadOptions::default()
        };
        let no_materials = |_: &Path| Ok(Default::default());
        let (models, _) = tobj::load_obj_buf(&mut text.as_bytes(), &options, no_materials)?;
        let mesh = models.into_iter().next().ok_or(ObjProblem::NoFaces)?.mesh;
        let positions = mesh.positions.as_chunks::<3>().0;
        Ok(Shape {
            positions: positions.iter().map(|p| DVec3::from(*p)).collect(),
            triangles: mesh.indices.as_chunks::<3>().0.to_vec(),
        })
    }
}

/// One object of positions and triangles, which is all that is used.
fn canonical(points: &[DVec3], triangles: &[[u32; 3]]) -> String {
    let mut text = String::with_capacity(40 * points.len() + 24 * triangles.len());
    // Writing to a String cannot fail.
    for p in points {
        let _ = writeln!(text, "v {} {} {}", p.x, p.y, p.z);
    }
    for t in triangles {
        let [a, b, c] = t.map(|i| i + 1);
        let _ = writeln!(text, "f {a} {b} {c}");
    }
    text
}
