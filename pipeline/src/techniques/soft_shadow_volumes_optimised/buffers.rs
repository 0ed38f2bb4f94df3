//! Textures that coverage is added up in, and passes over the whole screen that make
//! visibility of them.

use gnomon_raster::shader::FragmentStage;
use gnomon_raster::state::{ColorTargetState, DepthStencilState, PrimitiveState};
use gnomon_raster::{
    Format, LoadOp, Recording, RenderPass, RenderPipeline, TextureDescriptor, TextureId,
};
use gnomon_shaders::split_volumes::{AddVisibility, CombineGroups};
use gnomon_shaders::transform::FullScreen;

use crate::parts::visibility::{VisibilityTexture, attachment, binding, full_screen};
use crate::technique::TechniqueError;

/// Textures that coverage is added up in.
pub(super) struct Buffers {
    /// The hard count of a group: 1 minus it.
    pub(super) hard: TextureId,
    /// Additive and subtractive coverage of a group.
    pub(super) split: [TextureId; 2],
    /// What groups hide, before and after the last.
    combined: [TextureId; 2],
    /// Visibility of the light.
    visibility: TextureId,
}

impl Buffers {
    pub(super) fn create(
        [width, height]: [u32; 2],
        recording: &mut Recording,
    ) -> Result<Self, TechniqueError> {
        let mut create = |label: &str, format| {
            recording.create(&TextureDescriptor::d2(label, format, width, height))
        };
        Ok(Self {
            hard: create("hard count", Format::R32Float)?,
            split: [
                create("coverage added", Format::Rgba8Unorm)?,
                create("coverage taken", Format::Rgba8Unorm)?,
            ],
            combined: [
                create("hidden", Format::Rgba32Float)?,
                create("hidden before", Format::Rgba32Float)?,
            ],
            visibility: create("visibility", Format::R32Float)?,
        })
    }

    pub(super) fn visibility(&self) -> VisibilityTexture {
        VisibilityTexture::red(self.visibility)
    }

    /// After group number `turn`; the first finds nothing hidden before it.
    pub(super) fn combine_pass(&self, label: String, turn: usize) -> RenderPass {
        let [to, before] = [turn % 2, (turn + 1) % 2].map(|k| self.combined[k]);
        let shader = CombineGroups { first: turn == 0 };
        let sources = [self.hard, self.split[0], self.split[1], before].map(binding);
        let pipeline = over_screen(&label, shader.stage(), ColorTargetState::OPAQUE);
        RenderPass {
            label,
            color: vec![attachment(to, LoadOp::DontCare)],
            depth_stencil: None,
            draws: vec![full_screen(pipeline, sources.to_vec())],
        }
    }

    /// Adds a part's visibility after `groups` groups.
    pub(super) fn add_pass(
        &self,
        label: String,
        groups: usize,
        add: AddVisibility,
        turn: usize,
    ) -> RenderPass {
        let last = self.combined[(groups + 1) % 2];
        let pipeline = over_screen(&label, add.stage(), ColorTargetState::ADDITIVE);
        let load = if turn == 0 {
            LoadOp::Clear([0.0; 4])
        } else {
            LoadOp::Load
        };
        RenderPass {
            label,
            color: vec![attachment(self.visibility, load)],
            depth_stencil: None,
            draws: vec![full_screen(pipeline, vec![binding(last)])],
        }
    }
}

fn over_screen(label: &str, fragment: FragmentStage, target: ColorTargetState) -> RenderPipeline {
    RenderPipeline {
        label: label.to_owned(),
        vertex: FullScreen.stage(),
        fragment: Some(fragment),
        primitive: PrimitiveState::default(),
        depth_stencil: DepthStencilState::default(),
        color_targets: vec![target],
    }
}
