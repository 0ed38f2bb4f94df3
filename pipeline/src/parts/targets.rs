//! The attachments that all passes of a frame share.

use gnomon_raster::{
    ColorAttachment, DepthStencilAttachment, LoadOp, Recording, StoreOp, Subresource,
    TextureDescriptor, TextureId,
};

use super::frame_settings::FrameSettings;
use super::visibility::attachment;
use crate::technique::TechniqueError;

/// `what`, with the light's number where there are several.
pub fn label(what: &str, light: usize, lights: &[usize]) -> String {
    if lights.len() == 1 {
        what.to_owned()
    } else {
        format!("{what} {light}")
    }
}

/// The attachments of a frame.
pub struct Targets {
    color: TextureId,
    depth_stencil: TextureId,
}

impl Targets {
    /// Creates them for a picture of that width and height.
    ///
    /// # Errors
    /// The size is impossible.
    pub fn create(
        [width, height]: [u32; 2],
        settings: &FrameSettings,
        recording: &mut Recording,
    ) -> Result<Self, TechniqueError> {
        let texture = |label, format| TextureDescriptor::d2(label, format, width, height);
        let color = texture("color", settings.color_format());
        let depth_stencil = texture("depth-stencil", settings.depth_format());
        Ok(Self {
            color: recording.create(&color)?,
            depth_stencil: recording.create(&depth_stencil)?,
        })
    }

    /// The colour attachment.
    pub fn color(&self, load: LoadOp<[f32; 4]>) -> Vec<ColorAttachment> {
        vec![attachment(self.color, load)]
    }

    /// Linear light.
    pub fn color_texture(&self) -> TextureId {
        self.color
    }

    /// Depth and stencil, to be read while they are not attached.
    pub fn depth_texture(&self) -> TextureId {
        self.depth_stencil
    }

    /// Depth and stencil as they are, but for the given loads.
    pub fn depth_stencil(
        &self,
        depth: LoadOp<f32>,
        stencil: LoadOp<u8>,
    ) -> Option<DepthStencilAttachment> {
        Some(DepthStencilAttachment {
            texture: self.depth_stencil,
            subresource: Subresource::default(),
            depth_load: depth,
            depth_store: StoreOp::Store,
            stencil_load: stencil,
            stencil_store: StoreOp::Store,
        })
    }
}
