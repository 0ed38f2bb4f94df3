//! Colour output: conversion, blending and the masked store (rules §7, Colour).

use fearless_simd::{Bytes as _, SimdBase as _, SimdInt as _, SimdMask as _, u8x64};

use super::block::{self, Env, Place};
use super::config::TargetConfig;
use super::target::ColorTile;
use super::{COUNT, TileStageCounters};
use crate::format::lanes::{float_from_half, half_from_float};
use crate::format::{self, Format};
use crate::shader::{PACKETS, PacketOutput};
use crate::simd::{F32, I32, LANES, Lanes, Mask, U32, each4, outlined};
use crate::state::{BlendComponent, BlendFactor, BlendOperation, BlendState, ColorWrites};

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
        let l = self.l;
        if let (Some(word), ColorTile::B32(b)) = (self.target.word, &mut *tile) {
            return outlined(
                l,
                #[inline(always)]
                || self.constant_words(&mut b[block].0, word, live),
            );
        }
        match (self.target.format, tile) {
            (Format::Rgba8Unorm, ColorTile::B32(b)) => outlined(
                l,
                #[inline(always)]
                || {
                    self.packets(
                        out,
                        live,
                        #[inline(always)]
                        |w, k, src, live| w.rgba8(words(&mut b[block].0, k), src, live),
                    );
                },
            ),
            (Format::R8Unorm | Format::Rg8Unorm, tile) => outlined(
                l,
                #[inline(always)]
                || {
                    self.packets(
                        out,
                        live,
                        #[inline(always)]
                        |w, k, src, live| w.unorm(tile, block, k, src, live),
                    );
                },
            ),
            (Format::R32Uint, ColorTile::B32(b)) => outlined(
                l,
                #[inline(always)]
                || {
                    self.packets(
                        out,
                        live,
                        #[inline(always)]
                        |w, k, src, live| {
                            w.store32(words(&mut b[block].0, k), src[0].to_bits(), live)
                        },
                    );
                },
            ),
            (Format::R16Sint, ColorTile::B16(b)) => outlined(
                l,
                #[inline(always)]
                || {
                    self.packets(
                        out,
                        live,
                        #[inline(always)]
                        |w, k, src, live| w.sint16(words(&mut b[block].0, k), src[0], live),
                    );
                },
            ),
            (_, tile) => outlined(
                l,
                #[inline(always)]
                || {
                    self.packets(
                        out,
                        live,
                        #[inline(always)]
                        |w, k, src, live| w.float(tile, block, k, src, live),
                    );
                },
            ),
        }
    }

    /// All four packets: a branch on which are live costs more.
    #[inline(always)]
    fn constant_words(&mut self, block: &mut [u32; 64], word: u32, live: u64) {
        let s = U32::splat(self.l, word);
        let op = self.target.blend.as_ref().and_then(BlendState::bytewise);
        let same = each4(
            #[inline(always)]
            |k| {
                let (words, live) = (words(block, k), (live >> (16 * k)) as u16);
                match op {
                    Some(op) => self.rgba8_plain(words, s, op, live),
                    None => self.store32(words, s, live),
                }
            },
        );
        self.silent(&same);
    }

    #[inline(always)]
    fn packets(
        &mut self,
        out: &[PacketOutput; PACKETS],
        live: u64,
        mut f: impl FnMut(&mut Self, usize, &Channels<F32<L>>, u16) -> Mask<L>,
    ) {
        let l = self.l;
        let same = each4(
            #[inline(always)]
            |k| {
                let live = (live >> (16 * k)) as u16;
                if live == 0 {
                    return Mask::from_bits(l, 0);
                }
                let color = &out[k].color[self.attachment];
                let src = each4(
                    #[inline(always)]
                    |c| F32::from_array(l, &color[c]),
                );
                f(self, k, &src, live)
            },
        );
        self.silent(&same);
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

    #[inline(always)]
    fn saturated(&mut self, lanes: u32) {
        if COUNT {
            self.c.events.blend_saturated[self.attachment] += u64::from(lanes);
        }
    }

    /// Masked store of whole words; gives the lanes that stay what they are.
    #[inline(always)]
    fn store32(&mut self, words: &mut [u32; LANES], new: U32<L>, live: u16) -> Mask<L> {
        let old = U32::from_array(self.l, words);
        let live = Mask::from_bits(self.l, live);
        live.select_u32(new, old).store(words);
        new.eq(old) & live
    }

    /// Source channels as bytes, limited and rounded half to even; counts what
    /// had to be limited.
    #[inline(always)]
    fn bytes(&mut self, src: &Channels<F32<L>>, live: u16) -> Channels<I32<L>> {
        if !F32::all_in_unit(src).bits() & live == 0 {
            // Nothing to limit; what lanes that are not live hold is of no account.
            return each4(
                #[inline(always)]
                |c| (src[c] * 255.0 + 8_388_608.0).to_bits().to_i32() & I32::splat(self.l, 0xff),
            );
        }
        let (zero, one) = (F32::splat(self.l, 0.0), F32::splat(self.l, 1.0));
        each4(
            #[inline(always)]
            |c| {
                let v = src[c];
                if COUNT && self.target.mask.contains(c) {
                    let fits = v.ge(zero) & v.le(one);
                    let beyond = !fits.bits() & live;
                    if beyond != 0 {
                        let e = &mut self.c.events;
                        e.source_clamped[self.attachment] += u64::from(beyond.count_ones());
                        e.nan_canonicalised += u64::from((v.ne(v).bits() & live).count_ones());
                    }
                }
                // Adding 2²³ rounds a float below 2²² to an integer, ties to even.
                let scaled = v.clamp(0.0, 1.0) * 255.0 + 8_388_608.0;
                scaled.to_bits().to_i32() & I32::splat(self.l, 0xff)
            },
        )
    }

    /// The same four in a word, red in the low byte.
    #[inline(always)]
    fn packed_bytes(&mut self, src: &Channels<F32<L>>, live: u16) -> U32<L> {
        if !F32::all_in_unit(src).bits() & live != 0 {
            return pack(&self.bytes(src, live));
        }
        // Rounded as in `bytes`. The bits above the byte are those of 2²³: shifts
        // throw them out, but for red's.
        let [r, g, b, a] = each4(
            #[inline(always)]
            |c| (src[c] * 255.0 + 8_388_608.0).to_bits(),
        );
        let red = r ^ U32::splat(self.l, 8_388_608f32.to_bits());
        (red | g << 8) | (b << 16 | a << 24)
    }

    #[inline(always)]
    fn rgba8(&mut self, words: &mut [u32; LANES], src: &Channels<F32<L>>, live: u16) -> Mask<L> {
        let l = self.l;
        if self.target.mask == ColorWrites::ALL {
            let plain = self.target.blend.as_ref().map(BlendState::bytewise);
            if plain != Some(None) {
                let s = self.packed_bytes(src, live);
                return match plain.flatten() {
                    Some(op) => self.rgba8_plain(words, s, op, live),
                    None => self.store32(words, s, live),
                };
            }
        }
        let s = self.bytes(src, live);
        let old = U32::from_array(l, words);
        let d: Channels<I32<L>> = each4(
            #[inline(always)]
            |c| (old >> (8 * c as u32)).to_i32() & I32::splat(l, 0xff),
        );
        let new = self.blend_bytes(&s, &d, true, live);
        let kept = each4(
            #[inline(always)]
            |c| {
                if self.target.mask.contains(c) {
                    new[c]
                } else {
                    d[c]
                }
            },
        );
        self.store32(words, pack(&kept), live)
    }

    /// Blending whose factors are all One, or that has none: byte arithmetic.
    #[inline(always)]
    fn rgba8_plain(
        &mut self,
        words: &mut [u32; LANES],
        s: U32<L>,
        op: BlendOperation,
        live: u16,
    ) -> Mask<L> {
        let old = U32::from_array(self.l, words);
        let (sb, db): (u8x64<L::Isa>, u8x64<L::Isa>) = (s.v.bitcast(), old.v.bitcast());
        let (new, wrapped) = match op {
            BlendOperation::Add => (sb.saturating_add(db), sb + db),
            BlendOperation::Subtract => (sb.saturating_sub(db), sb - db),
            BlendOperation::ReverseSubtract => (db.saturating_sub(sb), db - sb),
            BlendOperation::Min => (sb.min(db), sb.min(db)),
            BlendOperation::Max => (sb.max(db), sb.max(db)),
        };
        if COUNT && !matches!(op, BlendOperation::Min | BlendOperation::Max) {
            let limited = !new.simd_eq(wrapped).to_bitmask();
            if limited != 0 {
                self.saturated((limited & spread(live)).count_ones());
            }
        }
        self.store32(words, U32::new(self.l, new.bitcast()), live)
    }

    #[inline(always)]
    fn unorm(
        &mut self,
        tile: &mut ColorTile<'_>,
        block: usize,
        k: usize,
        src: &Channels<F32<L>>,
        live: u16,
    ) -> Mask<L> {
        let s = self.bytes(src, live);
        let at = 16 * k..16 * k + 16;
        let raw: [u32; LANES] = match &*tile {
            ColorTile::B8(b) => core::array::from_fn(|i| u32::from(b[block].0[16 * k + i])),
            ColorTile::B16(b) => core::array::from_fn(|i| u32::from(b[block].0[16 * k + i])),
            _ => unreachable!("R8 and RG8 only"),
        };
        let old = U32::from_array(self.l, &raw);
        let byte = I32::splat(self.l, 0xff);
        let zero = I32::splat(self.l, 0);
        let d = [
            old.to_i32() & byte,
            (old >> 8).to_i32() & byte,
            zero,
            I32::splat(self.l, 255),
        ];
        let new = if self.target.blend.is_some() {
            self.blend_bytes(&s, &d, false, live)
        } else {
            s
        };
        let kept: Channels<I32<L>> = each4(
            #[inline(always)]
            |c| match c {
                0 | 1 if self.target.mask.contains(c) => new[c],
                0 | 1 => d[c],
                _ => zero,
            },
        );
        let mut words = raw;
        let same = self.store32(&mut words, pack(&kept), live);
        match tile {
            ColorTile::B8(b) => b[block].0[at]
                .iter_mut()
                .zip(words)
                .for_each(|(b, w)| *b = w as u8),
            ColorTile::B16(b) => b[block].0[at]
                .iter_mut()
                .zip(words)
                .for_each(|(b, w)| *b = w as u16),
            _ => {}
        }
        same
    }

    /// The formulas of `state::blend`, channel by channel.
    #[inline(always)]
    fn blend_bytes(
        &mut self,
        s: &Channels<I32<L>>,
        d: &Channels<I32<L>>,
        has_alpha: bool,
        live: u16,
    ) -> Channels<I32<L>> {
        let Some(blend) = self.target.blend else {
            return *s;
        };
        let l = self.l;
        let constant = self.constant.map(|c| i32::from(format::unorm8_from_f32(c)));
        let d_alpha = if has_alpha { d[3] } else { I32::splat(l, 255) };
        each4(
            #[inline(always)]
            |c| {
                if !self.target.mask.contains(c) {
                    return d[c];
                }
                let b = if c < 3 { &blend.color } else { &blend.alpha };
                match b.operation {
                    BlendOperation::Min => return s[c].min(d[c]),
                    BlendOperation::Max => return s[c].max(d[c]),
                    _ => {}
                }
                let sf = s[c] * byte_factor(l, b.src_factor, c, s, d, d_alpha, constant);
                let df = d[c] * byte_factor(l, b.dst_factor, c, s, d, d_alpha, constant);
                let t = match b.operation {
                    BlendOperation::Subtract => sf - df,
                    BlendOperation::ReverseSubtract => df - sf,
                    _ => sf + df,
                };
                let (zero, top) = (I32::splat(l, 0), I32::splat(l, 255 * 255));
                let limited = (t.lt(zero) | t.gt(top)).bits() & live;
                self.saturated(limited.count_ones());
                let t = t.max(zero).min(top) + I32::splat(l, 128);
                (t + (t >> 8)) >> 8
            },
        )
    }

    /// R16Sint: exact, saturating; factors are One or Zero.
    #[inline(always)]
    fn sint16(&mut self, words: &mut [u16; LANES], src: F32<L>, live: u16) -> Mask<L> {
        let l = self.l;
        let rounded = src.round_ties_even();
        let (lo, hi) = (F32::splat(l, -32768.0), F32::splat(l, 32767.0));
        let beyond = !(rounded.ge(lo) & rounded.le(hi)).bits() & live;
        let e = &mut self.c.events;
        e.source_clamped[self.attachment] += u64::from(beyond.count_ones());
        e.nan_canonicalised += u64::from((src.ne(src).bits() & live).count_ones());
        // NaN goes to 0, as `as` does.
        let s = rounded
            .to_i32()
            .max(I32::splat(l, -32768))
            .min(I32::splat(l, 32767));
        let mut old = [0; LANES];
        for k in 0..LANES {
            old[k] = i32::from(words[k] as i16);
        }
        let d = I32::from_array(l, &old);
        let new = match self.target.blend {
            None => s,
            Some(b) => self.blend_sint16(&b.color, s, d, live),
        };
        let same = new.eq(d) & Mask::from_bits(l, live);
        for (i, (w, n)) in words.iter_mut().zip(new.to_array()).enumerate() {
            if live >> i & 1 != 0 {
                *w = n as u16;
            }
        }
        same
    }

    #[inline(always)]
    fn blend_sint16(&mut self, b: &BlendComponent, s: I32<L>, d: I32<L>, live: u16) -> I32<L> {
        let l = self.l;
        let zero = I32::splat(l, 0);
        let sf = if b.src_factor == BlendFactor::One {
            s
        } else {
            zero
        };
        let df = if b.dst_factor == BlendFactor::One {
            d
        } else {
            zero
        };
        let t = match b.operation {
            BlendOperation::Add => sf + df,
            BlendOperation::Subtract => sf - df,
            BlendOperation::ReverseSubtract => df - sf,
            BlendOperation::Min => return s.min(d),
            BlendOperation::Max => return s.max(d),
        };
        let (lo, hi) = (I32::splat(l, -32768), I32::splat(l, 32767));
        self.saturated(((t.lt(lo) | t.gt(hi)).bits() & live).count_ones());
        t.max(lo).min(hi)
    }

    /// Half and single floats.
    #[inline(always)]
    fn float(
        &mut self,
        tile: &mut ColorTile<'_>,
        block: usize,
        k: usize,
        src: &Channels<F32<L>>,
        live: u16,
    ) -> Mask<L> {
        let l = self.l;
        let format = self.target.format;
        let half = matches!(format, Format::R16Float | Format::Rgba16Float);
        let n = format.channels();
        let mut old = [[0u32; LANES]; 4];
        for (c, o) in old.iter_mut().enumerate().take(n) {
            load_channel(tile, block, k, c, o);
        }
        let d: Channels<F32<L>> = each4(
            #[inline(always)]
            |c| match half {
                true => float_from_half(U32::from_array(l, &old[c])),
                false => U32::from_array(l, &old[c]).to_f32_bits(),
            },
        );
        let d_alpha = if n == 4 { d[3] } else { F32::splat(l, 1.0) };
        let lanes = Mask::from_bits(l, live);
        let mut same = lanes;
        for c in 0..n {
            if !self.target.mask.contains(c) {
                continue;
            }
            let v = match self.target.blend {
                None => src[c],
                Some(b) => blend_float(
                    l,
                    if c < 3 { &b.color } else { &b.alpha },
                    c,
                    src,
                    &d,
                    d_alpha,
                    self.constant,
                ),
            };
            let nan = v.ne(v).bits() & live;
            self.c.events.nan_canonicalised += u64::from(nan.count_ones());
            let v = v.canonical_nan();
            let new = if half {
                half_from_float(v)
            } else {
                v.to_bits()
            };
            let was = U32::from_array(l, &old[c]);
            same = same & new.eq(was);
            store_channel(tile, block, k, c, &lanes.select_u32(new, was).to_array());
        }
        same
    }
}

/// Packet `k` of a block's values.
#[inline(always)]
fn words<T>(block: &mut [T; 64], k: usize) -> &mut [T; LANES] {
    (&mut block[16 * k..16 * k + 16])
        .try_into()
        .expect("16 of 64")
}

/// Red in the low byte.
#[inline(always)]
fn pack<L: Lanes>(c: &Channels<I32<L>>) -> U32<L> {
    ((c[0] | c[1] << 8) | (c[2] << 16 | c[3] << 24)).to_u32()
}

/// Every bit four times.
#[inline(always)]
fn spread(lanes: u16) -> u64 {
    let mut v = u64::from(lanes);
    v = (v | v << 24) & 0x0000_00ff_0000_00ff;
    v = (v | v << 12) & 0x000f_000f_000f_000f;
    v = (v | v << 6) & 0x0303_0303_0303_0303;
    v = (v | v << 3) & 0x1111_1111_1111_1111;
    v * 15
}

#[inline(always)]
fn byte_factor<L: Lanes>(
    l: L,
    f: BlendFactor,
    c: usize,
    s: &Channels<I32<L>>,
    d: &Channels<I32<L>>,
    d_alpha: I32<L>,
    constant: [i32; 4],
) -> I32<L> {
    let full = I32::splat(l, 255);
    match f {
        BlendFactor::Zero => I32::splat(l, 0),
        BlendFactor::One => full,
        BlendFactor::Src => s[c],
        BlendFactor::OneMinusSrc => full - s[c],
        BlendFactor::SrcAlpha => s[3],
        BlendFactor::OneMinusSrcAlpha => full - s[3],
        BlendFactor::Dst => d[c],
        BlendFactor::OneMinusDst => full - d[c],
        BlendFactor::DstAlpha => d_alpha,
        BlendFactor::OneMinusDstAlpha => full - d_alpha,
        BlendFactor::SrcAlphaSaturated if c == 3 => full,
        BlendFactor::SrcAlphaSaturated => s[3].min(full - d_alpha),
        BlendFactor::Constant => I32::splat(l, constant[c]),
        BlendFactor::OneMinusConstant => I32::splat(l, 255 - constant[c]),
    }
}

#[inline(always)]
fn blend_float<L: Lanes>(
    l: L,
    b: &BlendComponent,
    c: usize,
    s: &Channels<F32<L>>,
    d: &Channels<F32<L>>,
    d_alpha: F32<L>,
    constant: [f32; 4],
) -> F32<L> {
    let sf = float_factor(l, b.src_factor, c, s, d, d_alpha, constant);
    let df = float_factor(l, b.dst_factor, c, s, d, d_alpha, constant);
    match b.operation {
        BlendOperation::Add => s[c] * sf + d[c] * df,
        BlendOperation::Subtract => s[c] * sf - d[c] * df,
        BlendOperation::ReverseSubtract => d[c] * df - s[c] * sf,
        BlendOperation::Min => s[c].min(d[c]),
        BlendOperation::Max => s[c].max(d[c]),
    }
}

#[inline(always)]
fn float_factor<L: Lanes>(
    l: L,
    f: BlendFactor,
    c: usize,
    s: &Channels<F32<L>>,
    d: &Channels<F32<L>>,
    d_alpha: F32<L>,
    constant: [f32; 4],
) -> F32<L> {
    let one = F32::splat(l, 1.0);
    match f {
        BlendFactor::Zero => F32::splat(l, 0.0),
        BlendFactor::One => one,
        BlendFactor::Src => s[c],
        BlendFactor::OneMinusSrc => one - s[c],
        BlendFactor::SrcAlpha => s[3],
        BlendFactor::OneMinusSrcAlpha => one - s[3],
        BlendFactor::Dst => d[c],
        BlendFactor::OneMinusDst => one - d[c],
        BlendFactor::DstAlpha => d_alpha,
        BlendFactor::OneMinusDstAlpha => one - d_alpha,
        BlendFactor::SrcAlphaSaturated if c == 3 => one,
        BlendFactor::SrcAlphaSaturated => s[3].min(one - d_alpha),
        BlendFactor::Constant => F32::splat(l, constant[c]),
        BlendFactor::OneMinusConstant => one - F32::splat(l, constant[c]),
    }
}

#[inline(always)]
fn load_channel(tile: &ColorTile<'_>, block: usize, k: usize, c: usize, out: &mut [u32; LANES]) {
    match tile {
        ColorTile::B16(b) => widen(&b[block].0, k, out),
        ColorTile::B32(b) => out.copy_from_slice(&b[block].0[16 * k..16 * k + 16]),
        ColorTile::B16x4(b) => widen(&b[block].0[c], k, out),
        ColorTile::B32x4(b) => out.copy_from_slice(&b[block].0[c][16 * k..16 * k + 16]),
        ColorTile::B8(_) => unreachable!("no float format has one byte"),
    }
}

#[inline(always)]
fn store_channel(tile: &mut ColorTile<'_>, block: usize, k: usize, c: usize, v: &[u32; LANES]) {
    match tile {
        ColorTile::B16(b) => narrow(v, words(&mut b[block].0, k)),
        ColorTile::B32(b) => b[block].0[16 * k..16 * k + 16].copy_from_slice(v),
        ColorTile::B16x4(b) => narrow(v, words(&mut b[block].0[c], k)),
        ColorTile::B32x4(b) => b[block].0[c][16 * k..16 * k + 16].copy_from_slice(v),
        ColorTile::B8(_) => unreachable!("no float format has one byte"),
    }
}

// Indices rather than iterators, which are calls of their own in the code of a wide
// level.

#[inline(always)]
fn widen(block: &[u16; 64], k: usize, out: &mut [u32; LANES]) {
    let words: &[u16; LANES] = block[16 * k..16 * k + 16].try_into().expect("16 of 64");
    for i in 0..LANES {
        out[i] = u32::from(words[i]);
    }
}

#[inline(always)]
fn narrow(v: &[u32; LANES], words: &mut [u16; LANES]) {
    for i in 0..LANES {
        words[i] = v[i] as u16;
    }
}
