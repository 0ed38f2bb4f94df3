//! Reading texels: gathers, one lane at a time, and decoding, over lanes.

use super::SlotLog;
use crate::format::lanes::Words;
use crate::simd::{I32, LANES, Lanes};
use crate::texture::{BLOCK, Block, Block4, ColorBlocks, Plane, Texture};

/// Which texel each lane reads.
pub(super) struct Texels<'a> {
    pub(super) mip: u32,
    /// Slices or faces.
    pub(super) layer: &'a [i32; LANES],
    /// Index of the texel in its layer's storage ([`Layout::locate_lanes`]).
    ///
    /// [`Layout::locate_lanes`]: crate::texture::Layout::locate_lanes
    pub(super) at: &'a [u32; LANES],
    /// Lanes that read; the indices of the others may be anything.
    pub(super) lanes: u16,
}

/// Which part of a texture is read.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Aspect {
    /// Colour, or depth.
    Main,
    /// Stencil.
    Stencil,
}

/// Where [`gather`] puts them: 256 bytes, filled in place.
pub(crate) const NO_WORDS: Words = [[0; LANES]; 4];

/// Puts the stored bits of texels into `words`, which hold zeros; lanes that do not
/// read are left alone. It does not depend on the instruction set. Counted reads are
/// logged, if somebody listens.
pub(super) fn gather(
    texture: &Texture,
    aspect: Aspect,
    t: &Texels<'_>,
    log: Option<&mut SlotLog<'_>>,
    words: &mut Words,
) {
    if let Some(log) = log {
        log.add(t);
    }
    let planes = &texture.planes[t.mip as usize];
    let mut rest = t.lanes;
    while rest != 0 {
        let layer = t.layer[rest.trailing_zeros() as usize];
        let same = if planes.len() == 1 {
            rest
        } else {
            rest & same_layer(t.layer, layer)
        };
        let source = Source {
            at: t.at,
            lanes: same,
        };
        source.take_plane(&planes[layer as usize], aspect, words);
        rest &= !same;
    }
}

fn same_layer(layers: &[i32; LANES], layer: i32) -> u16 {
    layers
        .iter()
        .rev()
        .fold(0, |m, l| m << 1 | u16::from(*l == layer))
}

/// The lanes that read from one plane.
struct Source<'a> {
    at: &'a [u32; LANES],
    lanes: u16,
}

impl Source<'_> {
    fn take_plane(&self, plane: &Plane, aspect: Aspect, words: &mut Words) {
        match plane {
            Plane::Color(ColorBlocks::B8(v)) => self.take(v, &mut words[0]),
            Plane::Color(ColorBlocks::B16(v)) => self.take(v, &mut words[0]),
            Plane::Color(ColorBlocks::B32(v)) => self.take(v, &mut words[0]),
            Plane::Color(ColorBlocks::B16x4(v)) => self.take_four(v, words),
            Plane::Color(ColorBlocks::B32x4(v)) => self.take_four(v, words),
            Plane::Depth(d) if aspect == Aspect::Stencil => self.take(&d.stencil, &mut words[0]),
            Plane::Depth(d) => self.take(&d.depth, &mut words[0]),
            Plane::Lent => {}
        }
    }

    /// Block, and place in it.
    #[inline(always)]
    fn place(&self, lane: usize) -> (usize, usize) {
        let at = self.at[lane] as usize;
        (at / TEXELS, at % TEXELS)
    }

    #[inline(always)]
    fn take<T: Copy + Into<u32>>(&self, blocks: &[Block<T>], out: &mut [u32; LANES]) {
        if let Some((b, i)) = self.run() {
            copy(&blocks[b].0, i, out);
            return;
        }
        if self.lanes == u16::MAX {
            for (lane, out) in out.iter_mut().enumerate() {
                let (b, i) = self.place(lane);
                *out = blocks[b].0[i].into();
            }
            return;
        }
        for lane in lanes_of(self.lanes) {
            let (b, i) = self.place(lane);
            out[lane] = blocks[b].0[i].into();
        }
    }

    #[inline(always)]
    fn take_four<T: Copy + Into<u32>>(&self, blocks: &[Block4<T>], words: &mut Words) {
        let [w0, w1, w2, w3] = words;
        if let Some((b, i)) = self.run() {
            let [c0, c1, c2, c3] = &blocks[b].0;
            copy(c0, i, w0);
            copy(c1, i, w1);
            copy(c2, i, w2);
            copy(c3, i, w3);
            return;
        }
        for lane in lanes_of(self.lanes) {
            let (b, i) = self.place(lane);
            let [c0, c1, c2, c3] = &blocks[b].0;
            w0[lane] = c0[i].into();
            w1[lane] = c1[i].into();
            w2[lane] = c2[i].into();
            w3[lane] = c3[i].into();
        }
    }

    /// Where texels start that lie one behind the other in a block, as those of a
    /// packet of fragments that each read their own pixel.
    #[inline(always)]
    fn run(&self) -> Option<(usize, usize)> {
        let first = self.at[0];
        let mut off = first % LANES as u32;
        for lane in 0..LANES {
            off |= self.at[lane].wrapping_sub(first) ^ lane as u32;
        }
        (self.lanes == u16::MAX && off == 0).then(|| self.place(0))
    }
}

/// Texels of a block.
const TEXELS: usize = (BLOCK * BLOCK) as usize;

/// As many words as there are lanes, from `first` on.
#[inline(always)]
fn copy<T: Copy + Into<u32>>(channel: &[T], first: usize, out: &mut [u32; LANES]) {
    let run = channel.get(first..first + LANES);
    let Some(Ok(run)) = run.map(<&[T; LANES]>::try_from) else {
        return;
    };
    for k in 0..LANES {
        out[k] = run[k].into();
    }
}

/// The lanes of a mask, ascending.
fn lanes_of(mut mask: u16) -> impl Iterator<Item = usize> {
    core::iter::from_fn(move || {
        let lane = mask.trailing_zeros() as usize;
        mask &= mask.wrapping_sub(1);
        (lane < LANES).then_some(lane)
    })
}

/// Lane indices, each limited to an axis of `size`, and which were inside.
#[inline(always)]
pub(super) fn inside<L: Lanes>(i: I32<L>, size: u32) -> u16 {
    let l = i.l;
    (i.ge(I32::splat(l, 0)) & i.lt(I32::splat(l, size as i32))).bits()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::format::Format;
    use crate::texture::TextureDescriptor;

    /// Packets that read their own pixels take whole runs; the same words as lane
    /// by lane, wherever the packet is and whichever lanes read.
    #[test]
    fn runs_are_read_like_single_texels() {
        for format in [Format::R32Float, Format::Rgba8Unorm, Format::Rgba32Float] {
            let desc = TextureDescriptor::d2("numbered", format, 40, 24);
            let mut texture = Texture::new(&desc).unwrap();
            let texel = |k: u32| [0.0, 0.25, 0.5, 0.75].map(|c| (c + k as f32) / 1024.0);
            let texels: Vec<_> = (0..40 * 24).map(texel).collect();
            texture.write_color(Default::default(), &texels).unwrap();
            let gather_at = |x: &[i32; LANES], y: &[i32; LANES], lanes| {
                let layout = &texture.layouts[0];
                let at = core::array::from_fn(|k| {
                    let (block, place) = layout.locate(x[k] as u32, y[k] as u32);
                    (block * TEXELS + place) as u32
                });
                let texels = Texels {
                    mip: 0,
                    layer: &[0; LANES],
                    at: &at,
                    lanes,
                };
                let mut words = NO_WORDS;
                gather(&texture, Aspect::Main, &texels, None, &mut words);
                words
            };
            for (x0, y0) in [(0, 0), (8, 2), (32, 22), (3, 2), (8, 5), (24, 16)] {
                let x = core::array::from_fn(|k| x0 + k as i32 % 8);
                let y = core::array::from_fn(|k| y0 + k as i32 / 8);
                let turned = core::array::from_fn(|k| y0 + (k as i32 / 8 + 1) % 2);
                for (x, y) in [(&x, &y), (&x, &turned)] {
                    let got = gather_at(x, y, u16::MAX);
                    for lane in 0..LANES {
                        let one = gather_at(x, y, 1 << lane);
                        for (got, one) in got.iter().zip(&one) {
                            assert_eq!(got[lane], one[lane], "{format:?} {x0} {y0} {lane}");
                        }
                    }
                }
            }
        }
    }
}
