//! Soft shadow volumes with coverage split over 8-bit buffers (paper IV, §4.2 and
//! §4.3), and visibilities of several silhouettes combined (§5.1).
//!
//! [`resolve`] makes visibility of the buffers and of a stencil's hard count.
//!
//! Coverage is a whole number of 4095ths, v. Its bits three by three,
//! `(v >> 3i) & 7`, go to channel i of an additive buffer on the umbra side of the
//! hard quad, and of a subtractive one on the other; five bits of each channel are
//! left for carries. So [`CAPACITY`] contributions fit for certain, and a channel
//! that overflows saturates, which the counters tell.
//!
//! With tables, as on the paper's hardware: angles come from a cube map of
//! [`ANGLE_SIDE`]^2 16-bit texels a face, the area between two angles from an image
//! of [`AREA_SIDE`]^2, and the split from one of [`SPLIT_ENTRIES`] texels, which
//! leaves 10 bits of the 12.

pub mod resolve;
pub mod textured;

use gnomon_raster::shader::{Fragment, FragmentOutputs, FragmentShader};
use gnomon_raster::simd::each4;
use gnomon_raster::{F32, I32, Lanes, uniforms};

use crate::coverage::{Edge, Projector, Segment, clip, covered};
use crate::soft_volumes::{HardPlane, own_texels, reads, receiver, texel_of};

/// Contributions that fit into a channel for certain: 255 / 7.
pub const CAPACITY: u32 = 36;
/// Bits of a contribution that a channel takes, and channels that take some: 12 in all.
pub const BITS_AND_CHANNELS: [u32; 2] = [3, 4];
/// What full coverage is stored as.
pub const FULL: f32 = 4095.0;
/// Texels along a face of the angle map.
pub const ANGLE_SIDE: u32 = 128;
/// Texels along the area map.
pub const AREA_SIDE: u32 = 256;
/// Texels of the split map.
pub const SPLIT_ENTRIES: u32 = 1024;
/// What half a turn is stored as in the angle map.
pub const HALF_TURN: f32 = 32767.0;

/// What is looked up instead of computed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Tables {
    /// Angles and areas: texture 1, the cube, and 2, the area between two angles
    /// as a share of the light times two.
    pub coverage: bool,
    /// The split: texture 3.
    pub split: bool,
}
uniforms!(Tables { coverage, split });

/// Which buffers a wedge is drawn to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Halves {
    /// Attachment 0 is the additive buffer, 1 the subtractive one.
    Both,
    /// The additive one alone, attachment 0: fragments on the umbra side.
    Inner,
    /// The subtractive one alone, attachment 0: all other fragments.
    Outer,
}
uniforms!(enum Halves { 0: Both, 1: Inner, 2: Outer });

/// The penumbra of one edge.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SplitPenumbra {
    /// The light.
    pub light: Projector,
    /// The edge, in the light's coordinates.
    pub edge: Edge,
    /// What side of its hard shadow quad a fragment is on.
    pub plane: HardPlane,
    /// What is looked up.
    pub tables: Tables,
    /// Where the coverage goes.
    pub halves: Halves,
}
uniforms!(SplitPenumbra {
    light,
    edge,
    plane,
    tables,
    halves
});

impl FragmentShader for SplitPenumbra {
    fn outputs(&self) -> FragmentOutputs {
        let any = self.tables.coverage || self.tables.split;
        reads(if any { 4 } else { 1 })
    }

    #[inline(always)]
    fn shade<L: Lanes>(&self, l: L, f: &mut Fragment<'_, L>) {
        let [position] = own_texels(l, f, 1);
        let (from, shadowable) = receiver(l, position, self.light.origin());
        let projected = self.light.project(l, from, &self.edge);
        let mut segment = clip(l, self.light.image(), &projected);
        segment.some = segment.some & shadowable;
        let bits = self.bits(l, f, &segment);
        let inside = self.plane.umbra_side(l, from);
        let zero = F32::splat(l, 0.0);
        let added = each4(
            #[inline(always)]
            |i| inside.select_f32(bits[i], zero),
        );
        let taken = each4(
            #[inline(always)]
            |i| inside.select_f32(zero, bits[i]),
        );
        match self.halves {
            Halves::Both => {
                f.set_color(0, added);
                f.set_color(1, taken);
            }
            Halves::Inner => f.set_color(0, added),
            Halves::Outer => f.set_color(0, taken),
        }
    }
}

impl SplitPenumbra {
    /// Coverage split over four channels, in steps of 1/255.
    #[inline(always)]
    fn bits<L: Lanes>(&self, l: L, f: &mut Fragment<'_, L>, segment: &Segment<L>) -> [F32<L>; 4] {
        let zero = F32::splat(l, 0.0);
        let mut share = if self.tables.coverage {
            zero
        } else {
            covered(l, self.light.image(), segment)
        };
        let mut looked_up = [zero; 4];
        let mut angles = [zero; 2];
        let [p, q] = segment.ends;
        // One loop, so that the look-up is compiled once: two angles, area, split.
        let (first, last) = (
            if self.tables.coverage { 0 } else { 3 },
            if self.tables.split { 4 } else { 3 },
        );
        for step in first..last {
            let (slot, at) = match step {
                0 => (1, angle_texel(l, p)),
                1 => (1, angle_texel(l, q)),
                2 => (2, area_texel(l, angles)),
                _ => (3, split_texel(l, share)),
            };
            let texel = texel_of(l, f, slot, at);
            match step {
                0 => angles[0] = texel[0],
                1 => angles[1] = texel[0],
                2 => {
                    let cross = (p[0] * q[1] - p[1] * q[0]).abs();
                    let triangle = cross * (0.5 / self.light.image().area());
                    let looked = (texel[0] * 0.5 - triangle).max(zero);
                    share = segment.some.select_f32(looked, zero);
                }
                _ => looked_up = texel,
            }
        }
        if self.tables.split {
            return looked_up;
        }
        split(l, share)
    }
}

/// Three bits of `round(4095 share)` a channel, in steps of 1/255.
#[inline(always)]
pub fn split<L: Lanes>(l: L, share: F32<L>) -> [F32<L>; 4] {
    let v = (share * FULL).round_ties_even().to_i32();
    let seven = I32::splat(l, 7);
    [
        (v & seven).to_f32() / 255.0,
        ((v >> 3) & seven).to_f32() / 255.0,
        ((v >> 6) & seven).to_f32() / 255.0,
        ((v >> 9) & seven).to_f32() / 255.0,
    ]
}

/// Texel of the angle cube for direction (x, y, 0): faces 0 to 3 in their middle
/// row or column (Vulkan's orientation).
#[inline(always)]
pub fn angle_texel<L: Lanes>(l: L, [x, y]: [F32<L>; 2]) -> [I32<L>; 3] {
    let zero = F32::splat(l, 0.0);
    let flat = x.abs().gt(y.abs());
    let along = flat.select_f32(x, y);
    let other = flat.select_f32(-y, x);
    let size = along.abs().max(F32::splat(l, f32::MIN_POSITIVE));
    let side = ANGLE_SIDE as f32;
    let place = ((other / size + 1.0) * (0.5 * side)).clamp(0.0, side - 1.0);
    let place = place.floor().to_i32();
    let middle = I32::splat(l, ANGLE_SIDE as i32 / 2);
    let negative = along
        .lt(zero)
        .select_i32(I32::splat(l, 1), I32::splat(l, 0));
    let axis = flat.select_i32(I32::splat(l, 0), I32::splat(l, 2));
    [
        flat.select_i32(middle, place),
        flat.select_i32(place, middle),
        axis + negative,
    ]
}

/// Texel of the area map for two stored angles.
#[inline(always)]
pub fn area_texel<L: Lanes>(l: L, angles: [F32<L>; 2]) -> [I32<L>; 3] {
    let scale = (AREA_SIDE as f32 - 1.0) / (2.0 * HALF_TURN);
    let [a, b] = [
        ((angles[0] + HALF_TURN) * scale).round_ties_even().to_i32(),
        ((angles[1] + HALF_TURN) * scale).round_ties_even().to_i32(),
    ];
    [a, b, I32::splat(l, 0)]
}

/// Texel of the split map.
#[inline(always)]
fn split_texel<L: Lanes>(l: L, share: F32<L>) -> [I32<L>; 3] {
    let last = SPLIT_ENTRIES as f32 - 1.0;
    let place = (share * last).round_ties_even().clamp(0.0, last);
    [place.to_i32(), I32::splat(l, 0), I32::splat(l, 0)]
}
