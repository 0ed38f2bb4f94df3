//! Deferred shadowing against closed forms, bounds and sampled directions, and against
//! itself where nothing may change.

use std::path::Path;

use glam::DVec3;
use gnomon_pipeline::geometry::harmonics::{Basis, dot};
use gnomon_pipeline::measure::comparison::{Directions, EnvironmentReference, RadianceScore};
use gnomon_pipeline::measure::render::Rendered;
use gnomon_pipeline::truth::oracle::transport::{Transport, TransportObject, TransportSettings};
use gnomon_pipeline::world::environment::decomposition::{DecompositionSettings, decompose};
use gnomon_pipeline::world::environment::{Environment, FitSettings, MapSettings};
use gnomon_pipeline::world::files::Outside;
use gnomon_pipeline::world::light::{Light, LightShape};
use gnomon_pipeline::world::mesh::{Mesh, Shading};
use gnomon_pipeline::world::scene::builtin::PLATES;
use gnomon_pipeline::world::scene::environment::{FittedMaps, place};
use gnomon_pipeline::world::scene::{Camera, Material, Object, Scene, builtin, file};
use gnomon_pipeline::world::shape::{self, Shape};
use gnomon_raster::GpuConfig;

use crate::drawing::{drawn, drawn_on};

pub(crate) const TECHNIQUE: &str = "deferred-shadowing";
pub(crate) const SIZE: [u32; 2] = [96, 64];

pub(crate) fn shown(scene: &Scene, set: &[&str]) -> Rendered {
    drawn(scene, TECHNIQUE, set, SIZE)
}

pub(crate) fn figure(done: &Rendered, name: &str) -> f64 {
    let found = done.figures.iter().find(|f| f.name == name);
    found
        .unwrap_or_else(|| panic!("no '{name}': {:?}", done.figures))
        .value
}

pub(crate) fn solid(name: &str, shape: Shape, shading: Shading, material: Material) -> Object {
    Object::new(name, shape.into_mesh(shading).unwrap(), material)
}

pub(crate) fn flat(name: &str, shape: Shape) -> Object {
    solid(name, shape, Shading::Flat, Material::matt([0.8, 0.7, 0.6]))
}

pub(crate) fn sky(side: usize) -> Environment {
    let settings = MapSettings {
        side,
        ..MapSettings::default()
    };
    Environment::open("sky", settings).unwrap()
}

pub(crate) fn lit_by(mut scene: Scene, map: &Environment) -> Scene {
    let fit = FitSettings {
        lights: 6,
        ..FitSettings::default()
    };
    place(&mut scene, map, map.fit(&fit).unwrap()).unwrap();
    scene
}

fn alone(object: Object) -> Scene {
    let camera = Camera::look_at([0.0, 0.6, 4.0], [0.0, 0.0, 0.0]);
    Scene::new(camera, Vec::new(), vec![object])
}

/// A ball over a floor, and a plate between them that touches neither's box.
pub(crate) fn two_over_a_floor() -> Scene {
    let plate = shape::cuboid(DVec3::new(0.3, 0.5, 0.0), DVec3::new(1.0, 0.06, 0.8));
    let ball = shape::icosphere(2, 0.4, DVec3::new(-0.2, 1.3, 0.1));
    Scene::new(
        Camera::look_at([0.5, 2.6, 4.2], [0.0, 0.4, 0.0]),
        vec![Light::horizontal_square(DVec3::new(0.4, 5.0, 0.3), 1.4)],
        vec![
            flat("floor", shape::plane(4.0, 0.0)).receiver_only(),
            flat("plate", plate),
            solid(
                "ball",
                ball,
                Shading::Smooth,
                Material::glossy([0.5; 3], 0.4, 12.0),
            ),
        ],
    )
}

/// Pixels of the plates' floor and what the closed form says there.
fn floor_errors(light_half: f64, set: &[&str]) -> f64 {
    let mut scene = builtin::build("parallel-plates").unwrap();
    if let LightShape::Rectangle { edge_u, edge_v, .. } = &mut scene.lights[0].shape {
        *edge_u *= light_half / PLATES.light_half;
        *edge_v *= light_half / PLATES.light_half;
    }
    let done = shown(&scene, set);
    let rays = scene.camera.eye_rays(SIZE[0], SIZE[1]);
    let [_, _, forward] = scene.camera.basis();
    let (mut squares, mut count) = (0.0, 0);
    for (i, visible) in done.visibility.iter().enumerate() {
        let at = [i as u32 % SIZE[0], i as u32 / SIZE[0]].map(|c| f64::from(c) + 0.5);
        let direction = rays.direction(at[0], at[1]);
        let t = -rays.origin.y / direction.y;
        let p = rays.origin + direction * t;
        let depth = 1.0 - scene.camera.near / (p - rays.origin).dot(forward);
        let seen = t > 0.0 && (f64::from(done.depth[i]) - depth).abs() < 1e-5;
        if seen && p.abs().max_element() < 4.0 {
            let error = f64::from(*visible) - PLATES.visibility(p.x, p.z);
            squares += error * error;
            count += 1;
        }
    }
    assert!(count > 500, "{count}");
    (squares / f64::from(count)).sqrt()
}

/// Light, plate and floor are parallel: the map is the box that the closed form is, to
/// the texel; a light of another size has another box.
#[test]
fn a_square_occluder_has_the_shadow_of_the_closed_form() {
    let errors = ["map-size=16", "map-size=64", "map-size=256"]
        .map(|size| floor_errors(PLATES.light_half, &[size, "format=f32"]));
    println!("{errors:?}");
    assert!(errors[1] < 0.02 && errors[2] < 0.006, "{errors:?}");
    assert!(errors[2] < errors[1] && errors[1] < errors[0], "{errors:?}");
    let half = floor_errors(PLATES.light_half, &["map-size=256"]);
    assert!((half - errors[2]).abs() < 1e-3, "{half} {errors:?}");
    let other = floor_errors(2.0 * PLATES.light_half, &["map-size=256"]);
    assert!(other > 4.0 * errors[2], "{other} {errors:?}");
}

/// Under the same light from everywhere an open convex object is as bright as its
/// albedo; one that hides light of itself is not.
#[test]
fn a_constant_environment_makes_convex_objects_white() {
    let ball = shape::icosphere(2, 1.0, DVec3::ZERO);
    let albedo = [0.8, 0.5, 0.25];
    let material = Material::matt(albedo);
    let scene = lit_by(
        alone(solid("ball", ball, Shading::Smooth, material)),
        &fine_white(16),
    );
    let done = shown(&scene, &["format=f32"]);
    let mut seen = 0;
    for (i, colour) in done.color.iter().enumerate() {
        if done.visibility[i].is_nan() {
            continue;
        }
        seen += 1;
        for c in 0..3 {
            assert!((colour[c] / albedo[c] - 1.0).abs() < 2e-3, "{colour:?}");
        }
        assert!((done.visibility[i] - 1.0).abs() < 2e-3);
    }
    assert!(seen > 1000, "{seen}");
    assert_eq!(figure(&done, "negative-radiance"), 0.0);
    let knot = shape::torus_knot(2, 3, 0.8, 0.3, 0.25, 60, 10, DVec3::ZERO);
    let scene = lit_by(
        alone(solid("knot", knot, Shading::Smooth, material)),
        &fine_white(16),
    );
    let done = shown(&scene, &[]);
    let dark = done.visibility.iter().filter(|v| **v < 0.8).count();
    assert!(dark > 100, "{dark}");
}

/// The sum of light over regions times transport towards them is what an open vertex
/// receives, the nearer to 1 the more regions there are.
#[test]
fn light_of_regions_times_transport_sums_to_one() {
    let ball: Mesh = shape::icosphere(1, 1.0, DVec3::ZERO)
        .into_mesh(Shading::Smooth)
        .unwrap();
    let list = ball.shading_vertices();
    let object = TransportObject {
        positions: &list.positions,
        normals: &list.normals,
        triangles: &list.triangles,
        casts: true,
    };
    let transport = Transport::new(&object, TransportSettings::default(), &|_| {});
    let basis = Basis::new(6);
    let fine = fine_white(16).cube;
    let worst = |lights: usize| {
        let regions = decompose(&fine, &DecompositionSettings { lights, seed: 1 });
        let sum = |vertex: usize| {
            let row: Vec<f64> = transport
                .diffuse_of(vertex)
                .iter()
                .map(|v| f64::from(*v))
                .collect();
            regions
                .iter()
                .map(|r| fine.energy(r.energy)[1] * dot(&row, &basis.at(r.towards)))
                .sum::<f64>()
        };
        (0..transport.vertices())
            .map(|v| (sum(v) - 1.0).abs())
            .fold(0.0, f64::max)
    };
    let [few, some, many] = [4, 32, 128].map(worst);
    println!("{few} {some} {many}");
    assert!(
        some < 0.06 && many < 0.02 && few > 0.1,
        "{few} {some} {many}"
    );
}

/// White, with many texels.
fn fine_white(side: usize) -> Environment {
    let settings = MapSettings {
        side,
        ..MapSettings::default()
    };
    let texels = vec![[1.0; 3]; 4 * side * 2 * side];
    Environment::of_radiance("white", [4 * side, 2 * side], texels, settings).unwrap()
}

/// Occlusions of groups are combined within the bounds that hold for any two events,
/// and each differs from the others somewhere.
#[test]
fn combinations_keep_to_the_bounds_of_frechet() {
    let scene = two_over_a_floor();
    let of = |how: &str| shown(&scene, &[&format!("combine={how}"), "format=f32"]).visibility;
    let [product, min, sum, middle] = ["product", "min", "sum", "midpoint"].map(of);
    let (mut apart, mut seen) = ([0; 2], 0);
    for i in 0..min.len() {
        if min[i].is_nan() {
            continue;
        }
        seen += 1;
        let (most, least) = (min[i] + 1e-6, sum[i] - 1e-6);
        for value in [product[i], middle[i]] {
            assert!(value <= most && value >= least, "{value} {least} {most}");
        }
        assert!((middle[i] - 0.5 * (min[i] + sum[i])).abs() < 1e-5);
        apart[0] += usize::from(product[i] > sum[i] + 0.01);
        apart[1] += usize::from(product[i] < min[i] - 0.01);
    }
    assert!(
        seen > 2000 && apart[0] > 20 && apart[1] > 20,
        "{seen} {apart:?}"
    );
    // One map for both has neither bound.
    let together = shown(&scene, &["groups=all", "format=f32"]).visibility;
    let off = together
        .iter()
        .zip(&product)
        .filter(|(a, b)| (*a - *b).abs() > 0.02)
        .count();
    assert!(off > 20, "{off}");
}

/// What is below 0 is limited and counted: full shadow under six bands.
#[test]
fn negative_light_is_counted_and_not_shown() {
    let scene = lit_by(two_over_a_floor(), &sky(32));
    let done = shown(&scene, &["lights=16", "map-size=32"]);
    assert!(figure(&done, "negative-radiance") > 0.0);
    assert!(figure(&done, "transport below 0") > 0.0);
    assert!(done.color.iter().flatten().all(|v| *v >= 0.0));
    let sizes = ["deferred lights", "occlusion maps", "occlusion map bytes"];
    let [lights, maps, bytes] = sizes.map(|name| figure(&done, name));
    assert_eq!((lights, bytes), (16.0, maps * 32.0 * 32.0 * 2.0));
    assert!(maps > 10.0 && maps <= 16.0 * 4.0, "{maps}");
    let vertices = figure(&done, "transport vertices");
    assert_eq!(figure(&done, "transport bytes"), vertices * 36.0 * 4.0);
}

#[test]
fn bits_under_an_environment_do_not_depend_on_execution() {
    let scene = lit_by(two_over_a_floor(), &sky(16));
    let mut first = None;
    for simd in gnomon_raster::SimdLevel::available() {
        for (threads, tile) in [(1, 16), (4, 64)] {
            let gpu = GpuConfig {
                threads,
                tile,
                simd,
                skip: threads == 1,
            };
            let set = ["lights=8", "map-size=16"];
            let done = drawn_on(&scene, TECHNIQUE, &set, SIZE, gpu);
            let bits = (done.color_hash(), done.visibility_hash());
            let expected = first.get_or_insert_with(|| bits.clone());
            assert_eq!(*expected, bits, "{simd:?} {threads} {tile}");
        }
    }
}

pub(crate) const MOVING: &str = r#"
name = "moving"
[camera]
eye = [0.5, 2.0, 4.0]
target = [0.0, 0.5, 0.0]
[environment]
map = "sky"
side = 16
lights = 6
[[objects]]
name = "floor"
mesh.plane = { half = 4.0 }
[[objects]]
name = "knot"
mesh.torus-knot = { p = 2, q = 3, ring = 0.5, minor = 0.2, tube = 0.14, along = 60, around = 9 }
MOTION
[[objects]]
name = "block"
mesh.box = { size = [0.4, 1.2, 0.4] }
translate = [-0.9, 0.6, -0.4]
"#;

pub(crate) fn at(text: &str, time: f64) -> Scene {
    let mut moment = file::Moment {
        time,
        outside: Outside::Refused,
        environment: None,
        maps: &mut FittedMaps::default(),
    };
    file::parse_at(text, "moving.toml", Path::new("."), &mut moment).unwrap()
}

/// An object that turns is what it is when it stands there: its transport, found for
/// its shape, is met by light that is turned the other way.
#[test]
fn turned_objects_are_those_that_stand_so() {
    let moving = MOVING.replace("MOTION", "motion.spin = [20.0, 70.0, 0.0]\ntranslate = [0.0, 0.8, 0.0]\nmotion.velocity = [0.1, 0.05, 0.0]");
    let standing = MOVING.replace(
        "MOTION",
        "rotate = [20.0, 70.0, 0.0]\ntranslate = [0.1, 0.85, 0.0]",
    );
    let set = ["format=f32", "directions=4096", "lights=8", "map-size=32"];
    let show = |scene: &Scene| shown(scene, &set).color;
    let [moved, stands] = [show(&at(&moving, 1.0)), show(&at(&standing, 0.0))];
    let first = show(&at(&moving, 0.0));
    let off = |a: &[[f32; 3]], b: &[[f32; 3]]| {
        let pairs = a.iter().zip(b);
        let squares = pairs.map(|(a, b)| f64::from(a[1] - b[1]) * f64::from(a[1] - b[1]));
        (squares.sum::<f64>() / a.len() as f64).sqrt()
    };
    let (same, other) = (off(&moved, &stands), off(&first, &stands));
    println!("{same} {other}");
    assert!(same < 0.003 && other > 10.0 * same, "{same} {other}");
    let rest = at(&moving, 1.0).objects[1].rest.clone().unwrap();
    assert_eq!(
        rest.mesh,
        at(&moving, 0.3).objects[1].rest.clone().unwrap().mesh
    );
    assert!(at(&moving, 1.0).objects[0].rest.is_none());
}

/// A coarse mesh is told of; a fine one of the same shape is not.
#[test]
fn coarse_meshes_are_warned_of() {
    let bowl = |around: u32| {
        let knot = shape::torus_knot(2, 3, 0.8, 0.3, 0.25, 4 * around, around, DVec3::ZERO);
        let material = Material::matt([0.7; 3]);
        lit_by(
            alone(solid("knot", knot, Shading::Smooth, material)),
            &fine_white(16),
        )
    };
    let count = |around| {
        let done = shown(&bowl(around), &["map-size=8", "directions=64"]);
        let told = done
            .warnings
            .iter()
            .filter(|w| w.code == "coarse-transport");
        told.map(|w| w.count).sum::<usize>() as f64 / f64::from(8 * around * around)
    };
    let [coarse, fine] = [5, 24].map(count);
    assert!(coarse > 0.5 && fine < 0.2, "{coarse} {fine}");
}

/// Nearer to sampled directions than a picture without shadows between objects, and
/// maps of more texels are worth more than more lights are.
/// A map of darkness but for one texel, and its light times solid angle.
fn low_sun(row: usize) -> (Environment, f64) {
    let settings = MapSettings {
        side: 64,
        ..MapSettings::default()
    };
    let mut texels = vec![[0.0; 3]; 64 * 32];
    texels[64 * row + 9] = [1000.0; 3];
    let map = Environment::of_radiance("low sun", [64, 32], texels, settings).unwrap();
    let edge = |row: usize| (0.5 - row as f64 / 32.0) * std::f64::consts::PI;
    let height = libm::sin(edge(row)) - libm::sin(edge(row + 1));
    (map, 1000.0 * std::f64::consts::TAU / 64.0 * height)
}

/// Six bands leave a floor 6% of a sun that has set; with the cosine it has nothing, and
/// before that what Lambert's law says.
#[test]
fn a_small_light_gives_a_floor_its_cosine_and_nothing_once_it_has_set() {
    let floor = || flat("floor", shape::plane(4.0, 0.0)).receiver_only();
    for (row, cosine) in [(12, 0.3365), (15, 0.0490), (16, 0.0), (18, 0.0)] {
        let (map, energy) = low_sun(row);
        let mut scene = alone(floor());
        // What casts is where nobody sees it or its shadow.
        let below = shape::icosphere(1, 0.3, DVec3::new(0.0, -3.0, 0.0));
        scene.objects.push(flat("ball", below));
        let scene = lit_by(scene, &map);
        let of = |set: &str| {
            let done = shown(&scene, &["format=f32", set]);
            let seen = (done.color.iter().zip(&done.visibility)).filter(|(_, v)| !v.is_nan());
            let all: Vec<f64> = seen
                .map(|(c, _)| f64::from(c[0]) / 0.8 / energy * std::f64::consts::PI)
                .collect();
            assert!(all.len() > 1000, "{}", all.len());
            all.iter().map(|c| (c - cosine).abs()).fold(0.0, f64::max)
        };
        let [exact, bands] = ["grazing=exact", "grazing=bands"].map(of);
        println!("row {row}: {exact:.4} exact, {bands:.4} by bands, off {cosine}");
        assert!(exact < 0.002, "row {row}: {exact}");
        assert!(row == 12 || row == 18 || bands > 0.03, "row {row}: {bands}");
    }
}

/// Under a map with a sun that has set, the exact cosine is nearer to the reference.
#[test]
fn exact_cosines_come_nearer_to_the_reference() {
    let mut texels: Vec<[f32; 3]> = vec![[0.4; 3]; 64 * 32];
    texels[64 * 16 + 9] = [600.0; 3];
    let settings = MapSettings {
        side: 64,
        ..MapSettings::default()
    };
    let map = Environment::of_radiance("evening", [64, 32], texels, settings).unwrap();
    let scene = lit_by(two_over_a_floor(), &map);
    let map = &scene.environment.as_ref().unwrap().map;
    let directions = Directions {
        count: 1024,
        seed: 1,
    };
    let truth = EnvironmentReference::new(&scene, map, SIZE, directions, true, &|| {});
    let of = |set: &str| {
        let done = shown(&scene, &[set]);
        RadianceScore::measure(&truth, &done).unwrap().relative_rmse
    };
    let [exact, bands] = ["grazing=exact", "grazing=bands"].map(of);
    println!("{exact} exact, {bands} by bands");
    assert!(exact < 0.6 * bands, "{exact} {bands}");
}

#[test]
fn maps_come_near_the_reference() {
    let scene = lit_by(two_over_a_floor(), &sky(32));
    let map = &scene.environment.as_ref().unwrap().map;
    let directions = Directions {
        count: 1024,
        seed: 1,
    };
    let truth = EnvironmentReference::new(&scene, map, SIZE, directions, true, &|| {});
    let score = |set: &[&str]| {
        let done = shown(&scene, set);
        RadianceScore::measure(&truth, &done).unwrap().relative_rmse
    };
    let region = score(&["lights=32", "map-size=128", "extent=region"]);
    let good = score(&["lights=32", "map-size=128"]);
    let mut bare = scene.clone();
    bare.objects.iter_mut().for_each(|o| o.casts = false);
    let unshadowed = {
        let done = shown(&bare, &[]);
        RadianceScore::measure(&truth, &done).unwrap().relative_rmse
    };
    println!("{good} {region} {unshadowed}");
    assert!(
        good < 0.03 && good < 0.3 * unshadowed,
        "{good} {unshadowed}"
    );
    // The sun's region is far larger than the sun.
    assert!(region > 1.5 * good && region < 0.06, "{region} {good}");
}
