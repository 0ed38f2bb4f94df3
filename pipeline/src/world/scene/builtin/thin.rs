//! Thin casters: a winged figure under a large light, after a picture of paper III, and a
//! plant with leaves. Both are ours.

use glam::DVec3;

use super::palette::{BRASS, CLAY, MOSS, STONE, floor, solid};
use crate::world::light::Light;
use crate::world::scene::{Camera, Scene};
use crate::world::shape::{self, Rib, Shape};

const RIBS: u32 = 12;

/// A pointed blade from `from` to `to`, `half` wide to either side at its widest, bent by
/// `sag` along `up`.
fn leaf(from: DVec3, to: DVec3, up: DVec3, half: f64, sag: f64) -> Shape {
    let along = to - from;
    let across = along.cross(up).normalize_or(DVec3::X);
    let face = across.cross(along).normalize_or(DVec3::Y);
    let rib = |k: u32| {
        let t = f64::from(k) / f64::from(RIBS);
        // Widest before the middle, a little left at both ends.
        let wide = 0.03 + 3.2 * t * (1.0 - t) * (1.0 - 0.45 * t);
        Rib {
            middle: from + along * t + face * (sag * 4.0 * t * (1.0 - t)),
            half: across * (half * wide),
            up: face * (0.008 + 0.006 * (1.0 - t)),
        }
    };
    shape::blade(&(0..=RIBS).map(rib).collect::<Vec<_>>())
}

fn limb(from: [f64; 3], to: [f64; 3], radii: [f64; 2]) -> Shape {
    let [from, to] = [from, to].map(DVec3::from_array);
    shape::capsule(from, to, radii[0], radii[1], 14, 4)
}

/// A figure that hovers over a floor: head, trunk, limbs, four wings and a staff.
fn figure() -> Shape {
    let wing = |side: f64, tip: [f64; 3], half: f64| {
        let from = DVec3::new(0.07 * side, 1.42, -0.08);
        let tip = DVec3::new(side * tip[0], tip[1], tip[2]);
        leaf(from, tip, DVec3::new(0.0, 0.3, 1.0), half, 0.05)
    };
    let both = [1.0, -1.0].into_iter().flat_map(|side| {
        let hand = [0.42 * side, 1.36, 0.22];
        let foot = [0.12 * side, 0.52, -0.12];
        [
            wing(side, [1.05, 2.05, -0.35], 0.20),
            wing(side, [0.85, 1.02, -0.40], 0.15),
            limb([0.13 * side, 1.47, 0.0], hand, [0.045, 0.03]),
            limb([0.07 * side, 1.05, 0.0], foot, [0.065, 0.035]),
        ]
    });
    let middle = [
        shape::icosphere(3, 0.13, DVec3::new(0.0, 1.74, 0.02)),
        limb([0.0, 1.08, 0.0], [0.0, 1.50, 0.0], [0.10, 0.12]),
        limb([0.0, 1.56, 0.0], [0.0, 1.66, 0.01], [0.05, 0.05]),
        limb([0.42, 1.15, 0.24], [0.42, 1.95, 0.20], [0.012, 0.012]),
    ];
    Shape::merged(middle.into_iter().chain(both))
}

/// The figure under a large square light (paper III, figure 14).
pub(super) fn fairy() -> Scene {
    Scene::new(
        Camera::look_at([1.5, 2.3, 4.2], [0.1, 0.85, -0.2]),
        vec![Light::horizontal_square(DVec3::new(0.9, 4.6, 1.5), 1.6)],
        vec![floor(6.0), solid("fairy", figure(), BRASS)],
    )
}

/// Leaves round a stem, the lower ones wider.
fn plant() -> Shape {
    const LEAVES: u32 = 9;
    let stem = limb([0.0, 0.05, 0.0], [0.06, 1.45, 0.03], [0.03, 0.012]);
    let one = |k: u32| {
        let t = f64::from(k) / f64::from(LEAVES - 1);
        let angle = 2.399_963_229_728_653 * f64::from(k);
        let out = DVec3::new(libm::cos(angle), 0.0, libm::sin(angle));
        let from = DVec3::new(0.06 * t, 0.35 + 1.05 * t, 0.03 * t) + out * 0.02;
        let to = from + out * (0.85 - 0.45 * t) + DVec3::Y * (0.05 + 0.35 * t);
        leaf(from, to, DVec3::Y, 0.15 - 0.06 * t, 0.08)
    };
    Shape::merged(std::iter::once(stem).chain((0..LEAVES).map(one)))
}

/// The plant in a tub under a square light.
pub(super) fn leaves() -> Scene {
    let tub = shape::cylinder(32, 0.28, 0.0, 0.3);
    Scene::new(
        Camera::look_at([1.3, 2.2, 3.3], [0.0, 0.6, -0.1]),
        vec![Light::horizontal_square(DVec3::new(1.2, 4.2, 1.0), 0.8)],
        vec![
            floor(6.0),
            solid("tub", tub, STONE),
            solid("plant", plant(), MOSS),
            solid(
                "ball",
                shape::icosphere(3, 0.22, DVec3::new(-0.95, 0.22, 0.35)),
                CLAY,
            ),
        ],
    )
}
