//! The exact oracle against closed forms, against itself, and at its limits.

mod closed_forms;
mod images;
mod invariances;
mod limits;

use super::*;
use crate::world::light::{ConvexPolygon, Light};
use crate::world::plates::ParallelPlates;
use crate::world::scene::{Camera, Object, builtin};
use crate::world::shape::{self, on_circle};

type Triangle = [DVec3; 3];

fn square_light(centre: DVec3, side: f64) -> LightShape {
    Light::horizontal_square(centre, side).shape
}

fn polygon(points: &[[f64; 2]], y: f64) -> LightShape {
    let lift = |p: &[f64; 2]| DVec3::new(p[0], y, p[1]);
    let vertices: Vec<_> = points.iter().map(lift).collect();
    LightShape::Polygon(ConvexPolygon::new(vertices).unwrap())
}

fn hexagon(radius: f64, y: f64) -> LightShape {
    let corner = |k: u32| on_circle(f64::from(k) * std::f64::consts::TAU / 6.0);
    let points: Vec<_> = (0..6)
        .map(corner)
        .map(|(x, z)| [radius * x, radius * z])
        .collect();
    polygon(&points, y)
}

/// A horizontal rectangle as two triangles.
fn plate(low: [f64; 2], high: [f64; 2], y: f64) -> Vec<Triangle> {
    let at = |x: f64, z: f64| DVec3::new(x, y, z);
    let [a, b] = [at(low[0], low[1]), at(high[0], low[1])];
    let [c, d] = [at(high[0], high[1]), at(low[0], high[1])];
    vec![[a, b, c], [a, c, d]]
}

/// Every light shape about (0, 4, 0).
fn lights() -> Vec<(&'static str, LightShape)> {
    let centre = DVec3::Y * 4.0;
    vec![
        ("square", square_light(centre, 1.0)),
        (
            "skew rectangle",
            LightShape::Rectangle {
                centre,
                edge_u: DVec3::new(1.0, 0.2, 0.1),
                edge_v: DVec3::new(-0.3, 0.1, 0.8),
            },
        ),
        ("hexagon", hexagon(0.6, 4.0)),
        (
            "disc",
            LightShape::Disc {
                centre,
                normal: DVec3::new(0.1, -1.0, 0.3).normalize(),
                radius: 0.5,
            },
        ),
        (
            "sphere",
            LightShape::Sphere {
                centre,
                radius: 0.5,
            },
        ),
        ("point", LightShape::Point { position: centre }),
        (
            "direction",
            LightShape::Directional {
                towards: DVec3::new(0.2, 1.0, 0.1),
            },
        ),
    ]
}

/// Pseudo-random numbers in 0..1.
struct Lcg(u64);

impl Lcg {
    fn next(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    fn within(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.next()
    }

    fn point(&mut self, reach: f64, low: f64, high: f64) -> DVec3 {
        let [x, z] = [0; 2].map(|_| self.within(-reach, reach));
        DVec3::new(x, self.within(low, high), z)
    }

    /// Triangles between floor and light, of all sizes.
    fn triangles(&mut self, count: usize) -> Vec<Triangle> {
        let mut one = |_| {
            let (centre, size) = (self.point(1.2, 0.6, 3.4), self.within(0.05, 0.9));
            [0; 3].map(|_| centre + self.point(1.0, -1.0, 1.0) * size)
        };
        (0..count).map(&mut one).collect()
    }

    fn shuffle<T>(&mut self, items: &mut [T]) {
        for i in (1..items.len()).rev() {
            items.swap(i, (self.next() * (i + 1) as f64) as usize);
        }
    }
}

fn at(triangles: &[Triangle], light: &LightShape, p: DVec3) -> f64 {
    let oracle = AreaOracle::of_triangles(triangles, light).unwrap();
    oracle.visibility(&Receiver::free(p))
}

/// The same area in four pieces, the last one turned.
fn quarters(&[a, b, c]: &Triangle) -> [Triangle; 4] {
    let [p, q, r] = [(a + b) / 2.0, (b + c) / 2.0, (c + a) / 2.0];
    [[a, p, r], [p, b, q], [r, q, c], [q, p, r]]
}
