//! What a fragment shader does for one fragment, counted by running it.
//!
//! Shaders are generic over lanes; these lanes count what is done with them. An
//! operation is one of + − × ÷ √, an absolute value, comparison, selection, rounding,
//! conversion, shift or bitwise operation on one number of one fragment: what the
//! facade has as one. Constants, varyings as far as they are the same everywhere, and the
//! arithmetic inside of a texture unit are none.

use core::cell::Cell;

use fearless_simd::Fallback;

use super::fragment::{
    Fragment, FragmentShader, PacketOutput, ShadeBlock, ShaderEvents, VaryingPlanes,
};
use crate::depth_plane::DepthBlock;
use crate::simd::Lanes;
use crate::texture::PACKETS;

/// Operations and texture look-ups of one fragment.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Operations {
    /// On single numbers.
    pub operations: u64,
    /// Look-ups in textures, whose own arithmetic is left out.
    pub look_ups: u64,
}

impl Operations {
    /// Of one fragment of `shader`, with all varyings 0 and textures of zeros. What a
    /// shader does must not depend on either, or this is one case of several.
    #[must_use]
    pub fn of<F: FragmentShader>(shader: &F) -> Self {
        let mut events = ShaderEvents::default();
        let mut out = [const { PacketOutput::EMPTY }; PACKETS];
        let mut block = ShadeBlock {
            x: 0,
            y: 0,
            live: u64::MAX,
            planes: &VaryingPlanes::default(),
            varyings: 0,
            depth: DepthBlock::<true>::UNUSED.for_shader(),
            front_facing: true,
            primitive: 0,
            textures: &[],
            out: &mut out,
            attachments: 0,
            writes_depth: false,
            events: &mut events,
            log: None,
        };
        let mut fragment = Fragment::new(Counting, &mut block, 0);
        COUNTED.set(Self::default());
        shader.shade(Counting, &mut fragment);
        COUNTED.get()
    }
}

std::thread_local! {
    /// What the lanes of this thread have counted.
    static COUNTED: Cell<Operations> = const { Cell::new(Operations { operations: 0, look_ups: 0 }) };
}

/// Lanes that count.
#[derive(Clone, Copy)]
struct Counting;

impl Lanes for Counting {
    type Isa = Fallback;

    fn isa(self) -> Fallback {
        Fallback::new()
    }

    fn apart<T>(self, f: impl FnOnce() -> T) -> T {
        f()
    }

    fn op<T>(self, f: impl FnOnce() -> T) -> T {
        let mut counted = COUNTED.get();
        counted.operations += 1;
        COUNTED.set(counted);
        f()
    }

    fn looked_up(self) {
        let mut counted = COUNTED.get();
        counted.look_ups += 1;
        COUNTED.set(counted);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shader::FragmentOutputs;
    use crate::simd::{F32, I32};

    /// Three sums, a product, a root, one comparison and two selections; two look-ups.
    struct Small;

    impl FragmentShader for Small {
        fn outputs(&self) -> FragmentOutputs {
            FragmentOutputs::default()
        }

        fn shade<L: Lanes>(&self, l: L, f: &mut Fragment<'_, L>) {
            let at = [I32::splat(l, 1); 3];
            let [r, g, b, _] = f.fetch_texel(0, at, 0);
            let [more, ..] = f.fetch_texel(5, at, 0);
            let sum = ((r + g) + b) + more;
            let root = (sum * 2.0).sqrt();
            let large = root.gt(F32::splat(l, 1.0));
            f.set_color(0, [large.select_f32(r, g), large.select_f32(g, r), b, b]);
        }
    }

    #[test]
    fn operations_are_those_written_down() {
        let counted = Operations::of(&Small);
        let want = Operations {
            operations: 8,
            look_ups: 2,
        };
        assert_eq!(counted, want);
        assert_eq!(Operations::of(&Small), want, "nothing is left from before");
    }
}
