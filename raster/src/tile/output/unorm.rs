//! 8-bit unorm: integer arithmetic, all bytes of a texel at once where blending has no
//! factors.

use fearless_simd::{Bytes as _, SimdBase as _, SimdInt as _, SimdMask as _, u8x64};

use super::blend::{Operands, combine, weigh};
use super::{Channels, Writer, store32};
use crate::format::lanes::unorm8_from_unit;
use crate::format::unorm8_from_f32;
use crate::shader::PacketOutput;
use crate::simd::{F32, I32, LANES, Lanes, Mask, U16, U32, each4};
use crate::state::{BlendOperation, ColorWrites};
use crate::texture::PACKETS;
use crate::tile::COUNT;

/// How texels of one or two bytes are stored.
trait Narrow: Copy {
    fn load<L: Lanes>(l: L, words: &[Self; LANES]) -> U32<L>;
    fn store<L: Lanes>(v: U32<L>, words: &mut [Self; LANES]);
}

impl Narrow for u8 {
    #[inline(always)]
    fn load<L: Lanes>(l: L, words: &[u8; LANES]) -> U32<L> {
        U32::from_bytes(l, words)
    }

    #[inline(always)]
    fn store<L: Lanes>(v: U32<L>, words: &mut [u8; LANES]) {
        v.store_bytes(words);
    }
}

impl Narrow for u16 {
    #[inline(always)]
    fn load<L: Lanes>(l: L, words: &[u16; LANES]) -> U32<L> {
        U16::from_array(l, words).widen()
    }

    #[inline(always)]
    fn store<L: Lanes>(v: U32<L>, words: &mut [u16; LANES]) {
        v.truncate().store(words);
    }
}

impl<L: Lanes> Writer<'_, L> {
    /// A block of RGBA8.
    #[inline(always)]
    pub(super) fn rgba8(
        &mut self,
        block: &mut [u32; 64],
        out: &[PacketOutput; PACKETS],
        live: u64,
    ) {
        let same = each4(
            #[inline(always)]
            |k| {
                let live = (live >> (16 * k)) as u16;
                if live == 0 {
                    return Mask::from_bits(self.l, 0);
                }
                let src = self.source(&out[k]);
                self.rgba8_packet(super::words(block, k), &src, live)
            },
        );
        self.silent(&same);
    }

    /// A block of R8.
    #[inline(always)]
    pub(super) fn r8(&mut self, block: &mut [u8; 64], out: &[PacketOutput; PACKETS], live: u64) {
        self.narrow(block, out, live);
    }

    /// A block of RG8.
    #[inline(always)]
    pub(super) fn rg8(&mut self, block: &mut [u16; 64], out: &[PacketOutput; PACKETS], live: u64) {
        self.narrow(block, out, live);
    }

    #[inline(always)]
    fn narrow<T: Narrow>(&mut self, block: &mut [T; 64], out: &[PacketOutput; PACKETS], live: u64) {
        self.each_packet(
            live,
            #[inline(always)]
            |w, k, live| {
                let src = w.source(&out[k]);
                let words = super::words(block, k);
                let old = T::load(w.l, words);
                let new = w.narrow_texels(old, &src, live);
                let mask = Mask::from_bits(w.l, live);
                T::store(mask.select_u32(new, old), words);
                (new.eq(old) & mask).bits()
            },
        );
    }

    /// Texels of at most two channels after their fragments.
    #[inline(always)]
    fn narrow_texels(&mut self, old: U32<L>, src: &Channels<F32<L>>, live: u16) -> U32<L> {
        let (zero, byte) = (I32::splat(self.l, 0), I32::splat(self.l, 0xff));
        let s = self.bytes(src, live);
        let d = [old.to_i32() & byte, (old >> 8).to_i32() & byte, zero, byte];
        let new = self.blend_bytes(&s, &d, false, live);
        let mask = self.target.mask;
        let r = if mask.contains(0) { new[0] } else { d[0] };
        let g = if mask.contains(1) { new[1] } else { d[1] };
        (r | g << 8).to_u32()
    }

    /// Source channels as bytes, limited and rounded half to even; counts what
    /// had to be limited.
    #[inline(always)]
    fn bytes(&mut self, src: &Channels<F32<L>>, live: u16) -> Channels<I32<L>> {
        if !F32::all_in_unit(src).bits() & live == 0 {
            // Nothing to limit; what lanes that are not live hold is of no account.
            return each4(
                #[inline(always)]
                |c| unorm8_from_unit(src[c]),
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
                unorm8_from_unit(v.clamp(0.0, 1.0))
            },
        )
    }

    /// The same four in a word, red in the low byte.
    #[inline(always)]
    fn packed_bytes(&mut self, src: &Channels<F32<L>>, live: u16) -> U32<L> {
        if !F32::all_in_unit(src).bits() & live != 0 {
            return pack(&self.bytes(src, live));
        }
        // Rounded as `unorm8_from_unit` does. The bits above the byte are those of 2²³: shifts
        // throw them out, but for red's.
        let [r, g, b, a] = each4(
            #[inline(always)]
            |c| (src[c] * 255.0 + 8_388_608.0).raw_bits(),
        );
        let red = r ^ U32::splat(self.l, 8_388_608f32.to_bits());
        (red | g << 8) | (b << 16 | a << 24)
    }

    #[inline(always)]
    fn rgba8_packet(
        &mut self,
        words: &mut [u32; LANES],
        src: &Channels<F32<L>>,
        live: u16,
    ) -> Mask<L> {
        let l = self.l;
        if self.target.mask == ColorWrites::ALL {
            let op = self.target.bytewise;
            if op.is_some() || self.target.blend.is_none() {
                let s = self.packed_bytes(src, live);
                return match op {
                    Some(op) => self.rgba8_plain(words, s, op, live),
                    None => store32(s, words, live),
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
        store32(pack(&kept), words, live)
    }

    /// Blending whose factors are all One, or that has none: byte arithmetic.
    #[inline(always)]
    pub(super) fn rgba8_plain(
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
        store32(U32::new(self.l, new.bitcast()), words, live)
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
        let Some(blend) = &self.target.blend else {
            return *s;
        };
        let l = self.l;
        let dst_alpha = if has_alpha { d[3] } else { I32::splat(l, 255) };
        each4(
            #[inline(always)]
            |c| {
                if !self.target.mask.contains(c) {
                    return d[c];
                }
                let b = blend.component(c);
                let operands = Operands {
                    channel: c,
                    src: s[c],
                    dst: d[c],
                    src_alpha: s[3],
                    constant: I32::splat(l, i32::from(unorm8_from_f32(self.constant[c]))),
                };
                let weighed = weigh(
                    l,
                    b,
                    &operands,
                    #[inline(always)]
                    || dst_alpha,
                );
                let t = combine(b.operation, weighed);
                if b.is_extreme() {
                    return t;
                }
                let (zero, top) = (I32::splat(l, 0), I32::splat(l, 255 * 255));
                let limited = (t.lt(zero) | t.gt(top)).bits() & live;
                self.saturated(limited.count_ones());
                let t = t.max(zero).min(top) + I32::splat(l, 128);
                (t + (t >> 8)) >> 8
            },
        )
    }
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
