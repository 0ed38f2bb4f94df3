//! Clipping to, and sectors of, a convex polygon round the origin.

use gnomon_raster::{F32, Lanes, uniforms};

use super::square::cut;
use crate::vector::each2;

/// Corners of a polygon at most.
pub const MAX_CORNERS: usize = 16;

/// A convex polygon with the light's centre at the origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Outline {
    /// Its area.
    pub area: f32,
    /// How many corners there are.
    pub count: u32,
    /// Corners counter-clockwise, then anything.
    pub corners: [[f32; 2]; MAX_CORNERS],
}
uniforms!(Outline {
    area,
    count,
    corners
});

impl Outline {
    /// Its edges.
    #[inline(always)]
    fn edges(&self) -> impl Iterator<Item = [[f32; 2]; 2]> + '_ {
        let n = (self.count as usize).min(MAX_CORNERS);
        (0..n).map(move |k| {
            let next = if k + 1 == n { 0 } else { k + 1 };
            [self.corners[k], self.corners[next]]
        })
    }
}

/// Parameters of the part of a homogeneous segment on the polygon, of the part given.
#[inline(always)]
pub(super) fn clip<L: Lanes>(
    l: L,
    outline: &Outline,
    a: [F32<L>; 3],
    b: [F32<L>; 3],
    part: [F32<L>; 2],
) -> [F32<L>; 2] {
    let mut bounds = part;
    for [[x0, y0], [x1, y1]] in outline.edges() {
        let (nx, ny) = (y0 - y1, x1 - x0);
        let offset = x0 * y1 - y0 * x1;
        let inside = each2(
            #[inline(always)]
            |k| {
                let p = [a, b][k];
                (p[0] * nx + p[1] * ny) + p[2] * offset
            },
        );
        let [fa, fb] = inside;
        bounds = cut(l, fa, fb, bounds);
    }
    bounds
}

/// Area of the polygon between the rays from the centre through p and q, on the side
/// where they are less than half a turn apart: of each edge the triangle of the part
/// between the rays.
#[inline(always)]
pub(super) fn sector<L: Lanes>(l: L, outline: &Outline, p: [F32<L>; 2], q: [F32<L>; 2]) -> F32<L> {
    let (zero, one) = (F32::splat(l, 0.0), F32::splat(l, 1.0));
    let turned = (p[0] * q[1] - p[1] * q[0]).lt(zero);
    let from = [turned.select_f32(q[0], p[0]), turned.select_f32(q[1], p[1])];
    let to = [turned.select_f32(p[0], q[0]), turned.select_f32(p[1], q[1])];
    let mut twice = zero;
    for [a, b] in outline.edges() {
        let whole = a[0] * b[1] - a[1] * b[0];
        let [left_a, left_b] = [left_of(from, a), left_of(from, b)];
        let [right_a, right_b] = [-left_of(to, a), -left_of(to, b)];
        let bounds = cut(l, left_a, left_b, [zero, one]);
        let [start, end] = cut(l, right_a, right_b, bounds);
        twice = twice + (end - start).max(zero) * whole;
    }
    twice * 0.5
}

/// How far a point is on the left of a ray from the centre.
#[inline(always)]
fn left_of<L: Lanes>(ray: [F32<L>; 2], [x, y]: [f32; 2]) -> F32<L> {
    ray[0] * y - ray[1] * x
}
