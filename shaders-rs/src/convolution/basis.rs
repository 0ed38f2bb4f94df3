//! Basis images: what of each term depends on the blocker alone (§4.1, Eq. 11).

use gnomon_raster::math::sin_cos;
use gnomon_raster::shader::{Fragment, FragmentOutputs, FragmentShader};
use gnomon_raster::{F32, I32, Lanes, Mask, uniforms};

use super::{Encoding, Expansion};
use crate::soft_volumes::{reads, texel_of};

/// Where the depth of a basis image's texel comes from: texture 0, scaled depth in
/// red.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Source {
    /// Texel at which the tile begins in the target.
    pub origin: [u32; 2],
    /// Entries are moved by one column and one row, and the first ones are 0, so
    /// that sums up to an entry leave the entry's own texel out.
    pub exclusive: bool,
}
uniforms!(Source { origin, exclusive });

impl Source {
    /// Depth 0..=1, NaN as 1, and which lanes hold a texel and not the zeros before
    /// the first.
    #[inline(always)]
    pub(crate) fn depth<L: Lanes>(&self, l: L, f: &mut Fragment<'_, L>) -> (F32<L>, Mask<L>) {
        let first = if self.exclusive { 1 } else { 0 };
        let [x, y] = self.origin;
        let x = f.column() - I32::splat(l, x as i32 + first);
        let y = f.row() - I32::splat(l, y as i32 + first);
        let zero = I32::splat(l, 0);
        let [stored, ..] = texel_of(l, f, 0, [x, y, zero]);
        let one = F32::splat(l, 1.0);
        (
            one - (one - stored).clamp(0.0, 1.0),
            x.ge(zero) & y.ge(zero),
        )
    }
}

/// Cosines and sines of two terms to attachment 0, and the same times series depth
/// to attachment 1: CSM and CSM-Z. Terms beyond the last are 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BasisImages {
    /// The expansion.
    pub expansion: Expansion,
    /// Which two terms: 2j and 2j + 1.
    pub pair: usize,
    /// `None` writes four channels; otherwise the one of this number as an unsigned
    /// integer.
    pub channel: Option<usize>,
    /// Where depth comes from.
    pub source: Source,
    /// How attachments 0 and 1 are stored.
    pub encodings: [Encoding; 2],
}
uniforms!(BasisImages {
    expansion,
    pair,
    channel,
    source,
    encodings
});

impl FragmentShader for BasisImages {
    fn outputs(&self) -> FragmentOutputs {
        reads(1)
    }

    #[inline(always)]
    fn shade<L: Lanes>(&self, l: L, f: &mut Fragment<'_, L>) {
        let (depth, some) = self.source.depth(l, f);
        let z = depth * self.expansion.reach;
        let zero = F32::splat(l, 0.0);
        let mut basis = [zero; 4];
        for half in 0..2 {
            let term = 2 * self.pair + half;
            if term < self.expansion.terms {
                let [sin, cos] = sin_cos(z * self.expansion.frequencies[term]);
                (basis[2 * half], basis[2 * half + 1]) = (cos, sin);
            }
        }
        for (i, encoding) in self.encodings.iter().enumerate() {
            let mut stored = basis;
            for s in &mut stored {
                let value = if i == 0 { *s } else { *s * z };
                *s = some.select_f32(encoding.store(value), zero);
            }
            match self.channel {
                None => f.set_color(i, stored),
                Some(c) => set_integer(f, i, stored[c]),
            }
        }
    }
}

/// Series depth to attachment 0: twice the z/2 of Eq. 11.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DepthImage {
    /// The expansion's [`Expansion::reach`].
    pub reach: f32,
    /// Whether the image holds unsigned integers.
    pub integer: bool,
    /// Where depth comes from.
    pub source: Source,
    /// How it is stored.
    pub encoding: Encoding,
}
uniforms!(DepthImage {
    reach,
    integer,
    source,
    encoding
});

impl FragmentShader for DepthImage {
    fn outputs(&self) -> FragmentOutputs {
        reads(1)
    }

    #[inline(always)]
    fn shade<L: Lanes>(&self, l: L, f: &mut Fragment<'_, L>) {
        let (depth, some) = self.source.depth(l, f);
        let zero = F32::splat(l, 0.0);
        let stored = some.select_f32(self.encoding.store(depth * self.reach), zero);
        if self.integer {
            set_integer(f, 0, stored);
        } else {
            f.set_color(0, [stored, zero, zero, zero]);
        }
    }
}

/// The nearest integer of a value from 0 to 2³¹ − 1.
#[inline(always)]
pub(crate) fn set_integer<L: Lanes>(f: &mut Fragment<'_, L>, attachment: usize, value: F32<L>) {
    let integer = value.round_ties_even().to_i32().to_u32();
    f.set_color_uint(attachment, integer);
}
