//! From a normalised coordinate to texel indices and a weight
//! (`docs/texture-rules.md`, §2).

use crate::simd::{F32, I32, Lanes, Mask};
use crate::state::AddressMode;

/// The texels that a coordinate selects along one axis.
#[derive(Clone, Copy)]
pub(super) struct Axis<L: Lanes> {
    /// Nearer the origin, farther; equal for nearest filtering.
    pub(super) index: [I32<L>; 2],
    /// Whether the texel exists; otherwise it has the border colour.
    pub(super) inside: [Mask<L>; 2],
    /// Of the second texel, 0..=1.
    pub(super) weight: F32<L>,
}

impl<L: Lanes> Axis<L> {
    /// Index 0 along an axis that the texture does not have.
    #[inline(always)]
    pub(super) fn none(l: L) -> Self {
        Self {
            index: [I32::splat(l, 0); 2],
            inside: [Mask::splat(l, true); 2],
            weight: F32::splat(l, 0.0),
        }
    }

    /// Along an axis of `size` texels.
    #[inline(always)]
    pub(super) fn new(mode: AddressMode, linear: bool, u: F32<L>, size: u32) -> Self {
        let scaled = wrap(mode, u) * size as f32;
        if linear {
            Self::linear(mode, scaled, size)
        } else {
            Self::nearest(mode, scaled, size)
        }
    }

    #[inline(always)]
    fn nearest(mode: AddressMode, scaled: F32<L>, size: u32) -> Self {
        let i = scaled.clamp(-1.0, size as f32).floor().to_i32();
        let (index, inside) = hold(mode, i, size);
        Self {
            index: [index; 2],
            inside: [inside; 2],
            weight: F32::splat(scaled.lanes(), 0.0),
        }
    }

    #[inline(always)]
    fn linear(mode: AddressMode, scaled: F32<L>, size: u32) -> Self {
        let (i, weight) = between(scaled, size);
        let (a, b) = if mode == AddressMode::Repeat {
            (turn(i[0], size), turn(i[1], size))
        } else {
            (hold(mode, i[0], size), hold(mode, i[1], size))
        };
        Self {
            index: [a.0, b.0],
            inside: [a.1, b.1],
            weight,
        }
    }

    /// Along an axis of a cube face: linear indices stay in −1..=size, for
    /// [`super::cube::fold`] to bring them to the neighbouring face.
    #[inline(always)]
    pub(super) fn on_face(linear: bool, u: F32<L>, size: u32) -> Self {
        let mode = AddressMode::ClampToEdge;
        let scaled = wrap(mode, u) * size as f32;
        if !linear {
            return Self::nearest(mode, scaled, size);
        }
        let (index, weight) = between(scaled, size);
        Self {
            index,
            inside: [Mask::splat(u.lanes(), true); 2],
            weight,
        }
    }
}

/// The coordinate after repetition or mirroring; NaN becomes 0.
#[inline(always)]
fn wrap<L: Lanes>(mode: AddressMode, u: F32<L>) -> F32<L> {
    let p = match mode {
        AddressMode::ClampToEdge | AddressMode::ClampToBorder => u,
        AddressMode::Repeat => u - u.floor(),
        AddressMode::MirrorRepeat => (u - (u * 0.5).round_ties_even() * 2.0).abs(),
    };
    p.eq(p).select_f32(p, F32::splat(u.lanes(), 0.0))
}

/// The two texels whose centres enclose the point, and the second one's weight.
#[inline(always)]
fn between<L: Lanes>(scaled: F32<L>, size: u32) -> ([I32<L>; 2], F32<L>) {
    let s = (scaled - 0.5).clamp(-2.0, size as f32 + 1.0);
    let floor = s.floor();
    let i = floor.to_i32();
    ([i, i + I32::splat(s.lanes(), 1)], s - floor)
}

/// Limits an index to the image; says where it was inside, if the mode cares.
#[inline(always)]
fn hold<L: Lanes>(mode: AddressMode, i: I32<L>, size: u32) -> (I32<L>, Mask<L>) {
    let limited = i
        .max(I32::splat(i.l, 0))
        .min(I32::splat(i.l, size as i32 - 1));
    let inside = if mode == AddressMode::ClampToBorder {
        limited.eq(i)
    } else {
        Mask::splat(i.l, true)
    };
    (limited, inside)
}

/// An index from −1 to `size`, modulo `size`.
#[inline(always)]
fn turn<L: Lanes>(i: I32<L>, size: u32) -> (I32<L>, Mask<L>) {
    let n = I32::splat(i.l, size as i32);
    let i = i.lt(I32::splat(i.l, 0)).select_i32(i + n, i);
    (i.ge(n).select_i32(i - n, i), Mask::splat(i.l, true))
}
