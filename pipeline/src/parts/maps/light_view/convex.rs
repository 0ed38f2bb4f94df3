//! Bounds of what a light sees of convex polygons.

use glam::DVec3;
use gnomon_shaders::light_view::Projection;

/// Where a point with positive z is in a picture: tangents, or lengths where views
/// are orthographic.
pub(super) fn place_of(p: DVec3, projection: Projection) -> [f64; 2] {
    match projection {
        Projection::Perspective => [p.x / p.z, p.y / p.z],
        Projection::Orthographic => [p.x, p.y],
    }
}

/// A rectangle of places, tangents (x/z, y/z) or lengths (x, y), and an interval of
/// distances z.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct TangentBox {
    pub(super) low: [f64; 2],
    pub(super) high: [f64; 2],
    pub(super) nearest: f64,
    pub(super) farthest: f64,
}

impl TangentBox {
    /// Holds nothing.
    pub(super) const EMPTY: Self = Self {
        low: [f64::INFINITY; 2],
        high: [f64::NEG_INFINITY; 2],
        nearest: f64::INFINITY,
        farthest: f64::NEG_INFINITY,
    };

    /// Bounds of points with positive z.
    pub(super) fn of(points: &[DVec3], projection: Projection) -> Self {
        let mut bounds = Self::EMPTY;
        for p in points {
            let place = place_of(*p, projection);
            for (k, t) in place.into_iter().enumerate() {
                bounds.low[k] = bounds.low[k].min(t);
                bounds.high[k] = bounds.high[k].max(t);
            }
            bounds.nearest = bounds.nearest.min(p.z);
            bounds.farthest = bounds.farthest.max(p.z);
        }
        bounds
    }

    pub(super) fn is_empty(&self) -> bool {
        !(self.low[0] <= self.high[0] && self.low[1] <= self.high[1])
    }

    pub(super) fn join(&mut self, other: &Self) {
        for k in 0..2 {
            self.low[k] = self.low[k].min(other.low[k]);
            self.high[k] = self.high[k].max(other.high[k]);
        }
        self.nearest = self.nearest.min(other.nearest);
        self.farthest = self.farthest.max(other.farthest);
    }

    /// The tangents that both have.
    pub(super) fn meet(&self, other: &Self) -> Self {
        let mut both = *self;
        for k in 0..2 {
            both.low[k] = both.low[k].max(other.low[k]);
            both.high[k] = both.high[k].min(other.high[k]);
        }
        both
    }

    /// Wider by so much on each side.
    pub(super) fn grown(&self, by: [f64; 2]) -> Self {
        let mut grown = *self;
        for (k, by) in by.into_iter().enumerate() {
            grown.low[k] -= by;
            grown.high[k] += by;
        }
        grown
    }

    pub(super) fn overlaps(&self, other: &Self) -> bool {
        !self.meet(other).is_empty()
    }

    /// Largest tangent, either sign.
    pub(super) fn steepest(&self) -> f64 {
        let all = self.low.into_iter().chain(self.high);
        all.map(f64::abs).fold(0.0, f64::max)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn boxes_join_meet_and_grow() {
        let corners = [DVec3::new(2.0, 0.0, 2.0), DVec3::new(-1.0, 4.0, 4.0)];
        let flat = TangentBox::of(&corners, Projection::Orthographic);
        assert_eq!((flat.low, flat.high), ([-1.0, 0.0], [2.0, 4.0]));
        let a = TangentBox::of(&corners, Projection::Perspective);
        assert_eq!((a.low, a.high), ([-0.25, 0.0], [1.0, 1.0]));
        assert_eq!((a.nearest, a.farthest), (2.0, 4.0));
        let far = TangentBox::of(&[DVec3::new(30.0, 1.0, 10.0)], Projection::Perspective);
        assert!(!a.overlaps(&far) && a.overlaps(&far.grown([2.0, 0.0])));
        let mut both = a;
        both.join(&far);
        assert_eq!((both.high[0], both.farthest), (3.0, 10.0));
        assert!(
            TangentBox::EMPTY.is_empty() && TangentBox::of(&[], Projection::Perspective).is_empty()
        );
    }
}
