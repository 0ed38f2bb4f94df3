//! Meshes of a scene file: built-in primitives and models.

use glam::DVec3;

use super::SceneFileError;
use super::check::Source;
use super::schema::MeshTable;
use crate::world::files::SceneFolder;
use crate::world::model::{self, Model};
use crate::world::obj;
use crate::world::scene::{MaterialPart, SceneWarning};
use crate::world::shape::{self, Shape, Terrain};
use crate::world::texture::{CornerCoordinates, Gallery};

/// Sides of a round primitive.
const SEGMENTS: std::ops::RangeInclusive<u32> = 3..=4096;

/// An untransformed shape, and what its file said besides.
#[derive(Default)]
pub(super) struct Read {
    pub(super) shape: Shape,
    pub(super) parts: Vec<MaterialPart>,
    /// Of each triangle its texture coordinates; empty where the mesh has none.
    pub(super) coordinates: Vec<CornerCoordinates>,
    pub(super) warnings: Vec<SceneWarning>,
}

/// The shape that a table asks for at `time`, in seconds; pictures go to the scene's.
pub(super) fn shape(
    source: &Source<'_>,
    folder: &SceneFolder,
    gallery: &mut Gallery,
    table: &MeshTable,
    time: f64,
) -> Result<Read, SceneFileError> {
    match table {
        MeshTable::Obj(path) => {
            let read = obj::load_from(&folder.join(path.get_ref()), folder, gallery)
                .map_err(|e| source.error(path.span(), e.to_string()))?;
            Ok(Read {
                shape: read.shape,
                parts: read.parts,
                coordinates: read.coordinates,
                warnings: read.warnings,
            })
        }
        MeshTable::Model(path) => {
            let read = model::load_from(&folder.join(path.get_ref()), folder, gallery, time)
                .map_err(|e| source.error(path.span(), e.to_string()))?;
            Ok(of_model(read, path.get_ref()))
        }
        primitive => {
            let shape = self::primitive(source, primitive, time)?;
            Ok(Read {
                coordinates: coordinates(primitive, &shape),
                shape,
                ..Read::default()
            })
        }
    }
}

/// All solids of a model; a scene file has a camera and lights of its own.
fn of_model(mut read: Model, name: &str) -> Read {
    let ignored = read.lights.len() + usize::from(read.camera.is_some());
    if ignored > 0 {
        read.warnings.push(SceneWarning {
            code: "ignored-lights",
            count: ignored,
            message: format!(
                "lights and cameras of models are ignored in scene files (first: '{name}')"
            ),
        });
    }
    let warnings = std::mem::take(&mut read.warnings);
    let merged = read.merged();
    Read {
        shape: merged.shape,
        parts: merged.parts,
        coordinates: merged.coordinates,
        warnings,
    }
}

/// Texture coordinates of what is made here: a picture lies on a sheet as it is seen from
/// above with z towards the viewer, and upright on the sides of a box.
fn coordinates(table: &MeshTable, shape: &Shape) -> Vec<CornerCoordinates> {
    let Some((low, high)) = shape.bounds() else {
        return Vec::new();
    };
    let share = |p: DVec3| (p - low) / (high - low);
    let of = |corners: [DVec3; 3]| -> CornerCoordinates {
        let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
        corners.map(|p| {
            let s = share(p);
            let (u, v) = match (table.is_sheet(), normal.abs().max_position()) {
                (true, _) => (s.x, s.z),
                (_, 0) => (if normal.x > 0.0 { 1.0 - s.z } else { s.z }, 1.0 - s.y),
                (_, 1) => (s.x, if normal.y > 0.0 { s.z } else { 1.0 - s.z }),
                _ => (if normal.z > 0.0 { s.x } else { 1.0 - s.x }, 1.0 - s.y),
            };
            [u as f32, v as f32]
        })
    };
    let lies = table.is_sheet() || matches!(table, MeshTable::Box { .. });
    let triangles = shape.triangles.iter().filter(|_| lies);
    triangles
        .map(|t| of(t.map(|i| shape.positions[i as usize])))
        .collect()
}

fn primitive(source: &Source<'_>, table: &MeshTable, time: f64) -> Result<Shape, SceneFileError> {
    Ok(match table {
        MeshTable::Obj(_) | MeshTable::Model(_) => Shape::default(),
        MeshTable::Plane { half } => shape::plane(source.positive("half", half)?, 0.0),
        MeshTable::Box { size } => {
            let extent = source.finite("size", size)?;
            if extent.min_element() <= 0.0 {
                let message = format!("size is {extent:?}; valid are three numbers above 0");
                return Err(source.error(size.span(), message));
            }
            shape::cuboid(glam::DVec3::ZERO, extent)
        }
        MeshTable::Cylinder {
            segments,
            radius,
            height,
        } => shape::cylinder(
            source.count("segments", segments, SEGMENTS)?,
            source.positive("radius", radius)?,
            0.0,
            source.positive("height", height)?,
        ),
        MeshTable::Sphere {
            subdivisions,
            radius,
        } => shape::icosphere(
            source.count("subdivisions", subdivisions, 0..=7)?,
            source.positive("radius", radius)?,
            glam::DVec3::ZERO,
        ),
        MeshTable::Capsule { from, to, radius } => {
            let (start, end) = (source.finite("from", from)?, source.finite("to", to)?);
            if start == end {
                return Err(
                    source.error(to.span(), "to equals from; valid is any other point".into())
                );
            }
            let radius = source.positive("radius", radius)?;
            shape::capsule(start, end, radius, radius, 24, 6)
        }
        MeshTable::TorusKnot {
            p,
            q,
            ring,
            minor,
            tube,
            along,
            around,
        } => shape::torus_knot(
            source.count("p", p, 1..=16)?,
            source.count("q", q, 0..=16)?,
            source.positive("ring", ring)?,
            source.number("minor", minor)?,
            source.positive("tube", tube)?,
            source.count("along", along, SEGMENTS)?,
            source.count("around", around, SEGMENTS)?,
            glam::DVec3::ZERO,
        ),
        MeshTable::Terrain {
            cells,
            half,
            amplitude,
        } => shape::terrain(Terrain {
            cells: source.count("cells", cells, 1..=1024)?,
            half: source.positive("half", half)?,
            frequency: 0.5,
            octaves: 7,
            amplitude: source.number("amplitude", amplitude)?,
        }),
        MeshTable::Creature { phase, walk } => {
            let mut angle = source.number("phase", phase)?;
            if let Some(walk) = walk {
                angle += source.number("walk", walk)? * time;
            }
            Shape::merged(shape::creature(angle))
        }
    })
}
