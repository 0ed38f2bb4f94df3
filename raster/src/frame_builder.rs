//! A frame in a few lines: one colour image, one depth-stencil buffer, triangles and
//! closures. Whatever it cannot say, a [`Recording`] can, which it makes.

use std::sync::Arc;

use crate::MAX_VARYINGS;
use crate::command::{
    ColorAttachment, DepthStencilAttachment, Draw, LoadOp, RenderPass, RenderPipeline, StoreOp,
    TextureBinding,
};
use crate::error::Error;
use crate::format::Format;
use crate::recording::Recording;
use crate::shader::{
    FragmentContext, FragmentOutputs, FragmentStage, Interpolation, ScalarFragmentOutput,
    ScalarVertexOutput, per_fragment, per_vertex,
};
use crate::state::{
    ColorTargetState, DepthStencilState, PrimitiveState, StencilFaceState, StencilState,
};
use crate::texture::{Subresource, TextureDescriptor, TextureId};

/// Puts a [`Recording`] of one render pass together, draw by draw: an `Rgba8Unorm` image
/// called `color`, cleared to opaque black, and a `Depth24Stencil8` buffer called `depth`,
/// cleared to 1 and 0. Both are stored.
///
/// ```
/// use gnomon_raster::shader::ScalarFragmentOutput;
/// use gnomon_raster::state::StencilFaceState;
/// use gnomon_raster::{FrameBuilder, GpuConfig, TriangleDraw};
///
/// let mut frame = FrameBuilder::new(64, 64)?;
/// let left = [[-1.0, -1.0, 0.6], [0.0, -1.0, 0.6], [-1.0, 1.0, 0.6]];
/// frame.draw(TriangleDraw::new("mask", &left).stencil(StencilFaceState::REPLACE, 1));
/// let all = [[-1.0, -1.0, 0.5], [3.0, -1.0, 0.5], [-1.0, 3.0, 0.5]];
/// let orange = ScalarFragmentOutput::color([1.0, 0.5, 0.0, 1.0]);
/// frame.draw(TriangleDraw::new("orange", &all).stencil(StencilFaceState::EQUAL, 1).shade(move |_| orange));
///
/// let drawn = frame.build().draw(GpuConfig::default())?;
/// let pixels = drawn.output("color")?.read_rgba8()?;
/// assert_eq!((pixels[63 * 64], pixels[63 * 64 + 63]), ([255, 128, 0, 255], [0, 0, 0, 255]));
/// # Ok::<(), gnomon_raster::Error>(())
/// ```
#[derive(Clone)]
pub struct FrameBuilder {
    recording: Recording,
    pass: RenderPass,
}

impl FrameBuilder {
    /// A frame of this many pixels.
    ///
    /// # Errors
    /// For sizes that are not possible.
    pub fn new(width: u32, height: u32) -> Result<Self, Error> {
        let mut recording = Recording::default();
        let mut create = |label, format| {
            let texture = recording.create(&TextureDescriptor::d2(label, format, width, height))?;
            recording.name_output(label, texture)?;
            Ok(texture)
        };
        let color = create("color", Format::Rgba8Unorm)?;
        let depth = create("depth", Format::Depth24Stencil8)?;
        Ok(Self {
            recording,
            pass: pass(color, depth),
        })
    }

    /// Draws triangles, after those before.
    pub fn draw(&mut self, triangles: TriangleDraw) -> &mut Self {
        self.pass.draws.push(triangles.draw());
        self
    }

    /// Adds a colour texture of one level for draws to read, rows from the top.
    ///
    /// # Errors
    /// For sizes that are not possible, formats without colour, and texels of another
    /// number.
    pub fn texture(
        &mut self,
        label: &str,
        format: Format,
        [width, height]: [u32; 2],
        texels: &[[f32; 4]],
    ) -> Result<TextureId, Error> {
        let descriptor = TextureDescriptor::d2(label, format, width, height);
        let texture = self.recording.create(&descriptor)?;
        self.recording
            .write(texture, Subresource::default(), texels)?;
        Ok(texture)
    }

    /// The frame as it is by now.
    #[must_use]
    pub fn build(&self) -> Recording {
        let mut recording = self.recording.clone();
        recording.list.passes.push(self.pass.clone());
        recording
    }
}

fn pass(color: TextureId, depth: TextureId) -> RenderPass {
    RenderPass {
        label: "frame".to_owned(),
        color: vec![ColorAttachment {
            texture: color,
            subresource: Subresource::default(),
            load: LoadOp::Clear([0.0, 0.0, 0.0, 1.0]),
            store: StoreOp::Store,
        }],
        depth_stencil: Some(DepthStencilAttachment {
            texture: depth,
            subresource: Subresource::default(),
            depth_load: LoadOp::Clear(1.0),
            depth_store: StoreOp::Store,
            stencil_load: LoadOp::Clear(0),
            stencil_store: StoreOp::Store,
        }),
        draws: Vec::new(),
    }
}

/// Triangles for a [`FrameBuilder`]: opaque, tested and written at depth `Less`, and
/// without colour until they are given a shader.
#[derive(Clone)]
pub struct TriangleDraw {
    label: String,
    /// Clip-space positions and varyings.
    corners: Arc<[ScalarVertexOutput]>,
    varyings: usize,
    fragment: Option<FragmentStage>,
    depth_stencil: DepthStencilState,
    stencil_reference: u8,
    target: ColorTargetState,
    textures: Vec<TextureBinding>,
}

impl TriangleDraw {
    /// Triangles of every three `corners` in normalised device coordinates: x to the right
    /// and y up from -1 to 1, depth from 0 (near) to 1. Corners that make no triangle are
    /// left out.
    #[must_use]
    pub fn new(label: &str, corners: &[[f32; 3]]) -> Self {
        let corner = |&[x, y, z]: &[f32; 3]| ScalarVertexOutput {
            position: [x, y, z, 1.0],
            ..ScalarVertexOutput::default()
        };
        Self::of(label, corners.iter().map(corner).collect(), 0)
    }

    /// The same in clip space, with values that fragments have interpolated with
    /// perspective as their varyings 0 to 3.
    #[must_use]
    pub fn with_varyings(label: &str, corners: &[([f32; 4], [f32; 4])]) -> Self {
        let corner = |&(position, values): &([f32; 4], [f32; 4])| {
            let mut varyings = [0.0; MAX_VARYINGS];
            varyings[..4].copy_from_slice(&values);
            ScalarVertexOutput { position, varyings }
        };
        Self::of(label, corners.iter().map(corner).collect(), 4)
    }

    fn of(label: &str, corners: Arc<[ScalarVertexOutput]>, varyings: usize) -> Self {
        Self {
            label: label.to_owned(),
            corners,
            varyings,
            fragment: None,
            depth_stencil: DepthStencilState::opaque(),
            stencil_reference: 0,
            target: ColorTargetState::OPAQUE,
            textures: Vec::new(),
        }
    }

    /// Colours fragments; the closure reads the textures that were bound before.
    #[must_use]
    pub fn shade<F>(self, shade: F) -> Self
    where
        F: Fn(&FragmentContext<'_>) -> ScalarFragmentOutput + Send + Sync + 'static,
    {
        let outputs = FragmentOutputs {
            textures: self.textures.len(),
            ..FragmentOutputs::default()
        };
        self.shade_with(outputs, shade)
    }

    /// The same for closures that discard, write depth or count.
    #[must_use]
    pub fn shade_with<F>(mut self, outputs: FragmentOutputs, shade: F) -> Self
    where
        F: Fn(&FragmentContext<'_>) -> ScalarFragmentOutput + Send + Sync + 'static,
    {
        self.fragment = Some(per_fragment(outputs, shade));
        self
    }

    /// The stencil test of both faces.
    #[must_use]
    pub fn stencil(mut self, face: StencilFaceState, reference: u8) -> Self {
        self.depth_stencil.stencil = StencilState {
            front: face,
            back: face,
        };
        self.stencil_reference = reference;
        self
    }

    /// All of depth and stencil.
    #[must_use]
    pub fn depth_stencil(mut self, state: DepthStencilState) -> Self {
        self.depth_stencil = state;
        self
    }

    /// Blending and channels.
    #[must_use]
    pub fn target(mut self, target: ColorTargetState) -> Self {
        self.target = target;
        self
    }

    /// Binds the next slot's texture.
    #[must_use]
    pub fn texture(mut self, binding: TextureBinding) -> Self {
        self.textures.push(binding);
        self
    }

    fn draw(self) -> Draw {
        let count = self.corners.len() as u32 / 3 * 3;
        let varyings = vec![Interpolation::Perspective; self.varyings];
        let corners = self.corners;
        let pipeline = RenderPipeline {
            label: self.label.clone(),
            vertex: per_vertex(&varyings, move |v| corners[v.vertex_index as usize]),
            fragment: self.fragment,
            primitive: PrimitiveState::default(),
            depth_stencil: self.depth_stencil,
            color_targets: vec![self.target],
        };
        Draw {
            stencil_reference: [self.stencil_reference; 2],
            textures: self.textures,
            ..Draw::vertices_only(&self.label, &Arc::new(pipeline), count)
        }
    }
}
