//! Meshes: primitives of points and indices to the triangles of one solid.

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;

use glam::DVec3;

use super::accessor;
use super::buffers::Buffers;
use super::error::{Checked, GltfProblem, element};
use super::notes::Notes;
use super::schema::{Primitive, Root, TextureOfMaterial};
use super::texture;
use crate::world::faces::{Triangles, compact, first_equals};
use crate::world::model::piece::MOST;
use crate::world::shape::Shape;
use crate::world::texture::CornerCoordinates;

const TRIANGLES: u32 = 4;
const STRIP: u32 = 5;
const FAN: u32 = 6;

/// A mesh in its own coordinates.
#[derive(Clone, Default)]
pub(super) struct Local {
    pub(super) shape: Shape,
    /// For each material in use its triangles.
    pub(super) painted: Vec<(usize, Vec<u32>)>,
    /// Of each triangle its texture coordinates; empty where no primitive has any.
    pub(super) coordinates: Vec<CornerCoordinates>,
}

/// A triangle as a primitive has it.
struct Corners {
    points: [u32; 3],
    material: Option<usize>,
    coordinates: CornerCoordinates,
}

/// The points of a mesh: primitives that share an accessor share its points.
#[derive(Default)]
struct Points {
    all: Vec<DVec3>,
    /// Of each accessor the number of its first point, and how many it has.
    places: BTreeMap<usize, (u32, usize)>,
    /// Texture coordinates by their accessor.
    coordinates: BTreeMap<usize, Vec<[f32; 2]>>,
}

/// Reads meshes, and bounds what they add up to.
#[derive(Default)]
pub(super) struct Reader {
    vertices: u64,
    indices: u64,
    /// Texture coordinates.
    texels: u64,
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
        let mut points = Points::default();
        let mut corners = Vec::new();
        for (number, primitive) in mesh.primitives.iter().enumerate() {
            let place = format!("meshes[{index}].primitives[{number}]");
            if !is_drawn(primitive, notes, &place)? {
                continue;
            }
            let (base, count) = self.points(root, buffers, primitive, &mut points, &place)?;
            let indices = self.indices(root, buffers, primitive, count, &place)?;
            let mode = primitive.mode.unwrap_or(TRIANGLES);
            let cut = notes_cut(mode, indices.len());
            notes.cut.add_many(usize::from(cut), || place.clone());
            let textured = self.coordinates(root, buffers, primitive, &mut points, notes, &place);
            let transform = base_color(root, primitive).and_then(|t| t.extensions.transform);
            let at = |c: u32| textured.get(c as usize).copied().unwrap_or_default();
            let moved = triangles(mode, &indices).into_iter().map(|t| {
                let mut coordinates = t.map(at);
                if let Some(transform) = &transform {
                    texture::transform(transform, &mut coordinates);
                }
                Corners {
                    points: t.map(|c| c + base),
                    material: primitive.material,
                    coordinates,
                }
            });
            corners.extend(moved);
        }
        let mut solid = solid(&points.all, &corners, notes, index);
        if points.coordinates.values().all(Vec::is_empty) {
            solid.coordinates = Vec::new();
        }
        Ok(solid)
    }

    /// The number of the first point of a primitive, and how many it has.
    fn points(
        &mut self,
        root: &Root,
        buffers: &mut Buffers<'_>,
        primitive: &Primitive,
        points: &mut Points,
        place: &str,
    ) -> Checked<(u32, usize)> {
        let what = "attributes.POSITION";
        let position = primitive.attributes.position;
        let position = position.ok_or_else(|| GltfProblem::Missing { what }.at(place))?;
        if let Some(known) = points.places.get(&position) {
            return Ok(*known);
        }
        let at = format!("{place}.{what}");
        let left = MOST - self.vertices;
        let own: Vec<[f64; 3]> = accessor::read(root, buffers, position, "VEC3", left, &at)?;
        self.vertices += own.len() as u64;
        let finite = |p: &[f64; 3]| p.iter().all(|c| c.is_finite());
        if let Some(number) = own.iter().position(|p| !finite(p)) {
            let (what, value) = ("a coordinate", format!("{:?}", own[number]));
            let valid = "finite numbers";
            return Err(GltfProblem::Bad { what, value, valid }.at(format!("{at}[{number}]")));
        }
        let known = (points.all.len() as u32, own.len());
        points.all.extend(own.into_iter().map(DVec3::from));
        points.places.insert(position, known);
        Ok(known)
    }

    /// Texture coordinates of a primitive's points: the set of its material's base colour.
    /// Wrong ones are noted and none, for a model without its paint is still a model.
    fn coordinates<'p>(
        &mut self,
        root: &Root,
        buffers: &mut Buffers<'_>,
        primitive: &Primitive,
        points: &'p mut Points,
        notes: &mut Notes,
        place: &str,
    ) -> &'p [[f32; 2]] {
        let set = base_color(root, primitive).map_or(0, texture::set);
        let Some(accessor) = texture::accessor(&primitive.attributes, set) else {
            return &[];
        };
        let slot = match points.coordinates.entry(accessor) {
            Entry::Occupied(known) => return known.into_mut(),
            Entry::Vacant(slot) => slot,
        };
        let place = format!("{place}.attributes.TEXCOORD_{set}");
        let left = MOST - self.texels;
        let read: Vec<[f64; 2]> = accessor::read(root, buffers, accessor, "VEC2", left, &place)
            .unwrap_or_else(|problem| {
                (notes.coordinates).add(|| format!("{}: {}", problem.place, problem.problem));
                Vec::new()
            });
        self.texels += read.len() as u64;
        let infinite = read.as_flattened().iter().filter(|v| !v.is_finite());
        (notes.coordinates).add_many(infinite.count(), || format!("{place}: not finite"));
        let finite = |v: f64| if v.is_finite() { v as f32 } else { 0.0 };
        slot.insert(read.into_iter().map(|at| at.map(finite)).collect())
    }

    fn indices(
        &mut self,
        root: &Root,
        buffers: &mut Buffers<'_>,
        primitive: &Primitive,
        points: usize,
        place: &str,
    ) -> Checked<Vec<u32>> {
        let left = 3 * MOST - self.indices;
        let Some(accessor) = primitive.indices else {
            // Many primitives may share few points.
            if points as u64 > left {
                let (what, limit) = ("vertices or indices", left);
                return Err(GltfProblem::TooMuch { what, limit }.at(place));
            }
            self.indices += points as u64;
            return Ok((0..points as u32).collect());
        };
        let place = format!("{place}.indices");
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

/// The texture of a primitive's base colour.
fn base_color<'r>(root: &'r Root, primitive: &Primitive) -> Option<&'r TextureOfMaterial> {
    let material = root.materials.get(primitive.material?)?;
    material.pbr_metallic_roughness.base_color_texture.as_ref()
}

/// Whether a primitive has triangles; what else it has is noted.
fn is_drawn(primitive: &Primitive, notes: &mut Notes, place: &str) -> Checked<bool> {
    match primitive.mode.unwrap_or(TRIANGLES) {
        TRIANGLES | STRIP | FAN => {}
        0..TRIANGLES => {
            notes.lines.add(|| place.to_owned());
            return Ok(false);
        }
        other => {
            let (what, value) = ("mode", other.to_string());
            let valid = "a whole number up to 6";
            return Err(GltfProblem::Bad { what, value, valid }.at(place));
        }
    }
    let morphs = !primitive.targets.is_empty();
    (notes.morphs).add_many(usize::from(morphs), || place.to_owned());
    let colours = primitive.attributes.color.is_some();
    (notes.colours).add_many(usize::from(colours), || place.to_owned());
    Ok(true)
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
fn solid(points: &[DVec3], corners: &[Corners], notes: &mut Notes, mesh: usize) -> Local {
    let first = first_equals(points);
    let mut triangles = Triangles::default();
    let mut local = Local::default();
    for triangle in corners {
        let mut corners = triangle.points.map(|c| first[c as usize]).to_vec();
        let number = triangles.corners.len() as u32;
        let made = triangles.face(&mut corners, points, || format!("meshes[{mesh}]"));
        if made != 1 {
            continue;
        }
        local.coordinates.push(triangle.coordinates);
        if let Some(material) = triangle.material {
            match local.painted.iter_mut().find(|(m, _)| *m == material) {
                Some((_, own)) => own.push(number),
                None => local.painted.push((material, vec![number])),
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

    /// Primitives without indices have as many as they have points, however they share them.
    #[test]
    fn points_without_indices_count_as_indices() {
        let root = Root::default();
        let mut buffers = Buffers::new(&root, None, None);
        let mut reader = Reader {
            indices: 3 * MOST - 5,
            ..Reader::default()
        };
        let primitive = Primitive::default();
        let mut indices = |points| reader.indices(&root, &mut buffers, &primitive, points, "p");
        assert_eq!(indices(3).unwrap(), [0, 1, 2]);
        let problem = indices(3).unwrap_err().problem.to_string();
        assert!(
            problem.contains("more than 2 vertices or indices"),
            "{problem}"
        );
    }

    /// As exporters write a mesh of many materials.
    #[test]
    fn points_that_primitives_share_are_read_and_counted_once() {
        let primitive = r#"{"attributes": {"POSITION": 0}}"#;
        let other = r#"{"attributes": {"POSITION": 1}}"#;
        let json = format!(
            r#"{{"meshes": [{{"primitives": [{primitive}, {other}, {primitive}]}}],
            "accessors": [
                {{"bufferView": 0, "componentType": 5121, "count": 3, "type": "VEC3"}},
                {{"bufferView": 0, "byteOffset": 3, "componentType": 5121, "count": 3, "type": "VEC3"}}
            ],
            "bufferViews": [{{"buffer": 0, "byteLength": 12}}],
            "buffers": [{{"byteLength": 12}}]}}"#
        );
        let root: Root = serde_json::from_str(&json).unwrap();
        let bytes = [0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1];
        let mut buffers = Buffers::new(&root, Some(&bytes), None);
        let mut reader = Reader::default();
        let read = reader.mesh(&root, &mut buffers, 0, &mut Notes::default(), "");
        let shape = read.unwrap().shape;
        assert_eq!((reader.vertices, reader.indices), (6, 9));
        assert_eq!(shape.triangles, [[0, 1, 2], [1, 2, 3], [0, 1, 2]]);
        assert_eq!(shape.positions, [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z]);
    }
}
