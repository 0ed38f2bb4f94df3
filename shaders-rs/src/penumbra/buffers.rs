//! Passes over whole buffers that paper II needs, and boundaries without wedges.

use gnomon_raster::shader::{Fragment, FragmentOutputs, FragmentShader};
use gnomon_raster::{F32, I32, Lanes, U32, uniforms};

use super::{FULL, stored_depth};

/// The greatest (attachment 0) and, where there is an attachment 1, the least
/// depth of the surfaces of each tile; one fragment a tile. Texture 0 is depth.
///
/// Pixels without surface (depth 1) are left out, or one of them would stretch
/// its tile to infinity. Tiles without any have the greatest depth -1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TileDepths {
    /// log2 of a tile's side in pixels.
    pub shift: u32,
    /// Width and height of the image in pixels.
    pub size: [u32; 2],
}
uniforms!(TileDepths { shift, size });

impl FragmentShader for TileDepths {
    fn outputs(&self) -> FragmentOutputs {
        FragmentOutputs {
            textures: 1,
            ..FragmentOutputs::default()
        }
    }

    #[inline(always)]
    fn shade<L: Lanes>(&self, l: L, f: &mut Fragment<'_, L>) {
        let (column, row) = (f.column() << self.shift, f.row() << self.shift);
        let one = F32::splat(l, 1.0);
        let (mut greatest, mut least) = (F32::splat(l, -1.0), F32::splat(l, 2.0));
        let side = 1i32 << self.shift;
        let [width, height] = self.size.map(|s| s as i32);
        for dy in 0..side.min(height) {
            let y = row + I32::splat(l, dy);
            for dx in 0..side.min(width) {
                let x = column + I32::splat(l, dx);
                let [depth, ..] = f.fetch_texel(0, [x, y, I32::splat(l, 0)], 0);
                let inside = x.lt(I32::splat(l, width)) & y.lt(I32::splat(l, height));
                let surface = inside & depth.lt(one);
                greatest = surface.select_f32(greatest.max(depth), greatest);
                least = surface.select_f32(least.min(depth), least);
            }
        }
        let zero = F32::splat(l, 0.0);
        f.set_color(0, [greatest, zero, zero, zero]);
        f.set_color(1, [least, zero, zero, zero]);
    }
}

/// Depth (texture 0) into attachment 0: to be read while it is attached.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct DepthCopy;
uniforms!(DepthCopy);

impl FragmentShader for DepthCopy {
    fn outputs(&self) -> FragmentOutputs {
        FragmentOutputs {
            textures: 1,
            ..FragmentOutputs::default()
        }
    }

    #[inline(always)]
    fn shade<L: Lanes>(&self, l: L, f: &mut Fragment<'_, L>) {
        let zero = F32::splat(l, 0.0);
        let depth = stored_depth(l, f, 0);
        f.set_color(0, [depth, zero, zero, zero]);
    }
}

/// A piece of the umbra's boundary that the depth test alone counts: `front` on
/// front faces, `-front` on back faces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Boundary {
    /// -255 where it lies before the surface, 255 where beyond.
    pub front: f32,
}
uniforms!(Boundary { front });

impl FragmentShader for Boundary {
    #[inline(always)]
    fn shade<L: Lanes>(&self, l: L, f: &mut Fragment<'_, L>) {
        let value = if f.front_facing() {
            self.front
        } else {
            -self.front
        };
        let zero = F32::splat(l, 0.0);
        f.set_color(0, [F32::splat(l, value), zero, zero, zero]);
    }
}

/// 255 times the stencil counts, as signed bytes, of all depth-stencil textures
/// bound (paper II, §6.1: the three-pass algorithm's 8-bit stencil).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StencilCounts {
    /// Number of depth-stencil textures, in slots from 0.
    pub textures: usize,
}
uniforms!(StencilCounts { textures });

impl FragmentShader for StencilCounts {
    fn outputs(&self) -> FragmentOutputs {
        FragmentOutputs {
            textures: self.textures,
            ..FragmentOutputs::default()
        }
    }

    #[inline(always)]
    fn shade<L: Lanes>(&self, l: L, f: &mut Fragment<'_, L>) {
        let at = [f.column(), f.row(), I32::splat(l, 0)];
        let mut sum = F32::splat(l, 0.0);
        for slot in 0..self.textures {
            sum = sum + signed(f.fetch_stencil(slot, at, 0)).to_f32();
        }
        let zero = F32::splat(l, 0.0);
        f.set_color(0, [sum * FULL, zero, zero, zero]);
    }
}

/// A byte as a signed one.
#[inline(always)]
fn signed<L: Lanes>(byte: U32<L>) -> I32<L> {
    (byte.to_i32() << 24) >> 24
}
