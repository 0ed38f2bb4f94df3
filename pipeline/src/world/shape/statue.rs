//! A statue in the class of scanned ones: tens of thousands of small triangles,
//! folds that shade themselves, and cavities.

use glam::DVec3;

use super::Shape;

/// Segments round the axis, and from pole to pole: 2 x 200 x 175 triangles.
const SEGMENTS: u32 = 200;
const RINGS: u32 = 176;

/// Half axes of the ellipsoid before it is displaced.
const HALF_AXES: DVec3 = DVec3::new(0.62, 1.0, 0.52);

/// Bulges and cavities: azimuth and height of the middle in radians, radius in
/// radians, and by how much of the radius it goes out (in).
const LOBES: [[f64; 4]; 12] = [
    [1.571, 1.25, 0.55, 0.16],  // head
    [1.571, -0.25, 0.75, 0.20], // belly
    [1.05, -0.95, 0.55, 0.24],  // knees
    [2.09, -0.95, 0.55, 0.24],
    [0.15, 0.45, 0.50, 0.18], // shoulders
    [2.99, 0.45, 0.50, 0.18],
    [0.70, 0.05, 0.24, -0.42], // under the arms
    [2.44, 0.05, 0.24, -0.42],
    [1.571, 0.62, 0.20, -0.28],  // below the chin
    [1.571, -0.98, 0.22, -0.40], // between the knees
    [4.10, 0.30, 0.30, -0.38],   // in the back
    [5.35, -0.35, 0.30, -0.38],
];

/// A closed figure of 70,000 triangles, about 2 high and centred at the origin: an
/// ellipsoid displaced along its radii by bulges, cavities up to 0.4 of a radius
/// deep, and folds (docs/papers.md, scenes, for the Buddha of Annen et al. 2008).
pub fn statue() -> Shape {
    let inner = RINGS - 1;
    let ring = |r: u32| (0..SEGMENTS).map(move |s| point(s, r));
    let positions = std::iter::once(pole(1.0))
        .chain((1..=inner).flat_map(ring))
        .chain(std::iter::once(pole(-1.0)));
    let south = 1 + inner * SEGMENTS;
    let at = |r: u32, s: u32| 1 + (r - 1) * SEGMENTS + s % SEGMENTS;
    let mut triangles = Vec::new();
    for s in 0..SEGMENTS {
        triangles.push([0, at(1, s + 1), at(1, s)]);
        for r in 1..inner {
            let [a, b, c, d] = [at(r, s), at(r, s + 1), at(r + 1, s), at(r + 1, s + 1)];
            triangles.extend([[a, b, c], [b, d, c]]);
        }
        triangles.push([south, at(inner, s), at(inner, s + 1)]);
    }
    Shape {
        positions: positions.collect(),
        triangles,
    }
}

fn point(segment: u32, ring: u32) -> DVec3 {
    let (around_cos, around_sin) = super::on_circle(super::step_angle(segment, SEGMENTS));
    let (down_cos, down_sin) = super::on_circle(super::step_angle(ring, 2 * RINGS));
    displaced(DVec3::new(
        around_cos * down_sin,
        down_cos,
        around_sin * down_sin,
    ))
}

fn pole(y: f64) -> DVec3 {
    displaced(DVec3::Y * y)
}

/// The surface in a direction of length 1.
fn displaced(direction: DVec3) -> DVec3 {
    let lobes: f64 = LOBES.iter().map(|l| lobe(l, direction)).sum();
    direction * HALF_AXES * (1.0 + lobes + folds(direction))
}

/// 1 in the middle, 0 from the rim on, smooth in between, times the height.
fn lobe([azimuth, height, radius, size]: &[f64; 4], direction: DVec3) -> f64 {
    let (ring, y) = super::on_circle(*height);
    let (x, z) = super::on_circle(*azimuth);
    let middle = DVec3::new(ring * x, y, ring * z);
    let rim = libm::cos(*radius);
    let t = ((direction.dot(middle) - rim) / (1.0 - rim)).clamp(0.0, 1.0);
    size * t * t * (3.0 - 2.0 * t)
}

/// Drapery: waves down the sides, none at the poles, where they would meet.
fn folds(direction: DVec3) -> f64 {
    let azimuth = libm::atan2(direction.z, direction.x);
    let flat = 1.0 - direction.y * direction.y;
    let slanted = libm::sin(18.0 * azimuth + 5.0 * direction.y);
    let fine = libm::sin(23.0 * direction.y) * libm::sin(7.0 * azimuth);
    flat * (0.022 * slanted + 0.015 * fine)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::world::adjacency::EdgeAdjacency;
    use crate::world::mesh::Shading;

    #[test]
    fn it_is_closed_and_has_70_000_faces_and_cavities() {
        let shape = statue();
        assert_eq!(shape.triangles.len(), 70_000);
        let mesh = shape.clone().into_mesh(Shading::Smooth).unwrap();
        let report = EdgeAdjacency::new(mesh.triangles()).closedness(&mesh);
        assert!(report.is_closed(), "{report}");
        assert_eq!(report.zero_area_triangles, 0);
        assert!(mesh.signed_volume() > 1.0);
        // How far the surface is from the ellipsoid, in radii.
        let radii = shape.positions.iter().map(|p| (*p / HALF_AXES).length());
        let (low, high) = radii.fold((f64::MAX, 0.0f64), |(l, h), r| (l.min(r), h.max(r)));
        assert!(low < 0.75 && low > 0.4 && high > 1.15, "{low} {high}");
    }
}
