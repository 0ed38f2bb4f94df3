//! Whether cutting a polygon into a fan is right.

use glam::DVec3;

/// Whether every triangle of the fan from the first corner is turned like the
/// polygon as a whole (Newell's normal). False for concave polygons whose fan
/// leaves the polygon; triangles are always fine, and polygons without area
/// too, since no cut of them is better.
pub(super) fn fan_is_valid(polygon: &[DVec3]) -> bool {
    let Some((&first, rest)) = polygon.split_first() else {
        return true;
    };
    let fan = || {
        rest.windows(2)
            .map(move |w| (w[0] - first).cross(w[1] - first))
    };
    let normal: DVec3 = fan().sum();
    polygon.len() <= 3 || normal == DVec3::ZERO || fan().all(|n| n.dot(normal) >= 0.0)
}
