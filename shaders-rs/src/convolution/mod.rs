//! Convolution soft shadows (Annen et al. 2008; docs/papers.md, Annen et al. 2008): the shadow test
//! as a sum of products of receiver and blocker, so that it can be filtered before
//! it is known who receives.
//!
//! * [`basis`]: the products' blocker halves as images
//! * [`prefilter`]: mip chains and summed-area tables of them
//! * [`look_up`]: means over a kernel
//! * [`visibility`]: what a receiver makes of the means
//!
//! Depth here is *series depth*: linear planar depth of the light view, 0 at its
//! near distance and [`Expansion::reach`] at the far one. The series has period 2;
//! over this range a blocker never comes near the other half of the period.
//!
//! # Images
//!
//! Images of one kind are tiles of one texture, [`Atlas`]. Terms 2j and 2j + 1 are
//! the channels of tile j: cosine and sine of the first, then of the second. In
//! integer tables each channel is a tile of its own, 4j + channel.

pub mod basis;
pub mod look_up;
pub mod prefilter;
pub mod visibility;

use crate::bounded::bounded_uniforms;
use gnomon_raster::{F32, Lanes, uniforms};

/// Most terms of the expansion.
pub const MAX_TERMS: usize = 16;

/// The expansion of the complementary shadow test,
/// `bias + gain · Σ 2/c_k sin(c_k (d − offset − z))`: 1 where the blocker at z is
/// nearer than the receiver at d, 0 where it is not (Eq. 10, scaled and shifted).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Expansion {
    /// Number of terms M, 1..=[`MAX_TERMS`].
    pub terms: usize,
    /// c_k = π(2k − 1), from k = 1.
    pub frequencies: [f32; MAX_TERMS],
    /// Value where the sum is 0.
    pub bias: f32,
    /// Factor of the sum.
    pub gain: f32,
    /// Taken off the receiver's series depth.
    pub offset: f32,
    /// Largest series depth, 1 − 1/(2M).
    pub reach: f32,
}
bounded_uniforms!(Expansion { terms, frequencies, bias, gain, offset, reach }: |e| [
    ("the number of terms", e.terms as u64, MAX_TERMS as u64),
]);

impl Expansion {
    /// Tiles of four channels that hold the terms' sines and cosines.
    #[must_use]
    pub fn tiles(&self) -> usize {
        self.terms.div_ceil(2)
    }
}

/// How a value v is stored: `v · scale + shift`. It is affine, so that means of
/// stored values are stored means.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Encoding {
    /// Factor.
    pub scale: f32,
    /// Added to the product.
    pub shift: f32,
}
uniforms!(Encoding { scale, shift });

impl Encoding {
    /// As it is.
    pub const PLAIN: Self = Self {
        scale: 1.0,
        shift: 0.0,
    };
    /// −1..=1 as 0..=1.
    pub const UNIT: Self = Self {
        scale: 0.5,
        shift: 0.5,
    };

    #[inline(always)]
    pub(crate) fn store<L: Lanes>(&self, v: F32<L>) -> F32<L> {
        v * self.scale + self.shift
    }

    #[inline(always)]
    pub(crate) fn read<L: Lanes>(&self, stored: F32<L>) -> F32<L> {
        (stored - self.shift) * (1.0 / self.scale)
    }
}

/// Square tiles in a texture, row by row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Atlas {
    /// Texels along a side of a tile, a power of two.
    pub side: u32,
    /// Tiles in a row.
    pub columns: u32,
    /// Rows.
    pub rows: u32,
}
uniforms!(Atlas {
    side,
    columns,
    rows
});

impl Atlas {
    /// Column and row of texels at which `tile` begins.
    #[must_use]
    #[inline(always)]
    pub fn origin(&self, tile: usize) -> [u32; 2] {
        let [column, row] = self.cell(tile);
        [column * self.side, row * self.side]
    }

    /// Column and row of a tile among tiles.
    #[must_use]
    #[inline(always)]
    pub fn cell(&self, tile: usize) -> [u32; 2] {
        let tile = tile as u32;
        [tile % self.columns, tile / self.columns]
    }

    /// Width and height in texels.
    #[must_use]
    #[inline(always)]
    pub fn size(&self) -> [u32; 2] {
        [self.columns * self.side, self.rows * self.side]
    }
}
