//! Points of an area light, spread by a pattern: the papers' reference replaces
//! the light by them (docs/papers.md, baselines).
//!
//! A pattern lies in the unit square and is carried onto the light so that
//! equal areas stay equal: rectangles affinely; discs by radius `sqrt(a)` and
//! angle `2 pi b`; other polygons as a fan of triangles.
//!
//! A sphere shows a disc to every receiver, another one to each. Its points lie
//! in the ball with density `1 / sqrt(1 - r^2)`, the only one that is seen as a
//! uniform disc from every direction (from afar; Abel's integral equation). It
//! is that of three coordinates of a point of the sphere in four dimensions:
//! two of them are the pattern on a horizontal disc, the third is
//! `sqrt(1 - a) cos(2 pi c)` with c running through multiples of the golden
//! section.

use std::f64::consts::TAU;

use glam::DVec3;

use crate::technique::{Choice, Condition, LightFact, Param};
use crate::truth::oracle::area::emitter::Emitter;
use crate::truth::oracle::sampled::{jitter, on_light};
use crate::world::error::LightError;
use crate::world::light::{HardLight, Light, LightShape};

/// The seed of points that are jittered always.
pub(crate) const JITTER_SEED: Param<u64> = Param::<u64>::whole(
    "seed",
    1,
    [0, u32::MAX as u64],
    "of the jitter of the light's points",
)
.when(Condition::Lights(LightFact::Extended));

/// How points are spread over the unit square.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Pattern {
    /// Centres of the cells of a square grid: the papers'.
    #[default]
    Grid,
    /// One point in each cell, jittered.
    Stratified,
    /// The grid turned by `atan(1/side)`, so that no two points have the same x
    /// or y: an edge along the light's sides passes them one by one, not a row
    /// at a time.
    RotatedGrid,
}

impl Pattern {
    /// Names in the order of the variants.
    pub const NAMES: [&str; 3] = ["grid", "stratified", "rotated-grid"];

    /// Its name on the command line.
    pub fn name(self) -> &'static str {
        Self::NAMES[self as usize]
    }

    /// Point in column `i`, row `j` of `side` by `side`, in 0..1.
    pub(crate) fn place(self, [i, j]: [u32; 2], side: u32, seed: u64) -> [f64; 2] {
        let n = f64::from(side);
        let centre = |cell: u32| (f64::from(cell) + 0.5) / n;
        let inside = match self {
            Self::Grid => [0.5; 2],
            Self::Stratified => {
                let key = u64::from(j) << 32 | u64::from(i) << 1;
                [jitter(seed, key), jitter(seed, key | 1)]
            }
            Self::RotatedGrid => [centre(j), centre(side - 1 - i)],
        };
        [
            (f64::from(i) + inside[0]) / n,
            (f64::from(j) + inside[1]) / n,
        ]
    }
}

impl Choice for Pattern {
    const NAMES: &'static [&'static str] = &Pattern::NAMES;
    const ALL: &'static [Self] = &[Self::Grid, Self::Stratified, Self::RotatedGrid];
}

/// `side * side` points of `light`, world space, row by row; a light without
/// extent has itself only. `seed` moves the points of [`Pattern::Stratified`],
/// and those of spheres along the vertical.
///
/// # Errors
/// The light should have an extent and has none.
pub fn light_points(
    light: &Light,
    pattern: Pattern,
    side: u32,
    seed: u64,
) -> Result<Vec<HardLight>, LightError> {
    let carry = Carry::new(&light.shape)?;
    let Some(carry) = carry else {
        return Ok(vec![light.hard()]);
    };
    let cells = (0..side).flat_map(|j| (0..side).map(move |i| [i, j]));
    let point = |cell: [u32; 2]| {
        let number = cell[1] * side + cell[0];
        let along = golden(number) + jitter(seed, u64::MAX);
        HardLight::Point(carry.point(pattern.place(cell, side, seed), along))
    };
    Ok(cells.map(point).collect())
}

/// Multiples of the golden section, modulo 1.
fn golden(number: u32) -> f64 {
    const SECTION: f64 = 0.618_033_988_749_894_9;
    let turns = f64::from(number) * SECTION;
    turns - turns.floor()
}

/// Carries the unit square onto a light.
enum Carry {
    Rectangle { corner: DVec3, edges: [DVec3; 2] },
    Flat(Emitter),
    Ball { centre: DVec3, radius: f64 },
}

impl Carry {
    /// `None` for lights without extent.
    fn new(shape: &LightShape) -> Result<Option<Self>, LightError> {
        let emitter = Emitter::new(shape)?;
        Ok(match *shape {
            LightShape::Point { .. } | LightShape::Directional { .. } => None,
            LightShape::Rectangle {
                centre,
                edge_u,
                edge_v,
            } => Some(Self::Rectangle {
                corner: centre - (edge_u + edge_v) * 0.5,
                edges: [edge_u, edge_v],
            }),
            LightShape::Polygon(_) | LightShape::Disc { .. } => Some(Self::Flat(emitter)),
            LightShape::Sphere { centre, radius } => Some(Self::Ball { centre, radius }),
        })
    }

    /// `along` is the third coordinate of a ball, modulo 1.
    fn point(&self, [a, b]: [f64; 2], along: f64) -> DVec3 {
        match self {
            Self::Rectangle { corner, edges } => *corner + edges[0] * a + edges[1] * b,
            // Flat lights look the same from everywhere.
            Self::Flat(emitter) => match emitter.seen_from(DVec3::ZERO) {
                Some(light) => light.frame.at(on_light(&light, [a, b])),
                None => DVec3::ZERO,
            },
            Self::Ball { centre, radius } => {
                let (r, angle) = (a.sqrt(), TAU * b);
                let (x, z) = (r * libm::cos(angle), r * libm::sin(angle));
                let y = (1.0 - a).sqrt() * libm::cos(TAU * along);
                *centre + DVec3::new(x, y, z) * *radius
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::world::light::ConvexPolygon;

    const PATTERNS: [Pattern; 3] = [Pattern::Grid, Pattern::Stratified, Pattern::RotatedGrid];

    fn points(shape: LightShape, pattern: Pattern, side: u32) -> Vec<DVec3> {
        let colour = [1.0; 3];
        let lights = light_points(&Light { shape, colour }, pattern, side, 5).unwrap();
        let place = |l: &HardLight| match l {
            HardLight::Point(p) => *p,
            HardLight::Directional(d) => *d,
        };
        lights.iter().map(place).collect()
    }

    fn square() -> LightShape {
        Light::horizontal_square(DVec3::new(1.0, 3.0, -2.0), 2.0).shape
    }

    /// Coordinates along x, sorted, and how many of them differ.
    fn columns(points: &[DVec3]) -> usize {
        let mut x: Vec<i64> = points.iter().map(|p| (p.x * 1e9).round() as i64).collect();
        x.sort_unstable();
        x.dedup();
        x.len()
    }

    #[test]
    fn every_pattern_has_a_point_in_every_cell() {
        for pattern in PATTERNS {
            let all = points(square(), pattern, 8);
            for (number, p) in all.iter().enumerate() {
                let cell = [number % 8, number / 8].map(|c| c as f64 / 4.0);
                let [x, z] = [p.x - cell[0], p.z + 3.0 - cell[1]];
                assert!((0.0..0.25).contains(&x) && (0.0..0.25).contains(&z), "{p}");
                assert_eq!(p.y, 3.0);
            }
        }
    }

    #[test]
    fn only_the_plain_grid_has_columns() {
        let of = |pattern| columns(&points(square(), pattern, 8));
        assert_eq!(PATTERNS.map(of), [8, 64, 64]);
        // Evenly, too: the k-th of the rotated grid's 64 columns is at (k + 1/2) / 64.
        let mut x: Vec<f64> = points(square(), Pattern::RotatedGrid, 8)
            .iter()
            .map(|p| p.x / 2.0)
            .collect();
        x.sort_unstable_by(f64::total_cmp);
        for (k, x) in x.iter().enumerate() {
            assert!((x - (k as f64 + 0.5) / 64.0).abs() < 1e-12);
        }
    }

    #[test]
    fn seeds_move_what_is_random_and_nothing_else() {
        let light = Light {
            shape: square(),
            colour: [1.0; 3],
        };
        for (pattern, moves) in PATTERNS.into_iter().zip([false, true, false]) {
            let of = |seed| light_points(&light, pattern, 4, seed).unwrap();
            assert_eq!(of(1), of(1));
            assert_eq!(of(1) != of(2), moves, "{pattern:?}");
        }
    }

    /// Mean and mean squared distance along `axis` of a uniform unit disc are 0
    /// and 1/4; of a ball of the right density, seen from anywhere, too.
    #[test]
    fn points_fill_round_lights_evenly_from_every_side() {
        let centre = DVec3::new(4.0, 5.0, 6.0);
        let ball = LightShape::Sphere {
            centre,
            radius: 2.0,
        };
        let all = points(ball, Pattern::Grid, 48);
        let axes = [DVec3::X, DVec3::Y, DVec3::Z, DVec3::new(0.6, 0.64, 0.48)];
        for axis in axes {
            let along: Vec<f64> = all.iter().map(|p| (*p - centre).dot(axis) / 2.0).collect();
            let mean = |f: fn(f64) -> f64| along.iter().map(|x| f(*x)).sum::<f64>() / 2304.0;
            assert!(mean(|x| x).abs() < 3e-3, "{axis}");
            assert!((mean(|x| x * x) - 0.25).abs() < 3e-3, "{axis}");
            // Fourth moment of the disc: 1/8. A ball of even density has 3/35.
            assert!((mean(|x| x * x * x * x) - 0.125).abs() < 3e-3, "{axis}");
        }
        let normal = DVec3::Y;
        let disc = LightShape::Disc {
            centre,
            normal,
            radius: 2.0,
        };
        let all = points(disc, Pattern::RotatedGrid, 32);
        let second = all.iter().map(|p| (p.x - 4.0) * (p.x - 4.0)).sum::<f64>() / 1024.0;
        assert!((second - 1.0).abs() < 5e-3 && all.iter().all(|p| (p.y - 5.0).abs() < 1e-12));
    }

    #[test]
    fn polygons_are_filled_and_hard_lights_are_themselves() {
        let corners = [[0.0, 0.0], [4.0, 0.0], [0.0, 4.0]];
        let corners: Vec<_> = corners
            .iter()
            .map(|p| DVec3::new(p[0], 1.0, p[1]))
            .collect();
        let triangle = LightShape::Polygon(ConvexPolygon::new(corners).unwrap());
        let all = points(triangle, Pattern::Grid, 32);
        let centre = all.iter().sum::<DVec3>() / 1024.0;
        assert!(
            (centre - DVec3::new(4.0 / 3.0, 1.0, 4.0 / 3.0)).length() < 0.01,
            "{centre}"
        );
        assert!(
            all.iter()
                .all(|p| p.x > 0.0 && p.z > 0.0 && p.x + p.z < 4.0)
        );
        let towards = DVec3::new(1.0, 2.0, 3.0);
        let sun = LightShape::Directional { towards };
        assert_eq!(points(sun, Pattern::Grid, 32), [towards]);
        let dot = LightShape::Sphere {
            centre: DVec3::ZERO,
            radius: 0.0,
        };
        let light = Light {
            shape: dot,
            colour: [1.0; 3],
        };
        assert!(light_points(&light, Pattern::Grid, 4, 0).is_err());
    }

    #[test]
    fn patterns_have_names() {
        for (pattern, name) in PATTERNS.into_iter().zip(Pattern::NAMES) {
            assert_eq!(
                <Pattern as crate::technique::Setting>::read(name),
                Some(pattern)
            );
            assert_eq!(pattern.name(), name);
        }
    }
}
