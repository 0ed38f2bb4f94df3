//! Planes in screen space.
//!
//! A visible point is (x, y, q): pixel coordinates with centres at halves, rows
//! downwards, and q = 1 - depth, which is affine in 1/w and loses no digit of a
//! depth near 1. The distance of a world-space point from a plane, over the
//! point's clip-space w, is affine in (x, y, q); so no point is transformed and
//! no division is spent on w (paper II, §3).
//!
//! Every evaluation is the one tree `(a x + b y) + (c + d q)`. Each of its
//! operations is monotone after rounding, so the values at a box's two extreme
//! corners bound the *rounded* values at all points of the box: tiles are culled
//! without tolerance and without changing a bit. And it is odd in its
//! coefficients, so two wedges that share a side plane with opposite signs divide
//! the points between them.

use gnomon_raster::{F32, Lanes, uniforms};

/// `(a x + b y) + (c + d q)`, positive inside; the scale is world distance over w.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ScreenPlane(pub [f32; 4]);
uniforms!(ScreenPlane(coefficients));

/// A pixel centre and what it shows there.
#[derive(Clone, Copy)]
pub struct ScreenPoint<L: Lanes> {
    /// Pixel column and half.
    pub x: F32<L>,
    /// Pixel row and half.
    pub y: F32<L>,
    /// 1 - depth.
    pub q: F32<L>,
}

/// A box of such points: least and greatest of each.
#[derive(Clone, Copy)]
pub struct ScreenBox<L: Lanes> {
    /// Columns.
    pub x: [F32<L>; 2],
    /// Rows.
    pub y: [F32<L>; 2],
    /// 1 - depth.
    pub q: [F32<L>; 2],
}

impl ScreenPlane {
    /// The value at a point.
    #[inline(always)]
    pub fn at<L: Lanes>(&self, p: &ScreenPoint<L>) -> F32<L> {
        let [a, b, c, d] = self.0;
        (p.x * a + p.y * b) + (p.q * d + c)
    }

    /// The value in the direction of a pixel, infinitely far away.
    #[inline(always)]
    pub fn far<L: Lanes>(&self, p: &ScreenPoint<L>) -> F32<L> {
        let [a, b, c, _] = self.0;
        (p.x * a + p.y * b) + c
    }

    /// The same tree for one point (x, y, q).
    pub fn at_point(&self, [x, y, q]: [f32; 3]) -> f32 {
        let [a, b, c, d] = self.0;
        (x * a + y * b) + (q * d + c)
    }

    /// The greatest value in a box, at its "p-vertex".
    #[inline(always)]
    pub fn greatest<L: Lanes>(&self, b: &ScreenBox<L>) -> F32<L> {
        self.at(&self.corner(b, true))
    }

    /// The least value in a box, at its "n-vertex".
    #[inline(always)]
    pub fn least<L: Lanes>(&self, b: &ScreenBox<L>) -> F32<L> {
        self.at(&self.corner(b, false))
    }

    #[inline(always)]
    fn corner<L: Lanes>(&self, b: &ScreenBox<L>, greatest: bool) -> ScreenPoint<L> {
        let pick = |k: usize| usize::from((self.0[k] > 0.0) == greatest);
        ScreenPoint {
            x: b.x[pick(0)],
            y: b.y[pick(1)],
            q: b.q[pick(3)],
        }
    }

    /// The least and the greatest value in a box given as least and greatest of x, y, q.
    pub fn range_in(&self, b: &[[f32; 2]; 3]) -> [f32; 2] {
        let corner = |greatest: bool| {
            let pick = |k: usize| usize::from((self.0[k] > 0.0) == greatest);
            self.at_point([b[0][pick(0)], b[1][pick(1)], b[2][pick(3)]])
        };
        [corner(false), corner(true)]
    }

    /// Whether the eye is on the inner side or in the plane.
    pub fn eye_is_inside(&self) -> bool {
        self.0[3] >= 0.0
    }
}
