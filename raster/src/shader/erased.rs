//! Shaders behind a pointer: one virtual call a batch or block, inside which
//! everything is compiled for the level.

use super::Interpolation;
use super::fragment::{Fragment, FragmentOutputs, FragmentShader, ShadeBlock};
use super::identity::{Named, ShaderIdentity, Uniforms};
use super::vertex::{Vertex, VertexBatch, VertexOutput, VertexShader};
use crate::MAX_VARYINGS;
use crate::simd::{F32, LANES, Lanes, SimdLevel, with_lanes};
use crate::texture::PACKETS;

pub(crate) trait ErasedVertexShader: Send + Sync {
    fn varyings(&self) -> &[Interpolation];
    fn shade_batch(
        &self,
        level: SimdLevel,
        batch: &VertexBatch<'_>,
        out: &mut VertexOutput<'_, '_>,
    );
    fn identity(&self) -> Option<ShaderIdentity> {
        None
    }
    fn type_name(&self) -> &'static str;
}

pub(crate) trait ErasedFragmentShader: Send + Sync {
    fn outputs(&self) -> FragmentOutputs;
    fn constant(&self) -> Option<[f32; 4]>;
    fn shade_block(&self, level: SimdLevel, block: &mut ShadeBlock<'_>);
    fn identity(&self) -> Option<ShaderIdentity> {
        None
    }
    fn type_name(&self) -> &'static str;
}

/// A shader whose stage says what it is; all else goes to the shader.
pub(super) struct NamedShader<S>(pub(super) S);

impl<V: VertexShader> ErasedVertexShader for V {
    fn varyings(&self) -> &[Interpolation] {
        VertexShader::varyings(self)
    }

    fn type_name(&self) -> &'static str {
        core::any::type_name::<V>()
    }

    fn shade_batch(
        &self,
        level: SimdLevel,
        batch: &VertexBatch<'_>,
        out: &mut VertexOutput<'_, '_>,
    ) {
        with_lanes!(level, l => shade_batch(self, l, batch, out));
    }
}

impl<F: FragmentShader> ErasedFragmentShader for F {
    fn outputs(&self) -> FragmentOutputs {
        FragmentShader::outputs(self)
    }

    fn type_name(&self) -> &'static str {
        core::any::type_name::<F>()
    }

    fn constant(&self) -> Option<[f32; 4]> {
        FragmentShader::constant(self)
    }

    fn shade_block(&self, level: SimdLevel, block: &mut ShadeBlock<'_>) {
        with_lanes!(level, l => shade_block(self, l, block));
    }
}

impl<V: VertexShader + Uniforms + Named> ErasedVertexShader for NamedShader<V> {
    fn varyings(&self) -> &[Interpolation] {
        VertexShader::varyings(&self.0)
    }

    fn type_name(&self) -> &'static str {
        core::any::type_name::<V>()
    }

    fn shade_batch(
        &self,
        level: SimdLevel,
        batch: &VertexBatch<'_>,
        out: &mut VertexOutput<'_, '_>,
    ) {
        self.0.shade_batch(level, batch, out);
    }

    fn identity(&self) -> Option<ShaderIdentity> {
        Some(ShaderIdentity::of(&self.0))
    }
}

impl<F: FragmentShader + Uniforms + Named> ErasedFragmentShader for NamedShader<F> {
    fn outputs(&self) -> FragmentOutputs {
        FragmentShader::outputs(&self.0)
    }

    fn type_name(&self) -> &'static str {
        core::any::type_name::<F>()
    }

    fn constant(&self) -> Option<[f32; 4]> {
        FragmentShader::constant(&self.0)
    }

    fn shade_block(&self, level: SimdLevel, block: &mut ShadeBlock<'_>) {
        self.0.shade_block(level, block);
    }

    fn identity(&self) -> Option<ShaderIdentity> {
        Some(ShaderIdentity::of(&self.0))
    }
}

#[cfg_attr(not(gnomon_unoptimised), inline(always))]
fn shade_batch<L: Lanes, V: VertexShader>(
    shader: &V,
    l: L,
    batch: &VertexBatch<'_>,
    out: &mut VertexOutput<'_, '_>,
) {
    let n = VertexShader::varyings(shader).len().min(MAX_VARYINGS);
    let mut varyings = [[0.0f32; LANES]; MAX_VARYINGS];
    for (k, chunk) in batch.vertices.chunks(LANES).enumerate() {
        // The last packet repeats its first vertex, so that every lane is valid.
        let mut ids = [chunk[0]; LANES];
        ids[..chunk.len()].copy_from_slice(chunk);
        let mut v = Vertex {
            l,
            batch,
            ids,
            position: [F32::splat(l, 0.0); 4],
            varyings: &mut varyings[..n],
        };
        shader.shade(l, &mut v);
        let at = k * LANES..(k + 1) * LANES;
        for (slot, p) in out.position.iter_mut().zip(v.position) {
            p.store((&mut slot[at.clone()]).try_into().expect("whole packets"));
        }
        for (slot, v) in out.varyings.iter_mut().zip(&varyings[..n]) {
            slot[at.clone()].copy_from_slice(v);
        }
    }
}

#[cfg_attr(not(gnomon_unoptimised), inline(always))]
fn shade_block<L: Lanes, F: FragmentShader>(shader: &F, l: L, block: &mut ShadeBlock<'_>) {
    let (attachments, writes_depth) = (block.attachments, block.writes_depth);
    for packet in 0..PACKETS {
        if (block.live >> (16 * packet)) as u16 != 0 {
            let mut f = Fragment::new(l, block, packet);
            shader.shade(l, &mut f);
            f.finish(attachments, writes_depth);
        }
    }
}
