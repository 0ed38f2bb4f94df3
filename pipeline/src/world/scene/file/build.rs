//! From the tables of a scene file to a [`Scene`].

use std::sync::Arc;

use glam::{DMat3, DMat4, DVec3};

use super::check::Source;
use super::motion::{self, Moved};
use super::schema::{
    CameraTable, LightShapeTable, LightTable, MaterialTable, ObjectTable, SceneTable,
};
use super::{Moment, SceneFileError, environment, shapes, texture};
use crate::world::files::SceneFolder;
use crate::world::light::{ConvexPolygon, Light, LightShape};
use crate::world::mesh::Shading;
use crate::world::scene::near;
use crate::world::scene::{Camera, Material, MaterialPart, Object, Rest, Scene, SceneWarning};
use crate::world::shape::{Shape, on_circle};
use crate::world::texture::{Gallery, turned_round};

type Built<T> = Result<T, SceneFileError>;

/// Largest image side.
const MAX_SIDE: u32 = gnomon_raster::MAX_TEXTURE_SIZE;

/// Crease angle where the file gives none, degrees.
const CREASE: f64 = 40.0;

pub(super) fn scene(
    source: &Source<'_>,
    folder: &SceneFolder,
    table: SceneTable,
    moment: &mut Moment<'_>,
) -> Built<Scene> {
    let camera = camera(source, &table.camera)?;
    let lights = table.lights.iter().map(|l| light(source, l));
    let mut out = Scene::new(camera, lights.collect::<Built<_>>()?, Vec::new());
    out.size = size(source, &table)?;
    if let Some(ambient) = &table.ambient {
        out.ambient = source.colour("ambient", ambient)?;
    }
    if let Some(background) = &table.background {
        out.background = source.colour("background", background)?;
    }
    let lit = table.environment.is_some() || moment.environment.is_some();
    require(source, "lights", table.lights.is_empty() && !lit)?;
    require(source, "objects", table.objects.is_empty())?;
    let mut gallery = Gallery::default();
    for (index, table) in table.objects.iter().enumerate() {
        let built = object(source, folder, &mut gallery, index, table, moment.time);
        let (object, warnings) = built?;
        out.objects.push(object);
        out.warnings.extend(warnings);
    }
    if table.camera.near.is_none() {
        out.camera.near = near::derived(&out);
    }
    out.name = table.name.clone();
    light_by_environment(source, folder, &table, moment, &mut out)?;
    Ok(out)
}

/// The environment that the moment asks for, or else the file's own.
fn light_by_environment(
    source: &Source<'_>,
    folder: &SceneFolder,
    table: &SceneTable,
    moment: &mut Moment<'_>,
    scene: &mut Scene,
) -> Built<()> {
    let span = table.environment.as_ref().map(|e| e.map.span());
    let at = span.unwrap_or(source.text.len()..source.text.len());
    let request = match (&table.environment, moment.environment) {
        (_, Some(asked)) => asked.clone(),
        (Some(own), None) => {
            if !table.lights.is_empty() {
                let message = "lights beside [environment] would not shine; remove one of them";
                return Err(source.error(at, message.to_owned()));
            }
            environment::request(source, folder, own)?
        }
        (None, None) => return Ok(()),
    };
    let lit = request.light(scene, moment.maps);
    lit.map_err(|e| source.error(at, e.to_string()))
}

/// Refuses a missing list, at the end of the text, where it may be added.
fn require(source: &Source<'_>, list: &str, missing: bool) -> Built<()> {
    if !missing {
        return Ok(());
    }
    let end = source.text.len()..source.text.len();
    let message = format!("no {list}; add at least one [[{list}]] table");
    Err(source.error(end, message))
}

fn size(source: &Source<'_>, table: &SceneTable) -> Built<Option<[u32; 2]>> {
    let Some(size) = &table.size else {
        return Ok(None);
    };
    if size.get_ref().iter().all(|s| (1..=MAX_SIDE).contains(s)) {
        return Ok(Some(size.get_ref().0));
    }
    let message = format!(
        "size is {:?}; valid is [width, height], each 1..={MAX_SIDE}",
        size.get_ref().0
    );
    Err(source.error(size.span(), message))
}

fn camera(source: &Source<'_>, table: &CameraTable) -> Built<Camera> {
    let mut camera = Camera::look_at(
        source.finite("eye", &table.eye)?,
        source.finite("target", &table.target)?,
    );
    let sight = camera.target - camera.eye;
    if sight.length() == 0.0 {
        let message = "target equals eye; valid is any other point".into();
        return Err(source.error(table.target.span(), message));
    }
    if let Some(up) = &table.up {
        camera.up = source.direction("up", up)?;
    }
    // A sine below 1e-9 leaves no digits for the direction of "right".
    if sight.cross(camera.up).length() <= 1e-9 * sight.length() * camera.up.length() {
        let span = table.up.as_ref().map_or(table.eye.span(), |up| up.span());
        let message = "up is parallel to the line of sight; choose another up, eye or target";
        return Err(source.error(span, message.into()));
    }
    if let Some(fov) = &table.fov {
        let rule = "above 0 and below 180 (degrees, vertical)";
        camera.fov_y_degrees = source.number_where("fov", fov, rule, |x| x > 0.0 && x < 180.0)?;
    }
    if let Some(near) = &table.near {
        camera.near = source.positive("near", near)?;
    }
    Ok(camera)
}

fn light(source: &Source<'_>, table: &LightTable) -> Built<Light> {
    let colour = match &table.colour {
        Some(colour) => source.colour("colour", colour)?,
        None => [1.0; 3],
    };
    let shape = light_shape(source, &table.shape)?;
    Ok(Light { shape, colour })
}

fn light_shape(source: &Source<'_>, table: &LightShapeTable) -> Built<LightShape> {
    Ok(match table {
        LightShapeTable::Point { position } => LightShape::Point {
            position: source.finite("position", position)?,
        },
        LightShapeTable::Square { centre, side } => {
            let centre = source.finite("centre", centre)?;
            Light::horizontal_square(centre, source.positive("side", side)?).shape
        }
        LightShapeTable::Rectangle {
            centre,
            edge_u,
            edge_v,
        } => LightShape::Rectangle {
            centre: source.finite("centre", centre)?,
            edge_u: source.direction("edge-u", edge_u)?,
            edge_v: source.direction("edge-v", edge_v)?,
        },
        LightShapeTable::Polygon { vertices } => {
            let points = vertices.get_ref().iter().map(|v| DVec3::from(v.0));
            let polygon = ConvexPolygon::new(points.collect::<Vec<_>>());
            let located = |e| source.error(vertices.span(), format!("vertices: {e}"));
            LightShape::Polygon(polygon.map_err(located)?)
        }
        LightShapeTable::Disc {
            centre,
            normal,
            radius,
        } => {
            let normal = source.direction("normal", normal)?;
            LightShape::Disc {
                centre: source.finite("centre", centre)?,
                normal: normal / normal.length(),
                radius: source.positive("radius", radius)?,
            }
        }
        LightShapeTable::Sphere { centre, radius } => LightShape::Sphere {
            centre: source.finite("centre", centre)?,
            radius: source.positive("radius", radius)?,
        },
        LightShapeTable::Directional { towards } => LightShape::Directional {
            towards: source.direction("towards", towards)?,
        },
    })
}

fn object(
    source: &Source<'_>,
    folder: &SceneFolder,
    gallery: &mut Gallery,
    index: usize,
    table: &ObjectTable,
    time: f64,
) -> Built<(Object, Vec<SceneWarning>)> {
    let mut read = shapes::shape(source, folder, gallery, &table.mesh, time)?;
    let degrees = match &table.crease {
        Some(crease) => {
            let rule = "0..=180 (degrees)";
            source.number_where("crease", crease, rule, |x| (0.0..=180.0).contains(&x))?
        }
        None => CREASE,
    };
    let name = match &table.name {
        Some(name) => name.clone(),
        None => format!("{} {}", table.mesh.kind(), index + 1),
    };
    let moved = motion::moved(source, table.motion.as_ref(), time)?;
    let place = Place::read(source, table, moved)?;
    let rest = table.motion.is_some().then(|| read.shape.clone());
    let paint = texture::paint(source, folder, gallery, table, &mut read)?;
    if place.world_from_local().determinant() < 0.0 {
        turned_round(&mut read.coordinates);
    }
    let mesh = read
        .shape
        .transformed(place.world_from_local())
        .into_mesh(Shading::Crease { degrees })
        .map_err(|e| object_error(source, table, &name, &e))?;
    let mut object = Object::new(name, mesh, material(source, table.material.as_ref())?);
    object.casts = table.casts.unwrap_or(!table.mesh.is_sheet());
    object.receives = table.receives.unwrap_or(true);
    object.open = table.open.unwrap_or(false);
    object.rest = rest.and_then(|shape| place.rest(shape, Shading::Crease { degrees }));
    if table.material.is_none() {
        object.parts = read.parts;
    }
    if let Some(texture) = paint {
        object.parts = vec![MaterialPart {
            material: object.material,
            texture: Some(texture),
            triangles: (0..object.mesh.triangles().len() as u32).collect(),
        }];
    }
    if object.parts.iter().any(|p| p.texture.is_some()) {
        object.coordinates = Some(read.coordinates.into());
    }
    Ok((object, read.warnings))
}

/// A mesh that its transform pushed beyond f32, blamed on that transform.
fn object_error(
    source: &Source<'_>,
    table: &ObjectTable,
    name: &str,
    error: &crate::world::error::MeshError,
) -> SceneFileError {
    let scale = table.scale.as_ref().map(|s| s.span());
    let translate = table.translate.as_ref().map(|t| t.span());
    source.error(
        scale.or(translate).unwrap_or(0..0),
        format!("object '{name}' leaves the range of f32: {error}"),
    )
}

/// Scale, then rotation about x, y, z, then translation.
#[derive(Clone, Copy)]
struct Place {
    scale: Option<DVec3>,
    /// Degrees.
    angles: DVec3,
    offset: DVec3,
}

impl Place {
    fn read(source: &Source<'_>, table: &ObjectTable, moved: Moved) -> Built<Self> {
        let own = |name, value: &Option<_>| match value {
            Some(value) => source.finite(name, value),
            None => Ok(DVec3::ZERO),
        };
        let offset = own("translate", &table.translate)? + moved.translate;
        let angles = own("rotate", &table.rotate)? + moved.rotate;
        let factors = table.scale.as_ref().map(|s| DVec3::from(s.get_ref().0));
        let bad = factors.filter(|f| !f.is_finite() || f.abs().min_element() == 0.0);
        if let (Some(factors), Some(scale)) = (bad, &table.scale) {
            let message = format!(
                "scale is {factors:?}; valid is a finite number other than 0, or three of them"
            );
            return Err(source.error(scale.span(), message));
        }
        Ok(Self {
            scale: factors,
            angles,
            offset,
        })
    }

    fn world_from_local(&self) -> DMat4 {
        let mut place = DMat4::IDENTITY;
        if self.offset != DVec3::ZERO {
            place *= DMat4::from_translation(self.offset);
        }
        if self.angles != DVec3::ZERO {
            let [x, y, z] = self.angles.to_array();
            place = place * about(2, z) * about(1, y) * about(0, x);
        }
        if let Some(factors) = self.scale {
            place *= DMat4::from_scale(factors);
        }
        place
    }

    /// The object without rotation and translation.
    fn rest(&self, shape: Shape, shading: Shading) -> Option<Rest> {
        let scaled = DMat4::from_scale(self.scale.unwrap_or(DVec3::ONE));
        let mesh = shape.transformed(scaled).into_mesh(shading).ok()?;
        let [x, y, z] = self.angles.to_array();
        Some(Rest {
            mesh: Arc::new(mesh),
            turn: DMat3::from_mat4(about(2, z) * about(1, y) * about(0, x)),
            offset: self.offset,
        })
    }
}

/// Rotation by `degrees` about world axis 0, 1 or 2, counter-clockwise seen
/// from its positive end. Multiples of 90 degrees are exact.
fn about(axis: usize, degrees: f64) -> DMat4 {
    let (cos, sin) = match degrees.rem_euclid(360.0) {
        0.0 => (1.0, 0.0),
        90.0 => (0.0, 1.0),
        180.0 => (-1.0, 0.0),
        270.0 => (0.0, -1.0),
        other => on_circle(other.to_radians()),
    };
    let [next, after] = [(axis + 1) % 3, (axis + 2) % 3];
    let mut columns = DMat4::IDENTITY.to_cols_array_2d();
    columns[next][next] = cos;
    columns[next][after] = sin;
    columns[after][next] = -sin;
    columns[after][after] = cos;
    DMat4::from_cols_array_2d(&columns)
}

fn material(source: &Source<'_>, table: Option<&MaterialTable>) -> Built<Material> {
    let mut material = Material::matt([0.7; 3]);
    let Some(table) = table else {
        return Ok(material);
    };
    if table.texture.is_some() {
        // A picture shows its own colours.
        material.albedo = [1.0; 3];
    }
    if let Some(albedo) = &table.albedo {
        material.albedo = source.colour("albedo", albedo)?;
    }
    if let Some(specular) = &table.specular {
        material.specular = source.colour("specular", specular)?;
    }
    if let Some(shininess) = &table.shininess {
        let rule = "1 to 3.4e38 (Phong exponent)";
        let valid = |x: f64| (1.0..=f64::from(f32::MAX)).contains(&x);
        material.shininess = source.number_where("shininess", shininess, rule, valid)? as f32;
    }
    Ok(material)
}
