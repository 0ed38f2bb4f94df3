//! Scenes made to break shadow volumes, each in its own way.

use glam::DVec3;

use super::palette::{BRASS, CLAY, FLOOR, STEEL, STONE, floor, solid};
use crate::world::light::{Light, LightShape};
use crate::world::scene::{Camera, Object, Scene};
use crate::world::shape::{self, Shape};

/// A slab over the eye: the eye is deep inside its shadow volume.
pub(super) fn eye_in_shadow() -> Scene {
    let objects = vec![floor(8.0), roof(), ball(), crate_box()];
    Scene::new(camera(), vec![overhead_light()], objects)
}

/// A side of the slab's volume passes 1 cm beside the eye, through the near
/// rectangle, with the eye itself in light. z-fail is right, and so is z-pass with
/// depth clamp; with a clipping near plane it is wrong (`tests/near_plane.rs`).
pub(super) fn near_plane() -> Scene {
    let objects = vec![floor(8.0), knife_edge(), ball(), crate_box()];
    Scene::new(camera(), vec![overhead_light()], objects)
}

/// A stack of plates whose shadows nest: the count on the floor climbs to 300,
/// with a ring of exactly 256, which is light where an 8-bit stencil wraps
/// (`overflow=wrap`).
pub(super) fn nested_300() -> Scene {
    let light = Light::horizontal_square(DVec3::new(0.2, 9.0, 0.3), 1.0);
    let camera = Camera::look_at([3.0, 1.8, 7.6], [0.0, 2.1, 0.0]);
    Scene::new(camera, vec![light], vec![floor(8.0), stack()])
}

/// Needles, a disc of slivers, and plates a millimetre thick.
pub(super) fn slivers() -> Scene {
    let light = Light::horizontal_square(DVec3::new(1.5, 6.0, 1.0), 1.0);
    let camera = Camera::look_at([0.5, 3.0, 5.0], [0.0, 0.6, 0.0]);
    Scene::new(
        camera,
        vec![light],
        vec![floor(6.0), needles(), sliver_disc(), thin_plates()],
    )
}

/// The still life at a ten-thousandth of its size.
pub(super) fn tiny() -> Scene {
    still_life(1e-4, DVec3::ZERO)
}

/// The still life ten thousand times as large.
pub(super) fn huge() -> Scene {
    still_life(1e4, DVec3::ZERO)
}

/// The still life far from the origin, where f32 resolves 8 millimetres.
pub(super) fn offset() -> Scene {
    still_life(1.0, DVec3::new(1e5, 0.0, 1e5))
}

/// The eye in shadow, a volume cutting the near plane, nested volumes and
/// slivers at once.
pub(super) fn combined() -> Scene {
    let aside = |object: Shape| object.translated(DVec3::new(-2.2, 0.0, -1.5));
    let objects = vec![
        floor(8.0),
        roof(),
        knife_edge(),
        ball(),
        solid("stack", aside(stack_shape()), STONE),
        sliver_disc(),
        needles(),
    ];
    Scene::new(camera(), vec![overhead_light()], objects)
}

fn camera() -> Camera {
    Camera::look_at([0.0, 1.5, 5.0], [0.0, 0.8, 0.0])
}

/// Straight above the eye, so that the line eye-light is vertical.
fn overhead_light() -> Light {
    Light::horizontal_square(DVec3::new(0.0, 8.0, 5.0), 1.0)
}

fn roof() -> Object {
    solid(
        "roof",
        shape::cuboid(DVec3::new(-1.0, 4.0, 4.6), DVec3::new(3.0, 0.2, 2.4)),
        CLAY,
    )
}

/// Its left edge is 5 mm right of the vertical through eye and light, 3 below
/// the light; 6.5 below it, level with the eye, its shadow starts 11 mm beside
/// the eye, and the near rectangle is 41 mm to each side.
fn knife_edge() -> Object {
    let (left, width) = (0.005, 2.0);
    let centre = DVec3::new(left + width / 2.0, 4.9, 4.6);
    solid(
        "knife edge",
        shape::cuboid(centre, DVec3::new(width, 0.2, 3.0)),
        STEEL,
    )
}

fn ball() -> Object {
    solid(
        "ball",
        shape::icosphere(3, 0.5, DVec3::new(-0.8, 0.7, 0.6)),
        BRASS,
    )
}

fn crate_box() -> Object {
    solid(
        "crate",
        shape::cuboid(DVec3::new(0.9, 0.4, 1.0), DVec3::splat(0.8)),
        STONE,
    )
}

fn stack() -> Object {
    solid("stack", stack_shape(), STONE)
}

/// 300 plates, 4 mm thick and 1 cm apart, each smaller than the one below.
fn stack_shape() -> Shape {
    Shape::merged((0..300).map(|i| {
        let i = f64::from(i);
        let side = 2.0 - 0.005 * i;
        shape::cuboid(DVec3::Y * (2.0 + 0.01 * i), DVec3::new(side, 0.004, side))
    }))
}

fn needles() -> Object {
    let needle = |k: u32| {
        let centre = DVec3::new(0.0, 0.4 + 0.15 * f64::from(k), 0.2 * f64::from(k) - 0.6);
        shape::cuboid(centre, DVec3::new(4.0, 0.002, 0.002 * f64::from(k + 1)))
    };
    solid("needles", Shape::merged((0..8).map(needle)), STEEL)
}

fn sliver_disc() -> Object {
    let disc = shape::cylinder(1024, 0.8, 1.4, 1.42);
    solid("disc", disc.translated(DVec3::new(0.9, 0.0, -0.4)), BRASS)
}

fn thin_plates() -> Object {
    let plate = |k: u32| {
        let centre = DVec3::new(-1.4 + 0.12 * f64::from(k), 0.5, 0.8);
        shape::cuboid(centre, DVec3::new(0.001, 0.9, 0.7))
    };
    solid("plates", Shape::merged((0..6).map(plate)), CLAY)
}

/// A cylinder, a ball and a box on a floor, scaled and then moved, with the
/// camera, its near plane and the light.
fn still_life(scale: f64, offset: DVec3) -> Scene {
    let place = |p: DVec3| p * scale + offset;
    let placed = |name: &str, mut shape: Shape, material| {
        shape.positions.iter_mut().for_each(|p| *p = place(*p));
        solid(name, shape, material)
    };
    let light = Light {
        shape: LightShape::Rectangle {
            centre: place(DVec3::new(1.7, 4.3, 1.1)),
            edge_u: DVec3::X * scale,
            edge_v: DVec3::Z * scale,
        },
        colour: [1.0; 3],
    };
    let camera = Camera {
        near: 0.1 * scale,
        ..Camera::look_at(
            place(DVec3::new(0.4, 2.6, 5.1)),
            place(DVec3::new(0.0, 0.6, 0.0)),
        )
    };
    let objects = vec![
        placed("floor", shape::plane(5.0, 0.0), FLOOR).receiver_only(),
        placed(
            "cylinder",
            shape::cylinder(32, 0.4, 0.1, 1.3).translated(DVec3::X * -1.1),
            CLAY,
        ),
        placed(
            "ball",
            shape::icosphere(3, 0.5, DVec3::new(0.2, 0.8, 0.5)),
            BRASS,
        ),
        placed(
            "box",
            shape::cuboid(DVec3::new(1.3, 0.5, -0.4), DVec3::splat(0.7)),
            STEEL,
        ),
    ];
    Scene::new(camera, vec![light], objects)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::caster::Caster;
    use crate::geometry::winding::volume_winding;

    /// Summed winding of all volumes at a point.
    fn count(scene: &Scene, p: DVec3) -> i32 {
        let light = scene.lights[0].hard();
        let volumes = scene
            .casters()
            .map(|o| Caster::new(&o.mesh).volume(&o.mesh, light));
        volumes.map(|v| volume_winding(&v, p)).sum()
    }

    #[test]
    fn the_eye_is_in_shadow_where_it_should_be() {
        let eye = |scene: &Scene| count(scene, scene.camera.eye);
        assert_eq!(eye(&eye_in_shadow()), 1);
        assert_eq!(eye(&combined()), 1);
        assert_eq!(eye(&near_plane()), 0);
    }

    #[test]
    fn a_volume_cuts_the_near_rectangle() {
        let scene = near_plane();
        let rays = scene.camera.eye_rays(100, 100);
        let at = |x: f64| {
            count(
                &scene,
                rays.origin + rays.direction(x, 50.0) * scene.camera.near,
            )
        };
        assert_eq!((at(10.0), at(90.0)), (0, 1));
    }

    #[test]
    fn three_hundred_volumes_nest() {
        let scene = nested_300();
        assert_eq!(count(&scene, DVec3::new(0.0, 0.001, 0.0)), 300);
        let rim =
            (0..200).map(|k| count(&scene, DVec3::new(0.8 + 0.002 * f64::from(k), 0.001, 0.0)));
        assert!(
            rim.into_iter().any(|c| c > 0 && c < 300),
            "the count climbs in rings"
        );
    }
}
