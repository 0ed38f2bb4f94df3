//! Pictures against rays in f64, fitting, and what is odd: nothing in the way,
//! lights inside geometry, receivers on both sides of the light.

use glam::DVec3;
use gnomon_raster::{Gpu, GpuConfig, Recording, Subresource};

use super::*;
use crate::parts::passes::View;
use crate::world::light::{Light, LightShape};
use crate::world::mesh::Shading;
use crate::world::scene::{Camera, Material, Object, Scene, builtin};
use crate::world::shape;

const PICTURE: [u32; 2] = [96, 64];
const SIZE: u32 = 64;

fn fitting(to: FitTo) -> Fitting {
    Fitting {
        size: SIZE,
        near: None,
        to,
        margin: 0.0,
    }
}

fn viewed(scene: &Scene) -> ViewedLight {
    ViewedLight::new("test", &scene.lights[0], 0).unwrap()
}

fn views(scene: &Scene, views: Views) -> Vec<Fitted> {
    let around = Surroundings::new(scene, PICTURE);
    views_of(&viewed(scene), &around, views, &fitting(FitTo::Casters)).views
}

/// The stored depths of a view, rows from the top.
fn depths(scene: &Scene, fitted: &Fitted, skip: bool) -> Vec<f32> {
    sloped(scene, fitted, skip, 0.0)
}

/// The same with a slope bias in texels.
fn sloped(scene: &Scene, fitted: &Fitted, skip: bool, slope: f64) -> Vec<f32> {
    let mut recording = Recording::default();
    let view = View::new(&scene.camera, PICTURE);
    let around = Surroundings::new(scene, PICTURE);
    let geometry = CasterGeometry::new(scene, &around, &view, viewed(scene).frame.centre);
    let mut map = LightMap::create(SIZE, &mut recording).unwrap();
    map.slope = slope;
    let pass = fitted.pass("light view".into(), &geometry, &view, &map, skip);
    recording.list.passes.push(pass);
    let mut gpu = Gpu::new(GpuConfig::default()).unwrap();
    gpu.load(&recording).unwrap();
    gpu.submit(&recording.list).unwrap();
    let texels = gpu.texture(map.depth).unwrap();
    let texels = texels.read_color(Subresource::default()).unwrap();
    texels.iter().map(|t| t.0[0]).collect()
}

/// Triangles of an object that a view draws, or all.
fn drawn(scene: &Scene, fitted: &Fitted, object: &Object) -> Vec<usize> {
    let number = scene.objects.iter().position(|o| std::ptr::eq(o, object));
    match &fitted.triangles {
        None => (0..object.mesh.triangles().len()).collect(),
        Some(all) => {
            let own = all.iter().filter(|(o, _)| Some(*o) == number);
            own.map(|(_, t)| *t as usize).collect()
        }
    }
}

/// Planar distance to the nearest caster along tangents (x, y) in f64; infinite
/// without one.
fn cast(scene: &Scene, fitted: &Fitted, [x, y]: [f64; 2]) -> f64 {
    let ray = DVec3::new(x, y, 1.0);
    let mut nearest = f64::INFINITY;
    for object in scene.casters() {
        for t in drawn(scene, fitted, object) {
            let [a, b, c] = object.mesh.corners(t).map(|p| fitted.frame.local(p));
            let volumes = [[a, b], [b, c], [c, a]].map(|[p, q]| ray.dot(p.cross(q)));
            let inside = volumes.iter().all(|v| *v >= 0.0) || volumes.iter().all(|v| *v <= 0.0);
            let normal = (b - a).cross(c - a);
            let distance = normal.dot(a) / normal.dot(ray);
            if inside && distance >= fitted.range[0] {
                nearest = nearest.min(distance);
            }
        }
    }
    nearest
}

/// Share of texels whose depth is not that of the ray through their centre; those
/// whose neighbourhood is not smooth do not count.
fn wrong_texels(scene: &Scene, fitted: &Fitted) -> f64 {
    let stored = depths(scene, fitted, true);
    let [near, far] = fitted.range;
    let scaled = |z: f64| ((z - near) / (far - near)).clamp(0.0, 1.0);
    let tangent =
        |k: usize, at: f64| fitted.middle[k] + fitted.half * (2.0 * at / f64::from(SIZE) - 1.0);
    let (mut wrong, mut judged) = (0, 0);
    for (number, depth) in stored.iter().enumerate() {
        let [i, j] = [number as u32 % SIZE, number as u32 / SIZE].map(f64::from);
        let at = |dx: f64, dy: f64| {
            let place = [tangent(0, i + 0.5 + dx), tangent(1, j + 0.5 + dy)];
            scaled(cast(scene, fitted, place))
        };
        let truth = at(0.0, 0.0);
        let off = 0.02; // snapping moves outlines by 1/512 texel
        let around = [at(off, off), at(-off, off), at(off, -off), at(-off, -off)];
        let low = around.into_iter().fold(truth, f64::min) - 1e-5;
        let high = around.into_iter().fold(truth, f64::max) + 1e-5;
        if high - low > 2e-3 {
            continue;
        }
        judged += 1;
        if !(low..=high).contains(&f64::from(*depth)) {
            wrong += 1;
        }
    }
    assert!(judged > SIZE * SIZE / 2, "{judged} texels are judged");
    f64::from(wrong) / f64::from(judged)
}

#[test]
fn a_picture_is_what_rays_meet() {
    for (name, kind) in [
        ("cylinder", Views::Planar),
        ("creature", Views::Auto),
        ("cylinder", Views::Cube),
    ] {
        let scene = builtin::build(name).unwrap();
        let found = views(&scene, kind);
        assert!(!found.is_empty(), "{name} {kind:?}");
        for fitted in &found {
            let wrong = wrong_texels(&scene, fitted);
            assert_eq!(wrong, 0.0, "{name} {kind:?} {fitted:?}");
        }
    }
}

/// Objects left out cover no texel: the same bits with all of them.
#[test]
fn skipping_casters_changes_no_bit() {
    let mut left_out = 0;
    for (name, kind) in [
        ("columns", Views::Auto),
        ("demo", Views::Cube),
        ("spheres", Views::Auto),
    ] {
        let scene = builtin::build(name).unwrap();
        let casters = scene.casters().count();
        for fitted in views(&scene, kind) {
            left_out += casters - fitted.objects.len();
            let bits = |skip| {
                let depths = depths(&scene, &fitted, skip).into_iter();
                depths.map(f32::to_bits).collect::<Vec<_>>()
            };
            assert!(bits(true) == bits(false), "{name} {kind:?}");
        }
    }
    assert!(left_out > 0, "nothing was skipped, nothing is tested");
}

/// Every shadow ray of a receiver lies in the picture, or meets nothing.
#[test]
fn what_is_outside_the_picture_is_empty() {
    for name in ["cylinder", "columns", "creature", "demo"] {
        let scene = builtin::build(name).unwrap();
        let around = Surroundings::new(&scene, PICTURE);
        for fitted in views(&scene, Views::Auto) {
            for p in around.receivers().flatten() {
                let p = fitted.frame.local(*p);
                let place = [p.x / p.z, p.y / p.z];
                let off = [0, 1].map(|k| (place[k] - fitted.middle[k]).abs());
                if p.z <= 0.0 || off.iter().all(|t| *t <= fitted.half) {
                    continue;
                }
                let blocked = cast(&scene, &fitted, place) < p.z * (1.0 - 1e-9);
                assert!(!blocked, "{name}: {p} in {fitted:?}");
            }
        }
    }
}

#[test]
fn fitting_to_casters_is_tighter_and_to_receivers_holds_them() {
    let scene = builtin::build("cylinder").unwrap();
    let around = Surroundings::new(&scene, PICTURE);
    let of = |to| views_of(&viewed(&scene), &around, Views::Auto, &fitting(to)).views;
    let ([casters], [receivers]) = (&of(FitTo::Casters)[..], &of(FitTo::Receivers)[..]) else {
        panic!("one view each");
    };
    assert!(casters.half < 0.5 * receivers.half);
    assert_eq!(casters.range, receivers.range);
    for p in around.receivers().flatten() {
        let p = receivers.frame.local(*p);
        let off = [
            p.x / p.z - receivers.middle[0],
            p.y / p.z - receivers.middle[1],
        ];
        assert!(off.iter().all(|t| t.abs() < receivers.half), "{p}");
        assert!(p.z < receivers.range[1]);
    }
}

#[test]
fn without_casters_or_receivers_there_is_no_view() {
    let mut scene = builtin::build("cylinder").unwrap();
    scene.objects[1].casts = false;
    assert!(views(&scene, Views::Auto).is_empty());
    let mut scene = builtin::build("cylinder").unwrap();
    scene.objects.iter_mut().for_each(|o| o.receives = false);
    assert!(views(&scene, Views::Auto).is_empty());
    let mut scene = builtin::build("cylinder").unwrap();
    // Below the floor: what is seen is never behind the caster.
    let below = DVec3::new(0.0, -20.0, 0.0);
    scene.lights[0].shape = Light::horizontal_square(below, 1.0).shape;
    scene.objects[0].casts = false;
    let one_sided = views(&scene, Views::Auto);
    assert!(one_sided.len() == 1 && one_sided[0].frame.axes[2].y > 0.0);
}

/// A ball above a floor, a light between ball and floor, and a ceiling.
fn between() -> Scene {
    let matt = Material::matt([0.7; 3]);
    let solid = |name: &str, shape: shape::Shape| {
        Object::new(name, shape.into_mesh(Shading::Flat).unwrap(), matt)
    };
    let ball = |name: &str, y: f64| solid(name, shape::icosphere(1, 0.3, DVec3::Y * y));
    let ceiling = solid(
        "ceiling",
        shape::cuboid(DVec3::Y * 5.0, DVec3::new(8.0, 0.1, 8.0)),
    );
    let objects = vec![
        solid("floor", shape::plane(4.0, 0.0)).receiver_only(),
        ceiling.receiver_only(),
        ball("low ball", 1.0),
        ball("high ball", 4.0),
    ];
    let light = Light::horizontal_square(DVec3::Y * 2.5, 0.5);
    let camera = Camera {
        fov_y_degrees: 70.0,
        ..Camera::look_at([0.5, 2.4, 7.0], [0.0, 2.5, 0.0])
    };
    Scene::new(camera, vec![light], objects)
}

#[test]
fn receivers_on_both_sides_of_a_flat_light_have_a_view_each() {
    let scene = between();
    let found = views(&scene, Views::Auto);
    let along: Vec<f64> = found.iter().map(|v| v.frame.axes[2].y).collect();
    assert_eq!(along.len(), 2);
    assert!(along[0] * along[1] < 0.0, "{along:?}");
    for fitted in &found {
        assert_eq!(
            (wrong_texels(&scene, fitted), fitted.objects.len()),
            (0.0, 1)
        );
    }
}

#[test]
fn a_light_inside_a_room_is_looked_at_all_round() {
    let mut scene = between();
    let room = shape::cuboid(DVec3::Y * 2.0, DVec3::new(9.0, 7.0, 18.0));
    let room = room.into_mesh(Shading::Flat).unwrap();
    scene
        .objects
        .push(Object::new("room", room, Material::matt([0.5; 3])));
    scene.lights[0].shape = LightShape::Point {
        position: DVec3::new(0.3, 2.2, 0.4),
    };
    // Walls alone shadow nothing: two views have a ball in them.
    assert_eq!(views(&scene, Views::Auto).len(), 2);
    for beside in [
        DVec3::new(-2.0, 2.2, 0.0),
        DVec3::new(2.0, 2.2, 0.0),
        DVec3::new(0.3, 2.2, -2.0),
    ] {
        let ball = shape::icosphere(1, 0.3, beside).into_mesh(Shading::Flat);
        let ball = Object::new("ball", ball.unwrap(), Material::matt([0.7; 3]));
        scene.objects.push(ball);
    }
    let found = views(&scene, Views::Auto);
    // No receiver is seen behind the camera.
    assert!(found.len() >= 5, "{}", found.len());
    for fitted in &found {
        assert_eq!(fitted.region, ViewRegion::Face);
        assert!(fitted.half < 1.5 && wrong_texels(&scene, fitted) == 0.0);
    }
}

/// A caster round the light and nearer than the near distance is cut, and counted.
#[test]
fn casters_at_the_light_are_counted() {
    let mut scene = builtin::build("cylinder").unwrap();
    let centre = DVec3::new(1.6, 4.0, 1.0);
    let bulb = shape::icosphere(3, 0.05, centre);
    let bulb = bulb.into_mesh(Shading::Flat).unwrap();
    let bulb = Object::new("bulb", bulb, Material::matt([0.5; 3]));
    scene.objects.push(bulb);
    scene.lights[0].shape = LightShape::Point { position: centre };
    let around = Surroundings::new(&scene, PICTURE);
    let of = |near| {
        let fitting = Fitting {
            near,
            ..fitting(FitTo::Casters)
        };
        views_of(&viewed(&scene), &around, Views::Cube, &fitting).views
    };
    let cut = |near| of(near).iter().map(|v| v.cut).sum::<usize>();
    assert!(cut(Some(0.0499)) > 0);
    assert_eq!(cut(Some(0.06)), 0, "all of it is nearer");
    assert_eq!(cut(Some(0.01)), 0, "none of it is nearer");
}

/// A slope bias moves depths away from the light only, by no more than its limit,
/// and leaves those of facets that face the light.
#[test]
fn slopes_push_surfaces_back_by_what_texels_need() {
    let scene = builtin::build("creature").unwrap();
    for fitted in views(&scene, Views::Auto) {
        let plain = sloped(&scene, &fitted, true, 0.0);
        let pushed = sloped(&scene, &fitted, true, 0.5);
        let [near, far] = fitted.range;
        let limit = 8.0 * fitted.texel_at_far(SIZE) / (far - near);
        let moved: Vec<f64> = plain
            .iter()
            .zip(&pushed)
            .map(|(a, b)| f64::from(b - a))
            .collect();
        assert!(moved.iter().all(|m| (0.0..=limit + 1e-6).contains(m)));
        assert!(moved.iter().any(|m| *m > 0.1 * limit));
    }
    let scene = builtin::build("parallel-plates").unwrap();
    for fitted in views(&scene, Views::Auto) {
        let [plain, pushed] = [0.0, 0.5].map(|k| sloped(&scene, &fitted, true, k));
        assert!(plain == pushed, "the plate faces the light");
    }
}
