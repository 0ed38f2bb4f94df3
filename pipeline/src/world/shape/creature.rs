//! A biped of overlapping closed parts, in the class of a Quake 2 character.

use glam::{DMat4, DVec3};

use super::{Shape, capsule, cuboid, icosphere, on_circle};

/// Number of closed parts.
pub const CREATURE_PARTS: usize = 15;

/// The 15 closed parts of a biped about 2 high, standing on y = 0, facing +z,
/// in mid-stride. `phase` (radians) swings legs and arms; the parts overlap at
/// the joints on purpose. Order: torso, hips, head, jaw, two horns, shoulders
/// bar, then upper and lower limbs left and right.
pub fn creature(phase: f64) -> [Shape; CREATURE_PARTS] {
    let swing = libm::sin(phase);
    let [left_thigh, left_shin] = leg(-0.16, swing);
    let [right_thigh, right_shin] = leg(0.16, -swing);
    let [left_arm, left_forearm] = arm(-0.36, -swing);
    let [right_arm, right_forearm] = arm(0.36, swing);
    grounded([
        limb([0.0, 0.98, 0.0], [0.0, 1.36, 0.05], 0.2, 0.25),
        cuboid(DVec3::new(0.0, 0.92, 0.0), DVec3::new(0.42, 0.2, 0.26)),
        icosphere(2, 0.17, DVec3::new(0.0, 1.76, 0.1)),
        cuboid(DVec3::new(0.0, 1.66, 0.24), DVec3::new(0.16, 0.08, 0.14)),
        limb([-0.09, 1.88, 0.08], [-0.2, 2.05, 0.02], 0.045, 0.012),
        limb([0.09, 1.88, 0.08], [0.2, 2.05, 0.02], 0.045, 0.012),
        limb([-0.36, 1.46, 0.05], [0.36, 1.46, 0.05], 0.12, 0.12),
        left_thigh,
        left_shin,
        right_thigh,
        right_shin,
        left_arm,
        left_forearm,
        right_arm,
        right_forearm,
    ])
}

/// Lets the lowest point touch y = 0, whatever the pose.
fn grounded(parts: [Shape; CREATURE_PARTS]) -> [Shape; CREATURE_PARTS] {
    let heights = parts.iter().flat_map(|part| &part.positions).map(|p| p.y);
    let lowest = heights.fold(f64::INFINITY, f64::min);
    parts.map(|part| part.translated(DVec3::Y * -lowest))
}

fn limb(from: [f64; 3], to: [f64; 3], r0: f64, r1: f64) -> Shape {
    capsule(from.into(), to.into(), r0, r1, 10, 3)
}

/// Thigh and shin-with-foot, hip at `x`, swung forward by `swing` (-1..1).
fn leg(x: f64, swing: f64) -> [Shape; 2] {
    let hip = DVec3::new(x, 0.9, 0.0);
    let bend = 0.35 + 0.2 * swing;
    let thigh = capsule(hip, hip + hanging(0.42, 0.5 * swing), 0.13, 0.1, 10, 3);
    let knee = hip + hanging(0.42, 0.5 * swing);
    let ankle = knee + hanging(0.36, 0.5 * swing - bend);
    let shin = capsule(knee, ankle, 0.1, 0.07, 10, 3);
    [thigh, shin]
}

/// Upper arm and forearm, shoulder at `x`.
fn arm(x: f64, swing: f64) -> [Shape; 2] {
    let shoulder = DVec3::new(x, 1.44, 0.05);
    let elbow = shoulder + hanging(0.32, 0.6 * swing) + DVec3::X * (0.1 * x.signum());
    let hand = elbow + hanging(0.32, 0.6 * swing + 0.9);
    [
        capsule(shoulder, elbow, 0.1, 0.075, 10, 3),
        capsule(elbow, hand, 0.075, 0.06, 10, 3),
    ]
}

/// A vector of `length` hanging down, turned forward (+z) by `angle` radians.
fn hanging(length: f64, angle: f64) -> DVec3 {
    let (cos, sin) = on_circle(angle);
    DVec3::new(0.0, -length * cos, length * sin)
}

/// The creature as one shape, turned by `heading` radians about y and moved to
/// `place`.
pub fn placed_creature(phase: f64, heading: f64, place: DVec3) -> Shape {
    let (cos, sin) = on_circle(heading);
    let turn = DMat4::from_cols_array(&[
        cos, 0.0, -sin, 0.0, 0.0, 1.0, 0.0, 0.0, sin, 0.0, cos, 0.0, place.x, place.y, place.z, 1.0,
    ]);
    Shape::merged(creature(phase)).transformed(turn)
}
