//! Paper III's own buffers (§4): visibility in floats without blending, and in 8 bits,
//! coverage in red and green and the umbra in the stencil.

use gnomon_raster::shader::{Fragment, FragmentOutputs, FragmentShader};
use gnomon_raster::{F32, I32, Lanes, uniforms};

use crate::soft_volumes::{SIX_BITS, own_texels, reads, receiver, umbra_side_of};

/// Which hard shadow quads lie between the eye and a surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum QuadTest {
    /// Those whose plane has them on different sides.
    Sides,
    /// Those that are drawn: a depth test has left out the others (§3.2.1).
    Depth,
}
uniforms!(enum QuadTest { 0: Sides, 1: Depth });

/// Counts hard shadow quads into a float: -1 for entering the umbra, 1 for leaving it.
/// Varyings are those of [`crate::soft_volumes::HardQuads`], texture 0 positions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct QuadCount {
    /// The light's origin, as [`crate::coverage::Projector::origin`].
    pub origin: [f32; 3],
    /// Which quads count.
    pub test: QuadTest,
    /// On top of the visibility in texture 1, since floats are not blended (§4.1); else
    /// to be added.
    pub copied: bool,
}
uniforms!(QuadCount {
    origin,
    test,
    copied
});

impl FragmentShader for QuadCount {
    fn outputs(&self) -> FragmentOutputs {
        reads(if self.copied { 2 } else { 1 })
    }

    #[inline(always)]
    fn shade<L: Lanes>(&self, l: L, f: &mut Fragment<'_, L>) {
        let [position, before] = own_texels(l, f, self.outputs().textures);
        let (from, shadowable) = receiver(l, position, self.origin);
        let (zero, one) = (F32::splat(l, 0.0), F32::splat(l, 1.0));
        let eye_inside = f.varying(3);
        let entered = match self.test {
            QuadTest::Sides => umbra_side_of(l, f, from).select_f32(one, zero) - eye_inside,
            QuadTest::Depth => one - eye_inside * 2.0,
        };
        let v = shadowable.select_f32(zero - entered, zero);
        if self.copied {
            f.set_color(0, [before[0] + v, before[1] + v, before[2] + v, before[3]]);
        } else {
            f.set_color(0, [v, v, v, zero]);
        }
    }
}

/// Visibility from 8 bits (§4.2): red less green over 63, less the count in the stencil.
/// Textures: the buffer, positions, which say where shadow may fall, depth-stencil.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ResolveRedGreen;
uniforms!(ResolveRedGreen);

impl FragmentShader for ResolveRedGreen {
    fn outputs(&self) -> FragmentOutputs {
        reads(3)
    }

    #[inline(always)]
    fn shade<L: Lanes>(&self, l: L, f: &mut Fragment<'_, L>) {
        let at = [f.column(), f.row(), I32::splat(l, 0)];
        let counted = f.fetch_stencil(2, at, 0).to_i32().to_f32();
        // Quads that meet may round to one leaving more than entered.
        let below = counted.gt(F32::splat(l, 127.0));
        let count = below.select_f32(counted - 256.0, counted);
        let [both, position] = own_texels(l, f, 2);
        let whole = ((both[0] - both[1]) * 255.0).round_ties_even();
        let zero = F32::splat(l, 0.0);
        let (_, shadowable) = receiver(l, position, [0.0; 3]);
        let hidden = shadowable.select_f32(count - whole / SIX_BITS, zero);
        let v = F32::splat(l, 1.0) - hidden;
        f.set_color(0, [v, v, v, F32::splat(l, 1.0)]);
    }
}
