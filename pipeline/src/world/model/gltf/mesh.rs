//! Meshes: primitives of points and indices to the triangles of one solid.

use glam::DVec3;

use super::accessor;
use super::buffers::Buffers;
use super::error::{Checked, GltfProblem, element};
use super::notes::Notes;
use super::schema::{Primitive, Root};
use crate::world::faces::{Triangles, compact, first_equals};
use crate::world::shape::Shape;

/// Vertices or triangles that are drawn of a file at most.
pub(super) const MOST: u64 = 1 << 23;

const TRIANGLES: u32 = 4;
const STRIP: u32 = 5;
const FAN: u32 = 6;

/// A mesh in its own coordinates.
#[derive(Clone, Default)]
pub(super) struct Local {
    pub(super) shape: Shape,
    /// For each material in use its triangles.
    pub(super) painted: Vec<(usize, Vec<u32>)>,
}

/// Points, and triangles of them.
type Drawn = (Vec<DVec3>, Vec<[u32; 3]>);

/// Reads meshes, and bounds what they add up to.
#[derive(Default)]
pub(super) struct Reader {
    vertices: u64,
    indices: u64,
}

impl Reader {
    /// Mesh `index`: primitives that share places are one solid.
    pub(super) fn mesh(
        &mut self,
        root: &Root,
        buffers: &mut Buffers<'_>,
        index: usize,
        notes: &mut Notes,
        place: &str,
    ) -> Checked<Local> {
        let mesh = element(&root.meshes, index, "meshes", place)?;
        let mut points = Vec::new();
        let mut corners = Vec::new();
        for (number, primitive) in mesh.primitives.iter().enumerate() {
            let place = format!("meshes[{index}].primitives[{number}]");
            let base = points.len() as u32;
            let own = self.primitive(root, buffers, primitive, notes, &place)?;
            let Some((own_points, own_triangles)) = own else {
                continue;
            };
            points.extend(own_points);
            let moved = own_triangles.into_iter().map(|t| t.map(|c| c + base));
            corners.extend(moved.map(|t| (t, primitive.material)));
        }
        Ok(solid(&points, &corners, notes, index))
    }

    /// The points of a primitive, and its triangles.
    fn primitive(
        &mut self,
        root: &Root,
        buffers: &mut Buffers<'_>,
        primitive: &Primitive,
        notes: &mut Notes,
        place: &str,
    ) -> Checked<Option<Drawn>> {
        let mode = primitive.mode.unwrap_or(TRIANGLES);
        match mode {
            TRIANGLES | STRIP | FAN => {}
            0..TRIANGLES => {
                notes.lines.add(|| place.to_owned());
                return Ok(None);
            }
            other => {
                let (what, value) = ("mode", other.to_string());
                let valid = "a whole number up to 6";
                return Err(GltfProblem::Bad { what, value, valid }.at(place));
            }
        }
        notes
            .morphs
            .add_many(usize::from(!primitive.targets.is_empty()), || {
                place.to_owned()
            });
        let colours = primitive.attributes.color.is_some();
        notes
            .colours
            .add_many(usize::from(colours), || place.to_owned());
        let what = "attributes.POSITION";
        let position = primitive.attributes.position;
        let position = position.ok_or_else(|| GltfProblem::Missing { what }.at(place))?;
        let at = format!("{place}.{what}");
        let left = MOST - self.vertices;
        let points: Vec<[f64; 3]> = accessor::read(root, buffers, position, "VEC3", left, &at)?;
        self.vertices += points.len() as u64;
        let points: Vec<DVec3> = points.into_iter().map(DVec3::from).collect();
        if let Some(number) = points.iter().position(|p| !p.is_finite()) {
            let (what, value) = ("a coordinate", format!("{:?}", points[number].to_array()));
            let valid = "finite numbers";
            return Err(GltfProblem::Bad { what, value, valid }.at(format!("{at}[{number}]")));
        }
        let indices = self.indices(root, buffers, primitive, points.len(), place)?;
        let cut = notes_cut(mode, indices.len());
        notes.cut.add_many(usize::from(cut), || place.to_owned());
        Ok(Some((points, triangles(mode, &indices))))
    }

    fn indices(
        &mut self,
        root: &Root,
        buffers: &mut Buffers<'_>,
        primitive: &Primitive,
        points: usize,
        place: &str,
    ) -> Checked<Vec<u32>> {
        let Some(accessor) = primitive.indices else {
            return Ok((0..points as u32).collect());
        };
        let place = format!("{place}.indices");
        let left = 3 * MOST - self.indices;
        let values: Vec<[f64; 1]> =
            accessor::read(root, buffers, accessor, "SCALAR", left, &place)?;
        self.indices += values.len() as u64;
        let valid = |v: f64| v >= 0.0 && v < points as f64 && v.fract() == 0.0;
        match values.iter().position(|[v]| !valid(*v)) {
            None => Ok(values.into_iter().map(|[v]| v as u32).collect()),
            Some(at) => {
                let (what, value) = ("an index", values[at][0].to_string());
                let valid = "a whole number from 0 below the number of vertices";
                Err(GltfProblem::Bad { what, value, valid }.at(format!("{place}[{at}]")))
            }
        }
    }
}

/// Whether corners are left over.
fn notes_cut(mode: u32, corners: usize) -> bool {
    match mode {
        TRIANGLES => !corners.is_multiple_of(3),
        _ => corners == 1 || corners == 2,
    }
}

/// Triangles of a list, a strip or a fan, in the winding of the first one.
fn triangles(mode: u32, c: &[u32]) -> Vec<[u32; 3]> {
    match mode {
        STRIP => {
            let turned = |(k, w): (usize, &[u32])| match k % 2 {
                0 => [w[0], w[1], w[2]],
                _ => [w[0], w[2], w[1]],
            };
            c.windows(3).enumerate().map(turned).collect()
        }
        FAN => {
            let rest = c.get(1..).unwrap_or_default();
            rest.windows(2).map(|w| [w[0], w[1], c[0]]).collect()
        }
        _ => c.as_chunks::<3>().0.to_vec(),
    }
}

/// Points of equal places are one: vertices are doubled where a texture has a seam.
fn solid(
    points: &[DVec3],
    corners: &[([u32; 3], Option<usize>)],
    notes: &mut Notes,
    mesh: usize,
) -> Local {
    let first = first_equals(points);
    let mut triangles = Triangles::default();
    let mut local = Local::default();
    for (triangle, material) in corners {
        let mut corners = triangle.map(|c| first[c as usize]).to_vec();
        let number = triangles.corners.len() as u32;
        let made = triangles.face(&mut corners, points, || format!("meshes[{mesh}]"));
        if let (Some(material), 1) = (material, made) {
            match local.painted.iter_mut().find(|(m, _)| m == material) {
                Some((_, own)) => own.push(number),
                None => local.painted.push((*material, vec![number])),
            }
        }
    }
    let degenerate = &triangles.degenerate;
    (notes.degenerate).add_many(degenerate.count, || degenerate.first.clone());
    local.shape = compact(points, &triangles.corners);
    local
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strips_and_fans_keep_their_winding() {
        let c = [4, 5, 6, 7, 8];
        assert_eq!(triangles(STRIP, &c), [[4, 5, 6], [5, 7, 6], [6, 7, 8]]);
        assert_eq!(triangles(FAN, &c), [[5, 6, 4], [6, 7, 4], [7, 8, 4]]);
        assert_eq!(triangles(TRIANGLES, &c), [[4, 5, 6]]);
        for mode in [STRIP, FAN, TRIANGLES] {
            assert_eq!(triangles(mode, &[]), [[0; 3]; 0]);
            assert_eq!(triangles(mode, &c[..2]), [[0; 3]; 0]);
        }
    }
}
