//! Sorting triangles into execution tiles.

use super::setup::Triangle;

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

    /// Sorts `triangles` anew.
    pub(super) fn rebuild(&mut self, triangles: &[Triangle], rect: [i32; 4], grid: &TileGrid) {
        self.pairs.clear();
        for (i, t) in triangles.iter().enumerate() {
            for_each_tile(t, rect, grid, |tile| self.pairs.push((tile, i as u32)));
        }
        self.sort(grid.tiles());
    }

    /// Stable counting sort of the pairs by tile.
    fn sort(&mut self, tiles: usize) {
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

/// Calls `f` for the tiles that the triangle may cover: those its bounds meet,
/// without those that lie outside one of its edges.
#[inline(always)]
fn for_each_tile(t: &Triangle, rect: [i32; 4], grid: &TileGrid, mut f: impl FnMut(u32)) {
    let x0 = i32::from(t.bounds[0]).max(rect[0]);
    let y0 = i32::from(t.bounds[1]).max(rect[1]);
    let x1 = i32::from(t.bounds[2]).min(rect[2] - 1);
    let y1 = i32::from(t.bounds[3]).min(rect[3] - 1);
    if x0 > x1 || y0 > y1 {
        return;
    }
    let (tx0, ty0) = (x0 as u32 >> grid.shift, y0 as u32 >> grid.shift);
    let (tx1, ty1) = (x1 as u32 >> grid.shift, y1 as u32 >> grid.shift);
    if tx0 == tx1 && ty0 == ty1 {
        return f(ty0 * grid.across + tx0);
    }
    let side = f64::from(1u32 << grid.shift);
    let step: [(f64, f64); 3] = core::array::from_fn(|k| (f64::from(t.dx[k]), f64::from(t.dy[k])));
    // Value of each edge at the corner of a tile where it is largest.
    let corner: [f64; 3] = core::array::from_fn(|k| {
        let (dx, dy) = step[k];
        let up = if dx > 0.0 { dx * (side - 1.0) } else { 0.0 };
        let along = if dy < 0.0 { -dy * (side - 1.0) } else { 0.0 };
        t.c[k] + up + along
    });
    for ty in ty0..=ty1 {
        let row: [f64; 3] =
            core::array::from_fn(|k| corner[k] + step[k].0 * (f64::from(ty) * side));
        for tx in tx0..=tx1 {
            let x = f64::from(tx) * side;
            let outside = (row[0] - step[0].1 * x < 0.0)
                | (row[1] - step[1].1 * x < 0.0)
                | (row[2] - step[2].1 * x < 0.0);
            if !outside {
                f(ty * grid.across + tx);
            }
        }
    }
}
