//! The same look-ups on the GPU's lanes.

use gnomon_raster::shader::Fragment;
use gnomon_raster::{F32, I32, Lanes, U32};

use super::look_up::{Coordinate, LookUp, LookUpKind, MAX_LOOK_UPS, Origin, TexelAt};

pub(super) type LaneValues<L> = [[F32<L>; 4]; MAX_LOOK_UPS];

/// Values of all look-ups, in order.
#[inline(always)]
pub(super) fn look_up_all<L: Lanes>(
    l: L,
    list: &[LookUp],
    f: &mut Fragment<'_, L>,
) -> LaneValues<L> {
    let mut values = [[F32::splat(l, 0.0); 4]; MAX_LOOK_UPS];
    for (k, look_up) in list.iter().enumerate() {
        values[k] = look(l, look_up, f, &values);
    }
    values
}

#[inline(always)]
fn look<L: Lanes>(
    l: L,
    look_up: &LookUp,
    f: &mut Fragment<'_, L>,
    values: &LaneValues<L>,
) -> [F32<L>; 4] {
    let slot = look_up.slot;
    match &look_up.kind {
        LookUpKind::Sample(c) => {
            let at = coordinate(c, f, values);
            f.sample(slot, at)
        }
        LookUpKind::Gradients(c, [dx, dy]) => {
            let at = coordinate(c, f, values);
            let (dx, dy) = (coordinate(dx, f, values), coordinate(dy, f, values));
            f.sample_grad(slot, at, dx, dy)
        }
        LookUpKind::Level(c, level) => {
            let at = coordinate(c, f, values);
            let level = coordinate(level, f, values)[0];
            f.sample_level(slot, at, level)
        }
        LookUpKind::Fetch(t) => {
            let at = texel_at(l, t, f);
            f.fetch_texel(slot, at, t.mip)
        }
        LookUpKind::Bits(t) => {
            let at = texel_at(l, t, f);
            let bits = f.fetch_texel_bits(slot, at, t.mip);
            bound(l, slot, f, bits)
        }
        LookUpKind::Stencil(t) => {
            let at = texel_at(l, t, f);
            let bits = f.fetch_stencil(slot, at, t.mip);
            bound(l, slot, f, bits)
        }
    }
}

#[inline(always)]
fn coordinate<L: Lanes>(
    c: &Coordinate,
    f: &Fragment<'_, L>,
    values: &LaneValues<L>,
) -> [F32<L>; 3] {
    let mut at = match c.of {
        Origin::Varyings(first) => [f.varying(first), f.varying(first + 1), f.varying(first + 2)],
        Origin::Position => [f.x(), f.y(), f.depth()],
        Origin::LookUp(k) => [values[k][0], values[k][1], values[k][2]],
    };
    for (k, v) in at.iter_mut().enumerate() {
        *v = *v * c.scale[k] + c.offset[k];
    }
    at
}

#[inline(always)]
fn texel_at<L: Lanes>(l: L, t: &TexelAt, f: &Fragment<'_, L>) -> [I32<L>; 3] {
    let [i, j, k] = t.offset.map(|o| I32::splat(l, o));
    [(f.column() >> t.shift) + i, (f.row() >> t.shift) + j, k]
}

/// The halves of 32 bits, 0 and 1; zeros for a slot without texture.
#[inline(always)]
fn bound<L: Lanes>(l: L, slot: usize, f: &Fragment<'_, L>, bits: U32<L>) -> [F32<L>; 4] {
    let zero = F32::splat(l, 0.0);
    if f.texture_size(slot, 0) == [0; 3] {
        return [zero; 4];
    }
    let low = (bits & U32::splat(l, 0xffff)).to_i32().to_f32();
    let high = (bits >> 16).to_i32().to_f32();
    [low, high, zero, F32::splat(l, 1.0)]
}
