//! Shadow rays: from each receiver to points of the light, through a hierarchy of boxes
//! over the casters' triangles, all of it read from textures.
//!
//! # The hierarchy
//!
//! Nodes are in depth-first order, two texels each: least corner and the number of the
//! node's triangle, -1 for inner nodes; greatest corner and the number of the node to go
//! on with where the box is missed, or after a leaf. Triangles are three texels each, their
//! corners. All are numbers of rows of [`Table`]s.
//!
//! # Hits
//!
//! Signs of three triple products say on which sides of its edges a ray passes a
//! triangle. Neighbours have the same product for their common edge but for its sign, to
//! the bit, so that no ray slips between them; through an edge itself it meets both.

use gnomon_raster::math::dot3;
use gnomon_raster::shader::{Fragment, FragmentOutputs, FragmentShader};
use gnomon_raster::simd::each3;
use gnomon_raster::{F32, I32, Lanes, Mask, uniforms};

use crate::soft_volumes::texel_of;

/// Slots after that of positions.
const NODES: usize = 1;
const TRIANGLES: usize = 2;
const POINTS: usize = 3;
const PLANES: usize = 4;

/// Name of the count of rays.
pub const SHADOW_RAYS: &str = "shadow-rays";

/// Texels in rows of a texture, one after the other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Table {
    /// Texels in a row: 2 to the power of this.
    pub log_width: u32,
}
uniforms!(Table { log_width });

impl Table {
    #[inline(always)]
    pub(crate) fn read<L: Lanes>(
        &self,
        l: L,
        f: &mut Fragment<'_, L>,
        slot: usize,
        number: I32<L>,
    ) -> [F32<L>; 4] {
        texel_of(l, f, slot, self.place(l, number))
    }

    /// Where a texel is.
    #[inline(always)]
    pub(crate) fn place<L: Lanes>(&self, l: L, number: I32<L>) -> [I32<L>; 3] {
        let mask = (1i32 << self.log_width) - 1;
        let column = number & I32::splat(l, mask);
        [column, number >> self.log_width, I32::splat(l, 0)]
    }
}

/// Visibility of a light, to red of attachment 0: the share of its points that rays
/// reach.
///
/// Texture 0 holds positions (w is 0 where no shadow falls), texture 3 the light's points,
/// w being 0 for directions, a row for each pixel of a block of pixels; texture 4 the
/// planes of the facets seen, unit normals and distances from the eye. Rays start off
/// them, on the eye's side.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShadowRays {
    /// How nodes lie in texture 1.
    pub nodes: Table,
    /// How triangles lie in texture 2.
    pub triangles: Table,
    /// Nodes; 0 where nothing casts.
    pub count: u32,
    /// Points to which rays go.
    pub points: u32,
    /// Pixels along a side of a block, a power of two.
    pub block: u32,
    /// How far off its surface a ray starts, world units.
    pub bias: f32,
}
uniforms!(ShadowRays {
    nodes,
    triangles,
    count,
    points,
    block,
    bias
});

/// Most points, and most nodes that a ray visits for each node that there is: uniforms of
/// a file may ask for any number, and textures may hold anything.
const MOST_POINTS: u32 = 4096;
const MOST_NODES: u32 = 1 << 26;

/// Least size of a direction's coordinate.
const STRAIGHT: f32 = 1e-20;

/// Rays of one packet.
struct Rays<L: Lanes> {
    origin: [F32<L>; 3],
    direction: [F32<L>; 3],
    inverse: [F32<L>; 3],
    /// Directions that they may go along: 1 to points, without end to directions.
    end: F32<L>,
}

impl<L: Lanes> Rays<L> {
    #[inline(always)]
    fn new(l: L, origin: [F32<L>; 3], to: [F32<L>; 4]) -> Self {
        let one = F32::splat(l, 1.0);
        let placed = to[3].gt(F32::splat(l, 0.0));
        let direction = each3(
            #[inline(always)]
            |k| placed.select_f32(to[k] - origin[k], to[k]),
        );
        let inverse = each3(
            #[inline(always)]
            |k| {
                let size = direction[k].abs().max(F32::splat(l, STRAIGHT));
                let negative = direction[k].lt(F32::splat(l, 0.0));
                one / negative.select_f32(-size, size)
            },
        );
        let end = placed.select_f32(one, F32::splat(l, f32::MAX));
        Self {
            origin,
            direction,
            inverse,
            end,
        }
    }

    /// Whether they meet a box.
    #[inline(always)]
    fn meet(&self, low: [F32<L>; 4], high: [F32<L>; 4]) -> Mask<L> {
        let l = self.end.lanes();
        let (mut enter, mut leave) = (F32::splat(l, 0.0), self.end);
        for k in 0..3 {
            let a = (low[k] - self.origin[k]) * self.inverse[k];
            let b = (high[k] - self.origin[k]) * self.inverse[k];
            enter = enter.max(a.min(b));
            leave = leave.min(a.max(b));
        }
        enter.le(leave)
    }

    /// Whether they meet a triangle before their end.
    #[inline(always)]
    fn hit(&self, corners: [[F32<L>; 4]; 3]) -> Mask<L> {
        let zero = F32::splat(self.end.lanes(), 0.0);
        let [a, b, c] = each3(
            #[inline(always)]
            |i| {
                each3(
                    #[inline(always)]
                    |k| corners[i][k] - self.origin[k],
                )
            },
        );
        let sides = [cross(a, b), cross(b, c), cross(c, a)];
        let [u, v, w] = each3(
            #[inline(always)]
            |i| dot3(sides[i], self.direction),
        );
        let left = u.ge(zero) & v.ge(zero) & w.ge(zero);
        let right = u.le(zero) & v.le(zero) & w.le(zero);
        let normal = cross(difference(b, a), difference(c, a));
        let slope = dot3(normal, self.direction);
        let along = dot3(normal, a) / slope;
        let before = along.gt(zero) & along.lt(self.end);
        (left | right) & slope.abs().gt(zero) & before
    }
}

#[inline(always)]
fn difference<L: Lanes>(a: [F32<L>; 3], b: [F32<L>; 3]) -> [F32<L>; 3] {
    each3(
        #[inline(always)]
        |k| a[k] - b[k],
    )
}

/// Each product is rounded by itself: exchanging both changes the sign and nothing else.
#[inline(always)]
fn cross<L: Lanes>(a: [F32<L>; 3], b: [F32<L>; 3]) -> [F32<L>; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

impl ShadowRays {
    /// Which of the wanted rays meet something.
    #[inline(always)]
    fn blocked<L: Lanes>(
        &self,
        l: L,
        f: &mut Fragment<'_, L>,
        rays: &Rays<L>,
        wanted: Mask<L>,
    ) -> Mask<L> {
        let (one, two) = (I32::splat(l, 1), I32::splat(l, 2));
        let count = I32::splat(l, self.count.min(MOST_NODES) as i32);
        // Lanes that are done read outside of the textures, which is nothing.
        let outside = I32::splat(l, -1);
        let mut node = I32::splat(l, 0);
        let mut blocked = Mask::splat(l, false);
        loop {
            let active = wanted & !blocked & node.lt(count);
            if !active.any() {
                return blocked;
            }
            let first = active.select_i32(node << 1, outside);
            let second = active.select_i32((node << 1) + one, outside);
            let low = self.nodes.read(l, f, NODES, first);
            let high = self.nodes.read(l, f, NODES, second);
            let met = active & rays.meet(low, high);
            let leaf = met & low[3].ge(F32::splat(l, 0.0));
            if leaf.any() {
                let triangle = low[3].to_i32();
                let first = triangle + (triangle << 1);
                let corner = |k: I32<L>| leaf.select_i32(first + k, outside);
                let at = [corner(I32::splat(l, 0)), corner(one), corner(two)];
                let corners = [
                    self.triangles.read(l, f, TRIANGLES, at[0]),
                    self.triangles.read(l, f, TRIANGLES, at[1]),
                    self.triangles.read(l, f, TRIANGLES, at[2]),
                ];
                blocked = blocked | (leaf & rays.hit(corners));
            }
            let down = met & !leaf;
            // Never back, whatever the texture holds.
            let on = high[3].to_i32().max(node + one);
            node = down.select_i32(node + one, on);
        }
    }

    /// Where rays start.
    #[inline(always)]
    fn origin<L: Lanes>(
        &self,
        l: L,
        f: &mut Fragment<'_, L>,
        own: [I32<L>; 3],
        position: [F32<L>; 3],
    ) -> [F32<L>; 3] {
        let plane = texel_of(l, f, PLANES, own);
        let behind = plane[3].lt(F32::splat(l, 0.0));
        let step = F32::splat(l, self.bias);
        let step = behind.select_f32(step, -step);
        each3(
            #[inline(always)]
            |k| position[k] + plane[k] * step,
        )
    }
}

impl FragmentShader for ShadowRays {
    fn outputs(&self) -> FragmentOutputs {
        FragmentOutputs {
            discards: true,
            textures: 5,
            counts: &[SHADOW_RAYS],
            ..FragmentOutputs::default()
        }
    }

    #[inline(always)]
    fn shade<L: Lanes>(&self, l: L, f: &mut Fragment<'_, L>) {
        let (zero, one) = (F32::splat(l, 0.0), F32::splat(l, 1.0));
        let own = [f.column(), f.row(), I32::splat(l, 0)];
        let [x, y, z, shadowable] = texel_of(l, f, 0, own);
        let receives = shadowable.gt(zero);
        f.discard(!receives);
        if !(receives & f.live()).any() {
            return;
        }
        let origin = self.origin(l, f, own, [x, y, z]);
        let block = I32::splat(l, self.block as i32 - 1);
        let within = own[1] & block;
        let row = (within << self.block.trailing_zeros()) + (own[0] & block);
        let wanted = receives & f.live();
        let mut reached = zero;
        for point in 0..self.points.min(MOST_POINTS) {
            let at = [I32::splat(l, point as i32), row, I32::splat(l, 0)];
            let to = texel_of(l, f, POINTS, at);
            let rays = Rays::new(l, origin, to);
            f.count(0, wanted);
            let blocked = self.blocked(l, f, &rays, wanted);
            reached = reached + blocked.select_f32(zero, one);
        }
        let share = reached * (1.0 / self.points as f32);
        f.set_color(0, [share, zero, zero, zero]);
    }
}
