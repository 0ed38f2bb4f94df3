//! 8-bit buffers and a hard count in the stencil become visibility (paper IV, §4.3), and
//! what several silhouettes hide is combined (§5.1), all of it in bytes.
//!
//! What groups of silhouettes hide, and how much of the light is seen, are whole
//! numbers of [`UNITS`], 16 to each of the 4095 steps of coverage. So sums and half ways
//! are exact; only the paper's rule, which halves again and again, is rounded. Two bytes
//! hold one, and three the sum over the parts of a light.

use gnomon_raster::shader::{Fragment, FragmentOutputs, FragmentShader};
use gnomon_raster::simd::each4;
use gnomon_raster::{F32, I32, Lanes, uniforms};

use super::FULL;
use crate::soft_volumes::{own_texels, reads, texel_of};
use crate::surface::two_bytes;

/// What all of the light is stored as.
pub const UNITS: f32 = 16.0 * FULL;
/// Bits of the stencil that hold the hard count; the eighth notes wedges.
pub const COUNT_BITS: u8 = 0x7f;
/// Hard counts above are those below 0: -8 to -1, by the rounding of quads that meet.
pub const MOST_COUNTED: u8 = 119;

/// How groups of silhouettes are combined.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Combination {
    /// The sum of what they hide, at most all.
    Sum,
    /// `max + min / 2`, group after group (paper IV, eq. 1), at most all.
    Paper,
    /// Half way from the largest to the sum, whatever the order.
    Bounded,
}
uniforms!(enum Combination { 0: Sum, 1: Paper, 2: Bounded });

/// What is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ResolveTo {
    /// What groups hide so far, for the next one: two bytes each for the paper's total
    /// or the largest, and for the sum.
    Groups,
    /// Visibility of the light's parts so far, for the next one: three bytes.
    Parts,
    /// Visibility of the light, whose parts are so many: two bytes.
    Bytes(u32),
    /// The same in every channel.
    Share(u32),
}
uniforms!(enum ResolveTo { 0: Groups, 1: Parts, 2: Bytes(parts), 3: Share(parts) });

/// The end of a group of silhouettes. Textures: the additive and the subtractive buffer,
/// depth-stencil; then the groups before, if it is `continued`; then the light's parts
/// before, if it is `added`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ResolveSplit {
    /// The rule.
    pub rule: Combination,
    /// There are groups before.
    pub continued: bool,
    /// There are parts of the light before.
    pub added: bool,
    /// What is written.
    pub to: ResolveTo,
}
uniforms!(ResolveSplit {
    rule,
    continued,
    added,
    to
});

impl FragmentShader for ResolveSplit {
    fn outputs(&self) -> FragmentOutputs {
        reads(3 + usize::from(self.continued) + usize::from(self.added))
    }

    #[inline(always)]
    fn shade<L: Lanes>(&self, l: L, f: &mut Fragment<'_, L>) {
        let hidden = hidden_by_group(l, f);
        let at = [f.column(), f.row(), I32::splat(l, 0)];
        let zero = F32::splat(l, 0.0);
        let mut before = [zero; 2];
        if self.continued {
            let [a, b, c, d] = texel_of(l, f, 3, at);
            before = [two_bytes(a, b), two_bytes(c, d)];
        }
        let groups = self.with_group(l, before, hidden);
        if self.to == ResolveTo::Groups {
            let [[a, b], [c, d]] = [bytes_of(groups[0]), bytes_of(groups[1])];
            f.set_color(0, [a, b, c, d]);
            return;
        }
        let mut seen = F32::splat(l, UNITS) - self.hidden_by_all(groups);
        if self.added {
            let [a, b, c, _] = texel_of(l, f, 3 + usize::from(self.continued), at);
            seen = seen + ((a * 255.0).round_ties_even() * 65536.0 + two_bytes(b, c));
        }
        f.set_color(0, self.stored(l, seen));
    }
}

/// What the group in the buffers hides: the hard count less what was added and more
/// what was taken, within 0 and all.
#[inline(always)]
fn hidden_by_group<L: Lanes>(l: L, f: &mut Fragment<'_, L>) -> F32<L> {
    let [added, taken] = own_texels(l, f, 2);
    let at = [f.column(), f.row(), I32::splat(l, 0)];
    let counted = f.fetch_stencil(2, at, 0).to_i32() & I32::splat(l, i32::from(COUNT_BITS));
    let counted = counted.to_f32();
    let wrapped = counted.gt(F32::splat(l, f32::from(MOST_COUNTED)));
    let count = wrapped.select_f32(counted - 128.0, counted);
    let difference = each4(
        #[inline(always)]
        |i| ((added[i] - taken[i]) * 255.0).round_ties_even(),
    );
    let [a, b, c, d] = difference;
    let whole = a + (b + (c + d * 8.0) * 8.0) * 8.0;
    (count * FULL - whole).clamp(0.0, FULL) * 16.0
}

/// A whole number below 65,536 as two channels, the high byte first.
#[inline(always)]
fn bytes_of<L: Lanes>(v: F32<L>) -> [F32<L>; 2] {
    let high = (v / 256.0).floor();
    [high / 255.0, (v - high * 256.0) / 255.0]
}

impl ResolveSplit {
    /// The paper's total or the largest, and the sum.
    #[inline(always)]
    fn with_group<L: Lanes>(&self, l: L, [first, sum]: [F32<L>; 2], hidden: F32<L>) -> [F32<L>; 2] {
        let all = F32::splat(l, UNITS);
        let larger = first.max(hidden);
        let first = if self.rule == Combination::Paper {
            let smaller = first.min(hidden);
            (larger + smaller * 0.5).round_ties_even().min(all)
        } else {
            larger
        };
        [first, (sum + hidden).min(all)]
    }

    #[inline(always)]
    fn hidden_by_all<L: Lanes>(&self, [first, sum]: [F32<L>; 2]) -> F32<L> {
        match self.rule {
            Combination::Sum => sum,
            Combination::Paper => first,
            Combination::Bounded => (first + sum) * 0.5,
        }
    }

    #[inline(always)]
    fn stored<L: Lanes>(&self, l: L, seen: F32<L>) -> [F32<L>; 4] {
        let (zero, one) = (F32::splat(l, 0.0), F32::splat(l, 1.0));
        match self.to {
            ResolveTo::Groups | ResolveTo::Parts => {
                let high = (seen / 65536.0).floor();
                let [b, c] = bytes_of(seen - high * 65536.0);
                [high / 255.0, b, c, one]
            }
            ResolveTo::Bytes(parts) => {
                let [a, b] = bytes_of((seen / parts as f32).round_ties_even());
                [a, b, zero, one]
            }
            ResolveTo::Share(parts) => [seen / (parts as f32 * UNITS); 4],
        }
    }
}
