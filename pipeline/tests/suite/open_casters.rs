//! `open-casters=generalised`: pictures of casters that are open or not
//! manifold, against counts by brute force.
//!
//! The truth here is written without the package's own: a plain f64 test of
//! every triangle against the segment from the visible point to the light. The
//! package's truth says only which pixels are away from edges, and has to give
//! the same counts.

use std::sync::Arc;

use glam::DVec3;
use gnomon_pipeline::geometry::caster::Caster;
use gnomon_pipeline::geometry::silhouette::light_facing;
use gnomon_pipeline::measure::comparison::{Reference, ReferenceKind};
use gnomon_pipeline::measure::render::{RenderError, RenderSettings, Rendered, render};
use gnomon_pipeline::technique::{Params, TechniqueError};
use gnomon_pipeline::techniques;
use gnomon_pipeline::truth::metrics::visibility::VisibilityError;
use gnomon_pipeline::truth::oracle::hard::{EdgeTolerance, HardTruth, PixelTruth};
use gnomon_pipeline::world::light::{HardLight, Light, LightShape};
use gnomon_pipeline::world::mesh::{Mesh, Shading};
use gnomon_pipeline::world::scene::{Camera, Material, Object, Scene};
use gnomon_pipeline::world::shape;
use gnomon_raster::GpuConfig;

const SIZE: [u32; 2] = [160, 128];

fn mesh(positions: &[[f32; 3]], triangles: &[[u32; 3]]) -> Mesh {
    Mesh::new(positions.to_vec(), triangles.to_vec(), Shading::Flat).unwrap()
}

/// No bottom and no lid.
fn open_cylinder() -> Mesh {
    let mut tube = shape::cylinder(24, 0.6, 0.3, 1.4);
    let flat = |t: &[u32; 3], shape: &shape::Shape| {
        let y = t.map(|i| shape.positions[i as usize].y);
        y[0] == y[1] && y[1] == y[2]
    };
    let all = tube.clone();
    tube.triangles.retain(|t| !flat(t, &all));
    assert_eq!(tube.triangles.len(), 48);
    tube.into_mesh(Shading::Flat).unwrap()
}

/// Three triangles on one edge, none of them in the plane of the light.
fn three_fins() -> Mesh {
    mesh(
        &[
            [-1.0, 0.6, 0.0],
            [1.0, 0.9, 0.1],
            [0.1, 1.8, 0.7],
            [-0.2, 0.5, 1.0],
            [0.3, 0.7, -0.9],
        ],
        &[[0, 1, 2], [0, 1, 3], [0, 1, 4]],
    )
}

/// Two boxes that share a face, which both of them have: its edges are used
/// four times.
fn glued_shells() -> Mesh {
    let grid = |k: u32| {
        [
            (k % 3) as f32 * 0.7 - 0.7,
            0.4 + (k / 3 % 2) as f32 * 0.8,
            (k / 6) as f32 * 0.7 - 0.35,
        ]
    };
    let positions: Vec<[f32; 3]> = (0..12).map(grid).collect();
    let mut triangles = Vec::new();
    for x in 0..2 {
        let c = |k: u32| x + k % 2 + 3 * (k / 2 % 2) + 6 * (k / 4);
        for [p, q, r, s] in [
            [0, 2, 3, 1],
            [4, 5, 7, 6],
            [0, 1, 5, 4],
            [2, 6, 7, 3],
            [0, 4, 6, 2],
            [1, 3, 7, 5],
        ] {
            triangles.push([c(p), c(q), c(r)]);
            triangles.push([c(p), c(r), c(s)]);
        }
    }
    mesh(&positions, &triangles)
}

/// A sheet of which each triangle is there twice, once more turned round.
fn duplicates() -> Mesh {
    let positions = [
        [-0.9, 0.7, -0.6],
        [0.9, 0.9, -0.5],
        [0.8, 1.3, 0.7],
        [-0.7, 1.1, 0.8],
    ];
    let sheet = [[0, 1, 2], [0, 2, 3]];
    let mut triangles = Vec::new();
    for [a, b, c] in sheet {
        triangles.extend([[a, b, c], [b, c, a], [a, c, b]]);
    }
    mesh(&positions, &triangles)
}

fn casters() -> [(&'static str, Mesh, u32); 3] {
    // Each with a count that some pixel has.
    [
        ("open cylinder", open_cylinder(), 2),
        ("three fins", three_fins(), 2),
        ("duplicates", duplicates(), 3),
    ]
}

/// Above a floor, from the lit and from the unlit side.
fn scenes(caster: &Mesh) -> Vec<Scene> {
    let floor = shape::plane(6.0, 0.0).into_mesh(Shading::Flat).unwrap();
    let lights = [
        LightShape::Point {
            position: DVec3::new(1.3, 3.9, 0.7),
        },
        LightShape::Directional {
            towards: DVec3::new(-0.47, 1.0, 0.31),
        },
    ];
    let eyes = [[0.6, 2.9, 4.1], [-2.2, 0.25, 2.6]];
    let mut list = Vec::new();
    for light in lights {
        for eye in eyes {
            let object = Object::new("caster", caster.clone(), Material::matt([0.8; 3]));
            let floor = Object::new("floor", floor.clone(), Material::matt([0.6; 3]));
            list.push(Scene::new(
                Camera::look_at(eye, [0.0, 0.6, 0.0]),
                vec![Light {
                    shape: light.clone(),
                    colour: [1.0; 3],
                }],
                vec![floor.receiver_only(), object],
            ));
        }
    }
    list
}

fn draw(scene: &Scene, params: &[&str]) -> Result<Rendered, RenderError> {
    let technique = techniques::find("shadow-volumes").unwrap();
    let params = Params::parse(technique, params).unwrap();
    let settings = RenderSettings {
        size: SIZE,
        gpu: GpuConfig {
            threads: 1,
            ..GpuConfig::default()
        },
        repeat: 1,
    };
    render(scene, technique, &params, &settings)
}

/// Where the segment from `from` along `d` (0..1) crosses a triangle, by signed volumes.
fn crosses(from: DVec3, d: DVec3, end: f64, corners: [DVec3; 3]) -> bool {
    let [a, b, c] = corners.map(|v| v - from);
    let n = (b - a).cross(c - a);
    let sides = [d.dot(a.cross(b)), d.dot(b.cross(c)), d.dot(c.cross(a))];
    let inside = sides.iter().all(|s| *s > 0.0) || sides.iter().all(|s| *s < 0.0);
    let t = n.dot(a) / n.dot(d);
    inside && t > 0.0 && t < end
}

/// Counts for one pixel: of all triangles between the surface and the light,
/// and of those that face the light.
fn brute_force(scene: &Scene, at: [u32; 2], depth: f64) -> [u32; 2] {
    let light = scene.lights[0].hard();
    let rays = scene.camera.eye_rays(SIZE[0], SIZE[1]);
    let [x, y] = at.map(|v| f64::from(v) + 0.5);
    // A little off the surface, on the eye's side of it.
    let point = rays.origin + rays.direction(x, y) * (depth * (1.0 - 1e-7));
    let end = if matches!(light, HardLight::Directional(_)) {
        f64::INFINITY
    } else {
        1.0
    };
    let mesh = &scene.objects[1].mesh;
    let facing = light_facing(mesh, light);
    let mut counts = [0; 2];
    for t in 0..mesh.triangles().len() {
        if crosses(point, light.towards_from(point), end, mesh.corners(t)) {
            counts[0] += 1;
            counts[1] += u32::from(facing[t]);
        }
    }
    counts
}

#[derive(Debug, Default)]
struct Seen {
    compared: usize,
    shadowed: usize,
    /// Of the caster's own surface.
    own: usize,
    most: u32,
    /// Where counting each layer once would differ.
    unweighted: usize,
}

fn check(what: &str, scene: &Scene, method: &str, seen: &mut Seen) {
    let drawn = draw(scene, &["open-casters=generalised", method]).unwrap();
    let truth = HardTruth::of_scene(scene, 0, SIZE, EdgeTolerance::HALF_PIXEL_AND_DEPTH);
    for y in 0..SIZE[1] {
        for x in 0..SIZE[0] {
            let pixel = truth.pixel(x, y);
            let Some(hit) = pixel.centre.hit.filter(|_| pixel.interior) else {
                continue;
            };
            let [count, facing] = brute_force(scene, [x, y], hit.depth);
            let i = (y * SIZE[0] + x) as usize;
            let at = format!("{what}, {method}, pixel ({x}, {y}), object {}", hit.object);
            assert_eq!(
                pixel.centre.shadow_count, count,
                "{at}: the package's truth"
            );
            assert_eq!(u32::from(drawn.stencil[i]), count, "{at}: the stencil");
            assert_eq!(drawn.visibility[i] == 0.0, count != 0, "{at}: visibility");
            seen.compared += 1;
            seen.shadowed += usize::from(count > 0);
            seen.own += usize::from(hit.object == 1);
            seen.most = seen.most.max(count);
            seen.unweighted += usize::from(count != facing);
        }
    }
}

#[test]
fn stencils_equal_the_weighted_count() {
    for (what, mesh, most) in casters() {
        let mut seen = Seen::default();
        for scene in scenes(&mesh) {
            for method in ["method=zfail", "method=auto"] {
                check(what, &scene, method, &mut seen);
            }
        }
        eprintln!("{what}: {seen:?}");
        assert!(
            seen.compared > 80_000 && seen.shadowed > 4_000,
            "{what}: {seen:?}"
        );
        assert!(seen.own > 2_000 && seen.most >= most, "{what}: {seen:?}");
        // Negative control: the rule of closed casters counts otherwise.
        assert!(seen.unweighted > 1_000, "{what}: {seen:?}");
    }
}

/// As many faces go one way along each of their edges as the other, so they need no
/// generalised silhouettes: each body counts.
#[test]
fn shells_that_share_edges_are_closed() {
    let mesh = glued_shells();
    assert!(Caster::new(&mesh).report().is_closed());
    let (mut compared, mut shadowed) = (0, 0);
    for scene in scenes(&mesh) {
        let truth = HardTruth::of_scene(&scene, 0, SIZE, EdgeTolerance::HALF_PIXEL_AND_DEPTH);
        for method in ["method=zfail", "method=auto"] {
            let drawn = draw(&scene, &[method]).unwrap();
            let pixels = truth.pixels.iter().zip(&drawn.stencil);
            for (pixel, stencil) in pixels.filter(|(p, _)| p.interior && p.centre.hit.is_some()) {
                assert_eq!(u32::from(*stencil), pixel.centre.shadow_count, "{method}");
                compared += 1;
                shadowed += usize::from(*stencil > 0);
            }
        }
    }
    assert!(
        compared > 80_000 && shadowed > 4_000,
        "{compared} {shadowed}"
    );
}

/// They are what they are said to be, and refused unless asked for.
#[test]
fn the_casters_are_open_or_not_manifold() {
    for (what, mesh, _) in casters() {
        let caster = Caster::new(&mesh);
        let report = caster.report();
        assert!(!report.is_closed(), "{what}: {report}");
        let light = HardLight::Point(DVec3::new(1.3, 3.9, 0.7));
        let weight = caster.volume(&mesh, light).max_multiplicity();
        assert!(weight >= 2 || what == "three fins", "{what}: {weight}");
        let refused = draw(&scenes(&mesh)[0], &[]).unwrap_err();
        assert!(
            matches!(
                refused,
                RenderError::Technique(TechniqueError::RefusedCaster(_))
            ),
            "{what}: {refused}"
        );
    }
}

/// The picture without one of the caster's triangles is not the truth's.
#[test]
fn negative_control_a_missing_triangle_is_noticed() {
    for (what, mesh, _) in casters() {
        let scene = scenes(&mesh).remove(0);
        let truth = HardTruth::of_scene(&scene, 0, SIZE, EdgeTolerance::HALF_PIXEL_AND_DEPTH);
        let triangles = mesh.triangles();
        let without = |t: usize| {
            let rest = [&triangles[..t], &triangles[t + 1..]].concat();
            let rest = Mesh::new(mesh.positions().to_vec(), rest, Shading::Flat).unwrap();
            let mut less = scene.clone();
            less.objects[1].mesh = Arc::new(rest);
            let drawn = draw(&less, &["open-casters=generalised"]).unwrap();
            let on_floor = |(p, _): &(&PixelTruth, &u8)| {
                p.interior && p.centre.hit.is_some_and(|h| h.object == 0)
            };
            let pixels = truth.pixels.iter().zip(&drawn.stencil).filter(on_floor);
            let differ = pixels.filter(|(p, s)| p.centre.shadow_count != u32::from(**s));
            differ.count()
        };
        let step = triangles.len().div_ceil(8);
        let differ: Vec<usize> = (0..triangles.len()).step_by(step).map(without).collect();
        let noticed = differ.iter().filter(|d| **d > 20).count();
        assert!(2 * noticed >= differ.len(), "{what}: {differ:?}");
    }
}

/// No technique with volumes draws an open cylinder unless it is asked to.
#[test]
fn every_technique_with_volumes_refuses_an_open_cylinder() {
    let scene = scenes(&open_cylinder()).remove(0);
    let mut refusing = 0;
    for technique in techniques::all() {
        if !technique.capabilities().needs_closed_casters() {
            continue;
        }
        let settings = RenderSettings {
            size: [32, 24],
            ..RenderSettings::default()
        };
        let refused = render(&scene, *technique, &Params::defaults(*technique), &settings);
        let message = refused.unwrap_err().to_string();
        let name = technique.name();
        assert!(
            message.contains("not closed") && message.contains("open-casters=generalised"),
            "{name}: {message}"
        );
        let asked = Params::parse(*technique, ["open-casters=generalised"]).unwrap();
        render(&scene, *technique, &asked, &settings).unwrap();
        refusing += 1;
    }
    assert!(refusing >= 6, "{refusing}");
}

/// RMSE of a soft shadow of one open caster over a floor.
fn soft_rmse(caster: &Mesh) -> f64 {
    let mut scene = scenes(caster).remove(0);
    scene.lights = vec![Light::horizontal_square(DVec3::new(0.4, 3.5, 0.2), 0.8)];
    let technique = techniques::find("soft-shadow-volumes").unwrap();
    let params = Params::parse(technique, ["open-casters=generalised"]).unwrap();
    let settings = RenderSettings {
        size: SIZE,
        ..RenderSettings::default()
    };
    let drawn = render(&scene, technique, &params, &settings).unwrap();
    let truth = Reference::new(&scene, 0, SIZE, ReferenceKind::Exact, None, &|| ()).unwrap();
    let truth = truth.under(&drawn.depth).unwrap().truth;
    let known = drawn.visibility.iter().zip(&truth.values);
    let seen: Vec<f32> = known
        .map(|(v, t)| if t.is_nan() { f32::NAN } else { *v })
        .collect();
    let error = VisibilityError::measure(&truth, SIZE, &seen).unwrap();
    eprintln!("{} triangles: {:?}", caster.triangles().len(), error.all);
    error.all.unwrap().rmse
}

/// A flat sheet has one silhouette for all of the light: its soft shadow is exact,
/// whichever way its triangles wind. Of an open tube both walls count, as two casters
/// would.
#[test]
fn an_open_sheet_has_the_soft_shadow_of_the_truth() {
    let corners = [[-0.6, -0.5], [0.7, -0.4], [0.6, 0.5], [-0.5, 0.4]];
    let flat = corners.map(|[x, z]| [x, 1.0, z]);
    for triangles in [
        [[0, 2, 1], [0, 3, 2]],
        [[0, 1, 2], [0, 2, 3]],
        [[0, 2, 1], [0, 2, 3]],
    ] {
        let sheet = mesh(&flat, &triangles);
        assert!(soft_rmse(&sheet) < 1e-5);
    }
    assert!(soft_rmse(&open_cylinder()) > 1e-3, "walls overlap");
}
