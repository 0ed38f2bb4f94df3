//! A hierarchy of boxes over triangles, in the order in which
//! [`gnomon_shaders::shadow_rays`] and [`gnomon_shaders::line_samples`] read it.

mod split;
mod triangles;

use split::split;
pub(crate) use triangles::Triangle;
use triangles::{area, bounds, centre};

/// A box and where to go on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Node {
    pub(crate) low: [f32; 3],
    pub(crate) high: [f32; 3],
    /// Number of the only triangle; `None` in inner nodes, whose children follow.
    pub(crate) triangle: Option<u32>,
    /// The node to go on with where the box is missed.
    pub(crate) next: u32,
}

impl Node {
    /// The two texels of a node.
    pub(crate) fn texels(&self) -> [[f32; 4]; 2] {
        let ([a, b, c], [x, y, z]) = (self.low, self.high);
        let triangle = self.triangle.map_or(-1.0, |t| t as f32);
        [[a, b, c, triangle], [x, y, z, self.next as f32]]
    }
}

/// Boxes are this much larger than what is in them, of the largest coordinate: more than
/// the rounding of a ray's way to a side of one.
const PADDING: f32 = 2e-6;

/// Most splits by cost from the first node on; then parts are halved, so that recursion
/// ends.
const MOST_SPLITS: usize = 48;

/// Nodes, depth first: each is split where that costs least, or else in the middle along
/// the widest axis of its triangles' centres, ties by their numbers. The larger side is
/// gone through first: rays end at the first hit.
pub(crate) fn build(triangles: &[Triangle]) -> Vec<Node> {
    let mut order: Vec<u32> = (0..triangles.len() as u32).collect();
    let mut builder = Builder {
        triangles,
        padding: largest(triangles) * PADDING,
        nodes: Vec::with_capacity(2 * triangles.len()),
    };
    if !order.is_empty() {
        builder.split(&mut order, 0);
    }
    builder.nodes
}

/// The largest coordinate.
pub(crate) fn largest(triangles: &[Triangle]) -> f32 {
    let all = triangles.iter().flatten().flatten();
    all.fold(0.0, |most, c| most.max(c.abs()))
}

struct Builder<'a> {
    triangles: &'a [Triangle],
    padding: f32,
    nodes: Vec<Node>,
}

impl Builder<'_> {
    fn split(&mut self, part: &mut [u32], depth: usize) {
        let number = self.nodes.len();
        let [low, high] = bounds(self.triangles, part);
        self.nodes.push(Node {
            low: low.map(|c| c - self.padding),
            high: high.map(|c| c + self.padding),
            triangle: (part.len() == 1).then(|| part[0]),
            next: 0,
        });
        if part.len() > 1 {
            let at = match depth < MOST_SPLITS {
                true => split(self.triangles, part),
                false => None,
            };
            let at = at.unwrap_or_else(|| self.halve(part));
            let (left, right) = part.split_at_mut(at);
            let [a, b] = [&*left, right].map(|side| area(bounds(self.triangles, side)));
            let (first, second) = if b > a { (right, left) } else { (left, right) };
            self.split(first, depth + 1);
            self.split(second, depth + 1);
        }
        self.nodes[number].next = self.nodes.len() as u32;
    }

    /// Sorts a part's halves along its widest axis; gives the middle.
    fn halve(&self, part: &mut [u32]) -> usize {
        let axis = self.widest(part);
        let middle = part.len() / 2;
        part.select_nth_unstable_by(middle, |a, b| {
            let [x, y] = [a, b].map(|i| self.centre(*i, axis));
            x.total_cmp(&y).then(a.cmp(b))
        });
        middle
    }

    fn centre(&self, triangle: u32, axis: usize) -> f32 {
        centre(&self.triangles[triangle as usize], axis)
    }

    fn widest(&self, part: &[u32]) -> usize {
        let width = |axis: usize| {
            let centres = part.iter().map(|i| self.centre(*i, axis));
            let empty = (f32::INFINITY, f32::NEG_INFINITY);
            let (low, high) = centres.fold(empty, |(a, b), c| (a.min(c), b.max(c)));
            high - low
        };
        (1..3).fold(0, |best, k| if width(k) > width(best) { k } else { best })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn triangles(count: u32) -> Vec<Triangle> {
        let at = |k: u32| {
            let [x, y, z] = [k * 7 % 13, k * 5 % 11, k * 3 % 17].map(|c| c as f32);
            [[x, y, z], [x + 1.0, y, z], [x, y + 1.0, z + 0.5]]
        };
        (0..count).map(at).collect()
    }

    fn is_inside(inner: &Node, outer: &Node) -> bool {
        (0..3).all(|k| inner.low[k] >= outer.low[k] && inner.high[k] <= outer.high[k])
    }

    /// Every triangle is a leaf once, children are in their parents' boxes, and the next
    /// node is behind all of them.
    #[test]
    fn nodes_are_nested_and_depth_first() {
        for count in [0, 1, 2, 3, 64, 101] {
            let triangles = triangles(count);
            let nodes = build(&triangles);
            assert_eq!(nodes.len(), (2 * triangles.len()).saturating_sub(1));
            let mut leaves: Vec<u32> = nodes.iter().filter_map(|n| n.triangle).collect();
            leaves.sort_unstable();
            assert_eq!(leaves, (0..count).collect::<Vec<_>>());
            for (number, node) in nodes.iter().enumerate() {
                let inside = number + 1..node.next as usize;
                assert_eq!(inside.is_empty(), node.triangle.is_some());
                assert!(nodes[inside].iter().all(|child| is_inside(child, node)));
                let Some(triangle) = node.triangle else {
                    continue;
                };
                for p in triangles[triangle as usize] {
                    assert!((0..3).all(|k| node.low[k] < p[k] && node.high[k] > p[k]));
                }
            }
        }
    }

    /// Triangles with one centre are told apart by their numbers.
    #[test]
    fn equal_centres_are_split_too() {
        let triangles = vec![[[0.0; 3]; 3]; 9];
        let nodes = build(&triangles);
        assert_eq!(nodes.len(), 17);
        assert_eq!(nodes[0].next, 17);
    }
}
