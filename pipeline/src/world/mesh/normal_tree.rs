//! Sums over triangles whose normals are near a given one, for vertices of so many
//! triangles that looking at all of them for each would take the square of their
//! number.
//!
//! A tree over the unit normals: each node has the box round its normals and the
//! sum of its areas. A node whose box is wholly near adds its sum, one whose box is
//! wholly far adds nothing. Rounded products and sums never turn order round, so
//! the bounds of a box hold for the rounded dot products of the normals in it.

use glam::DVec3;

/// Normals in a leaf.
const LEAF: usize = 8;

/// The triangles round a vertex.
pub(super) struct NormalTree<'a> {
    units: &'a [DVec3],
    areas: &'a [DVec3],
    triangles: Vec<u32>,
    root: Node,
}

struct Node {
    low: DVec3,
    high: DVec3,
    sum: DVec3,
    kind: Kind,
}

enum Kind {
    /// A range of the tree's triangles.
    Leaf(std::ops::Range<usize>),
    Inner(Box<[Node; 2]>),
}

impl<'a> NormalTree<'a> {
    /// Over `triangles`, with the unit normals and areas of all.
    pub(super) fn new(triangles: &[u32], units: &'a [DVec3], areas: &'a [DVec3]) -> Self {
        let mut triangles = triangles.to_vec();
        let root = Node::of(&mut triangles, 0, units, areas);
        Self {
            units,
            areas,
            triangles,
            root,
        }
    }

    /// The sum of the areas whose unit normals have a dot product of at least
    /// `least` with `unit`.
    pub(super) fn sum_near(&self, unit: DVec3, least: f64) -> DVec3 {
        self.sum_of(&self.root, unit, least)
    }

    fn sum_of(&self, node: &Node, unit: DVec3, least: f64) -> DVec3 {
        let (a, b) = (node.low * unit, node.high * unit);
        let total = |v: DVec3| v.x + v.y + v.z; // in the order of a dot product
        if total(a.max(b)) < least {
            return DVec3::ZERO;
        }
        if total(a.min(b)) >= least {
            return node.sum;
        }
        match &node.kind {
            Kind::Inner(halves) => {
                let [a, b] = [0, 1].map(|k| self.sum_of(&halves[k], unit, least));
                a + b
            }
            Kind::Leaf(range) => {
                let own = self.triangles[range.clone()].iter().map(|t| *t as usize);
                let near = own.filter(|t| self.units[*t].dot(unit) >= least);
                near.fold(DVec3::ZERO, |sum, t| sum + self.areas[t])
            }
        }
    }
}

impl Node {
    /// Over `triangles`, which begin at `first` in the tree and are sorted into it.
    fn of(triangles: &mut [u32], first: usize, units: &[DVec3], areas: &[DVec3]) -> Self {
        let of = |t: u32| units[t as usize];
        let bounds = |(low, high): (DVec3, DVec3), t: &u32| (low.min(of(*t)), high.max(of(*t)));
        let infinite = DVec3::splat(f64::INFINITY);
        let (low, high) = triangles.iter().fold((infinite, -infinite), bounds);
        if triangles.len() <= LEAF || low == high {
            let sum = triangles.iter().map(|t| areas[*t as usize]);
            return Self {
                low,
                high,
                sum: sum.fold(DVec3::ZERO, |sum, area| sum + area),
                kind: Kind::Leaf(first..first + triangles.len()),
            };
        }
        let extent = high - low;
        let axis = (1..3).fold(0, |most, k| if extent[k] > extent[most] { k } else { most });
        let middle = triangles.len() / 2;
        let order = |a: &u32, b: &u32| of(*a)[axis].total_cmp(&of(*b)[axis]).then(a.cmp(b));
        triangles.sort_unstable_by(order);
        let (left, right) = triangles.split_at_mut(middle);
        let halves = [
            Self::of(left, first, units, areas),
            Self::of(right, first + middle, units, areas),
        ];
        Self {
            low,
            high,
            sum: halves[0].sum + halves[1].sum,
            kind: Kind::Inner(Box::new(halves)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// Whole numbers as areas, so that sums do not depend on their order.
        #[test]
        fn it_sums_what_looking_at_all_sums(
            normals in prop::collection::vec(prop::array::uniform3(-4i32..5), 1..200),
            least in -1.0f64..1.0,
        ) {
            let areas: Vec<DVec3> = normals.iter().map(|n| DVec3::from(n.map(f64::from))).collect();
            let units: Vec<DVec3> = areas.iter().map(|a| *a / a.length().max(1e-30)).collect();
            let triangles: Vec<u32> = (0..areas.len() as u32).collect();
            let tree = NormalTree::new(&triangles, &units, &areas);
            for own in &units {
                let near = (0..areas.len()).filter(|t| units[*t].dot(*own) >= least);
                let expected = near.fold(DVec3::ZERO, |sum, t| sum + areas[t]);
                prop_assert_eq!(tree.sum_near(*own, least), expected);
            }
        }
    }
}
