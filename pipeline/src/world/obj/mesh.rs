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
    /// Of each triangle the texture coordinates of its corners, v counted from below; empty
    /// where the file has none.
    pub(super) coordinates: Vec<[[f64; 2]; 3]>,
}

impl Faces {
    /// Cuts the faces of `scan`, equal points being one.
    pub(super) fn of(scan: &Scan) -> Self {
        let first = first_equals(&scan.points);
        let mut out = Self::default();
        let mut next = 0;
        for face in &scan.faces {
            let range = next..next + face.corners;
            next = range.end;
            let own = &scan.corners[range.clone()];
            let mut corners: Vec<u32> = own.iter().map(|c| first[*c as usize]).collect();
            let texels = match scan.texels.is_empty() {
                true => Vec::new(),
                false => texels_of(scan, &corners, &scan.corner_texels[range]),
            };
            let place = || format!("line {}", face.line);
            let triangles = out.triangles.face(&mut corners, &scan.points, place);
            out.painted.push((triangles, face.material));
            if !texels.is_empty() {
                let made = out.triangles.corners.iter().rev().take(triangles).rev();
                let found = made.map(|t| t.map(|point| find(&texels, point)));
                out.coordinates.extend(found);
            }
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

/// The points of a face's corners with their texture coordinates, by point; of equal points
/// the first one's come first.
fn texels_of(scan: &Scan, points: &[u32], texels: &[i64]) -> Vec<(u32, [f64; 2])> {
    let of = |texel: &i64| {
        let texel = usize::try_from(*texel).ok();
        texel.map_or([0.0; 2], |t| scan.texels[t])
    };
    let all = points.iter().copied().zip(texels.iter().map(of));
    let mut all: Vec<_> = all.collect();
    all.sort_by_key(|(point, _)| *point);
    all
}

fn find(texels: &[(u32, [f64; 2])], point: u32) -> [f64; 2] {
    let first = texels.partition_point(|(p, _)| *p < point);
    texels.get(first).map_or([0.0; 2], |(_, at)| *at)
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
