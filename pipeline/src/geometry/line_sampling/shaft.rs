//! The hull of two boxes: all that lies on the way from receivers to a light (Haines and
//! Wallace, "Shaft Culling for Efficient Ray-Cast Radiosity", 1991).

use glam::DVec3;

/// An axis-aligned box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Least coordinates.
    pub low: DVec3,
    /// Greatest coordinates.
    pub high: DVec3,
}

impl Bounds {
    /// Of nothing.
    pub const EMPTY: Self = Self {
        low: DVec3::INFINITY,
        high: DVec3::NEG_INFINITY,
    };

    /// Round points.
    pub fn of(points: impl IntoIterator<Item = DVec3>) -> Self {
        points
            .into_iter()
            .fold(Self::EMPTY, |b, p| b.joined(&Self { low: p, high: p }))
    }

    /// Whether nothing is in it.
    pub fn is_empty(&self) -> bool {
        !self.low.cmple(self.high).all()
    }

    /// Round both.
    #[must_use]
    pub fn joined(&self, o: &Self) -> Self {
        Self {
            low: self.low.min(o.low),
            high: self.high.max(o.high),
        }
    }

    /// What is in both.
    #[must_use]
    pub fn common(&self, o: &Self) -> Self {
        Self {
            low: self.low.max(o.low),
            high: self.high.min(o.high),
        }
    }

    /// Larger by `by` on every side.
    #[must_use]
    pub fn grown(&self, by: f64) -> Self {
        Self {
            low: self.low - by,
            high: self.high + by,
        }
    }

    /// The largest coordinate.
    pub fn largest(&self) -> f64 {
        self.low.abs().max(self.high.abs()).max_element()
    }

    /// Distance from a point.
    pub fn distance(&self, p: DVec3) -> f64 {
        (p - p.clamp(self.low, self.high)).length()
    }

    /// Middle and half of the size.
    pub fn middle(&self) -> [DVec3; 2] {
        [0.5 * (self.low + self.high), 0.5 * (self.high - self.low)]
    }
}

/// A side of a shaft in the plane of two axes: points whose coordinates there, times
/// `normal`, sum to more than `most` are outside.
#[derive(Clone, Copy, Debug)]
struct Side {
    axes: [usize; 2],
    normal: [f64; 2],
    most: f64,
}

/// The hull of two boxes.
#[derive(Clone, Debug)]
pub struct Shaft {
    bounds: Bounds,
    sides: Vec<Side>,
}

impl Shaft {
    /// Between `a` and `b`.
    pub fn new(a: &Bounds, b: &Bounds) -> Self {
        let mut sides = Vec::with_capacity(12);
        for axes in [[0, 1], [1, 2], [0, 2]] {
            for signs in [[1.0, 1.0], [1.0, -1.0], [-1.0, 1.0], [-1.0, -1.0]] {
                sides.extend(tangent(a, b, axes, signs));
            }
        }
        Self {
            bounds: a.joined(b),
            sides,
        }
    }

    /// Whether a segment is outside of one side.
    pub fn misses(&self, [a, b]: [DVec3; 2]) -> bool {
        let (low, high) = (a.min(b), a.max(b));
        if !(low.cmple(self.bounds.high).all() && high.cmpge(self.bounds.low).all()) {
            return true;
        }
        self.sides.iter().any(|s| {
            let [i, j] = s.axes;
            let at = |p: DVec3| s.normal[0] * p[i] + s.normal[1] * p[j];
            at(a).min(at(b)) > s.most
        })
    }

    /// Whether a box is outside of one side.
    pub fn misses_box(&self, b: &Bounds) -> bool {
        if self.bounds.common(b).is_empty() {
            return true;
        }
        self.sides.iter().any(|s| {
            let least = |k: usize| {
                let end = if s.normal[k] > 0.0 { b.low } else { b.high };
                s.normal[k] * end[s.axes[k]]
            };
            least(0) + least(1) > s.most
        })
    }
}

/// The side through a corner of each box that has both on its inner side, where one box
/// reaches farther along one axis and the other along the other.
fn tangent(a: &Bounds, b: &Bounds, axes: [usize; 2], signs: [f64; 2]) -> Option<Side> {
    let corner = |bounds: &Bounds, k: usize| {
        let end = if signs[k] > 0.0 {
            bounds.high
        } else {
            bounds.low
        };
        end[axes[k]]
    };
    let [a0, a1, b0, b1] = [corner(a, 0), corner(a, 1), corner(b, 0), corner(b, 1)];
    let [ahead, across] = [(a0 - b0) * signs[0], (a1 - b1) * signs[1]];
    (ahead * across < 0.0).then(|| {
        let normal = [(a1 - b1).abs() * signs[0], (a0 - b0).abs() * signs[1]];
        let at = |x: f64, y: f64| normal[0] * x + normal[1] * y;
        Side {
            axes,
            normal,
            most: at(a0, a1).max(at(b0, b1)),
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Segments between the boxes are never missed, and boxes far beside always.
    #[test]
    fn what_joins_both_boxes_is_inside() {
        let a = Bounds::of([DVec3::new(-1.0, 0.0, 2.0), DVec3::new(0.5, 0.2, 3.0)]);
        let b = Bounds::of([DVec3::new(2.0, 4.0, -1.0), DVec3::new(3.0, 4.0, 1.0)]);
        let shaft = Shaft::new(&a, &b);
        let place = |x: &Bounds, k: u32| {
            let part = |s: u32| f64::from(k.wrapping_mul(2_654_435_761) >> s & 255) / 255.0;
            x.low + (x.high - x.low) * DVec3::new(part(0), part(8), part(16))
        };
        let mut missed = 0;
        for k in 0..2000 {
            let (from, to) = (place(&a, k), place(&b, k * 7 + 3));
            let at = from + (to - from) * (f64::from(k % 11) / 10.0);
            assert!(!shaft.misses([at, at + DVec3::Y * 9.0]), "{k}");
            assert!(!shaft.misses_box(&Bounds::of([at]).grown(0.01)));
            let aside = at + DVec3::new(3.0, -2.0, 0.0);
            missed += u32::from(shaft.misses([aside, aside + DVec3::X]));
        }
        assert!(missed > 1900, "{missed}");
    }
}
