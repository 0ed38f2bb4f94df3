//! The visible part of a light as a list of convex polygons, in the light's
//! own two coordinates.

use super::disc;

type Point = [f64; 2];

/// Pieces below this share of the light's area are dropped: they are what
/// rounding leaves between triangles that share an edge.
const SLIVER: f64 = 1e-16;

/// Enough to pack rarely, few enough to stay in the first cache.
const MAX_DEAD_POINTS: usize = 4096;

/// The side of a line on which `k + s x + t y` is positive.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct HalfPlane {
    pub(super) k: f64,
    pub(super) s: f64,
    pub(super) t: f64,
}

impl HalfPlane {
    pub(super) fn at(&self, p: Point) -> f64 {
        self.k + self.s * p[0] + self.t * p[1]
    }

    /// The largest value in a box.
    fn most(&self, low: Point, high: Point) -> f64 {
        let of = |slope: f64, low: f64, high: f64| slope * if slope > 0.0 { high } else { low };
        self.k + of(self.s, low[0], high[0]) + of(self.t, low[1], high[1])
    }
}

/// Which part of the outline emits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Emitting {
    /// All of it.
    Outline,
    /// What lies in the unit disc.
    UnitDisc,
}

/// A convex polygon: points `start..end` of the pool, and their bounds.
#[derive(Clone, Copy, Debug)]
struct Fragment {
    start: u32,
    end: u32,
    low: Point,
    high: Point,
}

/// Disjoint convex polygons, counter-clockwise.
#[derive(Clone, Debug)]
pub(super) struct Fragments {
    emitting: Emitting,
    /// Area below which a piece is dropped.
    sliver: f64,
    pool: Vec<Point>,
    list: Vec<Fragment>,
    next: Vec<Fragment>,
    /// The polygon being cut, and where its cut goes.
    rest: Vec<Point>,
    cut: Vec<Point>,
    most: usize,
    /// Points kept for dead fragments before the pool is packed.
    max_dead_points: usize,
}

impl Default for Fragments {
    fn default() -> Self {
        Self {
            emitting: Emitting::Outline,
            sliver: 0.0,
            pool: Vec::new(),
            list: Vec::new(),
            next: Vec::new(),
            rest: Vec::new(),
            cut: Vec::new(),
            most: 0,
            max_dead_points: MAX_DEAD_POINTS,
        }
    }
}

impl Fragments {
    /// Starts anew with a whole light.
    pub(super) fn reset(&mut self, outline: &[Point], emitting: Emitting) {
        self.emitting = emitting;
        self.sliver = SLIVER * area(outline);
        self.pool.clear();
        self.list.clear();
        self.pool.extend_from_slice(outline);
        self.list.push(fragment(&self.pool, 0));
        self.most = 1;
    }

    pub(super) fn is_empty(&self) -> bool {
        self.list.is_empty()
    }

    /// The most fragments there were at a time since the last reset.
    pub(super) fn most(&self) -> usize {
        self.most
    }

    pub(super) fn clear(&mut self) {
        self.list.clear();
    }

    /// The polygons left.
    pub(super) fn polygons(&self) -> impl Iterator<Item = &[Point]> {
        self.list.iter().map(|f| points(&self.pool, f))
    }

    /// Emitting area left, in the units of the coordinates.
    pub(super) fn area(&self) -> f64 {
        let of = match self.emitting {
            Emitting::Outline => area,
            Emitting::UnitDisc => disc::area_in_disc,
        };
        self.polygons().map(of).sum()
    }

    /// Keeps what lies in `plane`.
    pub(super) fn keep(&mut self, plane: HalfPlane) {
        self.subtract(&[HalfPlane {
            k: -plane.k,
            s: -plane.s,
            t: -plane.t,
        }]);
    }

    /// Takes away the convex region in which all `planes` are positive. What it
    /// does not touch, or touches in a sliver only, stays uncut.
    pub(super) fn subtract(&mut self, planes: &[HalfPlane]) {
        self.next.clear();
        for at in 0..self.list.len() {
            let whole = self.list[at];
            let outside = |h: &HalfPlane| h.most(whole.low, whole.high) <= 0.0;
            if planes.iter().any(outside) {
                self.next.push(whole);
                continue;
            }
            let (pooled, pieces) = (self.pool.len(), self.next.len());
            if !self.carve(&whole, planes) {
                self.pool.truncate(pooled);
                self.next.truncate(pieces);
                self.next.push(whole);
            }
        }
        std::mem::swap(&mut self.list, &mut self.next);
        self.most = self.most.max(self.list.len());
        self.pack();
    }

    /// Pushes the pieces of `whole` outside each plane in turn; false if nothing
    /// is left inside all of them.
    fn carve(&mut self, whole: &Fragment, planes: &[HalfPlane]) -> bool {
        self.rest.clear();
        self.rest.extend_from_slice(points(&self.pool, whole));
        for plane in planes {
            match side_of(plane, &self.rest) {
                Side::Inside => {}
                Side::Outside => return false,
                Side::Both => self.split_off(plane),
            }
        }
        area(&self.rest) > self.sliver
    }

    /// Cuts the rest along a plane: its outside becomes a fragment.
    fn split_off(&mut self, plane: &HalfPlane) {
        let start = self.pool.len();
        self.cut.clear();
        split(plane, &self.rest, &mut self.cut, &mut self.pool);
        std::mem::swap(&mut self.rest, &mut self.cut);
        let piece = &self.pool[start..];
        let missed = self.emitting == Emitting::UnitDisc && disc::misses_disc(piece);
        if missed || area(piece) <= self.sliver {
            self.pool.truncate(start);
        } else {
            self.next.push(fragment(&self.pool, start));
        }
    }

    /// Drops the points of dead fragments when there are many.
    fn pack(&mut self) {
        let live: u32 = self.list.iter().map(|f| f.end - f.start).sum();
        if self.pool.len() <= (live as usize).saturating_add(self.max_dead_points) {
            return;
        }
        self.cut.clear();
        for f in &mut self.list {
            let start = self.cut.len() as u32;
            self.cut.extend_from_slice(points(&self.pool, f));
            (f.start, f.end) = (start, self.cut.len() as u32);
        }
        std::mem::swap(&mut self.pool, &mut self.cut);
    }
}

fn points<'a>(pool: &'a [Point], f: &Fragment) -> &'a [Point] {
    &pool[f.start as usize..f.end as usize]
}

/// The polygon from `start` to the end of the pool.
fn fragment(pool: &[Point], start: usize) -> Fragment {
    let mut low = [f64::INFINITY; 2];
    let mut high = [f64::NEG_INFINITY; 2];
    for p in &pool[start..] {
        for k in 0..2 {
            low[k] = low[k].min(p[k]);
            high[k] = high[k].max(p[k]);
        }
    }
    Fragment {
        start: start as u32,
        end: pool.len() as u32,
        low,
        high,
    }
}

/// Where a polygon lies; on the line counts as either side.
enum Side {
    Inside,
    Outside,
    Both,
}

fn side_of(plane: &HalfPlane, polygon: &[Point]) -> Side {
    let (mut inside, mut outside) = (false, false);
    for p in polygon {
        let value = plane.at(*p);
        inside |= value > 0.0;
        outside |= value < 0.0;
    }
    match (inside, outside) {
        (true, true) => Side::Both,
        (true, false) => Side::Inside,
        (false, _) => Side::Outside,
    }
}

/// Appends the part of `polygon` inside `plane` and the part outside. Both get
/// the same point where an edge is cut, computed from its inner end.
fn split(plane: &HalfPlane, polygon: &[Point], inner: &mut Vec<Point>, outer: &mut Vec<Point>) {
    let mut from = polygon[polygon.len() - 1];
    let mut from_value = plane.at(from);
    for &to in polygon {
        let value = plane.at(to);
        if (from_value > 0.0 && value < 0.0) || (from_value < 0.0 && value > 0.0) {
            let [(a, fa), (b, fb)] = if from_value > 0.0 {
                [(from, from_value), (to, value)]
            } else {
                [(to, value), (from, from_value)]
            };
            let t = fa / (fa - fb);
            let cut = [a[0] + (b[0] - a[0]) * t, a[1] + (b[1] - a[1]) * t];
            inner.push(cut);
            outer.push(cut);
        }
        if value >= 0.0 {
            inner.push(to);
        }
        if value <= 0.0 {
            outer.push(to);
        }
        (from, from_value) = (to, value);
    }
}

/// Signed area of a polygon, positive counter-clockwise.
pub(super) fn area(polygon: &[Point]) -> f64 {
    let Some(&[x, y]) = polygon.first() else {
        return 0.0;
    };
    let doubled = polygon.windows(2).map(|e| {
        let [a, b] = [e[0], e[1]].map(|p| [p[0] - x, p[1] - y]);
        a[0] * b[1] - a[1] * b[0]
    });
    doubled.sum::<f64>() * 0.5
}

#[cfg(test)]
mod tests {
    use super::*;

    const SQUARE: [Point; 4] = [[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]];

    fn right_of(x: f64) -> HalfPlane {
        HalfPlane {
            k: -x,
            s: 1.0,
            t: 0.0,
        }
    }

    fn left_of(x: f64) -> HalfPlane {
        HalfPlane {
            k: x,
            s: -1.0,
            t: 0.0,
        }
    }

    fn above(y: f64) -> HalfPlane {
        HalfPlane {
            k: -y,
            s: 0.0,
            t: 1.0,
        }
    }

    fn whole() -> Fragments {
        let mut light = Fragments::default();
        light.reset(&SQUARE, Emitting::Outline);
        light
    }

    #[test]
    fn overlapping_regions_are_taken_once() {
        let mut light = whole();
        light.subtract(&[right_of(0.1)]);
        light.subtract(&[right_of(-0.2), above(0.0)]);
        light.subtract(&[right_of(-0.2), above(0.0)]); // a duplicate
        assert!((light.area() - (0.6 - 0.3 * 0.5)).abs() < 1e-15);
    }

    #[test]
    fn what_is_not_touched_stays_uncut() {
        let mut light = whole();
        light.subtract(&[right_of(0.0), left_of(-0.1)]); // an empty region across the light
        light.subtract(&[right_of(0.5)]); // shares an edge only
        assert_eq!(light.polygons().count(), 1);
        assert_eq!(light.area(), 1.0);
    }

    #[test]
    fn slivers_do_not_cut() {
        // Neighbouring numbers: a strip of 5.5e-17 through the light.
        let (low, high) = (0.25, 0.25f64.next_up());
        let mut light = whole();
        light.subtract(&[right_of(low), left_of(high)]);
        assert_eq!(light.polygons().count(), 1);
        light.subtract(&[right_of(low), left_of(0.25 + 1e-15)]);
        assert_eq!(light.polygons().count(), 2);
    }

    #[test]
    fn complements_leave_nothing() {
        let line = HalfPlane {
            k: 0.013,
            s: 0.77,
            t: -0.31,
        };
        let other = HalfPlane {
            k: -line.k,
            s: -line.s,
            t: -line.t,
        };
        let mut light = whole();
        light.subtract(&[line]);
        assert!(light.area() > 0.4 && light.area() < 0.6);
        light.subtract(&[other]);
        assert!(light.is_empty());
    }

    #[test]
    fn packing_changes_nothing() {
        let strip = |k: u32| {
            let (x, y) = crate::world::shape::on_circle(f64::from(k) * 2.4);
            let side = |sign: f64, k: f64| HalfPlane {
                k,
                s: sign * x,
                t: sign * y,
            };
            let r = 0.6 * f64::from(k) / 60.0;
            [side(1.0, -r), side(-1.0, r + 2e-3)]
        };
        let cut = |max_dead_points: usize| {
            let mut light = whole();
            light.max_dead_points = max_dead_points;
            (0..60).for_each(|k| light.subtract(&strip(k)));
            light
        };
        let (packed, loose) = (cut(0), cut(usize::MAX));
        assert!(packed.polygons().eq(loose.polygons()));
        assert_eq!(packed.polygons().flatten().count(), packed.pool.len());
        assert!(packed.pool.len() * 2 < loose.pool.len() && packed.area() > 0.5);
    }

    #[test]
    fn discs_count_only_what_is_inside() {
        let around = SQUARE.map(|p| [2.0 * p[0], 2.0 * p[1]]);
        let mut light = Fragments::default();
        light.reset(&around, Emitting::UnitDisc);
        assert!((light.area() - std::f64::consts::PI).abs() < 1e-15);
        light.subtract(&[right_of(0.0)]);
        assert!((light.area() - std::f64::consts::PI / 2.0).abs() < 1e-15);
        // A corner of the square that the disc does not reach is let go.
        let corner = HalfPlane {
            k: -1.5,
            s: -1.0,
            t: -1.0,
        };
        light.keep(HalfPlane {
            k: 1.5,
            s: 1.0,
            t: 1.0,
        });
        assert!((light.area() - std::f64::consts::PI / 2.0).abs() < 1e-15);
        assert!(light.polygons().flatten().all(|p| corner.at(*p) <= 1e-12));
    }
}
