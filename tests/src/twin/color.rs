//! Colour output and blending (rules, §7 "Colour").

use gnomon_raster::state::{
    BlendComponent, BlendFactor, BlendOperation, BlendState, ColorTargetState,
};
use gnomon_raster::{EventCounters, Format};

use super::convert::{div255_round, f16_bits, f16_value, f32_bits, sint16, unorm8};
use super::image::channels;

/// One colour attachment as a fragment meets it.
pub(super) struct Target<'a> {
    pub(super) attachment: usize,
    pub(super) format: Format,
    pub(super) state: &'a ColorTargetState,
    pub(super) constant: [f32; 4],
}

impl Target<'_> {
    /// Channels of the format that may be written.
    fn written(&self) -> Vec<usize> {
        (0..channels(self.format))
            .filter(|c| self.state.write_mask.0 >> c & 1 == 1)
            .collect()
    }

    pub(super) fn is_skipped(&self) -> bool {
        self.written().is_empty()
    }

    /// Whether a write needs the old texel.
    pub(super) fn reads(&self) -> bool {
        let written = self.written();
        let blends = |&c: &usize| {
            self.state
                .blend
                .is_some_and(|b| uses_destination(component(&b, c)))
        };
        written.len() < channels(self.format) || written.iter().any(blends)
    }

    /// The texel after a fragment's colour.
    pub(super) fn output(
        &self,
        old: [u32; 4],
        src: [f32; 4],
        integer: bool,
        e: &mut EventCounters,
    ) -> [u32; 4] {
        let mut new = old;
        for c in self.written() {
            new[c] = match self.format {
                Format::R8Unorm | Format::Rg8Unorm | Format::Rgba8Unorm => {
                    self.unorm(c, old, src, e)
                }
                Format::R16Sint => self.sint(old[0], src[0], e),
                Format::R32Uint if integer => src[0].to_bits(),
                Format::R32Uint => {
                    e.nan_canonicalised += u64::from(src[0].is_nan());
                    f32_bits(src[0])
                }
                _ => self.float(c, old, src, e),
            };
        }
        new
    }

    fn unorm(&self, c: usize, old: [u32; 4], src: [f32; 4], e: &mut EventCounters) -> u32 {
        e.nan_canonicalised += u64::from(src[c].is_nan());
        e.source_clamped[self.attachment] += u64::from(!(0.0..=1.0).contains(&src[c]));
        let s = src.map(unorm8);
        let Some(b) = self.state.blend else {
            return s[c];
        };
        let d = if channels(self.format) < 4 {
            [old[0], old[1], old[2], 255]
        } else {
            old
        };
        let k = self.constant.map(unorm8);
        let b = component(&b, c);
        let f = byte_factor(b.src_factor, c, s, d, k) * s[c];
        let g = byte_factor(b.dst_factor, c, s, d, k) * d[c];
        let (f, g) = (i64::from(f), i64::from(g));
        let sum = match b.operation {
            BlendOperation::Add => f + g,
            BlendOperation::Subtract => f - g,
            BlendOperation::ReverseSubtract => g - f,
            BlendOperation::Min => return s[c].min(d[c]),
            BlendOperation::Max => return s[c].max(d[c]),
        };
        let limited = sum.clamp(0, 255 * 255);
        e.blend_saturated[self.attachment] += u64::from(limited != sum);
        div255_round(limited as u32)
    }

    fn sint(&self, old: u32, src: f32, e: &mut EventCounters) -> u32 {
        let (s, out_of_range) = sint16(src);
        e.nan_canonicalised += u64::from(src.is_nan());
        e.source_clamped[self.attachment] += u64::from(out_of_range);
        let d = i32::from(old as u16 as i16);
        let r = match self.state.blend {
            None => s,
            Some(b) => {
                let f = if b.color.src_factor == BlendFactor::Zero {
                    0
                } else {
                    s
                };
                let g = if b.color.dst_factor == BlendFactor::Zero {
                    0
                } else {
                    d
                };
                match b.color.operation {
                    BlendOperation::Add => f + g,
                    BlendOperation::Subtract => f - g,
                    BlendOperation::ReverseSubtract => g - f,
                    BlendOperation::Min => s.min(d),
                    BlendOperation::Max => s.max(d),
                }
            }
        };
        let limited = r.clamp(-32768, 32767);
        e.blend_saturated[self.attachment] += u64::from(limited != r);
        u32::from(limited as i16 as u16)
    }

    fn float(&self, c: usize, old: [u32; 4], src: [f32; 4], e: &mut EventCounters) -> u32 {
        let half = matches!(self.format, Format::R16Float | Format::Rgba16Float);
        let mut d = old.map(|b| {
            if half {
                f16_value(b)
            } else {
                f32::from_bits(b)
            }
        });
        if channels(self.format) < 4 {
            d[3] = 1.0;
        }
        let v = match self.state.blend {
            None => src[c],
            Some(b) => blend_float(component(&b, c), c, src, d, self.constant),
        };
        e.nan_canonicalised += u64::from(v.is_nan());
        if half { f16_bits(v) } else { f32_bits(v) }
    }
}

fn component(b: &BlendState, c: usize) -> BlendComponent {
    if c == 3 { b.alpha } else { b.color }
}

fn uses_destination(b: BlendComponent) -> bool {
    use BlendFactor::{Dst, DstAlpha, OneMinusDst, OneMinusDstAlpha, SrcAlphaSaturated, Zero};
    matches!(b.operation, BlendOperation::Min | BlendOperation::Max)
        || b.dst_factor != Zero
        || matches!(
            b.src_factor,
            Dst | DstAlpha | OneMinusDst | OneMinusDstAlpha | SrcAlphaSaturated
        )
}

fn byte_factor(f: BlendFactor, c: usize, s: [u32; 4], d: [u32; 4], k: [u32; 4]) -> u32 {
    match f {
        BlendFactor::Zero => 0,
        BlendFactor::One => 255,
        BlendFactor::Src => s[c],
        BlendFactor::OneMinusSrc => 255 - s[c],
        BlendFactor::SrcAlpha => s[3],
        BlendFactor::OneMinusSrcAlpha => 255 - s[3],
        BlendFactor::Dst => d[c],
        BlendFactor::OneMinusDst => 255 - d[c],
        BlendFactor::DstAlpha => d[3],
        BlendFactor::OneMinusDstAlpha => 255 - d[3],
        BlendFactor::SrcAlphaSaturated if c == 3 => 255,
        BlendFactor::SrcAlphaSaturated => s[3].min(255 - d[3]),
        BlendFactor::Constant => k[c],
        BlendFactor::OneMinusConstant => 255 - k[c],
    }
}

fn blend_float(b: BlendComponent, c: usize, s: [f32; 4], d: [f32; 4], k: [f32; 4]) -> f32 {
    let f = s[c] * float_factor(b.src_factor, c, s, d, k);
    let g = d[c] * float_factor(b.dst_factor, c, s, d, k);
    match b.operation {
        BlendOperation::Add => f + g,
        BlendOperation::Subtract => f - g,
        BlendOperation::ReverseSubtract => g - f,
        BlendOperation::Min => {
            if s[c] < d[c] {
                s[c]
            } else {
                d[c]
            }
        }
        BlendOperation::Max => {
            if s[c] > d[c] {
                s[c]
            } else {
                d[c]
            }
        }
    }
}

fn float_factor(f: BlendFactor, c: usize, s: [f32; 4], d: [f32; 4], k: [f32; 4]) -> f32 {
    match f {
        BlendFactor::Zero => 0.0,
        BlendFactor::One => 1.0,
        BlendFactor::Src => s[c],
        BlendFactor::OneMinusSrc => 1.0 - s[c],
        BlendFactor::SrcAlpha => s[3],
        BlendFactor::OneMinusSrcAlpha => 1.0 - s[3],
        BlendFactor::Dst => d[c],
        BlendFactor::OneMinusDst => 1.0 - d[c],
        BlendFactor::DstAlpha => d[3],
        BlendFactor::OneMinusDstAlpha => 1.0 - d[3],
        BlendFactor::SrcAlphaSaturated if c == 3 => 1.0,
        BlendFactor::SrcAlphaSaturated => {
            let rest = 1.0 - d[3];
            if s[3] < rest { s[3] } else { rest }
        }
        BlendFactor::Constant => k[c],
        BlendFactor::OneMinusConstant => 1.0 - k[c],
    }
}
