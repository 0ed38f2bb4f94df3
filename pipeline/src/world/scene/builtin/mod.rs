//! The built-in scenes: procedural, so that a fresh machine needs no data.
//!
//! One file per family. To add a scene, write its file and add one line to
//! [`SCENES`]; every list, suite and message picks it up from there.

mod adversarial;
mod bust_and_trumpet;
mod columns;
mod creature;
mod cylinder;
mod demo;
mod fractal;
mod letters;
mod palette;
mod parallel_plates;
mod peers;
mod soft_errors;
mod spheres;
mod statue;
mod thin;
mod two_box;
mod walk;
mod wireframe;
mod writing;

use super::Scene;
use crate::world::error::{UnknownScene, nearest};

pub use parallel_plates::PLATES;

/// A built-in scene: its name, one line about it, and how it is made.
#[derive(Clone, Copy, Debug)]
pub struct BuiltinScene {
    /// Name on the command line.
    pub name: &'static str,
    /// One line for people.
    pub description: &'static str,
    build: Build,
}

/// How a scene is made.
#[derive(Clone, Copy, Debug)]
enum Build {
    Still(fn() -> Scene),
    /// At a time in seconds.
    Moving(fn(f64) -> Scene),
}

impl BuiltinScene {
    /// Makes the scene at time 0, with [`Scene::name`] set to the registered name.
    pub fn build(&self) -> Scene {
        self.at(0.0)
    }

    /// The scene at `time`, in seconds.
    pub fn at(&self, time: f64) -> Scene {
        let mut scene = match self.build {
            Build::Still(build) => build(),
            Build::Moving(build) => build(time),
        };
        scene.name = self.name.to_owned();
        scene
    }

    /// Whether it changes with time.
    pub fn moves(&self) -> bool {
        matches!(self.build, Build::Moving(_))
    }
}

/// All built-in scenes, in the order in which they are listed.
#[rustfmt::skip] // one line per scene
pub const SCENES: &[BuiltinScene] = &[
    entry("demo", "the default: creature, columns, torus knot and spheres on a ground plane", demo::scene),
    entry("cylinder", "32-gon cylinder standing on a floor", cylinder::scene),
    entry("spheres", "27 spheres in a 3x3x3 lattice over a floor", spheres::scene),
    entry("fractal", "two solids floating over a 100,352-triangle fractal landscape", fractal::scene),
    entry("columns", "5x4 columns with boxes on top, seen from low", columns::scene),
    entry("parallel-plates", "square plate parallel to light and floor: soft shadows in closed form", parallel_plates::scene),
    entry("single-silhouette", "cube close to a large light: the silhouette of the light's centre misses the umbra", soft_errors::single_silhouette),
    entry("overlap", "two crossing bars: penumbrae that overlap are not to be summed", soft_errors::overlap),
    entry("two-box", "a small box above a larger one above a floor: both cast, two receive", two_box::scene),
    entry("creature", "biped of 15 overlapping closed parts", creature::scene),
    moving("walk", "animated: a creature walks round, a ball bounces, a knot and a beam turn (8 s)", walk::scene),
    entry("statue", "a figure of 70,000 triangles with folds and cavities on a pedestal", statue::scene),
    entry("bust-and-trumpet", "a bust of 5,776 vertices and a trumpet of 8,557: what deferred shadowing was measured on", bust_and_trumpet::scene),
    entry("wireframe", "a ball of 1,920 wires with more than 10,000 silhouette edges under a sphere", wireframe::scene),
    entry("eg-logo", "two letters and two balls over three pots, which take shadows, under a sphere", writing::eg),
    entry("at-sign", "an @ over the fractal landscape under a sphere", writing::at_sign),
    entry("text-2002", "the digits 2002 over four pots and a floor under a sphere", writing::year),
    entry("fairy", "a winged figure, its wings thin, under a large square light", thin::fairy),
    entry("leaves", "a plant with nine thin leaves in a tub", thin::leaves),
    entry("adversarial", "eye in shadow, near plane cut, 300 nested volumes and slivers in one", adversarial::combined),
    entry("adversarial-eye-in-shadow", "the eye is inside a shadow volume: z-pass fails", adversarial::eye_in_shadow),
    entry("adversarial-near-plane", "the near plane cuts a volume: z-pass needs depth clamp", adversarial::near_plane),
    entry("adversarial-nested-300", "300 nested volumes: more than an 8-bit stencil counts; 256 would be light if it wrapped", adversarial::nested_300),
    entry("adversarial-tiny", "a small still life, coordinates x 1e-4", adversarial::tiny),
    entry("adversarial-huge", "a small still life, coordinates x 1e4", adversarial::huge),
    entry("adversarial-offset", "a small still life, 1e5 away from the origin", adversarial::offset),
    entry("adversarial-slivers", "needles, a 1024-gon disc and thin plates", adversarial::slivers),
    entry("peer-a", "64-gon cylinder over a plane, to the peers' numbers", peers::a),
    entry("peer-b", "27 spheres of 1280 triangles over a plane, to the peers' numbers", peers::b),
    entry("peer-c", "torus knot over a 100,352-triangle terrain, to the peers' numbers", peers::c),
];

const fn entry(
    name: &'static str,
    description: &'static str,
    build: fn() -> Scene,
) -> BuiltinScene {
    BuiltinScene {
        name,
        description,
        build: Build::Still(build),
    }
}

const fn moving(
    name: &'static str,
    description: &'static str,
    build: fn(f64) -> Scene,
) -> BuiltinScene {
    BuiltinScene {
        name,
        description,
        build: Build::Moving(build),
    }
}

/// Makes the scene called `name`.
///
/// # Errors
/// No such scene: the error lists all names and suggests the nearest.
pub fn build(name: &str) -> Result<Scene, UnknownScene> {
    Ok(find(name)?.build())
}

/// The entry called `name`.
///
/// # Errors
/// As [`build`].
pub fn find(name: &str) -> Result<&'static BuiltinScene, UnknownScene> {
    match SCENES.iter().find(|s| s.name == name) {
        Some(scene) => Ok(scene),
        None => {
            let known: Vec<&'static str> = SCENES.iter().map(|s| s.name).collect();
            Err(UnknownScene {
                name: name.to_owned(),
                nearest: nearest(name, &known),
                known,
            })
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::winding::mesh_winding;
    use crate::world::adjacency::EdgeAdjacency;
    use crate::world::light::HardLight;

    #[test]
    fn unknown_names_get_a_list_and_a_suggestion() {
        let error = build("peer_a").unwrap_err();
        assert_eq!(error.nearest, Some("peer-a"));
        assert!(error.to_string().contains("did you mean 'peer-a'"));
        assert!(error.to_string().contains("peer-c"));
        assert_eq!(build("zzzzzzzzzz").unwrap_err().nearest, None);
    }

    #[test]
    fn names_are_unique_and_kebab_case() {
        let mut names: Vec<_> = SCENES.iter().map(|s| s.name).collect();
        assert!(names.iter().all(|n| {
            n.chars()
                .all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-')
        }));
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), SCENES.len());
    }

    /// Casters are closed, face outwards and do not enclose the light; scenes
    /// have lights and something to see; making them twice gives the same.
    #[test]
    fn every_scene_is_fit_for_shadow_volumes() {
        let moments = |e: &'static BuiltinScene| {
            let times: &[f64] = if e.moves() {
                &[0.0, 0.4, 3.3, 7.9]
            } else {
                &[0.0]
            };
            times.iter().map(move |t| (e, *t))
        };
        for (entry, time) in SCENES.iter().flat_map(moments) {
            let scene = entry.at(time);
            assert_eq!(scene.name, entry.name);
            assert!(!scene.lights.is_empty() && scene.casters().count() > 0);
            for caster in scene.casters() {
                let report = EdgeAdjacency::new(caster.mesh.triangles()).closedness(&caster.mesh);
                assert!(
                    report.is_closed(),
                    "{} {}: {report}",
                    entry.name,
                    caster.name
                );
                assert!(
                    caster.mesh.signed_volume() > 0.0,
                    "{} {}",
                    entry.name,
                    caster.name
                );
                for light in &scene.lights {
                    if let HardLight::Point(p) = light.hard() {
                        assert_eq!(mesh_winding(&caster.mesh, p), 0, "{}", entry.name);
                    }
                }
            }
            assert!(
                entry.at(time) == scene,
                "{} is not deterministic",
                entry.name
            );
        }
    }
}
