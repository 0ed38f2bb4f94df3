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

mod erased;
mod fragment;
mod identity;
mod scalar;
mod table;
mod textures;
mod vertex;

pub(crate) use erased::{ErasedFragmentShader, ErasedVertexShader};
pub use fragment::{Fragment, FragmentOutputs, FragmentShader};
pub(crate) use fragment::{PacketOutput, ShadeBlock, ShaderEvents, VaryingPlanes};
pub use identity::{Named, ShaderIdentity, UniformError, UniformReader, UniformWriter, Uniforms};
pub use scalar::{
    ScalarFragment, ScalarFragmentOutput, ScalarVertex, ScalarVertexOutput, per_fragment,
    per_vertex,
};
pub use table::{ShaderTable, ShaderTableError};
pub use vertex::{Vertex, VertexShader};
pub(crate) use vertex::{VertexBatch, VertexOutput};

use std::sync::Arc;

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

    /// The colour of attachment 0, where every fragment has the same
    /// ([`FragmentShader::constant`]).
    #[must_use]
    pub fn constant(&self) -> Option<[f32; 4]> {
        self.0.constant()
    }
}

impl VertexStage {
    /// How each varying is interpolated.
    #[must_use]
    pub fn varyings(&self) -> &[Interpolation] {
        self.0.varyings()
    }
}

impl<F: FragmentShader + 'static> From<F> for FragmentStage {
    fn from(shader: F) -> Self {
        Self(Arc::new(shader))
    }
}
