//! Scenes after the papers' descriptions that are no built-in ones.

use glam::{DMat4, DVec3};

use super::{Lab, ReproduceError};
use gnomon_pipeline::world::light::{Light, LightShape};
use gnomon_pipeline::world::mesh::{Mesh, Shading};
use gnomon_pipeline::world::scene::{Camera, Material, Object, Scene};
use gnomon_pipeline::world::shape::{self, Shape};

const FLOOR: Material = Material::matt([0.72, 0.70, 0.66]);
const CLAY: Material = Material::matt([0.72, 0.36, 0.22]);

fn solid(name: &str, shape: Shape) -> Result<Object, ReproduceError> {
    let mesh = shape.into_mesh(Shading::Crease { degrees: 40.0 })?;
    Ok(Object::new(name, mesh, CLAY))
}

fn scene(
    name: String,
    camera: Camera,
    light: Light,
    casters: Vec<Object>,
) -> Result<Scene, ReproduceError> {
    let floor = shape::plane(12.0, 0.0).into_mesh(Shading::Flat)?;
    let floor = Object::new("floor", floor, FLOOR).receiver_only();
    let objects = std::iter::once(floor).chain(casters).collect();
    let mut scene = Scene::new(camera, vec![light], objects);
    scene.name = name;
    Ok(scene)
}

/// How far [`turned_plate`] is turned, in radians.
pub(super) const TURN: f64 = 0.37;
/// Where on the floor its shadow's edge lies, from below the light's centre.
pub(super) const TURNED_EDGE: f64 = 5.0 / 3.0;

/// A plate turned against a light's axes, whose shadow's straight edge is looked at from
/// below.
pub(super) fn turned_plate() -> Result<Scene, ReproduceError> {
    let turn = DMat4::from_rotation_y(TURN);
    let plate = shape::bevelled_plate(1.0, 2.0, 0.01, 1.6).transformed(turn);
    let mut plate = solid("plate", plate)?;
    plate.receives = false;
    let mut camera = Camera::look_at([1.9, -1.4, 0.01], [1.9, 0.0, 0.0]);
    camera.up = DVec3::Z;
    let light = Light::horizontal_square(DVec3::Y * 5.0, 0.3);
    scene("turned-plate".to_owned(), camera, light, vec![plate])
}

/// `count` (1 to 16) cylinders of 32 sides that stand apart under one light, seen
/// from high above, so that all look alike; light of the given side.
pub(super) fn cylinders(count: u32, side: f64) -> Result<Scene, ReproduceError> {
    // From the middle outwards, so that few are not all in one corner.
    const ORDER: [u32; 16] = [5, 10, 6, 9, 4, 11, 1, 14, 2, 7, 8, 13, 0, 3, 12, 15];
    let place = |k: u32| DVec3::new(f64::from(k % 4) - 1.5, 0.0, f64::from(k / 4) - 1.5) * 1.6;
    let cylinder = |k: &u32| {
        let shape = shape::cylinder(32, 0.25, 0.0, 0.7).translated(place(*k));
        solid(&format!("cylinder {k}"), shape)
    };
    let casters: Result<Vec<Object>, _> = ORDER[..count as usize].iter().map(cylinder).collect();
    let light = Light::horizontal_square(DVec3::new(0.4, 14.0, 0.3), side);
    let camera = Camera::look_at([0.0, 9.0, 5.0], [0.0, 0.0, 0.3]);
    scene(format!("{count} cylinders"), camera, light, casters?)
}

/// One cylinder and a number of square lights (1 to 4) round it.
pub(super) fn lights(count: usize) -> Result<Scene, ReproduceError> {
    let mut scene = cylinders(1, 1.0)?;
    let places = [[3.0, 3.0], [-3.0, -3.0], [3.0, -3.0], [-3.0, 3.0]];
    let light = |[x, z]: [f64; 2]| Light::horizontal_square(DVec3::new(x, 6.0, z), 1.0);
    scene.lights = places.into_iter().take(count).map(light).collect();
    scene.name = format!("{count} lights");
    Ok(scene)
}

/// The built-in statue under so many equal square lights, spread over the sky in a
/// spiral from the top to 20 degrees above the floor, all that look at it.
pub(super) fn statue_lights(lab: &Lab, count: usize) -> Result<Scene, ReproduceError> {
    const AWAY: f64 = 6.0;
    const MIDDLE: DVec3 = DVec3::new(0.0, 1.1, 0.0);
    const SIDE: f64 = 1.0;
    let light = |k: usize| {
        let y = 1.0 - 0.66 * (k as f64 + 0.5) / count as f64;
        let angle = 0.9 + 2.399_963_229_728_653 * k as f64;
        let ring = (1.0 - y * y).sqrt();
        let towards = DVec3::new(ring * libm::cos(angle), y, ring * libm::sin(angle));
        let edge_u = towards.any_orthonormal_vector() * SIDE;
        Light {
            shape: LightShape::Rectangle {
                centre: MIDDLE + towards * AWAY,
                edge_u,
                edge_v: towards.cross(edge_u),
            },
            colour: [1.0 / count as f32; 3],
        }
    };
    let mut scene = lab.scene("statue")?;
    scene.lights = (0..count).map(light).collect();
    scene.name = format!("statue under {count} lights");
    Ok(scene)
}

/// Behind the wall of [`wall`] is where x is below this.
pub(super) const WALL_BACK: f64 = -0.02;

/// A thin wall on a floor, lit from the side by a square that faces it: at its foot
/// what blocks is as near as can be, at the tip of its shadow it is far away.
pub(super) fn wall() -> Result<Scene, ReproduceError> {
    let size = DVec3::new(-2.0 * WALL_BACK, 1.2, 1.6);
    let wall = shape::cuboid(DVec3::new(0.0, 0.599, 0.0), size);
    let towards = DVec3::new(3.0, 3.0, 0.4);
    let edge_u = DVec3::Z;
    let light = Light {
        shape: LightShape::Rectangle {
            centre: towards,
            edge_u,
            edge_v: towards.cross(edge_u).normalize(),
        },
        colour: [1.0; 3],
    };
    let camera = Camera::look_at([-3.2, 3.2, 2.6], [-0.6, 0.2, 0.0]);
    let wall = solid("wall", wall)?;
    scene("wall".to_owned(), camera, light, vec![wall])
}

/// A flat triangle with an angle of 14 degrees, floating over a floor under a
/// spherical light (paper I, figure 7).
pub(super) fn acute_triangle() -> Result<Scene, ReproduceError> {
    let corner = |x: f64, y: f64, z: f64| DVec3::new(x, y, z);
    let rim = [[-1.2, 0.0], [1.2, 0.3], [1.2, -0.3]];
    let layer = |y: f64| rim.map(|[x, z]| corner(x, y, z));
    let positions = layer(1.02).into_iter().chain(layer(1.0)).collect();
    let mut triangles = vec![[0, 1, 2], [3, 5, 4]];
    for k in 0..3u32 {
        let next = (k + 1) % 3;
        triangles.extend([[k, k + 3, next], [next, k + 3, next + 3]]);
    }
    let prism = Shape {
        positions,
        triangles,
    };
    let light = Light {
        shape: LightShape::Sphere {
            centre: DVec3::new(0.3, 5.0, 0.2),
            radius: 0.5,
        },
        colour: [1.0; 3],
    };
    let camera = Camera::look_at([0.0, 3.4, 3.4], [0.0, 0.2, 0.0]);
    let prism = solid("triangle", prism)?;
    scene("acute triangle".to_owned(), camera, light, vec![prism])
}

/// The scene with the sides of its rectangular lights times `factor`.
pub(super) fn with_lights_scaled(mut scene: Scene, factor: f64) -> Scene {
    for light in &mut scene.lights {
        if let LightShape::Rectangle { edge_u, edge_v, .. } = &mut light.shape {
            *edge_u *= factor;
            *edge_v *= factor;
        }
    }
    scene.name = format!("{} x {factor}", scene.name);
    scene
}

/// A closed body: triangles round an apex whose rim goes up and down `folds` times,
/// and a point far below. Lights aside see the two faces of a fold from different
/// sides, so that the apex has many silhouette edges.
pub(super) fn folded_cone(folds: u32) -> Result<Mesh, ReproduceError> {
    let rim = 2 * folds;
    let at = |k: u32| {
        let angle = std::f64::consts::TAU * f64::from(k) / f64::from(rim);
        let y = if k.is_multiple_of(2) { 4.0 } else { -4.0 };
        DVec3::new(libm::cos(angle), y, libm::sin(angle))
    };
    let tips = [DVec3::ZERO, DVec3::NEG_Y * 20.0];
    let faces = (0..rim).flat_map(|k| {
        let (here, next) = (2 + k, 2 + (k + 1) % rim);
        [[0, next, here], [1, here, next]]
    });
    Ok(Shape {
        positions: tips.into_iter().chain((0..rim).map(at)).collect(),
        triangles: faces.collect(),
    }
    .into_mesh(Shading::Flat)?)
}

/// A knot with as many vertices as the teapot of Tamura et al.: 2,421.
pub(super) fn knot_mesh() -> Result<Mesh, ReproduceError> {
    let shape = shape::torus_knot(2, 3, 0.62, 0.26, 0.2, 269, 9, DVec3::new(-0.2, 0.9, 0.0));
    Ok(shape.into_mesh(Shading::Smooth)?)
}

/// The knot, a board and a ball over a floor, apart from each other.
pub(super) fn knot_over_floor() -> Result<Scene, ReproduceError> {
    let knot = Object::new("knot", knot_mesh()?, CLAY);
    let board = shape::cuboid(DVec3::new(1.3, 0.6, 0.2), DVec3::new(0.12, 1.1, 0.9));
    let ball = shape::icosphere(2, 0.35, DVec3::new(0.4, 0.36, 1.0));
    let light = Light::horizontal_square(DVec3::new(1.0, 5.0, 1.0), 1.0);
    let camera = Camera::look_at([0.6, 2.2, 4.2], [0.1, 0.6, 0.0]);
    let objects = vec![knot, solid("board", board)?, solid("ball", ball)?];
    scene("knot of 2,421 vertices".to_owned(), camera, light, objects)
}

#[cfg(test)]
mod tests {
    use super::*;
    use gnomon_pipeline::world::adjacency::EdgeAdjacency;

    #[test]
    fn folded_cones_are_closed() {
        for folds in 2..=5 {
            let mesh = folded_cone(folds).unwrap();
            let report = EdgeAdjacency::new(mesh.triangles()).closedness(&mesh);
            assert!(report.is_closed(), "{folds}: {report}");
        }
    }

    #[test]
    fn casters_are_closed_and_face_outwards() {
        let scenes = [cylinders(16, 1.0), lights(4), acute_triangle(), wall()];
        for scene in scenes.map(Result::unwrap) {
            for caster in scene.casters() {
                let report = EdgeAdjacency::new(caster.mesh.triangles()).closedness(&caster.mesh);
                assert!(report.is_closed(), "{}: {report}", scene.name);
                assert!(caster.mesh.signed_volume() > 0.0, "{}", scene.name);
            }
        }
        assert_eq!(cylinders(8, 1.0).unwrap().casters().count(), 8);
        assert_eq!(lights(3).unwrap().lights.len(), 3);
    }
}
