//! Sorting triangles into execution tiles.

use super::setup::Triangle;
use crate::simd::each3;

/// The execution tiles of a render target.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TileGrid {
    /// log₂ of a tile's side in pixels.
    pub(crate) shift: u32,
    pub(crate) across: u32,
    pub(crate) down: u32,
}

impl TileGrid {
    pub(crate) fn new(side: u32, width: u32, height: u32) -> Self {
        Self {
            shift: side.trailing_zeros(),
            across: width.div_ceil(side),
            down: height.div_ceil(side),
        }
    }

    pub(crate) fn tiles(&self) -> usize {
        (self.across * self.down) as usize
    }
}

/// Triangle numbers by tile, each tile's in submission order.
#[derive(Debug, Default)]
pub(crate) struct Bins {
    /// `starts[t]..starts[t + 1]` of `triangles` belong to tile t.
    starts: Vec<u32>,
    triangles: Vec<u32>,
    /// Memory of the sort.
    pairs: Vec<(u32, u32)>,
    next: Vec<u32>,
}

impl Bins {
    /// Triangles that may touch tile `t` (row-major number).
    #[inline(always)]
    pub(crate) fn tile(&self, t: usize) -> &[u32] {
        if self.triangles.is_empty() {
            return &[];
        }
        &self.triangles[self.starts[t] as usize..self.starts[t + 1] as usize]
    }

    /// Forgets everything.
    pub(super) fn clear(&mut self) {
        self.pairs.clear();
        self.triangles.clear();
    }

    /// Adds triangle `number` to all tiles from column and row `span[0..2]` to
    /// `span[2..4]`.
    #[inline(always)]
    pub(super) fn add_all(&mut self, number: u32, span: [u32; 4], grid: &TileGrid) {
        let [x0, y0, x1, y1] = span;
        if x0 == x1 && y0 == y1 {
            self.pairs.push((y0 * grid.across + x0, number));
            return;
        }
        for y in y0..=y1 {
            for x in x0..=x1 {
                self.pairs.push((y * grid.across + x, number));
            }
        }
    }

    /// The same without the tiles that lie outside one of the triangle's edges.
    #[inline(always)]
    pub(super) fn add_covered(
        &mut self,
        number: u32,
        t: &Triangle,
        span: [u32; 4],
        grid: &TileGrid,
    ) {
        let [x0, y0, x1, y1] = span;
        if x0 == x1 && y0 == y1 {
            self.pairs.push((y0 * grid.across + x0, number));
            return;
        }
        let corners = TileCorners::new(t, grid);
        for y in y0..=y1 {
            for x in x0..=x1 {
                if corners.may_cover(x, y) {
                    self.pairs.push((y * grid.across + x, number));
                }
            }
        }
    }

    /// Stable counting sort of the pairs by tile.
    pub(super) fn sort(&mut self, tiles: usize) {
        self.starts.clear();
        self.starts.resize(tiles + 1, 0);
        for &(tile, _) in &self.pairs {
            self.starts[tile as usize + 1] += 1;
        }
        for t in 0..tiles {
            self.starts[t + 1] += self.starts[t];
        }
        self.next.clone_from(&self.starts);
        self.triangles.resize(self.pairs.len(), 0);
        for &(tile, i) in &self.pairs {
            let n = &mut self.next[tile as usize];
            self.triangles[*n as usize] = i;
            *n += 1;
        }
    }
}

/// A triangle's edges at the corners of tiles where they are largest.
struct TileCorners {
    /// At tile (0, 0).
    c: [f64; 3],
    /// From tile to tile, right and down.
    right: [f64; 3],
    down: [f64; 3],
}

impl TileCorners {
    #[inline(always)]
    fn new(t: &Triangle, grid: &TileGrid) -> Self {
        let side = f64::from(1u32 << grid.shift);
        let (dx, dy) = (t.dx.map(f64::from), t.dy.map(f64::from));
        Self {
            c: each3(
                #[inline(always)]
                |k| {
                    let up = if dx[k] > 0.0 {
                        dx[k] * (side - 1.0)
                    } else {
                        0.0
                    };
                    let along = if dy[k] < 0.0 {
                        -dy[k] * (side - 1.0)
                    } else {
                        0.0
                    };
                    t.c[k] + up + along
                },
            ),
            right: each3(
                #[inline(always)]
                |k| -dy[k] * side,
            ),
            down: each3(
                #[inline(always)]
                |k| dx[k] * side,
            ),
        }
    }

    #[inline(always)]
    fn may_cover(&self, x: u32, y: u32) -> bool {
        let (x, y) = (f64::from(x), f64::from(y));
        let negative = |k: usize| self.c[k] + self.down[k] * y + self.right[k] * x < 0.0;
        !(negative(0) | negative(1) | negative(2))
    }
}
