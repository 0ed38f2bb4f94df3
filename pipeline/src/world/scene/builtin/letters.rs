//! Letters and digits as outlines of our own drawing, about one unit high, their middle at
//! the origin.

use std::f64::consts::PI;

use glam::DVec2;

use crate::world::shape::Outline;

/// Half the width of a stroke.
const HALF: f64 = 0.09;

fn arc(middle: [f64; 2], radii: [f64; 2], degrees: [f64; 2], steps: u32) -> Vec<DVec2> {
    let at = |k: u32| {
        let share = f64::from(k) / f64::from(steps);
        let angle = (degrees[0] + (degrees[1] - degrees[0]) * share) * PI / 180.0;
        DVec2::new(
            middle[0] + radii[0] * libm::cos(angle),
            middle[1] + radii[1] * libm::sin(angle),
        )
    };
    (0..=steps).map(at).collect()
}

fn point(x: f64, y: f64) -> DVec2 {
    DVec2::new(x, y)
}

/// E, in straight bars.
pub(super) fn e() -> Outline {
    Outline::solid([
        [-0.32, -0.5],
        [0.32, -0.5],
        [0.32, -0.32],
        [-0.12, -0.32],
        [-0.12, -0.09],
        [0.22, -0.09],
        [0.22, 0.09],
        [-0.12, 0.09],
        [-0.12, 0.32],
        [0.32, 0.32],
        [0.32, 0.5],
        [-0.32, 0.5],
    ])
}

/// G, a stroke.
pub(super) fn g() -> Outline {
    let mut path = arc([0.0, 0.0], [0.36, 0.41], [48.0, 340.0], 28);
    path.push(point(0.32, 0.02));
    path.push(point(0.02, 0.02));
    Outline::stroke(&path, HALF)
}

/// 2, a stroke.
pub(super) fn two() -> Outline {
    let mut path = arc([0.0, 0.17], [0.27, 0.24], [165.0, -30.0], 20);
    path.push(point(-0.27, -0.41));
    path.push(point(0.34, -0.41));
    Outline::stroke(&path, HALF)
}

/// 0, with its hole.
pub(super) fn zero() -> Outline {
    let ring = |grown: f64| {
        let mut ring = arc([0.0, 0.0], [0.27 + grown, 0.41 + grown], [0.0, 360.0], 32);
        ring.pop(); // the first again
        ring
    };
    let mut hole = ring(-HALF);
    hole.reverse();
    Outline {
        border: ring(HALF),
        holes: vec![hole],
    }
}

/// @, one stroke that turns outwards.
pub(super) fn at_sign() -> Outline {
    let radius = |degrees: f64| {
        let share = ((degrees - 350.0) / 75.0).clamp(0.0, 1.0);
        // Smooth at both ends.
        0.17 + 0.29 * share * share * (3.0 - 2.0 * share)
    };
    let place = |k: u32| {
        let degrees = 40.0 + 10.0 * f64::from(k);
        let angle = degrees * PI / 180.0;
        DVec2::new(libm::cos(angle), libm::sin(angle)) * radius(degrees)
    };
    let path: Vec<DVec2> = (0..=64).map(place).collect();
    Outline::stroke(&path, 0.055)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::world::adjacency::EdgeAdjacency;
    use crate::world::mesh::Shading;
    use crate::world::shape::prism;

    #[test]
    fn all_are_closed_solids_as_large_as_their_outline() {
        for outline in [e(), g(), two(), zero(), at_sign()] {
            let mesh = prism(&outline, 0.2).into_mesh(Shading::Flat).unwrap();
            let report = EdgeAdjacency::new(mesh.triangles()).closedness(&mesh);
            assert!(report.is_closed(), "{report}");
            let area = mesh.signed_volume() / 0.2;
            assert!(
                (area - outline.area()).abs() < 1e-6 && area > 0.15,
                "{area}"
            );
        }
    }
}
