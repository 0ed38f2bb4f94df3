//! The fragment stage over lanes.

use crate::counters::COUNT;
use crate::depth_plane::ShaderDepth;
use crate::sampling::{BoundTexture, TexelLog};
use crate::simd::{F32, I32, LANES, Lanes, Mask, U32};
use crate::texture::PACKETS;
use crate::{MAX_COLOR_ATTACHMENTS, MAX_SHADER_COUNTS, MAX_TEXTURES, MAX_VARYINGS};

/// What a fragment shader may do; the tests that run before it depend on this.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct FragmentOutputs {
    /// It may discard fragments. Depth and stencil *writes* then wait for it.
    pub discards: bool,
    /// It writes depth. All tests then come after it, and block culling is off.
    pub depth: bool,
    /// Texture slots that it reads: `0..textures`.
    pub textures: usize,
    /// Names of what it counts with [`Fragment::count`]; at most
    /// [`MAX_SHADER_COUNTS`](crate::MAX_SHADER_COUNTS).
    pub counts: &'static [&'static str],
}

/// Computes colours, 16 fragments (an 8×2 strip, whole quads) at a time.
pub trait FragmentShader: Send + Sync {
    /// What the shader may do beyond writing colours.
    fn outputs(&self) -> FragmentOutputs {
        FragmentOutputs::default()
    }

    /// The colour of attachment 0, where every fragment has the same and nothing else
    /// is written: the shader then need not be run, though its invocations count.
    /// Must be what [`Self::shade`] sets.
    fn constant(&self) -> Option<[f32; 4]> {
        None
    }

    /// Shades a packet of fragments. Mark it `#[inline(always)]`, and everything
    /// it calls.
    fn shade<L: Lanes>(&self, l: L, fragment: &mut Fragment<'_, L>);
}

/// `base + gx·ix + gy·iy` of each varying over one 8×8 block; index
/// [`MAX_VARYINGS`] is 1/w.
#[derive(Clone, Default)]
pub(crate) struct VaryingPlanes {
    pub(crate) base: [f32; MAX_VARYINGS + 1],
    pub(crate) gx: [f32; MAX_VARYINGS + 1],
    pub(crate) gy: [f32; MAX_VARYINGS + 1],
    /// Bit i: varying i is divided by w.
    pub(crate) perspective: u32,
}

impl VaryingPlanes {
    /// Varying `i` at one pixel of the block, as [`Fragment::varying`] gives it.
    pub(crate) fn at(&self, i: usize, column: u32, row: u32) -> f32 {
        let plane =
            |i: usize| (self.base[i] + column as f32 * self.gx[i]) + row as f32 * self.gy[i];
        if self.perspective >> i & 1 != 0 {
            plane(i) * (1.0 / plane(MAX_VARYINGS))
        } else {
            plane(i)
        }
    }
}

/// What the fragments of a packet computed.
#[derive(Clone)]
#[repr(C, align(64))]
pub(crate) struct PacketOutput {
    pub(crate) color: [[[f32; LANES]; 4]; MAX_COLOR_ATTACHMENTS],
    pub(crate) depth: [f32; LANES],
    /// Lanes that were discarded.
    pub(crate) discarded: u16,
    /// Lanes whose colour is the bits of an integer, by attachment.
    pub(crate) integers: [u16; MAX_COLOR_ATTACHMENTS],
}

impl PacketOutput {
    pub(crate) const EMPTY: Self = Self {
        color: [[[0.0; LANES]; 4]; MAX_COLOR_ATTACHMENTS],
        depth: [0.0; LANES],
        discarded: 0,
        integers: [0; MAX_COLOR_ATTACHMENTS],
    };
}

/// Texture traffic of a shader, by slot, and what it counts itself.
#[derive(Clone, Debug, Default)]
pub(crate) struct ShaderEvents {
    /// Texture look-ups of live lanes.
    pub(crate) fetches: [u64; MAX_TEXTURES],
    /// Texels that those look-ups read.
    pub(crate) texels: [u64; MAX_TEXTURES],
    /// In the order of [`FragmentOutputs::counts`].
    pub(crate) counts: [u64; MAX_SHADER_COUNTS],
}

/// In [`Fragment::set`].
const DEPTH_SET: u32 = 1 << 31;

/// One 8×8 block for a fragment shader.
pub(crate) struct ShadeBlock<'a> {
    /// Top-left pixel.
    pub(crate) x: u32,
    pub(crate) y: u32,
    /// Bit `8·row + column`: the fragment is to be shaded.
    pub(crate) live: u64,
    pub(crate) planes: &'a VaryingPlanes,
    /// How many of the planes mean something.
    pub(crate) varyings: usize,
    /// Depth of the block's fragments.
    pub(crate) depth: ShaderDepth,
    pub(crate) front_facing: bool,
    pub(crate) primitive: u32,
    pub(crate) textures: &'a [BoundTexture<'a>],
    pub(crate) out: &'a mut [PacketOutput; PACKETS],
    /// How many colour attachments there are.
    pub(crate) attachments: usize,
    pub(crate) writes_depth: bool,
    pub(crate) events: &'a mut ShaderEvents,
    /// Where counted reads of texels are taken down, if somebody asks for them.
    pub(crate) log: Option<&'a mut TexelLog>,
}

/// Inputs and outputs of 16 fragments.
pub struct Fragment<'a, L: Lanes> {
    pub(super) l: L,
    pub(super) x: u32,
    pub(super) y: u32,
    pub(super) live: u16,
    pub(super) planes: &'a VaryingPlanes,
    pub(super) varyings: usize,
    pub(super) w: F32<L>,
    pub(super) depth: ShaderDepth,
    pub(super) front_facing: bool,
    pub(super) primitive: u32,
    pub(crate) textures: &'a [BoundTexture<'a>],
    pub(super) out: &'a mut PacketOutput,
    /// Bit i: colour attachment i is set; bit 31: depth is.
    pub(super) set: u32,
    pub(crate) events: &'a mut ShaderEvents,
    pub(super) log: Option<&'a mut TexelLog>,
}

/// Columns and rows of the lanes of a packet.
const IX: [f32; LANES] = [
    0., 1., 2., 3., 4., 5., 6., 7., 0., 1., 2., 3., 4., 5., 6., 7.,
];
const IY: [f32; LANES] = [
    0., 0., 0., 0., 0., 0., 0., 0., 1., 1., 1., 1., 1., 1., 1., 1.,
];

impl<'a, L: Lanes> Fragment<'a, L> {
    #[cfg_attr(not(gnomon_unoptimised), inline(always))]
    pub(super) fn new(l: L, b: &'a mut ShadeBlock<'_>, packet: usize) -> Fragment<'a, L> {
        let live = (b.live >> (16 * packet)) as u16;
        let out = &mut b.out[packet];
        out.discarded = 0;
        let mut f = Fragment {
            l,
            x: b.x,
            y: b.y + 2 * packet as u32,
            live,
            planes: b.planes,
            varyings: b.varyings,
            w: F32::splat(l, 1.0),
            depth: b.depth,
            front_facing: b.front_facing,
            primitive: b.primitive,
            textures: b.textures,
            out,
            set: 0,
            events: b.events,
            log: b.log.as_deref_mut(),
        };
        if b.planes.perspective != 0 {
            f.w = f.plane(MAX_VARYINGS).recip();
        }
        f
    }

    /// `fl(fl(base + fl(gx·ix)) + fl(gy·iy))`.
    #[cfg_attr(not(gnomon_unoptimised), inline(always))]
    fn plane(&self, i: usize) -> F32<L> {
        let row = F32::splat(self.l, (self.y % 8) as f32) + F32::from_array(self.l, &IY);
        let along = F32::from_array(self.l, &IX) * self.planes.gx[i];
        let down = row * self.planes.gy[i];
        (F32::splat(self.l, self.planes.base[i]) + along) + down
    }

    /// The level's token.
    #[cfg_attr(not(gnomon_unoptimised), inline(always))]
    pub fn lanes(&self) -> L {
        self.l
    }

    /// Varying `i`, interpolated as the vertex shader declared; 0 beyond.
    #[cfg_attr(not(gnomon_unoptimised), inline(always))]
    pub fn varying(&self, i: usize) -> F32<L> {
        if i >= self.varyings {
            return F32::splat(self.l, 0.0);
        }
        let v = self.plane(i);
        if self.planes.perspective >> i & 1 != 0 {
            v * self.w
        } else {
            v
        }
    }

    /// Clip-space w of each fragment; 1 where no varying is interpolated with perspective.
    #[cfg_attr(not(gnomon_unoptimised), inline(always))]
    pub fn w(&self) -> F32<L> {
        self.w
    }

    /// Pixel centres, x to the right.
    #[cfg_attr(not(gnomon_unoptimised), inline(always))]
    pub fn x(&self) -> F32<L> {
        F32::from_array(self.l, &IX) + (self.x as f32 + 0.5)
    }

    /// Pixel centres, y downwards.
    #[cfg_attr(not(gnomon_unoptimised), inline(always))]
    pub fn y(&self) -> F32<L> {
        F32::from_array(self.l, &IY) + (self.y as f32 + 0.5)
    }

    /// Fragment depth in 0..=1.
    #[cfg_attr(not(gnomon_unoptimised), inline(always))]
    pub fn depth(&self) -> F32<L> {
        self.depth.packet(self.l, (self.y % 8 / 2) as usize)
    }

    /// Whether the primitive faces the viewer.
    #[cfg_attr(not(gnomon_unoptimised), inline(always))]
    pub fn front_facing(&self) -> bool {
        self.front_facing
    }

    /// Number of the primitive in its draw.
    #[cfg_attr(not(gnomon_unoptimised), inline(always))]
    pub fn primitive_index(&self) -> u32 {
        self.primitive
    }

    /// Lanes that are fragments; the others are helpers for derivatives.
    #[cfg_attr(not(gnomon_unoptimised), inline(always))]
    pub fn live(&self) -> Mask<L> {
        Mask::from_bits(self.l, self.live)
    }

    /// Lanes whose texture look-ups are counted: live and not discarded so far.
    #[cfg_attr(not(gnomon_unoptimised), inline(always))]
    pub(crate) fn counted_lanes(&self) -> u16 {
        self.live & !self.out.discarded
    }

    /// Outputs that the shader left alone are 0, whatever an earlier one computed.
    #[cfg_attr(not(gnomon_unoptimised), inline(always))]
    pub(super) fn finish(&mut self, attachments: usize, depth: bool) {
        let zero = F32::splat(self.l, 0.0);
        for i in 0..attachments {
            if self.set >> i & 1 == 0 {
                self.set_color(i, [zero; 4]);
            }
        }
        if depth && self.set & DEPTH_SET == 0 {
            self.set_depth(zero);
        }
    }

    /// Sets all four channels of colour attachment `i`; those that are never set are 0.
    #[cfg_attr(not(gnomon_unoptimised), inline(always))]
    pub fn set_color(&mut self, i: usize, rgba: [F32<L>; 4]) {
        self.set |= 1 << (i & 15);
        if let Some(c) = self.out.color.get_mut(i) {
            for (slot, v) in c.iter_mut().zip(rgba) {
                v.store(slot);
            }
            self.out.integers[i] = 0;
        }
    }

    /// Sets the value of an `R32Uint` colour attachment, to the bit.
    /// ([`Fragment::set_color`] gives such an attachment the bits of the first channel,
    /// of a NaN the canonical ones.)
    #[cfg_attr(not(gnomon_unoptimised), inline(always))]
    pub fn set_color_uint(&mut self, i: usize, v: U32<L>) {
        let bits = v.to_f32_bits();
        self.set_color(i, [bits; 4]);
        if let Some(lanes) = self.out.integers.get_mut(i) {
            *lanes = u16::MAX;
        }
    }

    /// Sets the depth; only where the shader declared it. It is 0 otherwise.
    #[cfg_attr(not(gnomon_unoptimised), inline(always))]
    pub fn set_depth(&mut self, depth: F32<L>) {
        self.set |= DEPTH_SET;
        depth.store(&mut self.out.depth);
    }

    /// Discards the lanes of the mask; only where the shader declared it.
    #[cfg_attr(not(gnomon_unoptimised), inline(always))]
    pub fn discard(&mut self, mask: Mask<L>) {
        self.out.discarded |= mask.bits();
    }

    /// Adds the fragments among `lanes` to the count number `i` of those declared;
    /// a count beyond [`MAX_SHADER_COUNTS`](crate::MAX_SHADER_COUNTS) is none.
    #[cfg_attr(not(gnomon_unoptimised), inline(always))]
    pub fn count(&mut self, i: usize, lanes: Mask<L>) {
        if COUNT && let Some(n) = self.events.counts.get_mut(i) {
            *n += u64::from((lanes.bits() & self.live).count_ones());
        }
    }

    /// Column and row of the 8×8 block of pixels that the packet lies in.
    #[cfg_attr(not(gnomon_unoptimised), inline(always))]
    pub fn block(&self) -> [u32; 2] {
        [self.x / 8, self.y / 8]
    }

    /// Integer pixel column of each lane.
    #[cfg_attr(not(gnomon_unoptimised), inline(always))]
    pub fn column(&self) -> I32<L> {
        I32::splat(self.l, self.x as i32)
            + I32::from_array(self.l, &[0, 1, 2, 3, 4, 5, 6, 7, 0, 1, 2, 3, 4, 5, 6, 7])
    }

    /// Integer pixel row of each lane.
    #[cfg_attr(not(gnomon_unoptimised), inline(always))]
    pub fn row(&self) -> I32<L> {
        I32::splat(self.l, self.y as i32)
            + I32::from_array(self.l, &[0, 0, 0, 0, 0, 0, 0, 0, 1, 1, 1, 1, 1, 1, 1, 1])
    }
}
