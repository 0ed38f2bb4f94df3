//! Which edges may be contours before the light for some receiver of a block of pixels.
//!
//! From squares of 64 by 64 pixels over 16 by 16 to blocks of 8 by 8, a list is what is
//! left of the list around it, the first of clusters of edges that lie near one another. An
//! edge is left out where
//!
//! * it is outside of the shaft between the square's receivers and the light, or
//! * both of its facets face all receivers, or none, or
//! * all receivers and all of the light are on one side of it: of each plane through it
//!   and a corner of the light (paper II's test of tiles against wedges, done once a block
//!   instead of once a pixel; docs/papers.md, paper II).
//!
//! All tests keep more than rounding apart, so what is left out changes no bit.

use glam::DVec3;
use rayon::prelude::*;

use super::blocks::BlockBounds;
use super::edges::{ContourEdge, NONE};
use super::light::LineLight;
use super::patches::Plane;
use super::shaft::{Bounds, Shaft};

/// Blocks along a side of the squares of each level.
const LEVELS: [u32; 3] = [8, 2, 1];
/// Edges of a cluster.
const CLUSTER: usize = 32;
/// What counts as rounding, as a share of the largest coordinate.
const SLACK: f64 = 1e-5;

/// Numbers of edges for each block.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct BlockLists {
    /// Blocks in a row, and rows.
    pub size: [u32; 2],
    /// Where each block's list begins in `entries`, and the end of the last.
    pub starts: Vec<u32>,
    /// Ascending for each block.
    pub entries: Vec<u32>,
    /// Tests of clusters and edges against squares.
    pub tests: u64,
}

impl BlockLists {
    /// The list of a block.
    pub fn of(&self, block: usize) -> &[u32] {
        &self.entries[self.starts[block] as usize..self.starts[block + 1] as usize]
    }

    /// Entries of all lists.
    pub fn len(&self) -> usize {
        self.entries.len()
    }

    /// Whether no block has an edge.
    pub fn is_empty(&self) -> bool {
        self.entries.is_empty()
    }
}

/// Edges, with what tests ask of them.
pub struct Culling<'a> {
    edges: &'a [ContourEdge],
    planes: &'a [Plane],
    light: &'a LineLight,
    /// The largest coordinate of all that is tested.
    largest: f64,
    /// Edges in clusters, and the boxes of these.
    clusters: Vec<(Bounds, Vec<u32>)>,
}

/// A square of blocks, ready for tests.
struct Square {
    bounds: Bounds,
    /// `None` where the light has no bounds from there.
    shaft: Option<Shaft>,
    corners: Vec<DVec3>,
    slack: f64,
}

impl<'a> Culling<'a> {
    /// Of candidate `edges`, whose facets have `planes`.
    pub fn new(edges: &'a [ContourEdge], planes: &'a [Plane], light: &'a LineLight) -> Self {
        let bounds = Bounds::of(edges.iter().flat_map(|e| e.ends));
        let lit = Bounds::of(light.corners(1.0));
        let largest = if edges.is_empty() {
            0.0
        } else {
            bounds.joined(&lit).largest()
        };
        Self {
            edges,
            planes,
            light,
            largest,
            clusters: clusters(edges, &bounds),
        }
    }

    /// The lists of all blocks.
    pub fn lists(&self, blocks: &BlockBounds) -> BlockLists {
        let [across, down] = blocks.size.map(|n| n.div_ceil(LEVELS[0]));
        let squares: Vec<[u32; 2]> = (0..down)
            .flat_map(|y| (0..across).map(move |x| [x * LEVELS[0], y * LEVELS[0]]))
            .collect();
        let parts: Vec<Part> = squares
            .par_iter()
            .map(|at| {
                let mut part = Part::default();
                self.descend(blocks, *at, None, &mut part);
                part
            })
            .collect();
        assemble(blocks.size, parts)
    }

    /// The list of a square from that around it, and those in it.
    fn descend(
        &self,
        blocks: &BlockBounds,
        at: [u32; 2],
        around: Option<(usize, &[u32])>,
        part: &mut Part,
    ) {
        let (level, list) = around.map_or((0, None), |(level, list)| (level, Some(list)));
        let side = LEVELS[level];
        let bounds = blocks.square(at, side);
        if bounds.is_empty() {
            return;
        }
        let square = self.square(bounds);
        let own = match list {
            None => self.of_clusters(&square, &mut part.tests),
            Some(list) => {
                part.tests += list.len() as u64;
                let kept = list.iter().filter(|e| !self.is_out(**e, &square));
                kept.copied().collect()
            }
        };
        if own.is_empty() {
            return;
        }
        if side == 1 {
            part.lists.push((at[1] * blocks.size[0] + at[0], own));
            return;
        }
        let inner = LEVELS[level + 1];
        for y in (at[1]..(at[1] + side).min(blocks.size[1])).step_by(inner as usize) {
            for x in (at[0]..(at[0] + side).min(blocks.size[0])).step_by(inner as usize) {
                self.descend(blocks, [x, y], Some((level + 1, &own)), part);
            }
        }
    }

    fn square(&self, bounds: Bounds) -> Square {
        let slack = SLACK * self.largest.max(bounds.largest());
        let bounds = bounds.grown(slack);
        let growth = self.light.growth(bounds.distance(self.light.frame.centre));
        let corners = self.light.corners(growth.min(1e6));
        let lit = Bounds::of(corners.iter().copied());
        let slack_of_light = 1e-4 * (lit.high - lit.low).max_element() + slack;
        let shaft = growth
            .is_finite()
            .then(|| Shaft::new(&bounds, &lit.grown(slack_of_light)));
        Square {
            shaft,
            bounds,
            corners,
            slack,
        }
    }

    fn of_clusters(&self, square: &Square, tests: &mut u64) -> Vec<u32> {
        let mut kept = Vec::new();
        for (bounds, own) in &self.clusters {
            *tests += 1;
            if square.shaft.as_ref().is_some_and(|s| s.misses_box(bounds)) {
                continue;
            }
            *tests += own.len() as u64;
            kept.extend(own.iter().filter(|e| !self.is_out(**e, square)));
        }
        kept.sort_unstable();
        kept
    }

    /// Whether an edge is no contour before the light for any receiver of the square.
    fn is_out(&self, edge: u32, square: &Square) -> bool {
        let edge = &self.edges[edge as usize];
        self.is_uniform(edge, square)
            || square
                .shaft
                .as_ref()
                .is_some_and(|s| s.misses(edge.ends) || is_beside(edge, square))
    }

    /// Whether both facets face all of the square, or none.
    fn is_uniform(&self, edge: &ContourEdge, square: &Square) -> bool {
        let [a, b] = edge.patches;
        if b == NONE {
            return false;
        }
        let side = |patch: u32| square.side(&self.planes[patch as usize]);
        let first = side(a);
        first != 0 && first == side(b)
    }
}

impl Square {
    /// 1 where all receivers are before a plane, -1 where all are behind, else 0.
    fn side(&self, plane: &Plane) -> i8 {
        let [middle, half] = self.bounds.middle();
        let (height, reach) = (plane.height(middle), plane.normal.abs().dot(half));
        match () {
            () if height - reach > self.slack => 1,
            () if height + reach < -self.slack => -1,
            () => 0,
        }
    }
}

/// Whether all receivers and all of the light are on one side of an edge.
fn is_beside(edge: &ContourEdge, square: &Square) -> bool {
    let [from, to] = edge.ends;
    let along = to - from;
    let mut sides = 0;
    for corner in &square.corners {
        let normal = along.cross(*corner - from);
        let length = normal.length();
        if length == 0.0 {
            return false;
        }
        let plane = Plane {
            normal: normal / length,
            offset: -normal.dot(from) / length,
        };
        let side = square.side(&plane);
        if side == 0 || side * sides < 0 {
            return false;
        }
        sides = side;
    }
    true
}

/// What one square of the first level has.
#[derive(Default)]
struct Part {
    lists: Vec<(u32, Vec<u32>)>,
    tests: u64,
}

fn assemble(size: [u32; 2], parts: Vec<Part>) -> BlockLists {
    let count = (size[0] * size[1]) as usize;
    let mut lists: Vec<Vec<u32>> = vec![Vec::new(); count];
    let mut tests = 0;
    for part in parts {
        tests += part.tests;
        for (block, list) in part.lists {
            lists[block as usize] = list;
        }
    }
    let mut starts = Vec::with_capacity(count + 1);
    let mut entries = Vec::new();
    starts.push(0);
    for list in lists {
        entries.extend(list);
        starts.push(entries.len() as u32);
    }
    BlockLists {
        size,
        starts,
        entries,
        tests,
    }
}

/// Edges by where their middles are along a curve through space, so many at a time.
fn clusters(edges: &[ContourEdge], bounds: &Bounds) -> Vec<(Bounds, Vec<u32>)> {
    let size = (bounds.high - bounds.low).max(DVec3::splat(f64::MIN_POSITIVE));
    let key = |e: &ContourEdge| {
        let place = (0.5 * (e.ends[0] + e.ends[1]) - bounds.low) / size * 1023.0;
        let spread =
            |v: f64| (0..10).fold(0u32, |all, bit| all | (v as u32 >> bit & 1) << (3 * bit));
        spread(place.x) | spread(place.y) << 1 | spread(place.z) << 2
    };
    let mut order: Vec<(u32, u32)> = edges
        .iter()
        .enumerate()
        .map(|(k, e)| (key(e), k as u32))
        .collect();
    order.sort_unstable();
    let numbers: Vec<u32> = order.into_iter().map(|(_, k)| k).collect();
    let cluster = |own: &[u32]| {
        let ends = own.iter().flat_map(|k| edges[*k as usize].ends);
        (Bounds::of(ends), own.to_vec())
    };
    numbers.chunks(CLUSTER).map(cluster).collect()
}
