//! Textures that visibility is added up in, as floats or as 6 of 8 bits.

use gnomon_raster::shader::FragmentStage;
use gnomon_raster::state::{ColorTargetState, DepthStencilState, PrimitiveState};
use gnomon_raster::{
    Format, LoadOp, Recording, RenderPass, RenderPipeline, TextureDescriptor, TextureId,
};
use gnomon_shaders::soft_volumes::{CoverTo, Resolve};
use gnomon_shaders::transform::FullScreen;
use gnomon_shaders::visibility_buffers::ResolveRedGreen;

use super::settings::{Buffer, SoftVolumesSettings};
use crate::parts::passes::Targets;
use crate::parts::visibility::{Positions, VisibilityTexture, attachment, binding, full_screen};
use crate::technique::TechniqueError;

/// Textures that coverage is added up in.
pub(super) struct Buffers {
    /// Red, green and blue apart.
    coloured: bool,
    /// Visibility, float.
    pub(super) visibility: TextureId,
    /// For copying back, of the same kind.
    pub(super) aside: Option<TextureId>,
    /// Coverage in 8 bits a channel.
    bytes: Option<Bytes>,
}

/// Coverage in 8 bits.
#[derive(Clone, Copy)]
enum Bytes {
    /// To add and to take, with counts in alpha.
    Two([TextureId; 2]),
    /// Both in red and green of one; counts are in the stencil.
    One(TextureId),
}

impl Buffers {
    pub(super) fn create(
        [width, height]: [u32; 2],
        settings: &SoftVolumesSettings,
        recording: &mut Recording,
    ) -> Result<Self, TechniqueError> {
        let mut create = |label: &str, format| {
            recording.create(&TextureDescriptor::d2(label, format, width, height))
        };
        let coloured = settings.covering.image.is_some();
        let float = if coloured {
            Format::Rgba32Float
        } else {
            Format::R32Float
        };
        Ok(Self {
            coloured,
            visibility: create("visibility", float)?,
            aside: if settings.copy_back {
                Some(create("visibility aside", float)?)
            } else {
                None
            },
            bytes: match settings.buffer {
                Buffer::R32f => None,
                Buffer::Rgba8x2 => Some(Bytes::Two([
                    create("coverage added", Format::Rgba8Unorm)?,
                    create("coverage taken", Format::Rgba8Unorm)?,
                ])),
                Buffer::Rgba8 => Some(Bytes::One(create("coverage", Format::Rgba8Unorm)?)),
            },
        })
    }

    pub(super) fn visibility(&self) -> VisibilityTexture {
        VisibilityTexture {
            coloured: self.coloured,
            ..VisibilityTexture::red(self.visibility)
        }
    }

    /// Where coverage and counts are added.
    pub(super) fn targets(&self) -> Vec<TextureId> {
        match self.bytes {
            Some(Bytes::Two(both)) => both.to_vec(),
            Some(Bytes::One(texture)) => vec![texture],
            None => vec![self.visibility],
        }
    }

    /// What wedges write there.
    pub(super) fn cover_to(&self) -> CoverTo {
        match self.bytes {
            Some(Bytes::Two(_)) => CoverTo::SixBits,
            Some(Bytes::One(_)) => CoverTo::RedGreen,
            None => CoverTo::Visibility,
        }
    }

    /// Visibility from 8-bit buffers.
    pub(super) fn resolve_pass(
        &self,
        label: String,
        targets: &Targets,
        positions: Positions,
    ) -> Option<RenderPass> {
        let (shader, textures): (FragmentStage, Vec<TextureId>) = match self.bytes? {
            Bytes::Two(both) => (Resolve::SixBits.stage(), both.to_vec()),
            Bytes::One(texture) => (
                ResolveRedGreen.stage(),
                vec![texture, positions.texture, targets.depth_texture()],
            ),
        };
        let pipeline = RenderPipeline {
            label: label.clone(),
            vertex: FullScreen.stage(),
            fragment: Some(shader),
            primitive: PrimitiveState::default(),
            depth_stencil: DepthStencilState::default(),
            color_targets: vec![ColorTargetState::OPAQUE],
        };
        Some(RenderPass {
            label,
            color: vec![attachment(self.visibility, LoadOp::DontCare)],
            depth_stencil: None,
            draws: vec![full_screen(
                pipeline,
                textures.into_iter().map(binding).collect(),
            )],
        })
    }
}
