//! The depth complexity of one point of the light, by a ray.

use gnomon_raster::math::dot3;
use gnomon_raster::shader::Fragment;
use gnomon_raster::simd::each3;
use gnomon_raster::{F32, I32, Lanes, Mask};

use super::events::Gap;
use super::receiver::{Receiver, cross};
use super::{ANCHOR_RAYS, FACETS, LineSamples, NODES};

/// Most boxes: uniforms of a file may ask for any number.
const MOST_NODES: u32 = 1 << 26;
/// Least size of a direction's coordinate.
const STRAIGHT: f32 = 1e-20;

/// Receivers lie on facets but for rounding: planes nearer than this share of the ray's length
/// are left behind where it begins. Otherwise the facet on the other side of an edge that both
/// share could be crossed.
const ROUNDING: f32 = 1e-6;

/// Rays of one packet, from receivers to points of the light.
struct Ray<L: Lanes> {
    origin: [F32<L>; 3],
    direction: [F32<L>; 3],
    inverse: [F32<L>; 3],
    own: F32<L>,
}

impl LineSamples {
    /// Finds D at the anchor for receivers that do not know it, from D in the widest gap.
    #[inline(always)]
    pub(super) fn count_at_anchor<L: Lanes>(
        &self,
        l: L,
        f: &mut Fragment<'_, L>,
        r: &mut Receiver<L>,
        gap: &Gap<L>,
        wanted: Mask<L>,
    ) {
        let asked = r.uncounted & wanted;
        if !asked.any() {
            return;
        }
        let to = self.point(l, r, gap.middle[0], gap.middle[1]);
        f.count(ANCHOR_RAYS, asked);
        let ray = Ray::new(l, r, to);
        let counted = self.crossed(l, f, &ray, asked);
        r.base = asked.select_f32(counted - gap.depth, r.base);
    }

    /// A point of the light, relative to the view's origin.
    #[inline(always)]
    fn point<L: Lanes>(&self, l: L, r: &Receiver<L>, x: F32<L>, y: F32<L>) -> [F32<L>; 3] {
        let source = &self.source;
        if source.radius > 0.0 {
            return each3(
                #[inline(always)]
                |k| (r.turned[0][k] * x + r.turned[1][k] * y) + source.centre[k],
            );
        }
        each3(
            #[inline(always)]
            |k| {
                let on = x * source.axes[0][k] + y * source.axes[1][k];
                on + F32::splat(l, source.centre[k])
            },
        )
    }

    /// How many facets that count are crossed.
    #[inline(always)]
    fn crossed<L: Lanes>(
        &self,
        l: L,
        f: &mut Fragment<'_, L>,
        ray: &Ray<L>,
        wanted: Mask<L>,
    ) -> F32<L> {
        let (one, two) = (I32::splat(l, 1), I32::splat(l, 2));
        let (nodes, facets) = (self.table(NODES), self.table(FACETS));
        let count = I32::splat(l, self.nodes.min(MOST_NODES) as i32);
        // Lanes that are done read outside of the textures, which is nothing.
        let outside = I32::splat(l, -1);
        let mut node = I32::splat(l, 0);
        let mut sum = F32::splat(l, 0.0);
        loop {
            let active = wanted & node.lt(count);
            if !active.any() {
                return sum;
            }
            let first = active.select_i32(node << 1, outside);
            let second = active.select_i32((node << 1) + one, outside);
            let low = nodes.read(l, f, NODES, first);
            let high = nodes.read(l, f, NODES, second);
            let met = active & ray.meets(l, low, high);
            let leaf = met & low[3].ge(F32::splat(l, 0.0));
            if leaf.any() {
                let facet = low[3].to_i32();
                let first = facet + (facet << 1);
                let at = [
                    leaf.select_i32(first, outside),
                    leaf.select_i32(first + one, outside),
                    leaf.select_i32(first + two, outside),
                ];
                let corners = [
                    facets.read(l, f, FACETS, at[0]),
                    facets.read(l, f, FACETS, at[1]),
                    facets.read(l, f, FACETS, at[2]),
                ];
                let hit = leaf & ray.crosses(l, corners);
                sum = sum + hit.select_f32(F32::splat(l, 1.0), F32::splat(l, 0.0));
            }
            let down = met & !leaf;
            // Never back, whatever the texture holds.
            let on = high[3].to_i32().max(node + one);
            node = down.select_i32(node + one, on);
        }
    }
}

impl<L: Lanes> Ray<L> {
    #[inline(always)]
    fn new(l: L, r: &Receiver<L>, to: [F32<L>; 3]) -> Self {
        let direction = each3(
            #[inline(always)]
            |k| to[k] - r.world[k],
        );
        let inverse = each3(
            #[inline(always)]
            |k| {
                let size = direction[k].abs().max(F32::splat(l, STRAIGHT));
                let negative = direction[k].lt(F32::splat(l, 0.0));
                F32::splat(l, 1.0) / negative.select_f32(-size, size)
            },
        );
        Self {
            origin: r.world,
            direction,
            inverse,
            own: r.own,
        }
    }

    #[inline(always)]
    fn meets(&self, l: L, low: [F32<L>; 4], high: [F32<L>; 4]) -> Mask<L> {
        let (mut enter, mut leave) = (F32::splat(l, 0.0), F32::splat(l, 1.0));
        for k in 0..3 {
            let a = (low[k] - self.origin[k]) * self.inverse[k];
            let b = (high[k] - self.origin[k]) * self.inverse[k];
            enter = enter.max(a.min(b));
            leave = leave.min(a.max(b));
        }
        enter.le(leave)
    }

    /// Whether they cross a facet of another plane that faces the light, or counts from
    /// both sides.
    #[inline(always)]
    fn crosses(&self, l: L, corners: [[F32<L>; 4]; 3]) -> Mask<L> {
        let (zero, one) = (F32::splat(l, 0.0), F32::splat(l, 1.0));
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
        let through =
            (u.gt(zero) & v.gt(zero) & w.gt(zero)) | (u.lt(zero) & v.lt(zero) & w.lt(zero));
        let edges = [difference(b, a), difference(c, a)];
        let normal = cross(edges[0], edges[1]);
        let slope = dot3(normal, self.direction);
        let distance = dot3(normal, a);
        let along = distance / slope;
        // Sums instead of lengths: squares would leave the range of floats in large units.
        let reach = (size(normal) * size(self.direction)) * ROUNDING;
        let is_left = distance.abs().le(reach);
        let between = along.gt(zero) & along.lt(one) & !is_left;
        let other = corners[0][3].ne(self.own);
        let both = corners[1][3].gt(zero);
        through & between & other & (both | slope.gt(zero))
    }
}

/// Between a vector's length and √3 of it.
#[inline(always)]
fn size<L: Lanes>([x, y, z]: [F32<L>; 3]) -> F32<L> {
    (x.abs() + y.abs()) + z.abs()
}

#[inline(always)]
fn difference<L: Lanes>(a: [F32<L>; 3], b: [F32<L>; 3]) -> [F32<L>; 3] {
    each3(
        #[inline(always)]
        |k| a[k] - b[k],
    )
}
