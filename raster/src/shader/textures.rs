//! What fragment shaders read of textures.

use super::Fragment;
use crate::counters::COUNT;
use crate::format::lanes::Words;
use crate::sampling::{Aspect, Detail, NO_WORDS, decode_fetched, fetch_words, look_up};
use crate::simd::{F32, I32, Lanes, U32};
use crate::texture::Texture;

/// Texture look-ups, by slot of the draw. All give 0 for a slot without texture
/// (which validation refuses). The arithmetic is in `docs/texture-rules.md`.
impl<L: Lanes> Fragment<'_, L> {
    /// Filtered by the slot's sampler, the level of detail from the change of
    /// `coord` over the 2×2 quad. 1D textures use `coord[0]`, 2D ones two
    /// components, 3D ones three, all 0..=1 over the image; cube maps take a
    /// direction of any length.
    #[inline(always)]
    pub fn sample(&mut self, slot: usize, coord: [F32<L>; 3]) -> [F32<L>; 4] {
        self.look_up(slot, coord, &Detail::Quads)
    }

    /// As [`Fragment::sample`], with the change of `coord` to the next pixel in
    /// x and y given.
    #[inline(always)]
    pub fn sample_grad(
        &mut self,
        slot: usize,
        coord: [F32<L>; 3],
        dx: [F32<L>; 3],
        dy: [F32<L>; 3],
    ) -> [F32<L>; 4] {
        self.look_up(slot, coord, &Detail::Gradients([dx, dy]))
    }

    /// Filtered at the level of detail given, to which the sampler's bias is not
    /// added.
    #[inline(always)]
    pub fn sample_level(&mut self, slot: usize, coord: [F32<L>; 3], lod: F32<L>) -> [F32<L>; 4] {
        self.look_up(slot, coord, &Detail::Level(lod))
    }

    /// The texel at integer coordinates of level `mip`, unfiltered: column, row,
    /// and slice or cube face. Zero outside the texture.
    #[inline(always)]
    pub fn fetch_texel(&mut self, slot: usize, at: [I32<L>; 3], mip: u32) -> [F32<L>; 4] {
        let l = self.lanes();
        let mut words = NO_WORDS;
        match self.fetch(slot, Aspect::Main, at, mip, &mut words) {
            Some((texture, inside)) => decode_fetched(l, texture, &words, inside),
            None => [F32::splat(l, 0.0); 4],
        }
    }

    /// One texel of the first level for all lanes: what [`Fragment::fetch_texel`] gives for
    /// equal coordinates, to the bit and to the count, for less work.
    #[inline(always)]
    pub fn fetch_same_texel(&mut self, slot: usize, at: [u32; 2]) -> [f32; 4] {
        let quick = match self.textures.get(slot) {
            Some(bound) if self.log.is_none() => bound.texture.plain_texel(at),
            _ => None,
        };
        if let Some(texel) = quick {
            self.lanes().looked_up();
            let texels = u64::from(self.counted_lanes().count_ones());
            self.count_fetches(slot, texels);
            return texel;
        }
        let l = self.lanes();
        let [x, y] = at.map(|c| i32::try_from(c).unwrap_or(i32::MAX));
        let at = [I32::splat(l, x), I32::splat(l, y), I32::splat(l, 0)];
        let [r, g, b, a] = self.fetch_texel(slot, at, 0);
        [first(r), first(g), first(b), first(a)]
    }

    /// The stored bits of the first channel of a texel: the integer of
    /// `R32Uint`, the float's bits of `R32Float`, the packed bytes of `Rgba8Unorm`
    /// (red low), the stored depth. Zero outside.
    #[inline(always)]
    pub fn fetch_texel_bits(&mut self, slot: usize, at: [I32<L>; 3], mip: u32) -> U32<L> {
        let l = self.lanes();
        let mut words = NO_WORDS;
        self.fetch(slot, Aspect::Main, at, mip, &mut words);
        U32::from_array(l, &words[0])
    }

    /// The stencil value of a texel of a depth-stencil texture. Zero outside and
    /// for colour.
    #[inline(always)]
    pub fn fetch_stencil(&mut self, slot: usize, at: [I32<L>; 3], mip: u32) -> U32<L> {
        let l = self.lanes();
        let mut words = NO_WORDS;
        self.fetch(slot, Aspect::Stencil, at, mip, &mut words);
        U32::from_array(l, &words[0])
    }

    /// Width, height and depth of level `mip` in texels; zeros without one.
    #[inline(always)]
    pub fn texture_size(&self, slot: usize, mip: u32) -> [u32; 3] {
        match self.textures.get(slot) {
            Some(b) if mip < b.texture.desc.mip_levels => b.texture.mip_size(mip),
            _ => [0; 3],
        }
    }

    #[inline(always)]
    fn look_up(&mut self, slot: usize, coord: [F32<L>; 3], detail: &Detail<L>) -> [F32<L>; 4] {
        let l = self.lanes();
        l.looked_up();
        let Some(bound) = self.textures.get(slot) else {
            return [F32::splat(l, 0.0); 4];
        };
        let counted = self.counted_lanes();
        let log = self.log.as_mut().map(
            #[inline(always)]
            |log| log.of_slot(slot, counted),
        );
        let (value, texels) = look_up(l, bound, counted, &coord, detail, log);
        self.count_fetches(slot, texels);
        value
    }

    #[inline(always)]
    fn fetch(
        &mut self,
        slot: usize,
        aspect: Aspect,
        at: [I32<L>; 3],
        mip: u32,
        words: &mut Words,
    ) -> Option<(&Texture, u16)> {
        self.lanes().looked_up();
        let texture = self.textures.get(slot)?.texture;
        let counted = self.counted_lanes();
        let log = self.log.as_mut().map(
            #[inline(always)]
            |log| log.of_slot(slot, counted),
        );
        let inside = fetch_words(texture, aspect, at, mip, log, words);
        let texels = u64::from((inside & counted).count_ones());
        self.count_fetches(slot, texels);
        Some((texture, inside))
    }

    /// One fetch a fragment, and the texels that these read.
    #[inline(always)]
    fn count_fetches(&mut self, slot: usize, texels: u64) {
        if !COUNT {
            return;
        }
        let fetches = u64::from(self.counted_lanes().count_ones());
        if let (Some(f), Some(t)) = (
            self.events.fetches.get_mut(slot),
            self.events.texels.get_mut(slot),
        ) {
            *f += fetches;
            *t += texels;
        }
    }
}

#[inline(always)]
fn first<L: Lanes>(v: F32<L>) -> f32 {
    v.to_array()[0]
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use crate::shader::{
        Fragment, FragmentOutputs, FragmentShader, ScalarVertexOutput, per_vertex,
    };
    use crate::simd::{F32, Lanes, SimdLevel};
    use crate::state::{ColorTargetState, DepthStencilState, PrimitiveState, ScissorRect};
    use crate::texture::ColorTexel;
    use crate::{
        ColorAttachment, CommandList, Counters, Draw, Format, Gpu, GpuConfig, LoadOp, RenderPass,
        RenderPipeline, Sampler, StoreOp, Subresource, TextureBinding, TextureDescriptor,
    };

    /// Slot 0 filtered, plus the stored bits of the pixel's own texel of slot 1.
    struct Both;

    impl FragmentShader for Both {
        fn outputs(&self) -> FragmentOutputs {
            FragmentOutputs {
                textures: 2,
                ..FragmentOutputs::default()
            }
        }

        #[inline(always)]
        fn shade<L: Lanes>(&self, l: L, f: &mut Fragment<'_, L>) {
            let zero = F32::splat(l, 0.0);
            assert_eq!(f.texture_size(0, 1), [4, 4, 1]);
            assert_eq!(f.texture_size(7, 0), [0; 3]);
            let a = f.sample(0, [f.x() / 4.0, f.y() / 4.0, zero])[0];
            let b = f
                .fetch_texel_bits(1, [f.column(), f.row(), f.row()], 0)
                .to_i32()
                .to_f32();
            let none = f.sample_level(5, [zero; 3], zero)[3] + f.fetch_texel(5, [f.row(); 3], 0)[3];
            f.set_color(0, [a, b, none, zero]);
        }
    }

    fn image(label: &str, format: Format, side: u32, mip_levels: u32) -> TextureDescriptor {
        TextureDescriptor {
            mip_levels,
            ..TextureDescriptor::d2(label, format, side, side)
        }
    }

    /// Three columns of a 4×4 image: 12 fragments.
    fn render(simd: SimdLevel) -> (Vec<ColorTexel>, Counters) {
        let mut gpu = Gpu::new(GpuConfig {
            threads: 1,
            simd,
            ..GpuConfig::default()
        })
        .unwrap();
        let target = gpu
            .create_texture(&image("target", Format::Rgba32Float, 4, 1))
            .unwrap();
        let mips = gpu
            .create_texture(&image("mips", Format::R8Unorm, 8, 4))
            .unwrap();
        let bits = gpu
            .create_texture(&image("bits", Format::R32Uint, 4, 1))
            .unwrap();
        let s = Subresource::default();
        for (mip, value) in [1.0, 0.2, 0.0, 0.0].into_iter().enumerate() {
            let s = Subresource {
                mip: mip as u32,
                layer: 0,
            };
            gpu.texture_mut(mips)
                .unwrap()
                .write_color(s, &vec![[value; 4]; (8usize >> mip).pow(2)])
                .unwrap();
        }
        let numbers: Vec<[u32; 4]> = (0..16).map(|i| [100 + i, 0, 0, 0]).collect();
        gpu.texture_mut(bits)
            .unwrap()
            .write_raw(s, &numbers)
            .unwrap();
        let pipeline = Arc::new(RenderPipeline {
            label: "both".into(),
            vertex: per_vertex(&[], |v| {
                let [x, y] = [[-1.0, 3.0], [-1.0, -1.0], [3.0, -1.0]][v.vertex_index as usize];
                ScalarVertexOutput {
                    position: [x, y, 0.5, 1.0],
                    ..Default::default()
                }
            }),
            fragment: Some(Both.into()),
            primitive: PrimitiveState::default(),
            depth_stencil: DepthStencilState::default(),
            color_targets: vec![ColorTargetState::OPAQUE],
        });
        let bind = |texture, sampler| TextureBinding { texture, sampler };
        let draw = Draw {
            textures: vec![
                bind(mips, Sampler::trilinear()),
                bind(bits, Sampler::default()),
            ],
            scissor: Some(ScissorRect {
                x: 0,
                y: 0,
                width: 3,
                height: 4,
            }),
            ..Draw::vertices_only("both", &pipeline, 3)
        };
        let color = ColorAttachment {
            texture: target,
            subresource: s,
            load: LoadOp::DontCare,
            store: StoreOp::Store,
        };
        let pass = RenderPass {
            label: "p".into(),
            color: vec![color],
            depth_stencil: None,
            draws: vec![draw],
        };
        let report = gpu.submit(&CommandList { passes: vec![pass] }).unwrap();
        let texels = gpu.texture(target).unwrap().read_color(s).unwrap();
        (texels, report.passes[0].draws[0].counters)
    }

    #[test]
    fn a_shader_samples_and_its_fragments_are_counted() {
        for simd in SimdLevel::available() {
            let (texels, counters) = render(simd);
            // Two texels of level 0 a pixel: level 1.
            assert_eq!(texels[12].0, [51.0 / 255.0, 112.0, 0.0, 0.0]);
            assert_eq!(texels[3].0, [0.0; 4], "not covered");
            assert_eq!(counters.fragments.written, 12);
            let t = counters.traffic;
            assert_eq!(t.tex_fetches[..3], [12, 12, 0]);
            assert_eq!((t.tex[0].read_accesses, t.tex[0].read_bytes), (48, 48));
            assert_eq!((t.tex[1].read_accesses, t.tex[1].read_bytes), (12, 48));
        }
    }
}
