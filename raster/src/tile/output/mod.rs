//! Colour output: conversion, blending and the masked store (rules §7, Colour).
//!
//! A family of formats a file: `unorm` for bytes, `sint`, `float` for halves and single
//! floats. `blend` has what they share.

mod blend;
mod float;
mod sint;
mod unorm;

use fearless_simd::{Simd as _, SimdBase as _, SimdMask as _, mask8x64, u8x64};

use super::block::{self, Env, Place};
use super::config::TargetConfig;
use super::target::ColorTile;
use super::{COUNT, TileStageCounters};
use crate::format::Format;
use crate::shader::PacketOutput;
use crate::simd::{F32, LANES, Lanes, Mask, Mask16, U16, U32, each4, outlined};
use crate::texture::PACKETS;

/// Writes the outputs of the fragments of `live` to every colour target.
#[inline(always)]
pub(super) fn write<L: Lanes>(l: L, env: &mut Env<'_, '_>, place: Place, live: u64) {
    for (i, target) in env.config.targets.iter().enumerate() {
        if target.mask.0 == 0 {
            continue;
        }
        let mut w = Writer {
            l,
            target,
            attachment: i,
            constant: env.config.blend_constant,
            c: &mut *env.counters,
        };
        w.block(&mut env.target.color[i], place.index, env.outputs, live);
    }
}

struct Writer<'a, L> {
    l: L,
    target: &'a TargetConfig,
    attachment: usize,
    constant: [f32; 4],
    c: &'a mut TileStageCounters,
}

type Channels<T> = [T; 4];

/// Storage of a block, as the format says that it is; another kind is a fault of
/// whoever cut the tile.
macro_rules! stored {
    ($tile:expr, $kind:ident, $block:expr) => {
        match $tile {
            ColorTile::$kind(b) => &mut b[$block].0,
            _ => unreachable!("a tile is cut as its format is stored"),
        }
    };
}

/// Runs a format's writer in code of its own.
macro_rules! apart {
    ($self:ident.$write:ident($stored:expr, $out:expr, $live:expr)) => {{
        let stored = $stored;
        outlined(
            $self.l,
            #[inline(always)]
            || $self.$write(stored, $out, $live),
        )
    }};
}

impl<L: Lanes> Writer<'_, L> {
    /// Writes all live packets of a block, in code of its own for each family of formats.
    #[inline(always)]
    fn block(
        &mut self,
        tile: &mut ColorTile<'_>,
        block: usize,
        out: &[PacketOutput; PACKETS],
        live: u64,
    ) {
        if let Some(texel) = self.target.texel {
            return self.one_color(tile, block, texel, live);
        }
        match self.target.format {
            Format::R8Unorm => apart!(self.r8(stored!(tile, B8, block), out, live)),
            Format::Rg8Unorm => apart!(self.rg8(stored!(tile, B16, block), out, live)),
            Format::Rgba8Unorm => apart!(self.rgba8(stored!(tile, B32, block), out, live)),
            Format::R16Sint => apart!(self.sint16(stored!(tile, B16, block), out, live)),
            Format::R32Uint => apart!(self.uint32(stored!(tile, B32, block), out, live)),
            Format::R16Float => {
                let channels = core::slice::from_mut(stored!(tile, B16, block));
                apart!(self.halves(channels, out, live));
            }
            Format::Rgba16Float => apart!(self.halves(stored!(tile, B16x4, block), out, live)),
            Format::R32Float => {
                let channels = core::slice::from_mut(stored!(tile, B32, block));
                apart!(self.singles(channels, out, live));
            }
            Format::Rgba32Float => apart!(self.singles(stored!(tile, B32x4, block), out, live)),
            Format::Depth24Stencil8 | Format::Depth32FloatStencil8 => {
                unreachable!("no colour attachment holds depth")
            }
        }
    }

    /// The same texel everywhere, found once a draw.
    #[inline(always)]
    fn one_color(&mut self, tile: &mut ColorTile<'_>, block: usize, texel: [u32; 4], live: u64) {
        match tile {
            ColorTile::B8(b) => apart!(self.one_byte(&mut b[block].0, texel, live)),
            ColorTile::B16(b) => {
                let channels = core::slice::from_mut(&mut b[block].0);
                apart!(self.one_texel16(channels, texel, live));
            }
            ColorTile::B32(b) => apart!(self.one_word(&mut b[block].0, texel, live)),
            ColorTile::B16x4(b) => apart!(self.one_texel16(&mut b[block].0, texel, live)),
            ColorTile::B32x4(b) => apart!(self.one_texel32(&mut b[block].0, texel, live)),
        }
    }

    /// All four packets: a branch on which are live costs more.
    #[inline(always)]
    fn one_word(&mut self, block: &mut [u32; 64], texel: [u32; 4], live: u64) {
        let s = U32::splat(self.l, texel[0]);
        let op = self.target.bytewise;
        let same = each4(
            #[inline(always)]
            |k| {
                let (words, live) = (words(block, k), (live >> (16 * k)) as u16);
                match op {
                    Some(op) => self.rgba8_plain(words, s, op, live),
                    None => store32(s, words, live),
                }
            },
        );
        self.silent(&same);
    }

    #[inline(always)]
    fn one_byte(&mut self, block: &mut [u8; 64], texel: [u32; 4], live: u64) {
        let isa = self.l.isa();
        let (new, old) = (
            u8x64::splat(isa, texel[0] as u8),
            u8x64::from_slice(isa, block),
        );
        let mask = mask8x64::from_bitmask(isa, live);
        isa.select_u8x64(mask, new, old).store_slice(block);
        self.silent_bits(new.simd_eq(old).to_bitmask() & live);
    }

    #[inline(always)]
    fn one_texel16(&mut self, channels: &mut [[u16; 64]], texel: [u32; 4], live: u64) {
        let l = self.l;
        self.each_packet(
            live,
            #[inline(always)]
            |_, k, live| {
                let mut same = live;
                for c in 0..channels.len() {
                    let new = U16::splat(l, texel[c & 3] as u16);
                    same &= store16(new, words(&mut channels[c], k), live);
                }
                same
            },
        );
    }

    #[inline(always)]
    fn one_texel32(&mut self, channels: &mut [[u32; 64]; 4], texel: [u32; 4], live: u64) {
        let l = self.l;
        self.each_packet(
            live,
            #[inline(always)]
            |_, k, live| {
                let mut same = live;
                for c in 0..4 {
                    let new = U32::splat(l, texel[c]);
                    same &= store32(new, words(&mut channels[c], k), live).bits();
                }
                same
            },
        );
    }

    /// An integer's bits as they are, a float's with NaN made canonical.
    #[inline(always)]
    fn uint_bits(&mut self, src: F32<L>, integers: u16, live: u16) -> U32<L> {
        let nan = src.ne(src).bits() & !integers;
        if nan == 0 {
            return src.raw_bits();
        }
        if COUNT {
            self.c.events.nan_canonicalised += u64::from((nan & live).count_ones());
        }
        let integers = Mask::from_bits(self.l, integers);
        integers.select_u32(src.raw_bits(), src.to_bits())
    }

    /// R32Uint: the bits that the shader gave.
    #[inline(always)]
    fn uint32(&mut self, block: &mut [u32; 64], out: &[PacketOutput; PACKETS], live: u64) {
        self.each_packet(
            live,
            #[inline(always)]
            |w, k, live| {
                let src = F32::from_array(w.l, &out[k].color[w.attachment][0]);
                let bits = w.uint_bits(src, out[k].integers[w.attachment], live);
                store32(bits, words(block, k), live).bits()
            },
        );
    }

    /// `f` of each packet with live fragments gives the lanes that stay what they are.
    #[inline(always)]
    fn each_packet(&mut self, live: u64, mut f: impl FnMut(&mut Self, usize, u16) -> u16) {
        let mut same = 0;
        for k in 0..PACKETS {
            let live = (live >> (16 * k)) as u16;
            if live != 0 {
                same |= u64::from(f(self, k, live)) << (16 * k);
            }
        }
        self.silent_bits(same);
    }

    /// What the shader gave for this target.
    #[inline(always)]
    fn source(&self, out: &PacketOutput) -> Channels<F32<L>> {
        let color = &out.color[self.attachment];
        each4(
            #[inline(always)]
            |c| F32::from_array(self.l, &color[c]),
        )
    }

    /// Counts the fragments whose texel keeps its bits; once a block, since a counter
    /// in memory can be added to only every few cycles.
    #[inline(always)]
    fn silent(&mut self, same: &[Mask<L>; PACKETS]) {
        block::count_lanes(
            &mut self.c.events.silent_color_writes[self.attachment],
            same,
        );
    }

    /// The same, of bits.
    #[inline(always)]
    fn silent_bits(&mut self, same: u64) {
        block::count(
            &mut self.c.events.silent_color_writes[self.attachment],
            same,
        );
    }

    #[inline(always)]
    fn saturated(&mut self, lanes: u32) {
        if COUNT {
            self.c.events.blend_saturated[self.attachment] += u64::from(lanes);
        }
    }
}

/// Masked store of words; gives the lanes that stay what they are.
#[inline(always)]
fn store32<L: Lanes>(new: U32<L>, words: &mut [u32; LANES], live: u16) -> Mask<L> {
    let old = U32::from_array(new.l, words);
    let mask = Mask::from_bits(new.l, live);
    mask.select_u32(new, old).store(words);
    new.eq(old) & mask
}

/// As [`store32`], their bits.
#[inline(always)]
fn store16<L: Lanes>(new: U16<L>, words: &mut [u16; LANES], live: u16) -> u16 {
    let old = U16::from_array(new.l, words);
    let mask = Mask16::from_bits(new.l, live);
    mask.select(new, old).store(words);
    (new.eq(old) & mask).bits()
}

/// Packet `k` of a block's values.
#[inline(always)]
fn words<T>(block: &mut [T; 64], k: usize) -> &mut [T; LANES] {
    (&mut block[16 * k..16 * k + 16])
        .try_into()
        .expect("16 of 64")
}

/// As [`words`].
#[inline(always)]
fn words_of<T>(block: &[T; 64], k: usize) -> &[T; LANES] {
    block[16 * k..16 * k + 16].try_into().expect("16 of 64")
}
