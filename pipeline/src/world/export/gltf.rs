//! Binary glTF 2.0 of a scene.

use std::sync::Arc;

use glam::DVec3;
use gnomon_raster::state::{AddressMode, FilterMode, Sampler};
use serde_json::{Value, json};

use super::Exporting;
use super::pictures::number;
use crate::world::light::{Light, LightShape};
use crate::world::material::{Material, MaterialPart};
use crate::world::mesh::ShadingVertices;
use crate::world::model::gltf::{SMALLEST, distance};
use crate::world::scene::{Camera, Object, Scene};
use crate::world::texture::{Picture, SurfaceTexture, split};

const FLOAT: u32 = 5126;
const UNSIGNED_INT: u32 = 5125;

/// The file.
pub(super) fn glb(scene: &Scene, size: [u32; 2], objects: &[Exporting<'_>]) -> Vec<u8> {
    let mut file = File::default();
    for object in objects {
        file.add_object(object);
    }
    file.add_camera(&scene.camera, size);
    let bounds = bounds(scene);
    for light in &scene.lights {
        file.add_light(light, bounds);
    }
    file.finish(&scene.name)
}

/// Bounds of all objects, in whose middle the reader measures lights.
fn bounds(scene: &Scene) -> (DVec3, DVec3) {
    let bounds = scene.objects.iter().filter_map(|o| o.mesh.bounds());
    let all = bounds.reduce(|(low, high), (l, h)| (low.min(l), high.max(h)));
    all.unwrap_or_default()
}

/// Lists of the JSON, and the buffer.
#[derive(Default)]
struct File {
    buffer: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
    materials: Vec<Value>,
    textures: Vec<Value>,
    images: Vec<Value>,
    samplers: Vec<Value>,
    pictures: Vec<Arc<Picture>>,
    meshes: Vec<Value>,
    nodes: Vec<Value>,
    cameras: Vec<Value>,
    punctual: Vec<Value>,
    areas: Vec<Value>,
}

impl File {
    /// Adds numbers of four bytes each to the buffer; returns the number of their view.
    fn add_view(&mut self, words: impl Iterator<Item = [u8; 4]>, target: u32) -> usize {
        let offset = self.buffer.len();
        words.for_each(|w| self.buffer.extend(w));
        let length = self.buffer.len() - offset;
        self.views.push(json!({
            "buffer": 0, "byteOffset": offset, "byteLength": length, "target": target,
        }));
        self.views.len() - 1
    }

    fn add_accessor(&mut self, accessor: Value) -> usize {
        self.accessors.push(accessor);
        self.accessors.len() - 1
    }

    fn add_vectors(&mut self, vectors: &[[f32; 3]]) -> usize {
        let words = vectors.iter().flatten().map(|c| c.to_le_bytes());
        let view = self.add_view(words, 34962);
        let fold = |f: fn(f32, f32) -> f32| {
            let all = vectors.iter().copied();
            let of = all.reduce(|a, b| [0, 1, 2].map(|k| f(a[k], b[k])));
            of.unwrap_or_default().map(f64::from)
        };
        let least = fold(|a, b| if b < a { b } else { a });
        let most = fold(|a, b| if b > a { b } else { a });
        self.add_accessor(json!({
            "bufferView": view, "componentType": FLOAT, "count": vectors.len(),
            "type": "VEC3", "min": least, "max": most,
        }))
    }

    fn add_part(&mut self, drawn: &ShadingVertices, part: &MaterialPart) -> usize {
        let triangles = part.triangles.iter().map(|t| drawn.triangles[*t as usize]);
        self.add_indices(triangles)
    }

    fn add_indices(&mut self, triangles: impl ExactSizeIterator<Item = [u32; 3]>) -> usize {
        let count = 3 * triangles.len();
        let words = triangles.flatten().map(u32::to_le_bytes);
        let view = self.add_view(words, 34963);
        self.add_accessor(json!({
            "bufferView": view, "componentType": UNSIGNED_INT, "count": count, "type": "SCALAR",
        }))
    }

    /// A part with vertices of its own, where its texture has seams.
    fn textured_primitive(
        &mut self,
        object: &Object,
        drawn: &ShadingVertices,
        normals: &[[f32; 3]],
        part: &MaterialPart,
    ) -> Value {
        let corners = part.triangles.iter().map(|&t| {
            let coordinates = object.coordinates_of(t);
            (drawn.triangles[t as usize], coordinates)
        });
        let seams = split(corners);
        let own = |of: &[[f32; 3]]| -> Vec<[f32; 3]> {
            let vertices = seams.vertices.iter();
            vertices.map(|(v, _)| of[*v as usize]).collect()
        };
        let position = self.add_vectors(&own(&drawn.positions));
        let normal = self.add_vectors(&own(normals));
        let words = seams.vertices.iter().flat_map(|(_, at)| *at);
        let view = self.add_view(words.map(f32::to_le_bytes), 34962);
        let texels = self.add_accessor(json!({
            "bufferView": view, "componentType": FLOAT, "count": seams.vertices.len(),
            "type": "VEC2",
        }));
        let indices = self.add_indices(seams.triangles.into_iter());
        json!({
            "attributes": {"POSITION": position, "NORMAL": normal, "TEXCOORD_0": texels},
            "indices": indices,
        })
    }

    /// The number of a texture, whose picture goes into the buffer.
    fn add_texture(&mut self, texture: &SurfaceTexture) -> usize {
        let known = number(&self.pictures, &texture.picture);
        let image = known.unwrap_or_else(|| self.add_picture(&texture.picture));
        self.samplers.push(sampler(&texture.sampler));
        let sampler = self.samplers.len() - 1;
        self.textures
            .push(json!({"source": image, "sampler": sampler}));
        self.textures.len() - 1
    }

    fn add_picture(&mut self, picture: &Arc<Picture>) -> usize {
        let offset = self.buffer.len();
        self.buffer.extend(picture.encoded());
        let length = self.buffer.len() - offset;
        self.buffer.resize(self.buffer.len().next_multiple_of(4), 0);
        self.views
            .push(json!({"buffer": 0, "byteOffset": offset, "byteLength": length}));
        self.images.push(json!({
            "bufferView": self.views.len() - 1, "mimeType": picture.kind().mime(),
        }));
        self.pictures.push(picture.clone());
        self.images.len() - 1
    }

    fn add_object(&mut self, exporting: &Exporting<'_>) {
        let drawn = exporting.object.mesh.shading_vertices();
        let position = self.add_vectors(&drawn.positions);
        // Normals have length 1 there.
        let up = |n: &[f32; 3]| if *n == [0.0; 3] { [0.0, 1.0, 0.0] } else { *n };
        let normals: Vec<[f32; 3]> = drawn.normals.iter().map(up).collect();
        let normal = self.add_vectors(&normals);
        let mut primitives = Vec::new();
        for part in exporting.object.painted() {
            let mut material = material(&part.material);
            let primitive = match &part.texture {
                Some(texture) => {
                    let index = self.add_texture(texture);
                    material["pbrMetallicRoughness"]["baseColorTexture"] = json!({"index": index});
                    self.textured_primitive(exporting.object, &drawn, &normals, &part)
                }
                None => {
                    let indices = self.add_part(&drawn, &part);
                    json!({
                        "attributes": {"POSITION": position, "NORMAL": normal},
                        "indices": indices,
                    })
                }
            };
            self.materials.push(material);
            primitives.push(primitive);
            if let Some(last) = primitives.last_mut() {
                last["material"] = json!(self.materials.len() - 1);
            }
        }
        let name = super::tables::word(&exporting.object.name);
        self.meshes
            .push(json!({"name": name, "primitives": primitives}));
        let mesh = self.meshes.len() - 1;
        self.nodes.push(json!({"name": name, "mesh": mesh}));
    }

    fn add_camera(&mut self, camera: &Camera, size: [u32; 2]) {
        let [right, up, forward] = camera.basis();
        self.cameras
            .push(json!({"type": "perspective", "perspective": {
                "yfov": camera.fov_y_degrees.to_radians(),
                "znear": camera.near,
                "aspectRatio": f64::from(size[0]) / f64::from(size[1]),
            }}));
        let matrix = matrix([right, up, -forward], camera.eye);
        self.nodes
            .push(json!({"name": "camera", "camera": 0, "matrix": matrix}));
    }

    fn add_light(&mut self, light: &Light, bounds: (DVec3, DVec3)) {
        // As bright at the middle as everywhere here.
        let strongest = light.colour.into_iter().fold(0.0, f32::max);
        let share = |c: f32| f64::from(if strongest > 0.0 { c / strongest } else { 0.0 });
        let color = light.colour.map(share);
        let strongest = f64::from(strongest);
        let candela = |at: DVec3| {
            let distance = distance(at, bounds);
            strongest * distance * distance
        };
        let middle = (bounds.0 + bounds.1) / 2.0;
        if let Some((area, axes, centre, square)) = area(&light.shape, middle) {
            let mut own = area;
            own["color"] = json!(color);
            own["intensity"] = json!(candela(centre) / square);
            self.areas.push(own);
            let index = self.areas.len() - 1;
            self.add_light_node("EXT_lights_area", index, matrix(axes, centre));
            return;
        }
        let (kind, intensity, matrix) = match &light.shape {
            LightShape::Directional { towards } => {
                let matrix = matrix(axes_of(*towards), DVec3::ZERO);
                ("directional", strongest, matrix)
            }
            shape => {
                let at = place(shape);
                let matrix = matrix([DVec3::X, DVec3::Y, DVec3::Z], at);
                ("point", candela(at), matrix)
            }
        };
        self.punctual
            .push(json!({"type": kind, "color": color, "intensity": intensity}));
        let index = self.punctual.len() - 1;
        self.add_light_node("KHR_lights_punctual", index, matrix);
    }

    fn add_light_node(&mut self, extension: &str, light: usize, matrix: Value) {
        self.nodes.push(json!({
            "name": "light", "matrix": matrix, "extensions": {extension: {"light": light}},
        }));
    }

    fn finish(self, name: &str) -> Vec<u8> {
        let all: Vec<usize> = (0..self.nodes.len()).collect();
        let mut file = json!({
            "asset": {"version": "2.0", "generator": "gnomon"},
            "scene": 0,
            "scenes": [{"name": name, "nodes": all}],
            "nodes": self.nodes,
            "meshes": self.meshes,
            "materials": self.materials,
            "accessors": self.accessors,
            "bufferViews": self.views,
            "buffers": [{"byteLength": self.buffer.len()}],
            "cameras": self.cameras,
        });
        for (name, list) in [
            ("textures", self.textures),
            ("images", self.images),
            ("samplers", self.samplers),
        ] {
            if !list.is_empty() {
                file[name] = Value::Array(list);
            }
        }
        let mut used = Vec::new();
        let mut extensions = serde_json::Map::new();
        for (name, lights) in [
            ("KHR_lights_punctual", self.punctual),
            ("EXT_lights_area", self.areas),
        ] {
            if !lights.is_empty() {
                used.push(name);
                extensions.insert(name.to_owned(), json!({"lights": lights}));
            }
        }
        if !used.is_empty() {
            file["extensionsUsed"] = json!(used);
            file["extensions"] = Value::Object(extensions);
        }
        container(&file.to_string(), &self.buffer)
    }
}

/// JSON and buffer as chunks, each padded to four bytes.
fn container(json: &str, buffer: &[u8]) -> Vec<u8> {
    let chunk = |kind: &[u8], bytes: &[u8], padding: u8| {
        let mut bytes = bytes.to_vec();
        bytes.resize(bytes.len().next_multiple_of(4), padding);
        let mut chunk = (bytes.len() as u32).to_le_bytes().to_vec();
        chunk.extend(kind);
        chunk.extend(bytes);
        chunk
    };
    let chunks = [
        chunk(b"JSON", json.as_bytes(), b' '),
        chunk(b"BIN\0", buffer, 0),
    ]
    .concat();
    let length = (12 + chunks.len()) as u32;
    [
        &b"glTF"[..],
        &2_u32.to_le_bytes(),
        &length.to_le_bytes(),
        &chunks,
    ]
    .concat()
}

/// Columns of a node's matrix.
fn matrix([x, y, z]: [DVec3; 3], at: DVec3) -> Value {
    let column = |v: DVec3, w: f64| [v.x, v.y, v.z, w];
    json!(
        [
            column(x, 0.0),
            column(y, 0.0),
            column(z, 0.0),
            column(at, 1.0)
        ]
        .concat()
    )
}

fn material(material: &Material) -> Value {
    let [r, g, b] = material.albedo.map(f64::from);
    json!({
        "pbrMetallicRoughness": {
            "baseColorFactor": [r, g, b, 1.0], "metallicFactor": 0.0, "roughnessFactor": 1.0,
        },
        "doubleSided": true,
    })
}

fn sampler(of: &Sampler) -> Value {
    let wrap = |mode| match mode {
        AddressMode::ClampToEdge | AddressMode::ClampToBorder => 33071,
        AddressMode::MirrorRepeat => 33648,
        AddressMode::Repeat => 10497,
    };
    let levels = of.lod[1] > SMALLEST;
    let min = match (levels, of.min, of.mip) {
        (false, FilterMode::Nearest, _) => 9728,
        (false, FilterMode::Linear, _) => 9729,
        (true, FilterMode::Nearest, FilterMode::Nearest) => 9984,
        (true, FilterMode::Linear, FilterMode::Nearest) => 9985,
        (true, FilterMode::Nearest, FilterMode::Linear) => 9986,
        (true, FilterMode::Linear, FilterMode::Linear) => 9987,
    };
    json!({
        "magFilter": if of.mag == FilterMode::Nearest { 9728 } else { 9729 },
        "minFilter": min,
        "wrapS": wrap(of.address[0]),
        "wrapT": wrap(of.address[1]),
    })
}

/// Axes of a node that looks along the negative of `z`.
fn axes_of(z: DVec3) -> [DVec3; 3] {
    let z = z / z.length();
    let other = if z.y.abs() < 0.9 { DVec3::Y } else { DVec3::X };
    let x = other.cross(z);
    let x = x / x.length();
    [x, z.cross(x), z]
}

/// Whether the light is a point in the file, though it is none.
pub(super) fn is_point_instead(shape: &LightShape) -> bool {
    let exact = matches!(
        shape,
        LightShape::Point { .. } | LightShape::Directional { .. }
    );
    !exact && area(shape, DVec3::ZERO).is_none()
}

fn place(shape: &LightShape) -> DVec3 {
    match shape {
        LightShape::Point { position } => *position,
        LightShape::Polygon(polygon) => polygon.centroid(),
        LightShape::Rectangle { centre, .. }
        | LightShape::Disc { centre, .. }
        | LightShape::Sphere { centre, .. } => *centre,
        LightShape::Directional { .. } => DVec3::ZERO,
    }
}

/// An area light: its table, the axes and the place of its node, which shines along its -z
/// towards `middle`, and the square measure of its surface.
fn area(shape: &LightShape, middle: DVec3) -> Option<(Value, [DVec3; 3], DVec3, f64)> {
    match shape {
        LightShape::Rectangle {
            centre,
            edge_u,
            edge_v,
        } => {
            let [u, v] = [edge_u.length(), edge_v.length()];
            let [x, y] = [*edge_u / u, *edge_v / v];
            if x.dot(y).abs() > 1e-9 {
                return None;
            }
            let z = x.cross(y);
            // Along the same edges, whichever side is towards the middle.
            let x = if z.dot(*centre - middle) < 0.0 { -x } else { x };
            let light = json!({"type": "rect", "size": v, "rect": {"aspect": u / v}});
            Some((light, [x, y, x.cross(y)], *centre, u * v))
        }
        LightShape::Disc {
            centre,
            normal,
            radius,
        } => {
            let away = normal.dot(*centre - middle) >= 0.0;
            let light = json!({"type": "disk", "size": 2.0 * radius});
            let axes = axes_of(if away { *normal } else { -*normal });
            Some((light, axes, *centre, std::f64::consts::PI * radius * radius))
        }
        _ => None,
    }
}
