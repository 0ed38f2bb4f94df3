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
//!
//! Each caster's edges are gone through by themselves. What is left of them for a square of
//! the first level depends on that caster, the light and the square's receivers alone, and
//! is kept from frame to frame ([`super::kept_lists`]).

use std::cell::OnceCell;
use std::ops::Range;
use std::sync::Arc;

use glam::DVec3;
use rayon::prelude::*;

use super::blocks::BlockBounds;
use super::edges::{ContourEdge, NONE};
use super::kept_lists::{KeptLists, Keys};
use super::light::LineLight;
use super::patches::Plane;
use super::shaft::{Bounds, Shaft};

/// Blocks along a side of the squares of each level.
pub(super) const LEVELS: [u32; 3] = [8, 2, 1];
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
    /// No less than the largest coordinate of all that is tested: a power of two, which
    /// stays when something moves a little.
    largest: f64,
    groups: Vec<Group>,
}

/// The edges of one caster.
struct Group {
    /// Their numbers.
    edges: Range<u32>,
    /// The same in clusters, and the boxes of these.
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
    /// Of candidate `edges`, whose facets have `planes`. `ends` is how many there are up to
    /// the end of each caster.
    pub fn new(
        (edges, ends): (&'a [ContourEdge], &[u32]),
        planes: &'a [Plane],
        light: &'a LineLight,
    ) -> Self {
        let bounds = Bounds::of(edges.iter().flat_map(|e| e.ends));
        let lit = Bounds::of(light.corners(1.0));
        let largest = if edges.is_empty() {
            0.0
        } else {
            power_above(bounds.joined(&lit).largest())
        };
        Self {
            edges,
            planes,
            light,
            largest,
            groups: groups(edges, ends),
        }
    }

    /// What counts as the largest coordinate.
    pub(super) fn largest(&self) -> f64 {
        self.largest
    }

    /// The light.
    pub(super) fn light(&self) -> &LineLight {
        self.light
    }

    /// Of each caster its edges, with the planes of their facets.
    pub(super) fn casters(&self) -> impl IndexedParallelIterator<Item = &[ContourEdge]> {
        let of = |g: &Group| &self.edges[g.edges.start as usize..g.edges.end as usize];
        self.groups.par_iter().map(of)
    }

    /// A plane.
    pub(super) fn plane(&self, number: u32) -> Option<&Plane> {
        self.planes.get(number as usize)
    }

    /// The lists of all blocks.
    pub fn lists(&self, blocks: &BlockBounds) -> BlockLists {
        let (parts, tests) = self.parts(blocks, |_, _| None);
        self.assemble(blocks.size, tests, &parts)
    }

    /// The same after another frame of an animation: what is as it was there is not made
    /// again, nor counted as tests. The second is what the next frame may need.
    pub fn lists_after(&self, blocks: &BlockBounds, before: &KeptLists) -> (BlockLists, KeptLists) {
        let keys = Keys::new(self);
        let known = before.of(&keys);
        let squares = squares_of(blocks).into_par_iter();
        let squares: Vec<_> = squares.map(|at| Keys::of_square(blocks, at)).collect();
        let found = |square: usize, group: usize| known[group]?.get(&squares[square]).cloned();
        let (parts, tests) = self.parts(blocks, found);
        let own = squares.iter().zip(&parts);
        let kept = KeptLists::new(&keys, own.map(|(key, (_, parts))| (*key, &parts[..])));
        (self.assemble(blocks.size, tests, &parts), kept)
    }

    /// What casters have in squares of the first level, `found` by the numbers of both or
    /// else made, and the tests that this took.
    fn parts(
        &self,
        blocks: &BlockBounds,
        found: impl Fn(usize, usize) -> Option<Arc<Part>> + Sync,
    ) -> (Vec<Parts>, u64) {
        let of_square = |(number, at): (usize, [u32; 2])| {
            let squares = Squares::new(self, blocks, at);
            let mut tests = 0;
            let of = |(group, own): (usize, &Group)| {
                found(number, group).unwrap_or_else(|| {
                    let part = self.part(&squares, own);
                    tests += part.tests;
                    Arc::new(part)
                })
            };
            let parts = self.groups.iter().enumerate().map(of).collect();
            ((at, parts), tests)
        };
        let squares = squares_of(blocks).into_par_iter().enumerate();
        let (parts, tests): (Vec<Parts>, Vec<u64>) = squares.map(of_square).unzip();
        (parts, tests.iter().sum())
    }

    /// What is left of a caster's edges in a square of the first level.
    fn part(&self, squares: &Squares<'_>, group: &Group) -> Part {
        let mut part = Part::default();
        self.descend(squares, [0, 0], 0, None, group, &mut part);
        for list in part.lists.iter_mut().flat_map(|(_, list)| list) {
            *list -= group.edges.start;
        }
        part
    }

    /// The list of a square of a level from that around it, and those in it.
    fn descend(
        &self,
        squares: &Squares<'_>,
        at: [u32; 2],
        level: usize,
        around: Option<&[u32]>,
        group: &Group,
        part: &mut Part,
    ) {
        let Some(square) = squares.get(level, at) else {
            return;
        };
        let own = match around {
            None => self.of_clusters(square, &group.clusters, &mut part.tests),
            Some(list) => {
                part.tests += list.len() as u64;
                let kept = list.iter().filter(|e| !self.is_out(**e, square));
                kept.copied().collect()
            }
        };
        if own.is_empty() {
            return;
        }
        let side = LEVELS[level];
        if side == 1 {
            part.lists.push((at, own));
            return;
        }
        let inner = LEVELS[level + 1] as usize;
        for y in (at[1]..at[1] + side).step_by(inner) {
            for x in (at[0]..at[0] + side).step_by(inner) {
                self.descend(squares, [x, y], level + 1, Some(&own), group, part);
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

    fn of_clusters(
        &self,
        square: &Square,
        clusters: &[(Bounds, Vec<u32>)],
        tests: &mut u64,
    ) -> Vec<u32> {
        let mut kept = Vec::new();
        for (bounds, own) in clusters {
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

/// What one caster has in a square of the first level.
#[derive(Debug, Default, PartialEq)]
pub(super) struct Part {
    /// Column and row of blocks in the square, and their edges, from the caster's first on.
    pub(super) lists: Vec<([u32; 2], Vec<u32>)>,
    tests: u64,
}

/// A square of the first level, and what each caster has there.
type Parts = ([u32; 2], Vec<Arc<Part>>);

/// First column and row of blocks of the squares of the first level.
fn squares_of(blocks: &BlockBounds) -> Vec<[u32; 2]> {
    let [across, down] = blocks.size.map(|n| n.div_ceil(LEVELS[0]));
    let row = |y| (0..across).map(move |x| [x * LEVELS[0], y * LEVELS[0]]);
    (0..down).flat_map(row).collect()
}

/// A square of the first level and those in it, each made when it is first asked for.
struct Squares<'a> {
    culling: &'a Culling<'a>,
    blocks: &'a BlockBounds,
    at: [u32; 2],
    made: [Vec<OnceCell<Option<Square>>>; LEVELS.len()],
}

impl<'a> Squares<'a> {
    fn new(culling: &'a Culling<'a>, blocks: &'a BlockBounds, at: [u32; 2]) -> Self {
        let made = LEVELS.map(|side| {
            let count = LEVELS[0] / side;
            (0..count * count).map(|_| OnceCell::new()).collect()
        });
        Self {
            culling,
            blocks,
            at,
            made,
        }
    }

    /// The square at a column and row of blocks in that of the first level, if there are
    /// receivers.
    fn get(&self, level: usize, at: [u32; 2]) -> Option<&Square> {
        let side = LEVELS[level];
        let number = at[1] / side * (LEVELS[0] / side) + at[0] / side;
        let make = || {
            let place = [0, 1].map(|a| self.at[a] + at[a]);
            let bounds = self.blocks.square(place, side);
            (!bounds.is_empty()).then(|| self.culling.square(bounds))
        };
        self.made[level][number as usize].get_or_init(make).as_ref()
    }
}

impl Culling<'_> {
    fn assemble(&self, size: [u32; 2], tests: u64, parts: &[Parts]) -> BlockLists {
        let count = (size[0] * size[1]) as usize;
        let mut lists: Vec<Vec<u32>> = vec![Vec::new(); count];
        for (at, parts) in parts {
            for (group, part) in self.groups.iter().zip(parts) {
                for ([x, y], list) in &part.lists {
                    let block = (at[1] + y) * size[0] + at[0] + x;
                    let numbers = list.iter().map(|e| e + group.edges.start);
                    lists[block as usize].extend(numbers);
                }
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
}

/// The next power of two above a number that is not negative.
fn power_above(number: f64) -> f64 {
    const MANTISSA: u64 = (1 << (f64::MANTISSA_DIGITS - 1)) - 1;
    let largest = f64::MAX.to_bits() & !MANTISSA;
    f64::from_bits(((number.to_bits() & !MANTISSA) + MANTISSA + 1).min(largest))
}

/// The edges of each caster that has any.
fn groups(edges: &[ContourEdge], ends: &[u32]) -> Vec<Group> {
    let first = [0].into_iter().chain(ends.iter().copied());
    let ranges = first.zip(ends).map(|(first, end)| first..*end);
    let group = |edges_of: Range<u32>| {
        let own = &edges[edges_of.start as usize..edges_of.end as usize];
        Group {
            clusters: clusters(own, edges_of.start),
            edges: edges_of,
        }
    };
    let some = ranges.filter(|r| !r.is_empty());
    let some: Vec<Range<u32>> = some.collect();
    some.into_par_iter().map(group).collect()
}

/// Edges by where their middles are along a curve through space, so many at a time.
/// Numbers begin with `first`.
fn clusters(edges: &[ContourEdge], first: u32) -> Vec<(Bounds, Vec<u32>)> {
    let bounds = Bounds::of(edges.iter().flat_map(|e| e.ends));
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
        (Bounds::of(ends), own.iter().map(|k| first + k).collect())
    };
    numbers.chunks(CLUSTER).map(cluster).collect()
}
