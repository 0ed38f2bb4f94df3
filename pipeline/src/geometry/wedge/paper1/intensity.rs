//! Light intensity inside a linked wedge (paper I, §4.2).

use glam::DVec3;

use super::LinkedWedge;
use crate::geometry::wedge::Plane;

/// Unit directions in the two side planes of a wedge.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SideDirections(pub [DVec3; 2]);

impl LinkedWedge {
    /// The interpolated intensity, equations (2) and (3): 1 on the front plane, 0
    /// on the back plane, continuous across shared side planes. `p` inside the
    /// wedge or on its boundary; 1 where front and back plane meet, on the edge.
    pub fn intensity(&self, p: DVec3) -> f64 {
        let [first, second] = self
            .side_directions
            .0
            .map(|d| between(&self.front, &self.back, p, d));
        // How far along the edge to either side, from the first to the second.
        let reach = self.sides.map(|side| along(&side, p, self.along));
        let total = reach[0] + reach[1];
        if total == 0.0 {
            return 0.5 * (first + second);
        }
        (reach[1] * first + reach[0] * second) / total
    }

    /// The intensity along the normal of the wedge's own quad, equation (1): what
    /// the paper tried first. It jumps between neighbours.
    pub fn intensity_by_own_normal(&self, p: DVec3) -> f64 {
        between(&self.front, &self.back, p, self.outer)
    }
}

/// `3 s^2 - 2 s^3`, nearer to a disc's coverage than s is (paper I, §4.2).
pub fn smoothed(s: f64) -> f64 {
    s * s * (3.0 - 2.0 * s)
}

/// `t_b / (t_f + t_b)` with the distances from `p` along the direction.
fn between(front: &Plane, back: &Plane, p: DVec3, direction: DVec3) -> f64 {
    let to_front = along(front, p, direction);
    let to_back = along(back, p, direction);
    let total = to_front + to_back;
    if total == 0.0 { 1.0 } else { to_back / total }
}

/// Distance from `p` to the plane along the line of `direction`.
fn along(plane: &Plane, p: DVec3, direction: DVec3) -> f64 {
    let rate = plane.normal.dot(direction).abs();
    let distance = plane.distance(p).max(0.0);
    if rate == 0.0 {
        distance
    } else {
        distance / rate
    }
}
