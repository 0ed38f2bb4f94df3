//! The map behind a scene: what the camera sees of it, in a texture of the picture's
//! size, copied to where no surface is.

use gnomon_raster::state::{
    CompareFunction, DepthState, DepthStencilState, PrimitiveState, Viewport,
};
use gnomon_raster::{
    Draw, Format, Recording, RenderPipeline, Subresource, TextureDescriptor, TextureId,
};
use gnomon_shaders::soft_volumes::Resolve;
use gnomon_shaders::transform::FullScreen;

use super::visibility::{binding, first_target, full_screen};
use crate::technique::TechniqueError;
use crate::world::scene::Scene;

/// What is seen behind a scene.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Backdrop {
    texture: TextureId,
    size: [u32; 2],
}

impl Backdrop {
    /// `None` where the background is of one colour.
    pub(crate) fn create(
        scene: &Scene,
        size: [u32; 2],
        recording: &mut Recording,
    ) -> Result<Option<Self>, TechniqueError> {
        if scene.backdrop.is_none() {
            return Ok(None);
        }
        let [width, height] = size;
        let desc = TextureDescriptor::d2("backdrop", Format::Rgba32Float, width, height);
        let texture = recording.create(&desc)?;
        recording.write(texture, Subresource::default(), &texels(scene, size))?;
        Ok(Some(Self { texture, size }))
    }

    /// Writes attachment 0 of `attachments` where depth is still the farthest.
    pub(crate) fn draw(&self, attachments: usize) -> Draw {
        let pipeline = RenderPipeline {
            label: "backdrop".into(),
            vertex: FullScreen.stage(),
            fragment: Some(Resolve::Copy.stage()),
            primitive: PrimitiveState::default(),
            depth_stencil: DepthStencilState {
                depth: DepthState {
                    compare: CompareFunction::Equal,
                    write: false,
                    bounds: None,
                },
                ..DepthStencilState::default()
            },
            color_targets: first_target(attachments),
        };
        let [width, height] = self.size;
        Draw {
            viewport: Some(Viewport {
                min_depth: 1.0,
                ..Viewport::full(width, height)
            }),
            ..full_screen(pipeline, vec![binding(self.texture)])
        }
    }
}

fn texels(scene: &Scene, [width, height]: [u32; 2]) -> Vec<[f32; 4]> {
    let rays = scene.camera.eye_rays(width, height);
    let texel = |(x, y): (u32, u32)| {
        let [r, g, b] = scene.behind(rays.direction(f64::from(x) + 0.5, f64::from(y) + 0.5));
        [r, g, b, 1.0]
    };
    let all = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
    all.map(texel).collect()
}
