//! What soft techniques share: visibility in a texture, positions to compute it
//! from, and draws that write it.
//!
//! The order of a frame is: ambient light with depth and positions
//! ([`super::passes::SceneDraws::ambient_pass_with_positions`]); then for each
//! light, the first one last, passes that leave its visibility in a texture, and
//! a lit pass with [`super::passes::LitTest::Visibility`]. One texture serves all
//! lights in turn.

use std::sync::Arc;

use glam::DVec4;
use gnomon_raster::state::{ColorTargetState, ColorWrites};
use gnomon_raster::{
    ColorAttachment, Draw, Format, LoadOp, Recording, RenderPipeline, Sampler, StoreOp,
    Subresource, TextureBinding, TextureDescriptor, TextureId, VertexBuffer,
};
use gnomon_shaders::surface::{Shadowed, ShadowedByBytes};

use super::surface_draw::index_buffer;
use super::view::View;
use crate::technique::{TechniqueError, VisibilityOutput};

/// World-space positions of what pixels show, relative to [`View`]'s origin: an
/// `Rgba32Float` image; w is 1 where shadow may fall, else 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Positions {
    /// The image.
    pub texture: TextureId,
    /// The planes of the facets there, if they are wanted: unit normals and distances
    /// from the eye.
    pub planes: Option<TextureId>,
}

impl Positions {
    /// Creates it for a picture of that width and height.
    ///
    /// # Errors
    /// The GPU refuses the texture.
    pub fn create(
        [width, height]: [u32; 2],
        recording: &mut Recording,
    ) -> Result<Self, TechniqueError> {
        let desc = TextureDescriptor::d2("positions", Format::Rgba32Float, width, height);
        Ok(Self {
            texture: recording.create(&desc)?,
            planes: None,
        })
    }

    /// With planes.
    pub(crate) fn with_planes(
        size: [u32; 2],
        recording: &mut Recording,
    ) -> Result<Self, TechniqueError> {
        let positions = Self::create(size, recording)?;
        let desc = TextureDescriptor::d2("planes", Format::Rgba32Float, size[0], size[1]);
        Ok(Self {
            planes: Some(recording.create(&desc)?),
            ..positions
        })
    }

    /// All of its textures.
    pub(crate) fn textures(&self) -> impl Iterator<Item = TextureId> {
        std::iter::once(self.texture).chain(self.planes)
    }
}

/// Visibility of a light: `texel · scale + offset`, limited to 0..=1; or a whole number
/// in two bytes of the texel for `texel`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VisibilityTexture {
    /// The texture, of the picture's size.
    pub texture: TextureId,
    /// Factor of its texels.
    pub scale: f32,
    /// Added to the product.
    pub offset: f32,
    /// Red, green and blue apart; else red for all.
    pub coloured: bool,
    /// Red is the high and green the low byte of what is scaled; nothing is added.
    pub bytes: bool,
}

impl VisibilityTexture {
    /// A texture whose red is the visibility.
    pub fn red(texture: TextureId) -> Self {
        Self {
            texture,
            scale: 1.0,
            offset: 0.0,
            coloured: false,
            bytes: false,
        }
    }

    /// A texture whose red and green are two bytes of it, in steps of `scale`.
    pub fn bytes(texture: TextureId, scale: f32) -> Self {
        Self {
            scale,
            bytes: true,
            ..Self::red(texture)
        }
    }

    /// What the frame's outputs say of it: red of several colours.
    pub fn output(&self) -> VisibilityOutput {
        if self.bytes {
            return VisibilityOutput::Bytes {
                texture: self.texture,
                scale: self.scale,
            };
        }
        VisibilityOutput::Red {
            texture: self.texture,
            scale: self.scale,
            offset: self.offset,
        }
    }

    /// A surface shader dimmed by it, if it is not in bytes.
    pub fn shadowed<S>(&self, surface: S) -> Shadowed<S> {
        Shadowed {
            surface,
            scale: self.scale,
            offset: self.offset,
            coloured: self.coloured,
        }
    }

    /// A surface shader dimmed by its bytes.
    pub fn shadowed_by_bytes<S>(&self, surface: S) -> ShadowedByBytes<S> {
        let scale = self.scale;
        ShadowedByBytes { surface, scale }
    }
}

/// All of a texture's first image.
pub fn attachment(texture: TextureId, load: LoadOp<[f32; 4]>) -> ColorAttachment {
    ColorAttachment {
        texture,
        subresource: Subresource::default(),
        load,
        store: StoreOp::Store,
    }
}

/// Replaces attachment 0 of `attachments` and leaves the others alone.
pub(crate) fn first_target(attachments: usize) -> Vec<ColorTargetState> {
    let kept = ColorTargetState {
        write_mask: ColorWrites(0),
        ..ColorTargetState::OPAQUE
    };
    let mut targets = vec![kept; attachments];
    targets[0] = ColorTargetState::OPAQUE;
    targets
}

/// A texture for fetches of single texels.
pub fn binding(texture: TextureId) -> TextureBinding {
    TextureBinding {
        texture,
        sampler: Sampler::default(),
    }
}

/// One triangle over all pixels; for [`gnomon_shaders::transform::FullScreen`].
pub fn full_screen(pipeline: RenderPipeline, textures: Vec<TextureBinding>) -> Draw {
    let label = pipeline.label.clone();
    Draw {
        textures,
        ..Draw::vertices_only(&label, &Arc::new(pipeline), 3)
    }
}

/// Vertices `(p, 1)` and `(direction, 0)` of world space as a buffer for
/// [`gnomon_shaders::transform::HomogeneousPoints`]: points relative to the
/// view's origin, rounded once.
pub fn homogeneous(view: &View, vertices: &[DVec4]) -> VertexBuffer {
    let moved = |v: &DVec4| {
        let p = if v.w == 0.0 {
            v.truncate()
        } else {
            view.relative(v.truncate())
        };
        [p.x as f32, p.y as f32, p.z as f32, v.w as f32]
    };
    VertexBuffer {
        data: vertices.iter().flat_map(moved).collect(),
        stride: 4,
    }
}

/// Triangles of homogeneous vertices: a wedge, half of one, or a quad. Each has
/// uniforms of its own and so is a draw of its own.
pub fn homogeneous_draw(
    label: &str,
    pipeline: RenderPipeline,
    vertices: &Arc<VertexBuffer>,
    triangles: &[[u32; 3]],
    textures: Vec<TextureBinding>,
) -> Draw {
    let indices = index_buffer(triangles);
    Draw {
        textures,
        ..Draw::indexed(label, &Arc::new(pipeline), vertices, &indices)
    }
}
