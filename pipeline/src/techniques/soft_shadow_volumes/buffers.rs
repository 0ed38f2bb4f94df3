//! Textures that visibility is added up in, as floats or as 6 of 8 bits.

use gnomon_raster::state::{ColorTargetState, DepthStencilState, PrimitiveState};
use gnomon_raster::{
    Format, LoadOp, Recording, RenderPass, RenderPipeline, TextureDescriptor, TextureId,
};
use gnomon_shaders::soft_volumes::Resolve;
use gnomon_shaders::transform::FullScreen;

use super::{Buffer, SoftVolumesSettings};
use crate::parts::visibility::{VisibilityTexture, attachment, binding, full_screen};
use crate::technique::TechniqueError;

/// Textures that coverage is added up in.
pub(super) struct Buffers {
    /// Red, green and blue apart.
    coloured: bool,
    /// Visibility, float.
    pub(super) visibility: TextureId,
    /// For copying back, of the same kind.
    pub(super) aside: Option<TextureId>,
    /// Coverage to add and to take, 8 bits a channel.
    pub(super) six_bits: Option<[TextureId; 2]>,
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
        let bytes = settings.buffer == Buffer::Rgba8x2;
        let aside = settings.copy_back;
        let coloured = settings.covering.image.is_some();
        let float = if coloured {
            Format::Rgba32Float
        } else {
            Format::R32Float
        };
        Ok(Self {
            coloured,
            visibility: create("visibility", float)?,
            aside: if aside {
                Some(create("visibility aside", float)?)
            } else {
                None
            },
            six_bits: if bytes {
                Some([
                    create("coverage added", Format::Rgba8Unorm)?,
                    create("coverage taken", Format::Rgba8Unorm)?,
                ])
            } else {
                None
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
        match self.six_bits {
            Some(both) => both.to_vec(),
            None => vec![self.visibility],
        }
    }

    /// Visibility from 8-bit buffers.
    pub(super) fn resolve_pass(&self, label: String) -> Option<RenderPass> {
        let both = self.six_bits?;
        let pipeline = RenderPipeline {
            label: label.clone(),
            vertex: FullScreen.stage(),
            fragment: Some(Resolve::SixBits.stage()),
            primitive: PrimitiveState::default(),
            depth_stencil: DepthStencilState::default(),
            color_targets: vec![ColorTargetState::OPAQUE],
        };
        Some(RenderPass {
            label,
            color: vec![attachment(self.visibility, LoadOp::DontCare)],
            depth_stencil: None,
            draws: vec![full_screen(pipeline, both.map(binding).to_vec())],
        })
    }
}
