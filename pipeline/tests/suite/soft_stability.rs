//! What is numerically hard, for every technique of the registry: no NaN, no
//! visibility outside 0..=1, no saturation that nothing tells of, and skipping that
//! stays invisible.
//!
//! Hundreds of small frames; how errors grow is measured by `gnomon stress` and held by
//! the module `stress`.

use crate::drawing::as_published;
use glam::DVec3;
use gnomon_pipeline::geometry::area_light::AreaLight;
use gnomon_pipeline::geometry::silhouette::{Orientation, Silhouette, light_facing};
use gnomon_pipeline::geometry::wedge::{Construction, Wedge, WedgeStatistics};
use gnomon_pipeline::measure::render::{RenderError, RenderSettings, Rendered, render};
use gnomon_pipeline::technique::{Params, Technique, TechniqueError};
use gnomon_pipeline::techniques;
use gnomon_pipeline::truth::metrics::visibility::VisibilityError;
use gnomon_pipeline::truth::oracle::area::VisibilityImage;
use gnomon_pipeline::world::adjacency::EdgeAdjacency;
use gnomon_pipeline::world::light::{HardLight, Light, LightShape};
use gnomon_pipeline::world::mesh::{Mesh, Shading};
use gnomon_pipeline::world::scene::{Camera, Material, Object, Scene, builtin};
use gnomon_pipeline::world::shape::{self, Shape};
use gnomon_raster::Counters;

const SIZE: [u32; 2] = [48, 32];

/// A picture by `technique`, quick to make; `None` where it refuses the light.
fn picture(scene: &Scene, technique: &dyn Technique, more: &[&str]) -> Option<Rendered> {
    let has = |name: &str| technique.params().iter().any(|p| p.name == name);
    let mut set = more.to_vec();
    if has("samples") {
        set.push("samples=16");
    }
    let published = as_published(technique).into_iter();
    let params = Params::parse(technique, published.chain(set)).unwrap();
    let settings = RenderSettings {
        size: SIZE,
        ..RenderSettings::default()
    };
    match render(scene, technique, &params, &settings) {
        Err(RenderError::Technique(TechniqueError::UnsuitableLight { .. })) => None,
        done => Some(done.unwrap()),
    }
}

fn check(what: &str, scene: &Scene, technique: &dyn Technique, picture: &Rendered) {
    let name = technique.name();
    let mut total = Counters::default();
    let passes = picture.report.passes.iter();
    passes.for_each(|p| total.add(&p.totals()));
    let seen = picture.depth.iter().zip(&picture.visibility);
    for (at, (depth, v)) in seen.enumerate() {
        let sane = (0.0..=1.0).contains(v) || (v.is_nan() && *depth >= 1.0);
        assert!(sane, "{what}, {name}: {v} at {at} of {}", scene.name);
    }
    let told = |code: &str| picture.warnings.iter().any(|w| w.code == code);
    assert!(!told("nan"), "{what}, {name}: {:?}", picture.warnings);
    assert!(!told("non-finite-vertices"), "{what}, {name}");
    let saturated: u64 = total.events.blend_saturated.iter().sum();
    let is_told = told("coverage-saturated") || told("blend-saturated");
    assert_eq!(saturated > 0, is_told, "{what}, {name}: {saturated}");
}

/// Every technique stays sane, and skipping changes no bit where there is any.
fn all_stay_sane(what: &str, scene: &Scene) {
    for technique in techniques::all() {
        let Some(on) = picture(scene, *technique, &[]) else {
            continue;
        };
        check(what, scene, *technique, &on);
        if technique.params().iter().any(|p| p.name == "skip") {
            let off = picture(scene, *technique, &["skip=off"]).unwrap();
            assert_eq!(
                on.visibility_hash(),
                off.visibility_hash(),
                "{what}, {}",
                technique.name()
            );
        }
    }
}

/// The largest error of `technique` against the oracle.
fn worst(scene: &Scene, technique: &str) -> f64 {
    let truth = VisibilityImage::of_scene(scene, 0, SIZE, &|| ()).unwrap();
    let technique = gnomon_pipeline::techniques::find(technique).unwrap();
    let picture = picture(scene, technique, &[]).unwrap();
    let error = VisibilityError::measure(&truth, SIZE, &picture.visibility).unwrap();
    error.all.unwrap().max
}

fn solid(name: &str, shape: Shape) -> Object {
    let mesh = shape.into_mesh(Shading::Flat).unwrap();
    Object::new(name, mesh, Material::matt([0.7; 3]))
}

/// `ulps` steps of f32 away from zero.
fn nudged(x: f32, ulps: i32) -> f32 {
    f32::from_bits(x.to_bits().wrapping_add_signed(ulps))
}

/// A wall in the plane through the light's centre and an edge of a plate above it,
/// but for `ulps`.
fn wall_on_the_hard_plane(ulps: i32) -> Scene {
    let x = nudged(1.0, ulps);
    let corners = [[0.0, -2.0], [1.2, -2.0], [1.2, 2.0], [0.0, 2.0]];
    let positions = corners.map(|[y, z]| [x, y, z]).to_vec();
    let triangles = vec![[0, 1, 2], [0, 2, 3]];
    let wall = Mesh::new(positions, triangles, Shading::Flat).unwrap();
    let wall = Object::new("wall", wall, Material::matt([0.7; 3])).receiver_only();
    // Its right side ends at x = 1.
    let plate = solid(
        "plate",
        shape::cuboid(DVec3::new(0.5, 2.0, 0.0), DVec3::new(1.0, 0.002, 1.0)),
    );
    let light = Light::horizontal_square(DVec3::new(1.0, 4.0, 0.0), 1.0);
    let camera = Camera::look_at([4.0, 1.2, 1.0], [1.0, 0.8, 0.0]);
    Scene::new(camera, vec![light], vec![wall, plate])
}

#[test]
fn receivers_on_the_hard_plane() {
    for ulps in -2..=2 {
        let scene = wall_on_the_hard_plane(ulps);
        all_stay_sane(&format!("wall {ulps} ulp off"), &scene);
        // Count and coverage share one predicate: were they at odds, pixels would
        // be wrong by 1. The plate's lower edges are none of its silhouette, and
        // hide a little light all the same.
        for technique in ["soft-shadow-volumes", "soft-shadow-volumes-optimised"] {
            let error = worst(&scene, technique);
            println!("{ulps} ulp, {technique}: {error}");
            assert!(error < 1e-3, "{ulps} ulp: {error}");
        }
    }
}

#[test]
fn edges_through_the_centre_of_the_light() {
    let block = || {
        solid(
            "block",
            shape::cuboid(DVec3::new(0.5, 1.0, 0.5), DVec3::splat(1.0)),
        )
    };
    let floor = || solid("floor", shape::plane(4.0, 0.0)).receiver_only();
    let camera = Camera::look_at([2.5, 2.5, 3.5], [0.3, 0.3, 0.3]);
    let shapes = |centre| {
        [
            LightShape::Rectangle {
                centre,
                edge_u: DVec3::X,
                edge_v: DVec3::Z,
            },
            LightShape::Disc {
                centre,
                normal: DVec3::NEG_Y,
                radius: 0.5,
            },
            LightShape::Sphere {
                centre,
                radius: 0.5,
            },
        ]
    };
    // Aimed at by upright edges; on an edge's line and in faces' planes; on an edge.
    let centres = [
        DVec3::new(1.0, 3.0, 1.0),
        DVec3::new(1.0, 1.5, 3.0),
        DVec3::new(1.0, 1.5, 0.5),
    ];
    for centre in centres {
        for shape in shapes(centre) {
            let light = Light {
                shape,
                colour: [1.0; 3],
            };
            let scene = Scene::new(camera, vec![light], vec![floor(), block()]);
            all_stay_sane(&format!("light at {centre}"), &scene);
        }
    }
}

/// Eyes inside the penumbra of each of a few edges, and on each of its planes.
#[test]
fn eyes_inside_wedges_and_on_their_planes() {
    let scene = builtin::build("cylinder").unwrap();
    let mesh = &scene.objects[1].mesh;
    let hard: HardLight = scene.lights[0].hard();
    let adjacency = EdgeAdjacency::new(mesh.triangles());
    let orientation = Orientation::closed(&light_facing(mesh, hard));
    let silhouette = Silhouette::new(mesh, &adjacency, &orientation);
    let light = AreaLight::new(&scene.lights[0].shape).unwrap().reversed();
    for edge in silhouette.edges.iter().step_by(9) {
        let ends = edge.map(|i| mesh.position(i));
        let met = &mut WedgeStatistics::default();
        for wedge in Wedge::of_edge(Construction::Exact, &light, ends, met) {
            let middle = (ends[0] + ends[1]) / 2.0;
            let inside = middle + (middle - light.centre()) * 0.2;
            assert!(wedge.volume.contains(inside));
            let planes = wedge.volume.planes().iter().copied();
            let planes = planes.chain(wedge.hard_plane());
            let on = planes.map(|p| inside - p.normal * p.distance(inside));
            for eye in [inside].into_iter().chain(on) {
                let mut scene = scene.clone();
                scene.camera.eye = eye;
                all_stay_sane(&format!("eye at {eye}"), &scene);
            }
        }
    }
}

/// Plates whose edges are behind each other as seen from the light's centre.
#[test]
fn stacks_of_forty_wedges() {
    let top = 6.0;
    let plate = |k: u32| {
        let y = 0.5 + 0.05 * f64::from(k);
        let side = 0.25 * (top - y - 0.005);
        shape::cuboid(DVec3::Y * y, DVec3::new(side, 0.01, side))
    };
    let plates = (0..40).map(|k| solid(&format!("plate {k}"), plate(k)));
    let floor = solid("floor", shape::plane(4.0, 0.0)).receiver_only();
    let objects = [floor].into_iter().chain(plates).collect();
    let light = Light::horizontal_square(DVec3::Y * top, 1.0);
    let camera = Camera::look_at([2.0, 1.0, 2.5], [0.0, 0.2, 0.0]);
    all_stay_sane("stack", &Scene::new(camera, vec![light], objects));
}

#[test]
fn scales_and_offsets() {
    let scene = builtin::build("cylinder").unwrap();
    for exponent in -4..=4 {
        let scale = libm::pow(10.0, f64::from(exponent));
        let placed = scene.placed(scale, DVec3::ZERO).unwrap();
        all_stay_sane(&format!("scale {scale:e}"), &placed);
    }
    for offset in [1e3, 1e4, 1e5] {
        let placed = scene.placed(1.0, DVec3::new(1.0, 0.5, -0.75) * offset);
        all_stay_sane(&format!("offset {offset:e}"), &placed.unwrap());
    }
}
