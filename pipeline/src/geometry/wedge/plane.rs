//! Oriented planes, kept as a point and a normal so that far-off coordinates
//! cost no digits.

use glam::DVec3;

/// An oriented plane, world space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plane {
    /// Unit normal; distances are positive on its side.
    pub normal: DVec3,
    /// A point of the plane.
    pub point: DVec3,
}

/// Sine of an angle below which two directions span no plane.
const PARALLEL: f64 = 1e-14;

impl Plane {
    /// The plane through `point` with the normal `u x v`; `None` where u and v
    /// are parallel or zero.
    pub fn spanned(point: DVec3, u: DVec3, v: DVec3) -> Option<Self> {
        let (u, v) = (u.try_normalize()?, v.try_normalize()?);
        let normal = u.cross(v);
        (normal.length() > PARALLEL).then(|| Self {
            normal: normal.normalize(),
            point,
        })
    }

    /// Signed distance of `p`.
    pub fn distance(&self, p: DVec3) -> f64 {
        self.normal.dot(p - self.point)
    }

    /// The same plane, positive on its other side.
    pub fn reversed(&self) -> Self {
        Self {
            normal: -self.normal,
            point: self.point,
        }
    }

    /// `(a, b, c, d)` with the distance of `p` being `a x + b y + c z + d`, for
    /// shaders.
    pub fn coefficients(&self) -> [f64; 4] {
        let n = self.normal;
        [n.x, n.y, n.z, -n.dot(self.point)]
    }
}
