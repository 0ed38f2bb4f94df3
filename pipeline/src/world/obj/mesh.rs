//! From the statements of a file to the triangles of one solid.

use std::fmt::Write as _;
use std::path::Path;

use glam::DVec3;

use super::ObjProblem;
use super::corners::drop_repeated;
use super::polygon::{Cut, Cutter};
use super::scan::{Scan, Tally};
use super::weld::first_equals;
use crate::world::shape::Shape;

/// Triangles, and what was amiss with the faces that they are of.
#[derive(Default)]
pub(super) struct Triangles {
    /// Corners as indices of points.
    corners: Vec<[u32; 3]>,
    /// For each face how many triangles it has, and its material.
    pub(super) painted: Vec<(usize, Option<u32>)>,
    /// Corners that repeat others of their face.
    pub(super) repeated: Tally,
    /// Faces of which too few corners are left.
    pub(super) degenerate: Tally,
    /// Faces whose outline crosses itself.
    pub(super) crossing: Tally,
}

impl Triangles {
    /// Cuts the faces of `scan`, equal points being one.
    pub(super) fn of(scan: &Scan) -> Self {
        let first = first_equals(&scan.points);
        let mut out = Self::default();
        let mut cutter = Cutter::default();
        let mut rest = &scan.corners[..];
        for face in &scan.faces {
            let (own, after) = rest.split_at(face.corners);
            rest = after;
            let mut corners: Vec<u32> = own.iter().map(|c| first[*c as usize]).collect();
            let triangles = out.face(&mut cutter, &mut corners, &scan.points, face.line);
            out.painted.push((triangles, face.material));
        }
        out
    }

    /// Adds a face; returns how many triangles it has.
    fn face(
        &mut self,
        cutter: &mut Cutter,
        corners: &mut Vec<u32>,
        points: &[DVec3],
        line: usize,
    ) -> usize {
        let place = || format!("line {line}");
        let dropped = drop_repeated(corners);
        if corners.len() < 3 {
            self.degenerate.add(place);
            return 0;
        }
        self.repeated.add_many(dropped, place);
        let before = self.corners.len();
        let places: Vec<DVec3> = corners.iter().map(|c| points[*c as usize]).collect();
        if cutter.cut(corners, &places, &mut self.corners) == Cut::Crossing {
            self.crossing.add(place);
        }
        self.corners.len() - before
    }

    /// The triangles as `tobj` builds them, points in order of first use.
    pub(super) fn shape(&self, points: &[DVec3]) -> Result<Shape, ObjProblem> {
        if self.corners.is_empty() {
            return Err(ObjProblem::NoFaces);
        }
        let text = canonical(points, &self.corners);
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
