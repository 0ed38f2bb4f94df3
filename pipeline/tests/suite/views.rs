//! Cameras and light views in scenes of any unit, lights far away, low or among walls,
//! and planes far larger than what is seen.

use crate::drawing::drawn;
use std::path::Path;

use glam::DVec3;
use gnomon_pipeline::measure::comparison::{Aligned, Reference, ReferenceKind};
use gnomon_pipeline::measure::render::Rendered;
use gnomon_pipeline::truth::metrics::visibility::VisibilityError;
use gnomon_pipeline::truth::oracle::area::LightRegion;
use gnomon_pipeline::world::light::{Light, LightShape};
use gnomon_pipeline::world::scene::{Scene, file};

const SIZE: [u32; 2] = [160, 120];

fn parsed(text: &str) -> Scene {
    file::parse(text, "scene.toml", Path::new(".")).unwrap()
}

fn shown(scene: &Scene, technique: &str, set: &[&str]) -> Rendered {
    drawn(scene, technique, set, SIZE)
}

/// A scene with the exact visibility of its light.
struct Bench {
    scene: Scene,
    truth: Reference,
}

/// Root mean square errors.
#[derive(Clone, Copy, Debug)]
struct Errors {
    all: f64,
    umbra: f64,
    lit: f64,
    /// Share of the pixels that could be compared.
    compared: f64,
}

impl Bench {
    fn new(scene: Scene) -> Self {
        let truth = Reference::new(&scene, 0, SIZE, ReferenceKind::Exact, None, &|| {});
        Self {
            truth: truth.unwrap(),
            scene,
        }
    }

    fn errors(&self, technique: &str, set: &[&str]) -> Errors {
        let done = shown(&self.scene, technique, set);
        let under: Aligned = self.truth.under(&done.depth).unwrap();
        let error = VisibilityError::measure(&under.truth, SIZE, &done.visibility).unwrap();
        let of = |region| error.of_region(region).map_or(0.0, |s| s.rmse);
        let all = error.all.unwrap();
        let found = Errors {
            all: all.rmse,
            umbra: of(LightRegion::Umbra),
            lit: of(LightRegion::Lit),
            compared: all.pixels as f64 / done.visibility.len() as f64,
        };
        println!("{technique} {set:?}: {found:?}");
        found
    }
}

fn codes(done: &Rendered) -> Vec<&'static str> {
    done.warnings.iter().map(|w| w.code).collect()
}

/// Pixels that show a surface, and of these those in shadow.
fn counts(done: &Rendered) -> [usize; 2] {
    let surface = done.visibility.iter().filter(|v| !v.is_nan());
    [
        surface.clone().count(),
        surface.filter(|v| **v < 0.5).count(),
    ]
}

/// All lengths of a scene file times a factor.
fn scaled(text: &str, factor: f64) -> String {
    let number = |token: &str| token.parse::<f64>().ok().map(|x| (x * factor).to_string());
    let line = |line: &str| {
        if ["fov", "rotate", "size = [160"]
            .iter()
            .any(|k| line.starts_with(k))
        {
            return line.to_owned();
        }
        let mut out = String::new();
        let mut token = String::new();
        for c in line.chars().chain(['\n']) {
            if c.is_ascii_alphanumeric() || ".-+".contains(c) {
                token.push(c);
                continue;
            }
            out += &number(&token).unwrap_or_else(|| token.clone());
            token.clear();
            out.push(c);
        }
        out
    };
    text.lines().map(line).collect::<Vec<_>>().join("\n")
}

const UNITS: &str = include_str!("views/units.toml");

#[test]
fn a_scene_in_other_units_is_the_same_picture() {
    let one = shown(&parsed(UNITS), "shadow-volumes", &[]);
    let [surface, dark] = counts(&one);
    assert!((15_200..=15_202).contains(&surface), "{surface}");
    assert!((958..=970).contains(&dark), "{dark}");
    for factor in [1e-6, 1e-3, 0.02, 7.0, 1e5, 3e5, 1e7] {
        for technique in ["shadow-volumes", "shadow-map", "pcss"] {
            let reference = shown(&parsed(UNITS), technique, &[]);
            let other = shown(&parsed(&scaled(UNITS, factor)), technique, &[]);
            assert_eq!(codes(&other), [""; 0], "{factor}");
            let [a, b] = [counts(&reference), counts(&other)];
            let off = [0, 1].map(|k| a[k].abs_diff(b[k]));
            assert!(
                off[0] <= 3 && off[1] <= 12,
                "{technique} {factor}: {a:?} {b:?}"
            );
        }
    }
}

/// Parallel light has no place, but what it shadows has a size.
#[test]
fn a_sun_over_a_scene_in_other_units_is_the_same() {
    let text = include_str!("views/low-sun.toml").replace("0.12", "0.6");
    let [_, dark] = counts(&shown(&parsed(&text), "shadow-map", &[]));
    assert!(dark > 100, "{dark}");
    for factor in [1e-6, 1e-3, 1e3, 1e7] {
        let other = shown(&parsed(&scaled(&text, factor)), "shadow-map", &[]);
        let [_, other] = counts(&other);
        assert!(dark.abs_diff(other) <= 12, "{factor}: {dark} {other}");
    }
}

/// Powers of two change no digit.
#[test]
fn a_scene_in_units_of_a_power_of_two_has_the_same_bits() {
    for technique in ["shadow-volumes", "pcss", "soft-shadow-volumes"] {
        let one = shown(&parsed(UNITS), technique, &[]);
        for exponent in [-12, 5, 20] {
            let text = scaled(UNITS, libm::exp2(f64::from(exponent)));
            let other = shown(&parsed(&text), technique, &[]);
            let differ = one.visibility.iter().zip(&other.visibility);
            let differ = differ.filter(|(a, b)| a.to_bits() != b.to_bits()).count();
            println!("{technique} 2^{exponent}: {differ}");
            assert!(
                differ <= 20,
                "{technique} 2^{exponent}: {differ} pixels differ"
            );
            assert_eq!(one.depth, other.depth);
        }
    }
}

#[test]
fn a_near_distance_beyond_the_scene_is_warned_of_by_name() {
    let text = UNITS.replace("fov = 42.0", "near = 100.0");
    let done = shown(&parsed(&text), "shadow-map", &[]);
    let warning = &done.warnings[0];
    assert_eq!((warning.code, warning.count), ("before-near-plane", 2));
    assert!(warning.message.contains("'floor'"), "{}", warning.message);
}

#[test]
fn lost_depth_is_warned_of() {
    let far = include_str!("views/far-eye.toml");
    let done = shown(&parsed(far), "shadow-volumes", &[]);
    assert_eq!(codes(&done), ["coarse-depth"]);
    let text = UNITS.replace("fov = 42.0", "fov = 42.0\nnear = 1e-6");
    let done = shown(&parsed(&text), "shadow-volumes", &[]);
    assert_eq!(codes(&done), ["coarse-depth"]);
    assert!(
        done.warnings[0].message.contains("near = 0.000001"),
        "{:?}",
        done.warnings
    );
    let derived = far.replace("near = 0.1", "");
    let bench = Bench::new(parsed(&derived));
    assert_eq!(codes(&shown(&bench.scene, "shadow-volumes", &[])), [""; 0]);
    assert!(bench.errors("shadow-volumes", &[]).umbra < 0.1);
}

#[test]
fn planes_far_larger_than_what_is_seen_stay_where_they_are() {
    let text = include_str!("views/huge-plane.toml");
    let plane = |half: &str, eye: &str, near: &str| {
        text.replace("half = 10000000.0", half)
            .replace("eye = [0.0, 3.0, 6.0]", eye)
            .replace("near = 0.1", near)
    };
    for half in ["1e3", "1e4", "1e5", "1e6", "1e7"] {
        for eye in [
            "[0.0, 3.0, 6.0]",
            "[0.0, 0.5, 6.0]",
            "[0.0, 300.0, 6.0]",
            "[-3.0, 30.0, 20.0]",
        ] {
            for near in ["", "near = 0.1"] {
                let text = plane(&format!("half = {half}"), &format!("eye = {eye}"), near);
                let bench = Bench::new(parsed(&text));
                let soft = bench.errors("soft-shadow-volumes", &[]);
                println!("{half} {eye} {near}");
                let seen = counts(&shown(&bench.scene, "shadow-volumes", &[]))[0] as f64;
                let seen = seen / f64::from(SIZE[0] * SIZE[1]);
                assert!(
                    soft.compared > seen - 0.02,
                    "{half} {eye} {near}: {soft:?} {seen}"
                );
                assert!(soft.umbra < 0.1, "{half} {eye} {near}: {soft:?}");
            }
        }
    }
}

/// The lamp's corners stay at the same angles.
fn at_distance(text: &str, factor: f64) -> Scene {
    let mut scene = parsed(text);
    match &mut scene.lights[0].shape {
        LightShape::Rectangle {
            centre,
            edge_u,
            edge_v,
        } => {
            *centre *= factor;
            *edge_u *= factor;
            *edge_v *= factor;
        }
        LightShape::Sphere { centre, radius } => {
            *centre *= factor;
            *radius *= factor;
        }
        other => panic!("{other:?}"),
    }
    scene
}

#[test]
fn lights_far_away_keep_their_shadows() {
    let lamp = include_str!("views/far-lamp.toml");
    let sun = include_str!("views/far-sun.toml");
    for (text, factors, bound) in [
        (lamp, [1.0, 10.0, 100.0, 1e5], 0.09),
        (sun, [1e-3, 0.1, 1.0, 100.0], 0.13),
    ] {
        for factor in factors {
            let bench = Bench::new(at_distance(text, factor));
            for technique in ["shadow-map", "pcf", "pcss"] {
                let found = bench.errors(technique, &[]);
                assert!(found.umbra < bound, "{technique} x {factor}: {found:?}");
            }
            let found = bench.errors("convolution-soft-shadows", &[]);
            assert!(found.umbra < 0.3, "x {factor}: {found:?}");
        }
    }
}

/// A light level with what it lights would need an endless planar view.
#[test]
fn grazing_lights_are_looked_at_all_round() {
    let text = include_str!("views/grazing.toml");
    for centre in [
        [9.0, 1.0, 1.0],
        [20.0, 1.0, 1.0],
        [100.0, 1.0, 1.0],
        [-9.0, 1.0, 1.0],
        [1.0, 1.0, -12.0],
        [6.0, 0.8, 7.0],
    ] {
        let mut scene = parsed(text);
        scene.lights = vec![Light::horizontal_square(DVec3::from(centre), 1.0)];
        let bench = Bench::new(scene);
        for technique in ["shadow-map", "pcf", "pcss"] {
            let found = bench.errors(technique, &[]);
            assert!(found.umbra < 0.25, "{centre:?} {technique}: {found:?}");
        }
        let done = shown(&bench.scene, "shadow-map", &["view=planar"]);
        let hints: Vec<_> = done
            .warnings
            .iter()
            .filter(|w| w.code == "view-limited")
            .collect();
        if centre[1] < 1.0 || !hints.is_empty() {
            continue;
        }
        // Either a planar view holds all shadows, or it is said that it does not.
        let planar = bench.errors("shadow-map", &["view=planar"]);
        assert!(planar.umbra < 0.25, "{centre:?}: {planar:?} and no warning");
    }
}

const ROOM: &str = include_str!("views/room.toml");

#[test]
fn closed_rooms_that_cast_have_soft_shadows() {
    let square =
        |centre: [f64; 3], side: f64| Light::horizontal_square(DVec3::from(centre), side).shape;
    let lights = [
        square([1.6, 3.2, 1.1], 0.6),
        // Near the ceiling, near a wall, in a corner.
        square([0.3, 3.9, 0.4], 0.6),
        square([3.5, 3.0, 0.5], 0.6),
        square([3.5, 3.5, -3.5], 0.6),
        LightShape::Sphere {
            centre: DVec3::new(1.6, 3.2, 1.1),
            radius: 0.3,
        },
        LightShape::Point {
            position: DVec3::new(1.6, 3.2, 1.1),
        },
    ];
    for shape in lights {
        let mut scene = parsed(ROOM);
        scene.lights[0].shape = shape.clone();
        let bench = Bench::new(scene);
        let unshadowed = bench.errors("unshadowed", &[]);
        for technique in ["pcss", "convolution-soft-shadows", "pcf", "shadow-map"] {
            for view in ["view=auto", "view=cube"] {
                let found = bench.errors(technique, &[view]);
                assert!(found.umbra < 0.3, "{shape:?} {technique} {view}: {found:?}");
                assert!(
                    found.all < 0.8 * unshadowed.all,
                    "{shape:?} {technique} {view}: {found:?}"
                );
            }
        }
    }
}

/// Hints do not contradict each other: never both less and more of one thing.
#[test]
fn hints_agree() {
    let lamp = "shape.square = { centre = [0.0, 1.05, 0.0], side = 0.6 }";
    let text = ROOM.replace(
        "shape.square = { centre = [1.6, 3.2, 1.1], side = 0.6 }",
        lamp,
    );
    for set in [
        &["view=auto"][..],
        &["view=planar"],
        &["view=cube"],
        &["near=0.2"],
        &["near=0.001"],
    ] {
        for technique in ["pcss", "convolution-soft-shadows"] {
            let done = shown(&parsed(&text), technique, set);
            let about: Vec<_> = done.warnings.iter().map(|w| w.message.as_str()).collect();
            println!("{technique} {set:?} {about:?}");
            let says = |what: &str| about.iter().any(|m| m.contains(what));
            assert!(!(says("less") && says("larger")), "{about:?}");
            assert!(!(set == ["view=cube"] && says("view to cube")), "{about:?}");
        }
    }
}

/// A sun at an elevation over two boxes and a ball on a slab, all of which cast.
fn low_sun(degrees: f64, turn: f64) -> Scene {
    let text = include_str!("views/low-sun.toml");
    let more = "\n[[objects]]\nmesh.box = { size = [0.8, 1.6, 0.6] }\nrotate = [0, 30, 0]\n\
                translate = [2.0, 0.8, -0.6]\n[[objects]]\n\
                mesh.sphere = { subdivisions = 3, radius = 0.5 }\ntranslate = [-1.2, 0.3, 1.6]\n";
    let mut scene = parsed(&format!("{text}{more}"));
    let [(high, flat), (z, x)] = [degrees, turn].map(|d| libm::sincos(d.to_radians()));
    scene.lights[0].shape = LightShape::Directional {
        towards: DVec3::new(x * flat, high, z * flat),
    };
    scene
}

#[test]
fn a_low_sun_leaves_no_acne_on_what_casts() {
    let bench = Bench::new(parsed(include_str!("views/low-sun.toml")));
    let settings: [&[&str]; 6] = [
        &[],
        &["map-size=4096"],
        &["slope-bias=32"],
        &["taps=8"],
        &["taps=32"],
        &["kernel=bicubic"],
    ];
    for set in settings {
        assert!(bench.errors("pcf", set).lit < 0.025, "{set:?}");
    }
    for (degrees, turn) in [
        (1.0, 17.0),
        (3.0, 120.0),
        (5.0, 200.0),
        (7.0, 17.0),
        (10.0, 290.0),
    ] {
        let bench = Bench::new(low_sun(degrees, turn));
        println!("{degrees} {turn}");
        for (technique, set) in [
            ("shadow-map", &[][..]),
            ("pcf", &[]),
            ("pcf", &["taps=8"]),
            ("pcf", &["kernel=bicubic"]),
            ("pcss", &[]),
            ("shadow-maps-n", &["maps=4"]),
        ] {
            let found = bench.errors(technique, set);
            assert!(
                found.lit < 0.12,
                "{technique} {set:?} {degrees} {turn}: {found:?}"
            );
            // At one degree eight texels reach as far as 460 would straight below.
            assert!(
                found.umbra < 0.35,
                "{technique} {set:?} {degrees} {turn}: {found:?}"
            );
        }
    }
}
