//! Three-component vectors over lanes.

use gnomon_raster::{F32, Lanes};

/// x, y, z of 16 fragments or vertices.
#[derive(Clone, Copy)]
pub(crate) struct V3<L: Lanes>(pub(crate) [F32<L>; 3]);

impl<L: Lanes> V3<L> {
    /// `(x·x' + y·y') + z·z'`.
    #[inline(always)]
    pub(crate) fn dot(self, o: Self) -> F32<L> {
        let ([x, y, z], [u, v, w]) = (self.0, o.0);
        (x * u + y * v) + z * w
    }

    /// From `self` to the uniform homogeneous point `(to, w)`: `to − w·self`,
    /// that is the direction `to` itself where w is 0.
    #[inline(always)]
    pub(crate) fn towards(self, [x, y, z, w]: [f32; 4]) -> Self {
        let [a, b, c] = self.0;
        let l = a.lanes();
        Self([
            F32::splat(l, x) - a * w,
            F32::splat(l, y) - b * w,
            F32::splat(l, z) - c * w,
        ])
    }
}

/// `[f(0), f(1)]`, for lane code.
#[inline(always)]
pub(crate) fn each2<T>(mut f: impl FnMut(usize) -> T) -> [T; 2] {
    [f(0), f(1)]
}
