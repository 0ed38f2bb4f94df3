//! Storage of one subresource: an aspect a plane, a plane in 8×8 blocks.

use super::Layout;
use crate::error::Error;
use crate::format::{Format, from_stored, to_stored};
use crate::memory::filled;

/// 64 values of one block, row by row; a cache line or more of its own.
#[derive(Clone, Copy)]
#[repr(C, align(64))]
pub(crate) struct Block<T>(pub(crate) [T; 64]);

/// Four channels of one block, each channel 64 values of its own.
#[derive(Clone, Copy)]
#[repr(C, align(64))]
pub(crate) struct Block4<T>(pub(crate) [[T; 64]; 4]);

/// Colour values, by the size of a texel.
#[derive(Clone)]
pub(crate) enum ColorBlocks {
    /// R8.
    B8(Vec<Block<u8>>),
    /// RG8 (red low), R16Sint, R16Float.
    B16(Vec<Block<u16>>),
    /// RGBA8 (red low), R32Float, R32Uint.
    B32(Vec<Block<u32>>),
    /// RGBA16Float.
    B16x4(Vec<Block4<u16>>),
    /// RGBA32Float.
    B32x4(Vec<Block4<u32>>),
}

/// Smallest and largest depth of the pixels of each block that lie in the image.
/// `min > max` says that a block's must be found again before use.
#[derive(Clone)]
pub(crate) struct HizPlane {
    pub(crate) min: Vec<i32>,
    pub(crate) max: Vec<i32>,
}

/// min and max of a block that must be found again.
pub(crate) const HIZ_STALE: [i32; 2] = [1, 0];

/// Depth and stencil of one subresource. Depth is kept as ordered non-negative
/// integers: the D24 value, or the bits of a float in 0..=1.
#[derive(Clone)]
pub(crate) struct DepthPlane {
    pub(crate) depth: Vec<Block<u32>>,
    pub(crate) stencil: Vec<Block<u8>>,
    pub(crate) hiz: HizPlane,
}

/// One subresource.
#[derive(Clone)]
pub(crate) enum Plane {
    Color(ColorBlocks),
    Depth(DepthPlane),
    /// Its storage is lent to a render pass that is being executed.
    Lent,
}

impl Plane {
    /// Zero colour, or depth 0 and stencil 0. `what` names it where memory is short.
    pub(crate) fn new(
        format: Format,
        layout: &Layout,
        what: impl Fn() -> String,
    ) -> Result<Self, Error> {
        let n = layout.blocks();
        Ok(match format {
            Format::Depth24Stencil8 | Format::Depth32FloatStencil8 => Self::Depth(DepthPlane {
                depth: filled(Block([0; 64]), n, &what)?,
                stencil: filled(Block([0; 64]), n, &what)?,
                hiz: HizPlane {
                    min: filled(0, n, &what)?,
                    max: filled(0, n, &what)?,
                },
            }),
            Format::R8Unorm => Self::Color(ColorBlocks::B8(filled(Block([0; 64]), n, what)?)),
            Format::Rg8Unorm | Format::R16Sint | Format::R16Float => {
                Self::Color(ColorBlocks::B16(filled(Block([0; 64]), n, what)?))
            }
            Format::Rgba8Unorm | Format::R32Float | Format::R32Uint => {
                Self::Color(ColorBlocks::B32(filled(Block([0; 64]), n, what)?))
            }
            Format::Rgba16Float => {
                Self::Color(ColorBlocks::B16x4(filled(Block4([[0; 64]; 4]), n, what)?))
            }
            Format::Rgba32Float => {
                Self::Color(ColorBlocks::B32x4(filled(Block4([[0; 64]; 4]), n, what)?))
            }
        })
    }
}

impl ColorBlocks {
    /// Raw channels of a texel; unused ones are 0.
    #[inline(always)]
    pub(crate) fn get(&self, format: Format, (b, i): (usize, usize)) -> [u32; 4] {
        let stored = match self {
            Self::B8(v) => [u32::from(v[b].0[i]), 0, 0, 0],
            Self::B16(v) => [u32::from(v[b].0[i]), 0, 0, 0],
            Self::B32(v) => [v[b].0[i], 0, 0, 0],
            Self::B16x4(v) => core::array::from_fn(|c| u32::from(v[b].0[c][i])),
            Self::B32x4(v) => core::array::from_fn(|c| v[b].0[c][i]),
        };
        from_stored(format, stored)
    }

    /// Stores raw channels.
    pub(crate) fn set(&mut self, format: Format, (b, i): (usize, usize), t: [u32; 4]) {
        let t = to_stored(format, t);
        match self {
            Self::B8(v) => v[b].0[i] = t[0] as u8,
            Self::B16(v) => v[b].0[i] = t[0] as u16,
            Self::B32(v) => v[b].0[i] = t[0],
            Self::B16x4(v) => (0..4).for_each(|c| v[b].0[c][i] = t[c] as u16),
            Self::B32x4(v) => (0..4).for_each(|c| v[b].0[c][i] = t[c]),
        }
    }
}
