//! Making the boundary of a cut the outline of the polygon.
//!
//! What a cut's edges have beyond the outline are closed ways along straight
//! lines: earcut takes the way from `a` to `c` where the outline, or another
//! triangle, goes by `b`. The triangle along the longest edge of such a way is
//! split at the others, or, where there is none, triangles without area fill it.

use std::collections::{BTreeMap, BTreeSet};

use glam::DVec2;

/// A corner and its place in the plane.
pub(super) type Corner = (u32, DVec2);

/// Three corners.
pub(super) type Triangle = [Corner; 3];

/// Changes `triangles` until their boundary is `outline`.
pub(super) fn mend(triangles: &mut Vec<Triangle>, outline: &[Corner]) {
    let mut excess = Excess::default();
    for [from, to] in triangles.iter().flat_map(edges) {
        excess.walk(from, to);
    }
    for (k, corner) in outline.iter().enumerate() {
        excess.walk(outline[(k + 1) % outline.len()].0, corner.0);
    }
    if excess.0.is_empty() {
        return;
    }
    let places: BTreeMap<u32, DVec2> = outline.iter().copied().collect();
    let mut triangles = ByEdge::new(triangles);
    while let Some(way) = excess.take_way() {
        let way: Vec<Corner> = way.into_iter().map(|i| (i, places[&i])).collect();
        triangles.close(way);
    }
}

/// Edges walked more often one way than the other, by their start.
#[derive(Default)]
struct Excess(BTreeMap<u32, BTreeMap<u32, u32>>);

impl Excess {
    fn walk(&mut self, from: u32, to: u32) {
        if from != to && !self.take(to, from) {
            *self.0.entry(from).or_default().entry(to).or_default() += 1;
        }
    }

    /// Takes one walk away, if there is one.
    fn take(&mut self, from: u32, to: u32) -> bool {
        let Some(ends) = self.0.get_mut(&from) else {
            return false;
        };
        let Some(count) = ends.get_mut(&to) else {
            return false;
        };
        *count -= 1;
        if *count == 0 {
            ends.remove(&to);
        }
        if ends.is_empty() {
            self.0.remove(&from);
        }
        true
    }

    /// Takes a closed way without a corner twice. As many edges arrive at a corner
    /// as leave it, so every walk returns.
    fn take_way(&mut self) -> Option<Vec<u32>> {
        let mut at = *self.0.keys().next()?;
        let mut way = vec![at];
        let mut met = BTreeSet::from([at]);
        loop {
            at = *self.0.get(&at)?.keys().next()?;
            if !met.insert(at) {
                break;
            }
            way.push(at);
        }
        let start = way.iter().position(|w| *w == at)?;
        way.drain(..start);
        for k in 0..way.len() {
            self.take(way[k], way[(k + 1) % way.len()]);
        }
        Some(way)
    }
}

/// Triangles by the edges that they walk.
struct ByEdge<'a> {
    triangles: &'a mut Vec<Triangle>,
    places: BTreeMap<[u32; 2], BTreeSet<usize>>,
}

impl<'a> ByEdge<'a> {
    fn new(triangles: &'a mut Vec<Triangle>) -> Self {
        let mut all = Self {
            triangles,
            places: BTreeMap::new(),
        };
        (0..all.triangles.len()).for_each(|at| all.note(at));
        all
    }

    fn note(&mut self, at: usize) {
        for edge in edges(&self.triangles[at]) {
            self.places.entry(edge).or_default().insert(at);
        }
    }

    fn forget(&mut self, at: usize) {
        for edge in edges(&self.triangles[at]) {
            if let Some(places) = self.places.get_mut(&edge) {
                places.remove(&at);
            }
        }
    }

    fn push(&mut self, triangle: Triangle) {
        self.triangles.push(triangle);
        self.note(self.triangles.len() - 1);
    }

    /// The first triangle that walks an edge, and which of its edges that is.
    fn along(&self, edge: [u32; 2]) -> Option<(usize, usize)> {
        let at = *self.places.get(&edge)?.first()?;
        let k = edges(&self.triangles[at]).iter().position(|e| *e == edge)?;
        Some((at, k))
    }

    /// Takes the closed way out of the boundary.
    fn close(&mut self, mut way: Vec<Corner>) {
        let after = (longest_edge(&way) + 1) % way.len();
        way.rotate_left(after);
        // Now the way begins at the end of its longest edge and ends at the start.
        let (end, start) = (way[0].0, way[way.len() - 1].0);
        let Some((at, k)) = self.along([start, end]) else {
            let inner = way[1..].windows(2);
            inner.for_each(|w| self.push([way[0], w[1], w[0]]));
            return;
        };
        let apex = self.triangles[at][(k + 2) % 3];
        let parts = way.windows(2).map(|w| [w[1], w[0], apex]);
        // A corner twice makes no triangle, and has no boundary.
        let mut parts = parts.filter(|t| t[0].0 != apex.0 && t[1].0 != apex.0);
        self.forget(at);
        match parts.next() {
            Some(first) => {
                self.triangles[at] = first;
                self.note(at);
            }
            None => self.remove(at),
        }
        parts.for_each(|part| self.push(part));
    }

    /// The last one takes its place.
    fn remove(&mut self, at: usize) {
        let last = self.triangles.len() - 1;
        if at < last {
            self.forget(last);
        }
        self.triangles.swap_remove(at);
        if at < last {
            self.note(at);
        }
    }
}

fn edges(t: &Triangle) -> [[u32; 2]; 3] {
    [0, 1, 2].map(|k| [t[k].0, t[(k + 1) % 3].0])
}

fn longest_edge(way: &[Corner]) -> usize {
    let length = |k: usize| way[k].1.distance_squared(way[(k + 1) % way.len()].1);
    (1..way.len()).fold(0, |most, k| if length(k) > length(most) { k } else { most })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn corner(i: u32, x: f64, y: f64) -> Corner {
        (i, DVec2::new(x, y))
    }

    #[test]
    fn a_corner_on_a_side_splits_the_triangle_along_it() {
        let [a, b, c, d] = [
            corner(0, 0.0, 0.0),
            corner(1, 1.0, 0.0),
            corner(2, 2.0, 0.0),
            corner(3, 0.0, 2.0),
        ];
        let mut triangles = vec![[a, c, d]];
        mend(&mut triangles, &[a, b, c, d]);
        let ids = |t: &Triangle| t.map(|c| c.0);
        let mut split: Vec<_> = triangles.iter().map(ids).collect();
        split.sort_unstable();
        assert_eq!(split, [[0, 1, 3], [1, 2, 3]]);
    }

    #[test]
    fn a_way_without_a_triangle_along_it_is_filled() {
        let line = [
            corner(0, 0.0, 0.0),
            corner(1, 2.0, 0.0),
            corner(2, 1.0, 0.0),
        ];
        let mut triangles = Vec::new();
        mend(&mut triangles, &line);
        assert_eq!(triangles, [line]);
    }
}
