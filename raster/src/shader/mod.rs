//! Shaders as Rust code, in two tiers.
//!
//! *Lanes*: implement [`VertexShader`] or [`FragmentShader`] for a struct that
//! holds the uniforms; the body is generic over [`crate::Lanes`] and runs 16
//! vertices or fragments at a time at the machine's SIMD level. *One at a time*:
//! [`per_vertex`] and [`per_fragment`] take an ordinary closure that sees a
//! single vertex or fragment; slower, and the way to a first shader. Both tiers
//! give the same bits for the same arithmetic.
//!
//! A shader of the first tier may be [`Named`]: its stage then says which shader it is
//! and with what uniforms ([`ShaderIdentity`]), and a [`ShaderTable`] makes it again.

mod context;
mod erased;
mod fragment;
mod identity;
mod operations;
mod scalar;
mod table;
mod textures;
mod vertex;

pub use context::FragmentContext;
pub(crate) use erased::{ErasedFragmentShader, ErasedVertexShader};
pub use fragment::{Fragment, FragmentOutputs, FragmentShader};
pub(crate) use fragment::{PacketOutput, ShadeBlock, ShaderEvents, VaryingPlanes};
pub use identity::{Named, ShaderIdentity, UniformError, UniformReader, UniformWriter, Uniforms};
pub use operations::Operations;
pub use scalar::{
    ScalarFragment, ScalarFragmentOutput, ScalarVertex, ScalarVertexOutput, per_fragment,
    per_vertex,
};
pub use table::{ShaderTable, ShaderTableError};
pub use vertex::{Vertex, VertexShader};
pub(crate) use vertex::{VertexBatch, VertexOutput};

use std::sync::Arc;

use crate::command::VertexBuffer;
use crate::error::Error;
use crate::simd::{LANES, SimdLevel};

/// How a varying is interpolated over a primitive.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Interpolation {
    /// Linear in clip space (divided by w).
    #[default]
    Perspective,
    /// Linear on the screen.
    Linear,
    /// The value of the primitive's first vertex.
    Flat,
}

/// A vertex shader ready for a render pipeline.
#[derive(Clone)]
pub struct VertexStage(pub(crate) Arc<dyn ErasedVertexShader>);

impl<V: VertexShader + 'static> From<V> for VertexStage {
    fn from(shader: V) -> Self {
        Self(Arc::new(shader))
    }
}

/// A fragment shader ready for a render pipeline.
#[derive(Clone)]
pub struct FragmentStage(pub(crate) Arc<dyn ErasedFragmentShader>);

impl FragmentStage {
    /// What its shader may do.
    #[must_use]
    pub fn outputs(&self) -> FragmentOutputs {
        self.0.outputs()
    }

    /// The Rust type of its shader, for debuggers.
    #[must_use]
    pub fn type_name(&self) -> &'static str {
        self.0.type_name()
    }

    /// The colour of attachment 0, where every fragment has the same
    /// ([`FragmentShader::constant`]).
    #[must_use]
    pub fn constant(&self) -> Option<[f32; 4]> {
        self.0.constant()
    }
}

impl VertexStage {
    /// The Rust type of its shader, for debuggers.
    #[must_use]
    pub fn type_name(&self) -> &'static str {
        self.0.type_name()
    }

    /// How each varying is interpolated.
    #[must_use]
    pub fn varyings(&self) -> &[Interpolation] {
        self.0.varyings()
    }

    /// Clip-space positions of `vertices` of `buffer` in an instance, as a draw would
    /// shade them.
    ///
    /// # Errors
    /// Where a vertex is beyond the end of the buffer.
    pub fn positions(
        &self,
        buffer: Option<&VertexBuffer>,
        vertices: &[u32],
        instance: u32,
    ) -> Result<Vec<[f32; 4]>, Error> {
        let (data, stride) = buffer.map_or((&[][..], 0), |b| (&b.data[..], b.stride));
        let count = data.len().checked_div(stride).unwrap_or(usize::MAX);
        if let Some(&vertex) = vertices.iter().find(|v| **v as usize >= count) {
            let vertices = count;
            return Err(Error::VertexOutOfRange { vertex, vertices });
        }
        let padded = vertices.len().next_multiple_of(LANES);
        let mut columns = vec![vec![0.0; padded]; 4 + self.varyings().len()];
        let (position, varyings) = columns.split_at_mut(4);
        let [x, y, z, w] = position else {
            unreachable!("split after four")
        };
        let mut varyings: Vec<&mut [f32]> = varyings.iter_mut().map(Vec::as_mut_slice).collect();
        let batch = VertexBatch {
            data,
            stride,
            vertices,
            instance,
        };
        let mut out = VertexOutput {
            position: [x, y, z, w].map(|c| &mut c[..]),
            varyings: &mut varyings,
        };
        self.0.shade_batch(SimdLevel::detect(), &batch, &mut out);
        Ok((0..vertices.len())
            .map(|i| core::array::from_fn(|c| columns[c][i]))
            .collect())
    }
}

impl<F: FragmentShader + 'static> From<F> for FragmentStage {
    fn from(shader: F) -> Self {
        Self(Arc::new(shader))
    }
}
