//! Half and single floats, a channel after the other.

use super::Writer;
use super::blend::{Operands, combine, weigh};
use crate::format::lanes::{float_or_nan_from_half, half_from_float};
use crate::shader::PacketOutput;
use crate::simd::{F32, LANES, Lanes, U16, U32};
use crate::texture::PACKETS;
use crate::tile::COUNT;

/// How floats are stored.
trait Stored: Copy {
    fn load<L: Lanes>(l: L, words: &[Self; LANES]) -> F32<L>;

    /// Stores the lanes of `live`; gives those whose bits stay what they are.
    fn store<L: Lanes>(v: F32<L>, words: &mut [Self; LANES], live: u16) -> u16;
}

impl Stored for u16 {
    #[inline(always)]
    fn load<L: Lanes>(l: L, words: &[u16; LANES]) -> F32<L> {
        float_or_nan_from_half(U16::from_array(l, words))
    }

    #[inline(always)]
    fn store<L: Lanes>(v: F32<L>, words: &mut [u16; LANES], live: u16) -> u16 {
        super::store16(half_from_float(v), words, live)
    }
}

impl Stored for u32 {
    #[inline(always)]
    fn load<L: Lanes>(l: L, words: &[u32; LANES]) -> F32<L> {
        U32::from_array(l, words).to_f32_bits()
    }

    #[inline(always)]
    fn store<L: Lanes>(v: F32<L>, words: &mut [u32; LANES], live: u16) -> u16 {
        super::store32(v.canonical_nan().raw_bits(), words, live).bits()
    }
}

impl<L: Lanes> Writer<'_, L> {
    /// A block of halves.
    #[inline(always)]
    pub(super) fn halves(
        &mut self,
        channels: &mut [[u16; 64]],
        out: &[PacketOutput; PACKETS],
        live: u64,
    ) {
        self.floats(channels, out, live);
    }

    /// A block of single floats.
    #[inline(always)]
    pub(super) fn singles(
        &mut self,
        channels: &mut [[u32; 64]],
        out: &[PacketOutput; PACKETS],
        live: u64,
    ) {
        self.floats(channels, out, live);
    }

    #[inline(always)]
    fn floats<T: Stored>(
        &mut self,
        channels: &mut [[T; 64]],
        out: &[PacketOutput; PACKETS],
        live: u64,
    ) {
        self.each_packet(
            live,
            #[inline(always)]
            |w, k, live| {
                let src = &out[k].color[w.attachment];
                let mut same = live;
                for c in 0..channels.len() {
                    if w.target.mask.contains(c) {
                        same &= w.float_channel(channels, k, c, src, live);
                    }
                }
                same
            },
        );
    }

    /// Channel `c` of packet `k`; gives the lanes that stay what they are.
    #[inline(always)]
    fn float_channel<T: Stored>(
        &mut self,
        channels: &mut [[T; 64]],
        k: usize,
        c: usize,
        src: &[[f32; LANES]; 4],
        live: u16,
    ) -> u16 {
        let v = self.blend_float(channels, k, c, src);
        if COUNT {
            let nan = v.ne(v).bits() & live;
            if nan != 0 {
                self.c.events.nan_canonicalised += u64::from(nan.count_ones());
            }
        }
        T::store(v, super::words(&mut channels[c], k), live)
    }

    #[inline(always)]
    fn blend_float<T: Stored>(
        &self,
        channels: &[[T; 64]],
        k: usize,
        c: usize,
        src: &[[f32; LANES]; 4],
    ) -> F32<L> {
        let l = self.l;
        let s = F32::from_array(l, &src[c]);
        let Some(blend) = &self.target.blend else {
            return s;
        };
        let b = blend.component(c);
        let d = T::load(l, super::words_of(&channels[c], k));
        if b.is_plain() {
            return combine(b.operation, [s, d]);
        }
        let operands = Operands {
            channel: c,
            src: s,
            dst: d,
            src_alpha: F32::from_array(l, &src[3]),
            constant: F32::splat(l, self.constant[c]),
        };
        let weighed = weigh(
            l,
            b,
            &operands,
            // Alpha is written last: it still is what it was.
            #[inline(always)]
            || match channels.get(3) {
                Some(alpha) => T::load(l, super::words_of(alpha, k)),
                None => F32::splat(l, 1.0),
            },
        );
        combine(b.operation, weighed)
    }
}
