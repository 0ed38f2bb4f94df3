//! A bounding volume hierarchy over triangles in f64.
//!
//! The triangle test shears space so that the ray becomes an axis (Woop, Benthin
//! and Wald, "Watertight Ray/Triangle Intersection", JCGT 2013) and takes signs
//! of 2D edge functions. Both products of such a function are rounded
//! monotonically, so a sign may become zero but never wrong. Under
//! [`EdgeRule::Closed`] a ray cannot slip between neighbours, not even at a
//! vertex; under [`EdgeRule::HalfOpen`] it crosses one of them.
//! Traversal order affects only speed: [`Bvh::closest`] breaks ties by the
//! lowest triangle index, [`Bvh::count`] is a sum.

mod gather;

use std::ops::Range;

use glam::DVec3;

pub use gather::Region;

/// Most triangles in a leaf.
const LEAF_SIZE: usize = 4;

/// A ray `origin + t direction`; the direction need not be normalised.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    origin: DVec3,
    direction: DVec3,
    /// Axes x, y, z of the sheared space; z has the largest direction.
    axes: [usize; 3],
    /// Steps in x and y per step in z.
    shear: [f64; 2],
}

impl Ray {
    /// A ray that is at `origin` for `t` = 0 and steps by `direction` (not
    /// zero) per unit of `t`.
    pub fn new(origin: DVec3, direction: DVec3) -> Self {
        let size = direction.abs();
        let z = (1..3).fold(0, |best, k| if size[k] > size[best] { k } else { best });
        let [x, y] = [(z + 1) % 3, (z + 2) % 3];
        Self {
            origin,
            direction,
            axes: [x, y, z],
            shear: [direction[x] / direction[z], direction[y] / direction[z]],
        }
    }

    /// The point at `t`.
    pub fn at(&self, t: f64) -> DVec3 {
        self.origin + self.direction * t
    }

    /// The `t` at which the ray crosses the triangle, from either side. `None`
    /// for misses and for triangles seen edge-on.
    pub fn crossing(&self, triangle: &[DVec3; 3], edges: EdgeRule) -> Option<f64> {
        let [a, b, c] = triangle.map(|v| v - self.origin);
        let [p, q, r] = [a, b, c].map(|v| self.sheared(v));
        let sides = [[p, q], [q, r], [r, p]];
        let signs = sides.map(|[from, to]| edge(from, to));
        let left = signs.iter().any(|s| *s > 0.0);
        let right = signs.iter().any(|s| *s < 0.0);
        if left == right {
            return None; // outside, or edge-on
        }
        let owns = |k: usize| signs[k] != 0.0 || owns_edge(sides[k], left);
        if edges == EdgeRule::HalfOpen && !(0..3).all(owns) {
            return None;
        }
        let normal = (b - a).cross(c - a);
        let slope = normal.dot(self.direction);
        // Adding 0 makes −0 into 0: a crossing at the origin is one number.
        (slope != 0.0).then(|| normal.dot(a) / slope + 0.0)
    }

    /// Where the parallel to the ray through `v` (relative to the origin)
    /// meets the plane z = 0.
    fn sheared(&self, v: DVec3) -> [f64; 2] {
        let [x, y, z] = self.axes;
        [v[x] - self.shear[0] * v[z], v[y] - self.shear[1] * v[z]]
    }
}

/// Which triangles a ray through a common edge crosses.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EdgeRule {
    /// All triangles at the edge: nothing slips through.
    Closed,
    /// One of two neighbours turned the same way: layers count once.
    HalfOpen,
}

/// Whether an edge through the ray belongs to the triangle that walks it, which
/// is turned left (counter-clockwise) or not: the top-left rule of rasterisers,
/// in sheared space.
fn owns_edge([p, q]: [[f64; 2]; 2], left: bool) -> bool {
    let [from, to] = if left { [p, q] } else { [q, p] };
    to[1] < from[1] || (to[1] == from[1] && to[0] > from[0])
}

/// On which side of the line from `p` to `q` the origin lies; 0 on the line or
/// too close to say.
fn edge(p: [f64; 2], q: [f64; 2]) -> f64 {
    p[0] * q[1] - p[1] * q[0]
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Bounds {
    low: DVec3,
    high: DVec3,
}

impl Bounds {
    const EMPTY: Self = Self {
        low: DVec3::INFINITY,
        high: DVec3::NEG_INFINITY,
    };

    fn with(self, p: DVec3) -> Self {
        Self {
            low: self.low.min(p),
            high: self.high.max(p),
        }
    }

    /// Grown by a little more than the rounding of the slab test can lose.
    fn padded(self) -> Self {
        let pad = (self.low.abs().max(self.high.abs()) + DVec3::ONE) * 1e-12;
        Self {
            low: self.low - pad,
            high: self.high + pad,
        }
    }

    /// Whether the ray meets the box with `t` in `range`. A direction of 0 gives
    /// infinities of the right sign, or NaN (0 * inf), which min and max drop.
    fn meets(&self, origin: DVec3, inverse: DVec3, range: &Range<f64>) -> bool {
        let (t0, t1) = (
            (self.low - origin) * inverse,
            (self.high - origin) * inverse,
        );
        let enter = t0
            .min(t1)
            .to_array()
            .into_iter()
            .fold(range.start, f64::max);
        let leave = t0.max(t1).to_array().into_iter().fold(range.end, f64::min);
        enter <= leave
    }
}

/// Inner nodes have their left child next in the array and the right one at
/// `right`; leaves have triangles.
#[derive(Clone, Debug, PartialEq)]
struct Node {
    bounds: Bounds,
    right: u32,
    leaf: Range<u32>,
}

/// The hierarchy: median split along the widest axis of the centroids.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Bvh {
    nodes: Vec<Node>,
    /// Triangle indices as given by the caller, in leaf order.
    order: Vec<u32>,
    /// Corners, in leaf order.
    corners: Vec<[DVec3; 3]>,
}

impl Bvh {
    /// Builds over `triangles`; their indices are what queries return.
    pub fn new(triangles: &[[DVec3; 3]]) -> Self {
        let mut order: Vec<u32> = (0..triangles.len() as u32).collect();
        let mut bvh = Self::default();
        if !order.is_empty() {
            bvh.split(triangles, &mut order, 0);
        }
        bvh.corners = order.iter().map(|&i| triangles[i as usize]).collect();
        bvh.order = order;
        bvh
    }

    /// Makes the node for `part`, which begins at `first` in leaf order.
    fn split(&mut self, triangles: &[[DVec3; 3]], part: &mut [u32], first: usize) {
        let corners = part.iter().flat_map(|&i| triangles[i as usize]);
        let bounds = corners.fold(Bounds::EMPTY, Bounds::with).padded();
        let node = self.nodes.len();
        let end = first + part.len();
        let is_leaf = part.len() <= LEAF_SIZE;
        let leaf = if is_leaf {
            first as u32..end as u32
        } else {
            0..0
        };
        self.nodes.push(Node {
            bounds,
            right: 0,
            leaf,
        });
        if is_leaf {
            return;
        }
        let middle = part.len() / 2;
        partition(triangles, part, middle);
        let (left, right) = part.split_at_mut(middle);
        self.split(triangles, left, first);
        self.nodes[node].right = self.nodes.len() as u32;
        self.split(triangles, right, first + middle);
    }

    /// Calls `visit` with index and `t` of every crossing within `range`, which
    /// `visit` may narrow.
    fn visit(
        &self,
        ray: &Ray,
        edges: EdgeRule,
        mut range: Range<f64>,
        mut visit: impl FnMut(u32, f64, &mut Range<f64>),
    ) {
        let inverse = ray.direction.recip();
        let mut stack = [0u32; 64]; // median split: depth is at most log2 of the count
        let mut depth = usize::from(!self.nodes.is_empty());
        while depth > 0 {
            depth -= 1;
            let index = stack[depth];
            let node = &self.nodes[index as usize];
            if !node.bounds.meets(ray.origin, inverse, &range) {
                continue;
            }
            for slot in node.leaf.clone() {
                let crossing = ray.crossing(&self.corners[slot as usize], edges);
                if let Some(t) = crossing.filter(|t| *t >= range.start && *t <= range.end) {
                    visit(self.order[slot as usize], t, &mut range);
                }
            }
            if node.leaf.is_empty() {
                stack[depth] = node.right;
                stack[depth + 1] = index + 1;
                depth += 2;
            }
        }
    }

    /// The first triangle that the ray crosses with `t` in `range`, and its `t`;
    /// of several at the same `t`, the one with the lowest index.
    pub fn closest(&self, ray: &Ray, range: Range<f64>) -> Option<(u32, f64)> {
        let mut best: Option<(u32, f64)> = None;
        self.visit(ray, EdgeRule::Closed, range, |index, t, range| {
            if best.is_none_or(|(i, nearest)| (t, index) < (nearest, i)) {
                best = Some((index, t));
                range.end = t;
            }
        });
        best
    }

    /// How many triangles with `wanted(index)` the ray crosses with `t` in
    /// `range`; through an edge between two, one of them.
    pub fn count(&self, ray: &Ray, range: Range<f64>, wanted: impl Fn(u32) -> bool) -> u32 {
        let mut count = 0;
        self.visit(ray, EdgeRule::HalfOpen, range, |index, _, _| {
            count += u32::from(wanted(index));
        });
        count
    }
}

/// Puts the `middle` smallest centroids along the widest axis first; ties by
/// triangle index, so that the order is one.
fn partition(triangles: &[[DVec3; 3]], part: &mut [u32], middle: usize) {
    let centroid = |i: u32| triangles[i as usize].iter().sum::<DVec3>();
    let spread = part
        .iter()
        .map(|&i| centroid(i))
        .fold(Bounds::EMPTY, Bounds::with);
    let extent = (spread.high - spread.low).to_array();
    let axis = (0..3).fold(0, |best, k| if extent[k] > extent[best] { k } else { best });
    let key = |i: u32| centroid(i)[axis];
    part.select_nth_unstable_by(middle, |&a, &b| key(a).total_cmp(&key(b)).then(a.cmp(&b)));
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn point() -> impl Strategy<Value = DVec3> {
        // A coarse lattice, so that ties, edge hits and flat boxes are common.
        prop::array::uniform3(-8i32..8).prop_map(|v| DVec3::from(v.map(f64::from)) * 0.25)
    }

    fn triangles() -> impl Strategy<Value = Vec<[DVec3; 3]>> {
        prop::collection::vec(prop::array::uniform3(point()), 0..60)
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(400))]

        #[test]
        fn hierarchy_agrees_with_brute_force(
            triangles in triangles(), origin in point(), direction in point(), end in 0.1f64..9.0,
        ) {
            prop_assume!(direction != DVec3::ZERO);
            let ray = Ray::new(origin, direction);
            let hits = |edges| triangles.iter().enumerate().filter_map(move |(i, t)| {
                let t = ray.crossing(t, edges).filter(|t| (0.0..=end).contains(t))?;
                Some((i as u32, t))
            });
            let bvh = Bvh::new(&triangles);
            let nearest = hits(EdgeRule::Closed)
                .min_by(|a, b| a.1.total_cmp(&b.1).then(a.0.cmp(&b.0)));
            prop_assert_eq!(bvh.closest(&ray, 0.0..end), nearest);
            let all = hits(EdgeRule::HalfOpen).count();
            prop_assert_eq!(bvh.count(&ray, 0.0..end, |_| true) as usize, all);
            let odd = hits(EdgeRule::HalfOpen).filter(|(i, _)| i % 2 == 1).count();
            prop_assert_eq!(bvh.count(&ray, 0.0..end, |i| i % 2 == 1) as usize, odd);
        }
    }

    /// Rays at lattice points of a flat sheet, many exactly on its edges and
    /// vertices, cross one triangle.
    #[test]
    fn a_sheet_counts_once_even_at_edges_and_vertices() {
        let at = |x: i32, z: i32| DVec3::new(f64::from(x), 0.0, f64::from(z));
        let mut sheet = Vec::new();
        for (x, z) in (-3..3).flat_map(|x| (-3..3).map(move |z| (x, z))) {
            sheet.push([at(x, z), at(x + 1, z + 1), at(x + 1, z)]);
            sheet.push([at(x, z), at(x, z + 1), at(x + 1, z + 1)]);
        }
        let bvh = Bvh::new(&sheet);
        for direction in [DVec3::NEG_Y, DVec3::new(0.25, -1.0, -0.5)] {
            for (i, k) in (-8..=8).flat_map(|i| (-8..=8).map(move |k| (i, k))) {
                let target = at(i, k) * 0.25;
                let ray = Ray::new(target - direction, direction);
                assert_eq!(bvh.count(&ray, 0.0..2.0, |_| true), 1, "{target}");
            }
        }
    }

    /// Rays aimed exactly at the edges and vertices of a closed solid from
    /// inside never slip out.
    #[test]
    fn shared_edges_do_not_leak() {
        let sphere = crate::world::shape::icosphere(2, 1.0, DVec3::ZERO);
        let corners = |t: &[u32; 3]| t.map(|i| sphere.positions[i as usize]);
        let triangles: Vec<_> = sphere.triangles.iter().map(corners).collect();
        let bvh = Bvh::new(&triangles);
        let origin = DVec3::new(0.01, 0.02, -0.03);
        for [a, b, c] in triangles {
            for target in [a, b, c, (a + b) / 2.0, (b + c) * 0.37 + a * 0.26] {
                let direction = target - origin;
                assert!(
                    bvh.closest(&Ray::new(origin, direction), 0.0..9.0)
                        .is_some()
                );
            }
        }
    }

    /// Overlapping sheets in one plane, the earlier ones later in leaf order.
    #[test]
    fn of_coincident_triangles_the_lowest_index_is_hit() {
        let sheet = |reach: f64| [[-1.0, -1.0], [reach, 1.0], [-1.0, 1.0]];
        let flat = |[x, z]: [f64; 2]| DVec3::new(x, 0.0, z);
        let sheets: Vec<_> = (0..12)
            .map(|k| sheet(40.0 - 3.0 * f64::from(k)).map(flat))
            .collect();
        let ray = Ray::new(DVec3::new(-0.5, 1.0, 0.5), DVec3::NEG_Y);
        assert_eq!(Bvh::new(&sheets).closest(&ray, 0.0..9.0), Some((0, 1.0)));
    }

    #[test]
    fn empty_hierarchy_has_no_hits() {
        let ray = Ray::new(DVec3::ZERO, DVec3::X);
        assert_eq!(Bvh::new(&[]).closest(&ray, 0.0..1.0), None);
    }
}
