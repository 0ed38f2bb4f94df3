//! A scene at a value of an axis.

use std::sync::Arc;

use glam::DVec3;

use super::axis::{Axis, Kind};
use super::cut::{cut, halved};
use crate::truth::oracle::bvh::{Bvh, Ray};
use crate::world::light::{ConvexPolygon, HardLight, LightShape};
use crate::world::mesh::{Mesh, widen};
use crate::world::scene::Scene;

/// Which way a scene goes when it leaves the origin.
const AWAY: DVec3 = DVec3::new(1.0, 0.5, -0.75);
/// Most triangles of a caster: more pieces are no other numbers, only more of them.
const MOST_TRIANGLES: usize = 1 << 17;

/// `scene` at `value` of `axis`, which concerns light number `light`.
///
/// # Errors
/// What is left of the scene there, in words.
pub(super) fn place(scene: &Scene, light: usize, axis: &Axis, value: f64) -> Result<Scene, String> {
    let mut placed = scene.clone();
    match axis.kind {
        _ if value == axis.rest && axis.kind != Kind::Slivers => {}
        Kind::Scale => return scene.placed(value, DVec3::ZERO).map_err(|e| e.to_string()),
        Kind::Offset => {
            let sight = (scene.camera.target - scene.camera.eye).length();
            let offset = AWAY.normalize() * sight * value;
            return scene.placed(1.0, offset).map_err(|e| e.to_string());
        }
        Kind::Slivers => with_casters(&mut placed, |mesh| {
            cut(mesh, 1.0 / value).map_err(|e| e.to_string())
        })?,
        Kind::Pieces => with_casters(&mut placed, |mesh| {
            let times = (value as u32).ilog2();
            let halved = halved(mesh, times, MOST_TRIANGLES);
            let halved = halved.ok_or("casters would have too many triangles to try")?;
            halved.map_err(|e| e.to_string())
        })?,
        Kind::Near | Kind::NearFloat => placed.camera.near /= value,
        Kind::LightSize => resize(&mut placed.lights[light].shape, value)?,
        Kind::LightDown | Kind::LightNear => {
            let to = light_goes(scene, light, axis.kind, value)?;
            placed.lights[light].shape = moved(&scene.lights[light].shape, to)?;
        }
        Kind::EyeNear => {
            let camera = &mut placed.camera;
            camera.eye = camera.target + (camera.eye - camera.target) / value;
            camera.near /= value;
        }
        Kind::EyeShadow => {
            let shadow = in_shadow(scene, light)?;
            placed.camera.eye = scene.camera.eye.lerp(shadow, value);
        }
    }
    Ok(placed)
}

/// Replaces what casts.
fn with_casters(
    scene: &mut Scene,
    change: impl Fn(&Mesh) -> Result<Mesh, String>,
) -> Result<(), String> {
    for object in scene.objects.iter_mut().filter(|o| o.casts) {
        object.mesh = Arc::new(change(&object.mesh)?);
        // Parts are of triangles, which are others.
        object.parts.clear();
        object.coordinates = None;
        object.rest = None;
    }
    Ok(())
}

/// The middle of the box around all that casts.
fn casters_centre(scene: &Scene) -> Result<DVec3, String> {
    let boxes = scene.casters().filter_map(|o| o.mesh.bounds());
    let whole = boxes.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)));
    let (least, most) = whole.ok_or("nothing casts shadow")?;
    Ok((least + most) / 2.0)
}

fn centre_of(scene: &Scene, light: usize) -> Result<DVec3, String> {
    match scene.lights[light].hard() {
        HardLight::Point(centre) => Ok(centre),
        HardLight::Directional(_) => Err("the light is nowhere: it has a direction alone".into()),
    }
}

/// Where the light's centre goes.
fn light_goes(scene: &Scene, light: usize, kind: Kind, value: f64) -> Result<DVec3, String> {
    let casters = casters_centre(scene)?;
    let away = centre_of(scene, light)? - casters;
    if kind == Kind::LightNear {
        return Ok(casters + away / value);
    }
    let up = scene.camera.up.normalize();
    let height = away.dot(up);
    let level = away - up * height;
    // A light straight above goes down to the right of the picture.
    let right = (scene.camera.target - scene.camera.eye).cross(up);
    let level = if level.length() > 1e-6 * away.length() {
        level
    } else {
        right
    };
    let lower = height / value;
    let along = libm::sqrt((away.length_squared() - lower * lower).max(0.0));
    Ok(casters + up * lower + level.normalize() * along)
}

fn moved(shape: &LightShape, to: DVec3) -> Result<LightShape, String> {
    let mut shape = shape.clone();
    match &mut shape {
        LightShape::Point { position } => *position = to,
        LightShape::Rectangle { centre, .. }
        | LightShape::Disc { centre, .. }
        | LightShape::Sphere { centre, .. } => *centre = to,
        LightShape::Polygon(polygon) => {
            let by = to - polygon.centroid();
            *polygon = mapped(polygon, |v| v + by)?;
        }
        LightShape::Directional { .. } => return Err("the light is nowhere".into()),
    }
    Ok(shape)
}

fn resize(shape: &mut LightShape, times: f64) -> Result<(), String> {
    match shape {
        LightShape::Rectangle { edge_u, edge_v, .. } => {
            *edge_u *= times;
            *edge_v *= times;
        }
        LightShape::Disc { radius, .. } | LightShape::Sphere { radius, .. } => *radius *= times,
        LightShape::Polygon(polygon) => {
            let centre = polygon.centroid();
            *polygon = mapped(polygon, |v| centre + (v - centre) * times)?;
        }
        LightShape::Point { .. } | LightShape::Directional { .. } => {
            return Err("the light has no extent".into());
        }
    }
    Ok(())
}

fn mapped(polygon: &ConvexPolygon, map: impl Fn(DVec3) -> DVec3) -> Result<ConvexPolygon, String> {
    let vertices: Vec<DVec3> = polygon.vertices().iter().map(|v| map(*v)).collect();
    ConvexPolygon::new(vertices).map_err(|e| e.to_string())
}

/// A point in the middle between the casters and what their centre's shadow falls on;
/// where that is nothing, as far behind the centre as the light is before it.
fn in_shadow(scene: &Scene, light: usize) -> Result<DVec3, String> {
    let casters = casters_centre(scene)?;
    let away = casters - centre_of(scene, light)?;
    let behind = away.normalize();
    let floor = first_floor(scene, casters, behind).unwrap_or(2.0 * away.length());
    let inside = extent_along(scene, casters, behind).min(floor);
    Ok(casters + behind * ((inside + floor) / 2.0))
}

/// How far it is to what casts nothing.
fn first_floor(scene: &Scene, from: DVec3, direction: DVec3) -> Option<f64> {
    let floors = scene.objects.iter().filter(|o| !o.casts);
    let triangles = floors.flat_map(|o| (0..o.mesh.triangles().len()).map(|t| o.mesh.corners(t)));
    let triangles: Vec<[DVec3; 3]> = triangles.collect();
    let ray = Ray::new(from, direction);
    Bvh::new(&triangles)
        .closest(&ray, 0.0..f64::INFINITY)
        .map(|(_, t)| t)
}

/// How far casters reach from `from` in a direction.
fn extent_along(scene: &Scene, from: DVec3, direction: DVec3) -> f64 {
    let meshes = scene.casters().map(|o| &o.mesh);
    let points = meshes.flat_map(|m| m.positions().iter().map(|p| widen(*p)));
    points
        .map(|p| (p - from).dot(direction))
        .fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::world::scene::builtin;

    fn at(scene: &str, axis: &str, value: f64) -> Result<Scene, String> {
        let scene = builtin::build(scene).unwrap();
        place(&scene, 0, &Axis::find(axis).unwrap(), value)
    }

    #[test]
    fn the_scene_at_rest_is_the_scene() {
        let scene = builtin::build("cylinder").unwrap();
        for axis in Axis::all() {
            let placed = place(&scene, 0, &axis, axis.rest).unwrap();
            assert_eq!(placed == scene, axis.kind != Kind::Slivers, "{}", axis.name);
        }
    }

    #[test]
    fn lights_go_down_at_their_distance_and_near_in_their_direction() {
        for name in ["cylinder", "parallel-plates", "spheres"] {
            let scene = builtin::build(name).unwrap();
            let casters = casters_centre(&scene).unwrap();
            let away = |scene: &Scene| centre_of(scene, 0).unwrap() - casters;
            let rest = away(&scene);
            let down = away(&at(name, "light-down", 10.0).unwrap());
            assert!((down.length() / rest.length() - 1.0).abs() < 1e-9, "{name}");
            assert!((down.y * 10.0 - rest.y).abs() < 1e-9, "{name}: {down}");
            let near = away(&at(name, "light-near", 100.0).unwrap());
            assert!((near * 100.0 - rest).length() < 1e-9, "{name}: {near}");
        }
    }

    #[test]
    fn eyes_go_into_the_umbra() {
        let scene = at("cylinder", "eye-shadow", 1.0).unwrap();
        let hard = crate::truth::oracle::hard::HardOracle::new(&scene, scene.lights[0].hard());
        assert!(hard.shadow_count_at(scene.camera.eye) > 0);
        let rest = at("cylinder", "eye-shadow", 0.0).unwrap();
        assert_eq!(hard.shadow_count_at(rest.camera.eye), 0);
    }

    #[test]
    fn what_cannot_be_is_said() {
        let error = at("cylinder", "scale", 1e300).unwrap_err();
        assert!(error.contains("'floor'"), "{error}");
        let mut point = builtin::build("cylinder").unwrap();
        point.lights[0].shape = LightShape::Point { position: DVec3::Y };
        let axis = Axis::find("light-size").unwrap();
        let error = place(&point, 0, &axis, 2.0).unwrap_err();
        assert_eq!(error, "the light has no extent");
    }
}
