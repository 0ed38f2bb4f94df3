//! Screen-linear quantities (rules, §3.6).

/// q0 + gx·(x − x0) + gy·(y − y0), in double precision.
#[derive(Clone, Copy, Debug)]
pub(super) struct Plane {
    q0: f64,
    x0: f64,
    y0: f64,
    pub(super) gx: f64,
    pub(super) gy: f64,
}

impl Plane {
    /// Through the values `q` at the snapped corners `xy`.
    pub(super) fn through(xy: [[i64; 2]; 3], q: [f32; 3]) -> Self {
        let [x0, x1, x2] = xy.map(|p| p[0] as f64 / 256.0);
        let [y0, y1, y2] = xy.map(|p| p[1] as f64 / 256.0);
        let [q0, q1, q2] = q.map(f64::from);
        let (ax, ay, bx, by) = (x1 - x0, y1 - y0, x2 - x0, y2 - y0);
        let det = ax * by - bx * ay;
        let (e1, e2) = (q1 - q0, q2 - q0);
        Self {
            q0,
            x0,
            y0,
            gx: (e1 * by - e2 * ay) / det,
            gy: (e2 * ax - e1 * bx) / det,
        }
    }

    /// The value at the centre of pixel (x, y).
    pub(super) fn base(&self, x: u32, y: u32) -> f64 {
        let dx = (f64::from(x) + 0.5) - self.x0;
        let dy = (f64::from(y) + 0.5) - self.y0;
        self.q0 + (self.gx * dx + self.gy * dy)
    }

    /// The value at pixel (x, y) as single precision sees it from its block.
    pub(super) fn at(&self, x: u32, y: u32) -> f32 {
        in_block(
            self.base(x - x % 8, y - y % 8),
            self.gx,
            self.gy,
            x % 8,
            y % 8,
        )
    }
}

/// `fl(fl(fl32(base) + fl(fl32(gx)·ix)) + fl(fl32(gy)·iy))`.
pub(super) fn in_block(base: f64, gx: f64, gy: f64, ix: u32, iy: u32) -> f32 {
    let along = base as f32 + gx as f32 * ix as f32;
    along + gy as f32 * iy as f32
}
