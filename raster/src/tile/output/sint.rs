//! R16Sint: exact, saturating; factors are One or Zero.

use super::Writer;
use crate::format::lanes::sint16_from_float;
use crate::shader::PacketOutput;
use crate::simd::{F32, I32, LANES, Lanes, U16};
use crate::state::{BlendComponent, BlendFactor};
use crate::texture::PACKETS;
use crate::tile::COUNT;

impl<L: Lanes> Writer<'_, L> {
    #[inline(always)]
    pub(super) fn sint16(
        &mut self,
        block: &mut [u16; 64],
        out: &[PacketOutput; PACKETS],
        live: u64,
    ) {
        self.each_packet(
            live,
            #[inline(always)]
            |w, k, live| {
                let src = F32::from_array(w.l, &out[k].color[w.attachment][0]);
                w.sint16_packet(super::words(block, k), src, live)
            },
        );
    }

    #[inline(always)]
    fn sint16_packet(&mut self, words: &mut [u16; LANES], src: F32<L>, live: u16) -> u16 {
        let (s, fits) = sint16_from_float(src);
        let beyond = !fits.bits() & live;
        if COUNT && beyond != 0 {
            let e = &mut self.c.events;
            e.source_clamped[self.attachment] += u64::from(beyond.count_ones());
            e.nan_canonicalised += u64::from((src.ne(src).bits() & live).count_ones());
        }
        let new = match &self.target.blend {
            None => s,
            Some(b) => {
                let d = U16::from_array(self.l, words).widen();
                self.blend_sint16(&b.color, s, (d << 16).to_i32() >> 16, live)
            }
        };
        super::store16(new.narrow(), words, live)
    }

    #[inline(always)]
    fn blend_sint16(&mut self, b: &BlendComponent, s: I32<L>, d: I32<L>, live: u16) -> I32<L> {
        let l = self.l;
        if b.is_extreme() {
            return super::blend::combine(b.operation, [s, d]);
        }
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
        let t = super::blend::combine(b.operation, [sf, df]);
        let (lo, hi) = (I32::splat(l, -32768), I32::splat(l, 32767));
        self.saturated(((t.lt(lo) | t.gt(hi)).bits() & live).count_ones());
        t.max(lo).min(hi)
    }
}
