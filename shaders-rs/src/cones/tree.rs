//! Patches found exactly: among all of them, or by the tree of their boxes. Both visit
//! them in one order, so that equal sets have equal sums, to the bit.

use gnomon_raster::math::{cross, dot3};
use gnomon_raster::shader::Fragment;
use gnomon_raster::simd::each3;
use gnomon_raster::{F32, I32, Lanes, MAX_TEXTURE_SIZE, Mask, uniforms};

use super::bounds::first_level;
use super::patches::PatchShape;
use super::{PATCHES, PatchSearch, PictureCone, ShadowCone};
use crate::bounded::bounded_uniforms;
use crate::soft_volumes::{texel_of, texel_of_mip};

/// By how much cones are taken for wider than they are, as a share of distances and of
/// coordinates: many times what f32 rounds off.
const SLACK: f32 = 1e-4;
const ROUNDING: f32 = 1e-6;

/// Levels of the largest tree, its leaves included.
const MOST_LEVELS: usize = MAX_TEXTURE_SIZE.ilog2() as usize + 1;

/// Column and row of a number in Morton order.
#[inline(always)]
fn place(code: u32) -> [i32; 2] {
    [even_bits(code), even_bits(code >> 1)]
}

#[inline(always)]
fn even_bits(code: u32) -> i32 {
    let b = code & 0x5555_5555;
    let b = (b | b >> 1) & 0x3333_3333;
    let b = (b | b >> 2) & 0x0f0f_0f0f;
    let b = (b | b >> 4) & 0x00ff_00ff;
    ((b | b >> 8) & 0xffff) as i32
}

/// A patch by its number, for some lanes; the others read nothing.
#[inline(always)]
fn patch<L: Lanes>(l: L, f: &mut Fragment<'_, L>, code: u32, lanes: Mask<L>) -> [F32<L>; 4] {
    let at = place_for(l, code, lanes);
    texel_of(l, f, PATCHES, at)
}

#[inline(always)]
fn place_for<L: Lanes>(l: L, code: u32, lanes: Mask<L>) -> [I32<L>; 3] {
    let [column, row] = place(code);
    let outside = I32::splat(l, -1);
    let column = lanes.select_i32(I32::splat(l, column), outside);
    [column, I32::splat(l, row), I32::splat(l, 0)]
}

/// Each texel of the picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct AllPatches;
uniforms!(AllPatches);

impl PatchSearch for AllPatches {
    const MORE_TEXTURES: usize = 0;

    #[inline(always)]
    fn hidden<L: Lanes>(
        &self,
        l: L,
        f: &mut Fragment<'_, L>,
        shape: &PatchShape,
        cone: &ShadowCone<L>,
        at: &PictureCone<'_, L>,
    ) -> F32<L> {
        let size = at.mapping.size;
        let mut hidden = F32::splat(l, 0.0);
        for code in 0..size * size {
            let patch = patch(l, f, code, cone.wanted);
            hidden = hidden + cone.hidden(f, shape, patch, 1.0);
        }
        hidden
    }
}

/// The leaves of a tree of boxes that cones reach. Textures 2 and 3 hold low and high
/// corners of even levels from 2 on, textures 4 and 5 those of odd levels from 1 on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PatchTree {
    /// Level of the root, whose box holds all patches; that of texels is 0.
    pub root: u32,
}
bounded_uniforms!(PatchTree { root }: |t| [("levels", t.root.into(), MOST_LEVELS as u64 - 1)]);

impl PatchTree {
    /// The lanes whose cones may hold something of a box.
    #[inline(always)]
    fn reached<L: Lanes>(
        l: L,
        f: &mut Fragment<'_, L>,
        cone: &ShadowCone<L>,
        [level, code]: [u32; 2],
        lanes: Mask<L>,
    ) -> Mask<L> {
        let slot = 2 + 2 * (level % 2) as usize;
        let mip = level - first_level(level);
        let at = place_for(l, code, lanes);
        let low = texel_of_mip(l, f, slot, at, mip);
        let high = texel_of_mip(l, f, slot + 1, at, mip);
        let middle = each3(
            #[inline(always)]
            |i| (low[i] + high[i]) * 0.5,
        );
        let half = each3(
            #[inline(always)]
            |i| (high[i] - low[i]) * 0.5,
        );
        let there = low[3].gt(F32::splat(l, 0.0));
        lanes & there & cone.may_reach(middle, dot3(half, half).sqrt())
    }
}

impl<L: Lanes> ShadowCone<L> {
    /// Whether it may hold something of a ball.
    #[inline(always)]
    fn may_reach(&self, middle: [F32<L>; 3], radius: F32<L>) -> Mask<L> {
        let v = self.to(middle);
        let [x, y, z] = self.apex;
        let rounding = (x.abs() + y.abs() + z.abs()) * ROUNDING;
        let radius = radius + (dot3(v, v).sqrt() + radius) * SLACK + rounding;
        let along = dot3(v, self.axis);
        let off = cross(v, self.axis);
        // Distance from the cone's surface, or less.
        let beyond = dot3(off, off).sqrt() * self.cosine - along * self.sine;
        let behind = (along + radius).lt(F32::splat(along.lanes(), 0.0));
        let past = (along - radius).gt(self.distance);
        !(behind | past | beyond.gt(radius))
    }
}

impl PatchSearch for PatchTree {
    const MORE_TEXTURES: usize = 4;

    /// All lanes of a packet go through the tree together; each reads the children of
    /// those nodes only that it reaches.
    #[inline(always)]
    fn hidden<L: Lanes>(
        &self,
        l: L,
        f: &mut Fragment<'_, L>,
        shape: &PatchShape,
        cone: &ShadowCone<L>,
        _: &PictureCone<'_, L>,
    ) -> F32<L> {
        let mut hidden = F32::splat(l, 0.0);
        // Of each level, the lanes that reached the node above.
        let mut lanes = [0u16; MOST_LEVELS];
        let (mut level, mut code) = (self.root, 0);
        lanes[level as usize] = cone.wanted.bits();
        loop {
            let wanted = Mask::from_bits(l, lanes[level as usize]);
            if level == 0 {
                let patch = patch(l, f, code, wanted);
                hidden = hidden + cone.hidden(f, shape, patch, 1.0);
            } else {
                let reached = Self::reached(l, f, cone, [level, code], wanted);
                if reached.any() {
                    level -= 1;
                    code *= 4;
                    lanes[level as usize] = reached.bits();
                    continue;
                }
            }
            while code % 4 == 3 && level < self.root {
                level += 1;
                code /= 4;
            }
            if level == self.root {
                return hidden;
            }
            code += 1;
        }
    }
}
