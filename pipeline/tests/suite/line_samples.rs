//! Line-sampled shadow volumes against the exact oracle, their twin in f64, and themselves
//! without lists (docs/line-sampled-shadow-volumes.md).

use crate::map_support::{by, figure, scene, sized};
use glam::DVec3;
use gnomon_pipeline::geometry::caster::{Caster, CasterPolicy};
use gnomon_pipeline::geometry::line_sampling::edges::LineCasters;
use gnomon_pipeline::geometry::line_sampling::light::{ANGLE, LineLight};
use gnomon_pipeline::geometry::line_sampling::patches::Patches;
use gnomon_pipeline::geometry::line_sampling::walk::{LineReceiver, visible};
use gnomon_pipeline::measure::comparison::{Reference, ReferenceKind};
use gnomon_pipeline::measure::render::Rendered;
use gnomon_pipeline::truth::metrics::visibility::VisibilityError;
use gnomon_pipeline::truth::oracle::area::VisibilityImage;
use gnomon_pipeline::truth::oracle::surfaces::Surfaces;
use gnomon_pipeline::world::light::Light;
use gnomon_pipeline::world::light::{ConvexPolygon, HardLight, LightShape};
use gnomon_pipeline::world::light_image::LightImage;
use gnomon_pipeline::world::mesh::{Mesh, Shading};
use gnomon_pipeline::world::scene::Scene;
use gnomon_pipeline::world::scene::{Camera, Material, Object};
use gnomon_pipeline::world::shape;

const NAME: &str = "line-sampled-shadow-volumes";
const SIZE: [u32; 2] = [96, 72];

fn drawn(scene: &Scene, set: &[&str]) -> Rendered {
    sized(NAME, scene, set, SIZE).unwrap()
}

fn truth(scene: &Scene) -> Reference {
    Reference::new(scene, 0, SIZE, ReferenceKind::Exact, None, &|| ()).unwrap()
}

/// Root mean square and largest error, where the picture shows the surface that the truth
/// is of; D is never below 0.
fn error(scene: &Scene, truth: &Reference, set: &[&str]) -> [f64; 2] {
    let picture = drawn(scene, set);
    let negative = figure(&picture, "negative-depth-complexity");
    assert_eq!(negative, 0.0, "{}", scene.name);
    let under = truth.under(&picture.depth).unwrap();
    let pairs = picture.visibility.iter().zip(&under.truth.values);
    let off = pairs.map(|(v, t)| (f64::from(*v) - t).abs());
    let off: Vec<f64> = off.filter(|d| !d.is_nan()).collect();
    let rmse = (off.iter().map(|d| d * d).sum::<f64>() / off.len() as f64).sqrt();
    let most = off.iter().fold(0.0, |m: f64, d| m.max(*d));
    let name = &scene.name;
    println!(
        "{name} {set:?}: {rmse:.2e}, most {most:.2e}, {} compared",
        off.len()
    );
    [rmse, most]
}

fn with_lines(scene: &Scene, truth: &Reference, n: u32) -> f64 {
    error(scene, truth, &[&format!("lines={n}")])[0]
}

#[test]
fn errors_fall_with_the_number_of_lines() {
    for name in ["peer-a", "peer-b", "peer-c", "single-silhouette", "overlap"] {
        let scene = scene(name);
        let truth = truth(&scene);
        let errors = [4, 16, 64].map(|n| with_lines(&scene, &truth, n));
        assert!(errors[1] < 2.5e-3, "{name} {errors:?}");
        assert!(errors[1] < 0.34 * errors[0], "{name} {errors:?}");
        assert!(
            errors[2] < 0.34 * errors[1] || errors[2] < 2e-4,
            "{name} {errors:?}"
        );
    }
}

#[test]
fn scenes_of_every_kind_are_right() {
    for name in [
        "spheres", "creature", "cylinder", "columns", "demo", "two-box",
    ] {
        let scene = scene(name);
        let truth = truth(&scene);
        let error = with_lines(&scene, &truth, 16);
        assert!(error < 3e-3, "{name} {error}");
    }
}

fn shapes(centre: DVec3, size: f64) -> [LightShape; 4] {
    let corner = |x: f64, y: f64, z: f64| centre + DVec3::new(x, y, z) * size;
    let triangle = vec![
        corner(-0.6, 0.0, -0.4),
        corner(0.1, 0.1, 0.7),
        corner(0.7, 0.0, -0.3),
    ];
    let pentagon = [0.0, 1.0, 2.0, 3.0, 4.0].map(|k: f64| {
        let angle = k * std::f64::consts::TAU / 5.0;
        corner(0.7 * libm::cos(angle), 0.0, 0.7 * libm::sin(angle))
    });
    [
        LightShape::Disc {
            centre,
            normal: DVec3::new(0.2, 1.0, 0.1).normalize(),
            radius: 0.6 * size,
        },
        LightShape::Sphere {
            centre,
            radius: 0.5 * size,
        },
        LightShape::Polygon(ConvexPolygon::new(triangle).unwrap()),
        LightShape::Polygon(ConvexPolygon::new(pentagon.to_vec()).unwrap()),
    ]
}

fn centre(scene: &Scene) -> DVec3 {
    let HardLight::Point(centre) = scene.lights[0].hard() else {
        panic!("a point");
    };
    centre
}

#[test]
fn lights_of_every_shape_are_right() {
    for name in ["single-silhouette", "spheres"] {
        let mut scene = scene(name);
        for shape in shapes(centre(&scene), 1.0) {
            scene.lights[0].shape = shape;
            let truth = truth(&scene);
            let errors = [8, 32].map(|n| with_lines(&scene, &truth, n));
            assert!(
                errors[1] < 2e-3 && errors[1] < 0.5 * errors[0] + 2e-4,
                "{name} {errors:?}"
            );
        }
    }
}

/// An image, as the oracle has it; a plain light would be far off.
#[test]
fn images_on_lights_are_summed_along_lines() {
    let scene = scene("parallel-plates");
    for (name, image) in [
        ("windows", LightImage::windows()),
        ("fire", LightImage::fire(0)),
    ] {
        let truth = VisibilityImage::of_light_image(&scene, 0, (&image, 0), SIZE, &|| ()).unwrap();
        let error = |set: &[&str]| {
            let picture = drawn(&scene, set);
            let error = VisibilityError::measure(&truth, SIZE, &picture.visibility).unwrap();
            error.all.unwrap().rmse
        };
        let told = format!("light-image={name}");
        let own = error(&["lines=64", &told]);
        let plain = error(&["lines=64"]);
        assert!(own < 3e-3 && plain > 3.0 * own, "{name} {own} {plain}");
    }
}

/// Lists leave out nothing that matters, wherever they are made.
#[test]
fn skipping_changes_no_bit() {
    for name in [
        "peer-a",
        "creature",
        "spheres",
        "two-box",
        "adversarial-near-plane",
    ] {
        let scene = scene(name);
        for lines in ["lines=5", "lines=40"] {
            let [on, off] = ["skip=on", "skip=off"]
                .map(|skip| sized(NAME, &scene, &[lines, skip], [56, 40]).unwrap());
            assert_eq!(
                on.visibility_hash(),
                off.visibility_hash(),
                "{name} {lines}"
            );
            assert_eq!(on.color_hash(), off.color_hash(), "{name} {lines}");
            let tests = |p: &Rendered| figure(p, "edge-tests");
            assert!(tests(&on) < 0.8 * tests(&off), "{name}");
        }
    }
}

/// The twin goes through every edge for every receiver, in f64.
struct Twin {
    casters: LineCasters,
    own: Vec<Option<u32>>,
    surfaces: Surfaces,
    light: LineLight,
}

impl Twin {
    fn new(scene: &Scene) -> Self {
        let light = &scene.lights[0];
        let (mut casters, mut own) = (LineCasters::default(), Vec::new());
        for object in &scene.objects {
            let triangles = object.mesh.triangles().len();
            if !object.casts {
                own.extend(vec![None; triangles]);
                continue;
            }
            let caster = Caster::of_object(object, CasterPolicy::Generalised).unwrap();
            let patches = Patches::new(&object.mesh, caster.adjacency());
            let counting = caster.counting(&object.mesh, light.hard());
            let first = casters.push(&object.mesh, &caster, &patches, counting);
            own.extend(patches.of_triangle.iter().map(|p| Some(first + p)));
        }
        Self {
            casters,
            own,
            surfaces: Surfaces::new(scene),
            light: LineLight::new(&light.shape, ANGLE).unwrap().unwrap(),
        }
    }

    fn seen(&self, scene: &Scene, n: u32, size: [u32; 2]) -> Vec<f64> {
        let rays = scene.camera.eye_rays(size[0], size[1]);
        let pixel = |k: u32| {
            let [x, y] = [k % size[0], k / size[0]].map(|c| f64::from(c) + 0.5);
            let Some(hit) = self.surfaces.hit(&rays, x, y) else {
                return f64::NAN;
            };
            let receiver = self.surfaces.receiver_of(&hit, &rays, x, y);
            let own = self.own[self.surfaces.index_of(&hit) as usize];
            let receiver = LineReceiver {
                point: receiver.point,
                own: own.and_then(|own| Some((own, receiver.normal?))),
            };
            visible(&self.casters, &self.light, n, receiver).share
        };
        (0..size[0] * size[1]).map(pixel).collect()
    }
}

/// Lanes are the twin's but for rounding: hardly any pixel is off by more, and none of
/// those that count.
#[test]
fn lanes_are_their_twin() {
    let size = [40, 30];
    for name in [
        "peer-a", "overlap", "creature", "spheres", "two-box", "cylinder",
    ] {
        let mut scene = scene(name);
        let shapes = shapes(centre(&scene), 1.0);
        let own = scene.lights[0].shape.clone();
        for shape in std::iter::once(own).chain(shapes) {
            scene.lights[0].shape = shape;
            let picture = sized(NAME, &scene, &["lines=20"], size).unwrap();
            let twin = Twin::new(&scene).seen(&scene, 20, size);
            let pairs = picture.visibility.iter().zip(&twin);
            let off = pairs.map(|(a, b)| (f64::from(*a) - b).abs());
            let off: Vec<f64> = off.filter(|d| !d.is_nan()).collect();
            let wrong = off.iter().filter(|d| **d > 2e-3).count();
            let most = off.iter().fold(0.0, |m: f64, d| m.max(*d));
            println!(
                "{name} {:?}: {wrong} of {}, {most:.1e}",
                scene.lights[0].shape,
                off.len()
            );
            assert!(wrong * 400 <= off.len(), "{name}: {wrong} of {}", off.len());
        }
    }
}

/// More events on a line than are kept at a time take more looks, and lose nothing.
#[test]
fn lines_with_many_events_are_looked_at_again() {
    let mut scene = scene("wireframe");
    let centre = centre(&scene);
    scene.lights[0].shape = LightShape::Rectangle {
        centre,
        edge_u: DVec3::X * 6.0,
        edge_v: DVec3::Z * 6.0,
    };
    let picture = drawn(&scene, &["lines=8"]);
    assert!(figure(&picture, "second-looks") > 20.0);
    assert_eq!(figure(&picture, "negative-depth-complexity"), 0.0);
    let twin = Twin::new(&scene).seen(&scene, 8, SIZE);
    let pairs = picture.visibility.iter().zip(&twin);
    let off = pairs
        .map(|(a, b)| (f64::from(*a) - b).abs())
        .filter(|d| *d > 1e-3);
    assert!(off.count() < 20);
}

/// Lights without extent throw the hard shadows of volumes.
#[test]
fn lights_without_extent_are_hard() {
    let mut scene = scene("creature");
    let position = centre(&scene);
    let towards = DVec3::new(0.4, 1.0, 0.3);
    for shape in [
        LightShape::Point { position },
        LightShape::Directional { towards },
    ] {
        scene.lights[0].shape = shape;
        let hard = by("shadow-volumes", &scene, &[]);
        let lines = by(NAME, &scene, &[]);
        assert_eq!(hard.visibility_hash(), lines.visibility_hash());
    }
}

/// An eye in shadow, and more volumes than a stencil counts.
#[test]
fn the_count_before_the_centre_is_right_in_hard_cases() {
    for name in [
        "adversarial-eye-in-shadow",
        "adversarial-nested-300",
        "adversarial-near-plane",
    ] {
        let scene = scene(name);
        let truth = truth(&scene);
        let error = with_lines(&scene, &truth, 32);
        assert!(error < 4e-3, "{name} {error}");
    }
}

/// Edges of one facet are contours from everywhere: a sheet's shadow is that of the truth,
/// whichever way round its triangles are, from above and from below.
#[test]
fn sheets_have_the_shadow_of_the_truth() {
    let corners = [
        [-0.6, 1.0, -0.5],
        [0.7, 1.0, -0.4],
        [0.6, 1.0, 0.5],
        [-0.5, 1.0, 0.4],
    ];
    let floor = shape::plane(6.0, 0.0).into_mesh(Shading::Flat).unwrap();
    for triangles in [
        [[0, 2, 1], [0, 3, 2]],
        [[0, 1, 2], [0, 2, 3]],
        [[0, 2, 1], [0, 2, 3]],
    ] {
        let sheet = Mesh::new(corners.to_vec(), triangles.to_vec(), Shading::Flat).unwrap();
        let floor = Object::new("floor", floor.clone(), Material::matt([0.6; 3]));
        let sheet = Object::new("sheet", sheet, Material::matt([0.8; 3]));
        let scene = Scene::new(
            Camera::look_at([0.6, 2.9, 4.1], [0.0, 0.6, 0.0]),
            vec![Light::horizontal_square(DVec3::new(0.4, 3.5, 0.2), 0.8)],
            vec![floor.receiver_only(), sheet],
        );
        let truth = truth(&scene);
        let [rmse, _] = error(&scene, &truth, &["lines=32", "open-casters=generalised"]);
        assert!(rmse < 3e-3, "{triangles:?}: {rmse}");
    }
}

fn solid(name: &str, centre: DVec3, size: DVec3) -> Object {
    let mesh = shape::cuboid(centre, size)
        .into_mesh(Shading::Flat)
        .unwrap();
    Object::new(name, mesh, Material::matt([0.7; 3]))
}

/// A beam between a light and what is behind its own top: below the horizon its other edges
/// are in the way of nothing that is seen, and lines are reached without passing there.
#[test]
fn lines_are_reached_before_the_horizon() {
    let mut errors = Vec::new();
    for [half, tilt] in [[0.9, 0.0], [0.9, 0.5], [1.5, -0.7]] {
        let light = Light {
            shape: LightShape::Rectangle {
                centre: DVec3::new(-1.1, -0.15, 0.1),
                edge_u: DVec3::new(0.0, 1.2, tilt),
                edge_v: DVec3::new(0.1, 0.0, 2.0 * half),
            },
            colour: [1.0; 3],
        };
        let scene = Scene::new(
            Camera::look_at([0.5, 1.6, 1.4], [0.1, 0.0, 0.0]),
            vec![light],
            vec![
                solid(
                    "beam",
                    DVec3::new(0.3, -0.5, 0.0),
                    DVec3::new(1.6, 1.0, 0.6),
                ),
                solid(
                    "block",
                    DVec3::new(-0.2, 0.1, 0.1),
                    DVec3::new(0.1, 0.2, 0.2),
                ),
            ],
        );
        let truth = truth(&scene);
        errors.push(error(&scene, &truth, &["lines=48"]));
    }
    assert!(errors.iter().all(|[rmse, _]| *rmse < 4e-3), "{errors:?}");
}

/// A light that the plane of a caster's own facet cuts, near to it, seen from afar: neither
/// the facet nor its edges hide it, though positions are rounded by as much as they are far.
#[test]
fn own_planes_hide_nothing_wherever_the_eye_is() {
    let mut errors = Vec::new();
    for away in [1.0, 40.0, 160.0] {
        let eye = DVec3::new(0.4, 3.0, 2.5) * away;
        let mut camera = Camera::look_at(eye.to_array(), [0.0, 0.0, 0.0]);
        camera.near *= away;
        camera.fov_y_degrees /= away;
        let light = Light {
            shape: LightShape::Rectangle {
                centre: DVec3::new(-1.1, 0.1, 0.2),
                edge_u: DVec3::new(0.0, 0.8, 0.1),
                edge_v: DVec3::new(0.1, 0.0, 0.9),
            },
            colour: [1.0; 3],
        };
        let scene = Scene::new(
            camera,
            vec![light],
            vec![
                solid(
                    "table",
                    DVec3::new(0.3, -0.5, 0.0),
                    DVec3::new(2.0, 1.0, 2.0),
                ),
                solid(
                    "block",
                    DVec3::new(0.0, 0.15, 0.1),
                    DVec3::new(0.3, 0.3, 0.4),
                ),
            ],
        );
        let truth = truth(&scene);
        errors.push(error(&scene, &truth, &["lines=48"]));
    }
    assert!(errors.iter().all(|[rmse, _]| *rmse < 4e-3), "{errors:?}");
}
