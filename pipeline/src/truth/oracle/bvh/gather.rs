//! Queries by region instead of ray: which triangles may reach into a convex
//! region, and whether anything crosses a segment.

use std::ops::{ControlFlow, Range};

use glam::DVec3;

use super::{Bounds, Bvh, EdgeRule, Ray};

/// A convex region of space: half-spaces `normal . (x - origin) + offset >= 0`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Region {
    origin: DVec3,
    /// Normals and offsets.
    planes: Vec<(DVec3, f64)>,
}

impl Region {
    /// All of space; half-spaces added will be relative to `origin`.
    pub fn reset(&mut self, origin: DVec3) {
        self.origin = origin;
        self.planes.clear();
    }

    /// Keeps only `normal . (x - origin) + offset >= 0`.
    pub fn keep(&mut self, normal: DVec3, offset: f64) {
        self.planes.push((normal, offset));
    }

    /// Whether the box may reach into the region: false only if it lies behind
    /// one of the planes.
    fn may_meet_box(&self, bounds: &Bounds) -> bool {
        let centre = (bounds.low + bounds.high) * 0.5 - self.origin;
        let half = (bounds.high - bounds.low) * 0.5;
        let reach = |n: DVec3, o: f64| n.dot(centre) + n.abs().dot(half) + o;
        self.planes.iter().all(|&(n, o)| reach(n, o) >= 0.0)
    }

    /// The same for a triangle, with room for rounding: planes pass through
    /// `origin`, and a corner on one may come out on either side.
    fn may_meet_triangle(&self, corners: &[DVec3; 3]) -> bool {
        let relative = corners.map(|c| c - self.origin);
        let reach = relative.iter().map(|c| c.abs().max_element());
        let slack = 1e-12 * reach.fold(0.0, f64::max);
        let above = |n: DVec3, o: f64| {
            let least = -slack * (n.x.abs() + n.y.abs() + n.z.abs());
            relative.iter().any(|c| n.dot(*c) + o >= least)
        };
        self.planes.iter().all(|&(n, o)| above(n, o))
    }
}

impl Bvh {
    /// Calls `visit` with index and corners of every triangle that may reach
    /// into `region`, and possibly of some others nearby, until it breaks. The
    /// order depends on the triangles alone.
    pub fn gather(
        &self,
        region: &Region,
        mut visit: impl FnMut(u32, &[DVec3; 3]) -> ControlFlow<()>,
    ) {
        let mut stack = [0u32; 64];
        let mut depth = usize::from(!self.nodes.is_empty());
        while depth > 0 {
            depth -= 1;
            let index = stack[depth];
            let node = &self.nodes[index as usize];
            if !region.may_meet_box(&node.bounds) {
                continue;
            }
            for slot in node.leaf.clone() {
                let corners = &self.corners[slot as usize];
                if region.may_meet_triangle(corners)
                    && visit(self.order[slot as usize], corners).is_break()
                {
                    return;
                }
            }
            if node.leaf.is_empty() {
                stack[depth] = node.right;
                stack[depth + 1] = index + 1;
                depth += 2;
            }
        }
    }

    /// Whether any triangle, edges included, is crossed with `t` in `range`.
    pub fn any(&self, ray: &Ray, range: Range<f64>) -> bool {
        let mut met = false;
        self.visit(ray, EdgeRule::Closed, range, |_, _, range| {
            met = true;
            range.end = f64::NEG_INFINITY; // nothing else is of interest
        });
        met
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn point() -> impl Strategy<Value = DVec3> {
        prop::array::uniform3(-8i32..8).prop_map(|v| DVec3::from(v.map(f64::from)) * 0.25)
    }

    fn triangles() -> impl Strategy<Value = Vec<[DVec3; 3]>> {
        prop::collection::vec(prop::array::uniform3(point()), 0..60)
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(400))]

        /// Nothing with a corner inside is missed, nothing comes twice, and
        /// what lies wholly behind one plane stays out.
        #[test]
        fn gathers_all_inside_and_none_behind(
            triangles in triangles(), origin in point(),
            planes in prop::collection::vec((point(), -1.0f64..1.0), 1..5),
        ) {
            let mut region = Region::default();
            region.reset(origin);
            planes.iter().for_each(|&(n, o)| region.keep(n, o));
            let above = |n: DVec3, o: f64, p: DVec3| n.dot(p - origin) + o;
            let mut found = Vec::new();
            Bvh::new(&triangles).gather(&region, |i, corners| {
                assert_eq!(*corners, triangles[i as usize]);
                found.push(i as usize);
                ControlFlow::Continue(())
            });
            let count = found.len();
            found.sort_unstable();
            found.dedup();
            prop_assert_eq!(found.len(), count);
            for (i, t) in triangles.iter().enumerate() {
                let inside = t.iter().any(|p| planes.iter().all(|&(n, o)| above(n, o, *p) > 0.0));
                let behind = planes.iter().any(|&(n, o)| t.iter().all(|p| above(n, o, *p) < -1e-6));
                prop_assert!(!inside || found.contains(&i), "{} missed", i);
                prop_assert!(!behind || !found.contains(&i), "{} is behind", i);
            }
        }

        #[test]
        fn any_agrees_with_closest(
            triangles in triangles(), origin in point(), direction in point(), end in 0.1f64..9.0,
        ) {
            prop_assume!(direction != DVec3::ZERO);
            let (bvh, ray) = (Bvh::new(&triangles), Ray::new(origin, direction));
            prop_assert_eq!(bvh.any(&ray, 0.0..end), bvh.closest(&ray, 0.0..end).is_some());
        }
    }

    #[test]
    fn a_break_ends_the_search() {
        let sheet = [[DVec3::ZERO, DVec3::X, DVec3::Y]; 40];
        let mut seen = 0;
        Bvh::new(&sheet).gather(&Region::default(), |_, _| {
            seen += 1;
            ControlFlow::Break(())
        });
        assert_eq!(seen, 1);
    }
}
