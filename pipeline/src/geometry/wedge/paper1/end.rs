//! Where wedges and the volumes that they bound end.

use glam::{DVec3, DVec4};

use crate::geometry::wedge::Plane;

/// The plane in which shadows end, positive on the light's side; `None`: at infinity.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct End(pub Option<Plane>);

impl End {
    /// Where a ray from `apex` ends.
    pub fn of_ray(&self, apex: DVec3, ray: DVec3) -> DVec4 {
        match &self.0 {
            None => ray.extend(0.0),
            Some(plane) => {
                let length = -plane.distance(apex) / plane.normal.dot(ray);
                (apex + ray * length).extend(1.0)
            }
        }
    }

    /// Whether `point` lies before the end.
    pub fn holds(&self, point: DVec3) -> bool {
        self.0.is_none_or(|plane| plane.distance(point) > 0.0)
    }

    /// Whether rays of that direction come to the end, and not almost beside it.
    pub fn is_reached_by(&self, ray: DVec3) -> bool {
        /// Least sine of the angle with the plane.
        const STEEP: f64 = 0.05;
        let falls = |plane: Plane| plane.normal.dot(ray.normalize_or_zero()) < -STEEP;
        self.0.is_none_or(falls)
    }
}
