//! Textures of the patches' boxes, and the passes that fill them, level by level.

use gnomon_raster::state::{ColorTargetState, DepthStencilState, PrimitiveState};
use gnomon_raster::{
    ColorAttachment, Format, LoadOp, Recording, RenderPass, RenderPipeline, StoreOp, Subresource,
    TextureDescriptor, TextureId,
};
use gnomon_shaders::cones::bounds::PatchBounds;
use gnomon_shaders::transform::FullScreen;

use crate::parts::visibility::{binding, full_screen};
use crate::technique::{Pass, PassRole, TechniqueError};

/// Low and high corners of boxes: of even levels from 2 on, and of odd levels from 1 on.
/// Half of the images are not used, since a texture is read whole while another is
/// written.
#[derive(Clone, Copy, Debug)]
pub(super) struct BoxTextures {
    pairs: [[TextureId; 2]; 2],
    /// Level of the box round everything.
    pub(super) root: u32,
}

impl BoxTextures {
    /// Over a picture of `side` texels a side.
    pub(super) fn create(side: u32, recording: &mut Recording) -> Result<Self, TechniqueError> {
        let root = side.ilog2();
        let mut create = |what: &str, first: u32| {
            let label = format!("patch boxes {what}");
            let desc = TextureDescriptor {
                mip_levels: root - first + 1,
                ..TextureDescriptor::d2(&label, Format::Rgba32Float, side >> first, side >> first)
            };
            recording.create(&desc)
        };
        let even = [create("low, even", 2)?, create("high, even", 2)?];
        let odd = [create("low, odd", 1)?, create("high, odd", 1)?];
        Ok(Self {
            pairs: [even, odd],
            root,
        })
    }

    /// In the order of [`gnomon_shaders::cones::PatchTree`].
    pub(super) fn textures(&self) -> impl Iterator<Item = TextureId> {
        self.pairs.into_iter().flatten()
    }

    fn pair(&self, level: u32) -> [TextureId; 2] {
        self.pairs[(level % 2) as usize]
    }

    /// Boxes of `patches`, from the finest.
    pub(super) fn passes(&self, label: &str, patches: TextureId) -> Vec<Pass> {
        let pass = |level| Pass::new(PassRole::Prefilter, self.pass(label, patches, level));
        (1..=self.root).map(pass).collect()
    }

    fn pass(&self, label: &str, patches: TextureId, level: u32) -> RenderPass {
        let first = 2 - level % 2;
        let attachment = |texture: TextureId| ColorAttachment {
            texture,
            subresource: Subresource {
                mip: level - first,
                layer: 0,
            },
            load: LoadOp::DontCare,
            store: StoreOp::Store,
        };
        let pipeline = RenderPipeline {
            label: label.to_owned(),
            vertex: FullScreen.stage(),
            fragment: Some(PatchBounds { level }.stage()),
            primitive: PrimitiveState::default(),
            depth_stencil: DepthStencilState::default(),
            color_targets: vec![ColorTargetState::OPAQUE; 2],
        };
        let read = match level {
            1 => vec![binding(patches)],
            _ => self.pair(level - 1).map(binding).to_vec(),
        };
        RenderPass {
            label: label.to_owned(),
            color: self.pair(level).map(attachment).to_vec(),
            depth_stencil: None,
            draws: vec![full_screen(pipeline, read)],
        }
    }
}
