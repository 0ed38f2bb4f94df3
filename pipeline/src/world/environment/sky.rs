//! The procedural map `sky`: a gradient, a sun of half a degree and a window of
//! four panes (docs/papers.md, scenes), as a picture of the six faces of a cube.

use glam::DVec3;

use super::cube::{FACES, direction, place_of, texel_angle};
use super::layout::Picture;
use crate::world::shape::on_circle;

const ZENITH: [f64; 3] = [0.16, 0.30, 0.62];
const HORIZON: [f64; 3] = [0.62, 0.62, 0.60];
const GROUND: [f64; 3] = [0.13, 0.11, 0.09];
/// Share of the way up at which the gradient is half done.
const BEND: f64 = 0.3;

/// Elevation, azimuth from -z towards +x, and radius of the sun, degrees.
const SUN_AT: [f64; 2] = [42.0, 140.0];
const SUN_RADIUS: f64 = 0.25;
/// Of the whole disc: a facing white surface is shaded to this over π.
const SUN_ENERGY: [f64; 3] = [2.3, 2.05, 1.65];
/// Points by which the disc is spread over texels.
const SUN_POINTS: u32 = 256;

/// Panes: low and high corner on face -x, in -1..=1, right and down.
const PANES: [[[f64; 2]; 2]; 4] = [
    [[-0.42, -0.72], [-0.20, -0.46]],
    [[-0.16, -0.72], [0.06, -0.46]],
    [[-0.42, -0.42], [-0.20, -0.16]],
    [[-0.16, -0.42], [0.06, -0.16]],
];
const PANE_FACE: usize = 1;
const PANE: [f64; 3] = [2.6, 3.0, 3.5];

/// Texels along a side of a face.
const SIDE: usize = 256;
/// Points along a side of a texel at which the sky is looked up.
const LOOKS: usize = 2;

/// The sky's six faces.
pub(super) fn picture() -> Picture {
    let place = |k: usize| -1.0 + 2.0 * k as f64 / SIDE as f64;
    let texel = |i: usize| {
        let (face, x, y) = (i / (SIDE * SIDE), i % SIDE, i / SIDE % SIDE);
        let mut sum = [0.0; 3];
        for k in 0..LOOKS * LOOKS {
            let inside = [x, y].map(place);
            let step =
                [k % LOOKS, k / LOOKS].map(|j| (2.0 * j as f64 + 1.0) / (SIDE * LOOKS) as f64);
            let at = [inside[0] + step[0], inside[1] + step[1]];
            let rgb = radiance(direction(face, at));
            (0..3).for_each(|c| sum[c] += rgb[c]);
        }
        sum.map(|v| v / (LOOKS * LOOKS) as f64)
    };
    let mut radiance: Vec<[f64; 3]> = (0..FACES * SIDE * SIDE).map(texel).collect();
    for d in sun_points() {
        let (face, at) = place_of(d);
        let [x, y] = at.map(|c| (((c + 1.0) * 0.5 * SIDE as f64) as usize).min(SIDE - 1));
        let i = (face * SIDE + y) * SIDE + x;
        let angle = texel_angle(SIDE, i);
        (0..3).for_each(|c| radiance[i][c] += SUN_ENERGY[c] / (f64::from(SUN_POINTS) * angle));
    }
    let texels = radiance.iter().map(|rgb| rgb.map(|v| v as f32));
    Picture::strip(SIDE, texels.collect())
}

/// Everything but the sun.
fn radiance(d: DVec3) -> [f64; 3] {
    let (face, at) = place_of(d);
    let inside = |[low, high]: &[[f64; 2]; 2]| (0..2).all(|k| at[k] >= low[k] && at[k] < high[k]);
    if face == PANE_FACE && PANES.iter().any(inside) {
        return PANE;
    }
    let up = d.y / d.length();
    if up < 0.0 {
        return GROUND;
    }
    let share = up * (1.0 + BEND) / (up + BEND);
    [0, 1, 2].map(|c| HORIZON[c] + share * (ZENITH[c] - HORIZON[c]))
}

/// Points that fill the sun's disc evenly (a sunflower).
fn sun_points() -> impl Iterator<Item = DVec3> {
    let [elevation, azimuth] = SUN_AT.map(f64::to_radians);
    let ((level, up), (ahead, right)) = (on_circle(elevation), on_circle(azimuth));
    let towards = DVec3::new(level * right, up, -level * ahead);
    let across = DVec3::new(ahead, 0.0, right);
    let above = across.cross(towards);
    let radius = libm::tan(SUN_RADIUS.to_radians());
    (0..SUN_POINTS).map(move |k| {
        const GOLDEN_ANGLE: f64 = 2.399_963_229_728_653;
        let r = radius * ((f64::from(k) + 0.5) / f64::from(SUN_POINTS)).sqrt();
        let (x, y) = on_circle(GOLDEN_ANGLE * f64::from(k));
        towards + across * (r * x) + above * (r * y)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::world::environment::{Environment, MapSettings, SKY};

    fn open(side: usize, turn: f64) -> Environment {
        let settings = MapSettings {
            side,
            turn,
            ..MapSettings::default()
        };
        Environment::open(SKY, settings).unwrap()
    }

    /// The sun has its energy whatever the resolution, and a disc of half a
    /// degree lies in a few texels.
    #[test]
    fn the_sun_is_small_and_has_its_energy() {
        let totals = [16, 64, 128].map(|side| {
            let cube = open(side, 0.0).cube;
            cube.energy(cube.total())
        });
        for total in totals {
            assert!((total[0] / totals[2][0] - 1.0).abs() < 1e-6, "{totals:?}");
        }
        let bright = open(128, 0.0);
        let bright = bright.cube.radiance().filter(|rgb| rgb[0] > 100.0).count();
        assert!((1..=4).contains(&bright), "{bright}");
        for d in sun_points() {
            let up = d.y / d.length();
            assert!((libm::asin(up).to_degrees() - 42.0).abs() <= 0.26);
        }
    }

    /// It stands high behind on the right, and turns counter-clockwise seen from above.
    #[test]
    fn a_turn_moves_the_sun() {
        let sun = |turn| {
            let cube = open(64, turn).cube;
            let texels = cube.radiance().enumerate();
            let (i, _) = texels.max_by(|a, b| a.1[0].total_cmp(&b.1[0])).unwrap();
            let at = [i % 64, i / 64 % 64].map(|k| -1.0 + (2.0 * k as f64 + 1.0) / 64.0);
            direction(i / (64 * 64), at).normalize()
        };
        let expected = DVec3::new(0.478, 0.669, 0.569);
        assert!((sun(0.0) - expected).length() < 0.03, "{}", sun(0.0));
        let turned = DVec3::new(expected.z, expected.y, -expected.x);
        assert!((sun(90.0) - turned).length() < 0.03, "{}", sun(90.0));
    }
}
