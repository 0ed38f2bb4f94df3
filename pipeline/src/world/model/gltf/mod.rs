//! Models and scenes from glTF 2.0 files: `.gltf` and `.glb`.
//!
//! The nodes of the file's scene are drawn with their transforms, in metres and y up as
//! they are written: triangles in lists, strips and fans, base colours with their textures, the first
//! camera in perspective, lights of `KHR_lights_punctual` and `EXT_lights_area`, positions
//! of `KHR_mesh_quantization`. A face has no back: all are drawn from both sides, whether or
//! not `doubleSided` is set, and normals are this crate's own. What else a file has is told
//! once in warnings; what it requires and is not supported is an error.
//!
//! JSON goes through serde into the few structs of `schema`. Whatever a file says is
//! checked against what it has before it is believed: lengths, offsets, counts, indices.

mod accessor;
mod buffers;
mod camera;
mod container;
mod error;
mod light;
mod mesh;
mod nodes;
mod notes;
mod pose;
mod schema;
mod texture;
mod uri;

use std::collections::BTreeMap;
use std::path::Path;

use glam::DMat4;

pub use error::{GltfError, GltfProblem};
pub(crate) use light::distance;
pub(crate) use texture::SMALLEST;

use super::piece::{MOST, Model, Piece};
use crate::world::files::{self, FileError, Outside, SceneFolder};
use crate::world::material::{Material, MaterialPart};
use crate::world::texture::{Gallery, turned_round};
use buffers::{Beside, Buffers};
use error::{Checked, element};
use mesh::{Local, Reader};
use nodes::Placed;
use notes::Notes;
use schema::{About, Root};
use texture::Pictures;

/// Bytes of a file that are read at most, without buffers that are files of their own.
pub const MAX_GLTF_BYTES: u64 = 256 << 20;

/// Bytes `{` and `,` of the JSON at most: as many tables and elements of lists there are, and
/// a table of three bytes takes hundreds.
const MAX_JSON: usize = 1 << 21;

/// Extensions that a file may require.
pub const SUPPORTED: [&str; 4] = [
    "KHR_lights_punctual",
    "EXT_lights_area",
    "KHR_mesh_quantization",
    "KHR_texture_transform",
];

/// Largest coordinate: what f32 holds.
const LARGEST: f64 = f32::MAX as f64;

/// Reads a file that the user names, as it is at `time`, in seconds; its buffers must lie in its folder, unless more is
/// allowed.
///
/// # Errors
/// See [`GltfProblem`].
pub fn load_given(path: &Path, outside: Outside, time: f64) -> Result<Model, GltfError> {
    let folder = SceneFolder::of(path, outside);
    let bytes = files::read(path, MAX_GLTF_BYTES);
    of_bytes(bytes, path, &folder, &mut Gallery::default(), time)
}

/// Reads a file that a scene in `folder` names, as it is at `time`; `gallery` has the scene's
/// pictures.
///
/// # Errors
/// See [`GltfProblem`].
pub fn load_from(
    path: &Path,
    folder: &SceneFolder,
    gallery: &mut Gallery,
    time: f64,
) -> Result<Model, GltfError> {
    of_bytes(
        folder.read(path, MAX_GLTF_BYTES),
        path,
        folder,
        gallery,
        time,
    )
}

fn of_bytes(
    bytes: Result<Vec<u8>, FileError>,
    path: &Path,
    folder: &SceneFolder,
    gallery: &mut Gallery,
    time: f64,
) -> Result<Model, GltfError> {
    let file = path.display().to_string();
    let bytes = bytes.map_err(|e| GltfError {
        file: file.clone(),
        place: String::new(),
        problem: e.into(),
    })?;
    parse_with(&bytes, &file, Some(Beside { path, folder }), gallery, time)
}

/// Reads a file's bytes; buffers that are files of their own are an error. `file` names it
/// in messages. Any bytes are accepted or refused with an error, never a panic.
///
/// # Errors
/// See [`GltfProblem`].
pub fn parse(bytes: &[u8], file: &str) -> Result<Model, GltfError> {
    parse_at(bytes, file, 0.0)
}

/// The same at a time, in seconds.
///
/// # Errors
/// See [`GltfProblem`].
pub fn parse_at(bytes: &[u8], file: &str, time: f64) -> Result<Model, GltfError> {
    parse_with(bytes, file, None, &mut Gallery::default(), time)
}

fn parse_with(
    bytes: &[u8],
    file: &str,
    beside: Option<Beside<'_>>,
    gallery: &mut Gallery,
    time: f64,
) -> Result<Model, GltfError> {
    model(bytes, beside, gallery, time).map_err(|e| GltfError {
        file: file.to_owned(),
        place: e.place,
        problem: e.problem,
    })
}

fn model(
    bytes: &[u8],
    beside: Option<Beside<'_>>,
    gallery: &mut Gallery,
    time: f64,
) -> Checked<Model> {
    let (json, own) = container::parts(bytes).map_err(|p| p.at(""))?;
    check_json(json, MAX_JSON).map_err(|p| p.at(""))?;
    check_asset(json)?;
    let root: Root = serde_json::from_slice(json).map_err(|e| GltfProblem::from(e).at(""))?;
    check_extensions(&root)?;
    let mut build = Build {
        root: &root,
        buffers: Buffers::new(&root, own, beside),
        reader: Reader::default(),
        meshes: BTreeMap::new(),
        pictures: Pictures::new(gallery),
        notes: Notes::default(),
        triangles: 0,
    };
    build.model(time)
}

/// Refuses JSON that has more in it than the limit, before it is read.
fn check_json(json: &[u8], limit: usize) -> Result<(), GltfProblem> {
    let count = json.iter().filter(|b| matches!(b, b'{' | b',')).count();
    if count > limit {
        return Err(GltfProblem::TooMuchJson { count, limit });
    }
    Ok(())
}

/// The version, before anything that other versions write otherwise.
fn check_asset(json: &[u8]) -> Checked<()> {
    let about: About = serde_json::from_slice(json).map_err(|e| GltfProblem::from(e).at(""))?;
    let asset = about.asset;
    let version = asset.min_version.as_ref().unwrap_or(&asset.version);
    let least = asset.min_version.is_some();
    if !(version == "2.0" || (!least && version.starts_with("2."))) {
        let version = version.clone();
        return Err(GltfProblem::Version { version }.at("asset"));
    }
    Ok(())
}

fn check_extensions(root: &Root) -> Checked<()> {
    let unknown = |name: &&String| !SUPPORTED.contains(&name.as_str());
    match root.extensions_required.iter().find(unknown) {
        None => Ok(()),
        Some(name) => {
            let name = name.clone();
            Err(GltfProblem::Extension { name }.at("extensionsRequired"))
        }
    }
}

/// A file on its way to a model.
struct Build<'a> {
    root: &'a Root,
    buffers: Buffers<'a>,
    reader: Reader,
    /// Those that were read.
    meshes: BTreeMap<usize, Local>,
    pictures: Pictures<'a>,
    notes: Notes,
    /// Triangles of all nodes so far.
    triangles: u64,
}

impl Build<'_> {
    fn model(&mut self, time: f64) -> Checked<Model> {
        let pose = pose::pose(self.root, &mut self.buffers, time, &mut self.notes)?;
        let (mut pieces, mut sources, mut camera) = (Vec::new(), Vec::new(), None);
        for placed in nodes::placed(self.root, &pose)? {
            pieces.extend(self.piece(&placed)?);
            sources.extend(light::at(self.root, &placed, &mut self.notes)?);
            camera = camera::at(self.root, &placed, camera, &mut self.notes)?;
        }
        let mut model = Model {
            pieces,
            camera,
            lights: Vec::new(),
            moves: !pose.is_empty(),
            warnings: self.notes.warnings(self.root, &SUPPORTED),
        };
        let bounds = model.bounds().ok_or_else(|| GltfProblem::NoFaces.at(""))?;
        model.lights = light::lit(sources, bounds);
        Ok(model)
    }

    /// The mesh of a node, where the node is.
    fn piece(&mut self, placed: &Placed<'_>) -> Checked<Option<Piece>> {
        let Some(number) = placed.node.mesh else {
            return Ok(None);
        };
        let place = format!("nodes[{}]", placed.number);
        let local = self.mesh(number, &place)?;
        if local.shape.triangles.is_empty() {
            return Ok(None);
        }
        self.triangles += local.shape.triangles.len() as u64;
        if self.triangles > MOST {
            let (what, limit) = ("triangles", MOST);
            return Err(GltfProblem::TooMuch { what, limit }.at(place));
        }
        let mut model_from_node = placed.model_from_node;
        if placed.node.skin.is_some() {
            // Bones place it, not its node.
            self.notes.skins.add(|| place.clone());
            model_from_node = DMat4::IDENTITY;
        }
        let parts = self.parts(&local)?;
        let mut coordinates = local.coordinates;
        if model_from_node.determinant() < 0.0 {
            turned_round(&mut coordinates);
        }
        let shape = local.shape.transformed(model_from_node);
        let fits = |p: &glam::DVec3| p.to_array().iter().all(|c| c.abs() <= LARGEST);
        if !shape.positions.iter().all(fits) {
            let (what, value) = (
                "a coordinate",
                "too large where the node puts it".to_owned(),
            );
            let valid = "numbers below 3.4e38";
            return Err(GltfProblem::Bad { what, value, valid }.at(place));
        }
        let names = [&placed.node.name, &self.root.meshes[number].name];
        let name = names.into_iter().flatten().next().cloned();
        Ok(Some(Piece {
            name: name.unwrap_or_else(|| format!("node {}", placed.number)),
            shape,
            parts,
            coordinates,
        }))
    }

    fn mesh(&mut self, number: usize, place: &str) -> Checked<Local> {
        if let Some(read) = self.meshes.get(&number) {
            return Ok(read.clone());
        }
        let (buffers, notes) = (&mut self.buffers, &mut self.notes);
        let read = self.reader.mesh(self.root, buffers, number, notes, place)?;
        self.meshes.insert(number, read.clone());
        Ok(read)
    }

    fn parts(&mut self, local: &Local) -> Checked<Vec<MaterialPart>> {
        let part = |(number, triangles): &(usize, Vec<u32>)| {
            let materials = &self.root.materials;
            let material = element(materials, *number, "materials", "a primitive")?;
            let pbr = &material.pbr_metallic_roughness;
            let [r, g, b, _] = pbr.base_color_factor.unwrap_or([1.0; 4]);
            let texture = match &pbr.base_color_texture {
                Some(of) => self.pictures.texture(
                    self.root,
                    &mut self.buffers,
                    of,
                    &mut self.notes,
                    &format!("materials[{number}]"),
                )?,
                None => None,
            };
            let out = [r, g, b].iter().any(|c| !(0.0..=1.0).contains(c));
            (self.notes.limited).add_many(usize::from(out), || format!("materials[{number}]"));
            Ok(MaterialPart {
                material: Material::matt([r, g, b].map(|c| c.clamp(0.0, 1.0) as f32)),
                texture,
                triangles: triangles.clone(),
            })
        };
        local.painted.iter().map(part).collect()
    }
}

#[cfg(test)]
mod tests;
