//! Casters projected on a plane, and counted there.

use std::sync::Arc;

use gnomon_raster::state::{
    ColorTargetState, CompareFunction, DepthState, DepthStencilState, PrimitiveState,
    StencilFaceState, StencilOperation, StencilState,
};
use gnomon_raster::{
    DepthStencilAttachment, Draw, Format, IndexBuffer, LoadOp, Recording, RenderPass,
    RenderPipeline, StoreOp, Subresource, TextureDescriptor, TextureId, VertexBuffer,
};
use gnomon_shaders::surface::Constant;
use gnomon_shaders::transform::{ClipFromWorld, Points};

use super::planes::Receiver;
use crate::parts::passes::View;
use crate::parts::visibility::attachment;
use crate::technique::{Pass, PassRole, TechniqueError};
use crate::world::light::HardLight;
use crate::world::mesh::narrow;
use crate::world::scene::Scene;

/// How many points are hidden, and what keeps counts apart; planes use the textures in
/// turn.
pub(super) struct Counting {
    /// Whole numbers in red.
    pub(super) counts: TextureId,
    stencil: TextureId,
    casters: Vec<CasterDraw>,
}

/// A caster's triangles, relative to the view's origin.
struct CasterDraw {
    object: usize,
    name: String,
    vertices: Arc<VertexBuffer>,
    indices: Arc<IndexBuffer>,
}

fn casters(scene: &Scene, view: &View) -> Vec<CasterDraw> {
    let all = scene.objects.iter().enumerate().filter(|(_, o)| o.casts);
    all.map(|(number, object)| {
        let mesh = &object.mesh;
        let corners = (0..mesh.positions().len() as u32).map(|i| mesh.position(i));
        let data = corners.flat_map(|p| narrow(view.relative(p))).collect();
        let indices = mesh.triangles().iter().flatten().copied().collect();
        CasterDraw {
            object: number,
            name: object.name.clone(),
            vertices: Arc::new(VertexBuffer { data, stride: 3 }),
            indices: Arc::new(IndexBuffer::new(indices)),
        }
    })
    .collect()
}

/// Points that a stencil keeps apart.
const APART: usize = 255;

impl Counting {
    /// With textures of `size` texels a side.
    pub(super) fn create(
        scene: &Scene,
        view: &View,
        size: u32,
        recording: &mut Recording,
    ) -> Result<Self, TechniqueError> {
        let mut create = |label: &str, format| {
            recording.create(&TextureDescriptor::d2(label, format, size, size))
        };
        Ok(Self {
            counts: create("hidden points", Format::R32Float)?,
            stencil: create("hidden points stencil", Format::Depth32FloatStencil8)?,
            casters: casters(scene, view),
        })
    }

    /// Counts the points that are hidden from each texel of a plane.
    pub(super) fn passes(
        &self,
        label: &str,
        plane: &Receiver,
        points: &[HardLight],
        view: &View,
    ) -> Vec<Pass> {
        let pass = |(number, points): (usize, &[HardLight])| {
            let load = match number {
                0 => LoadOp::Clear([0.0; 4]),
                _ => LoadOp::Load,
            };
            let draws = points.iter().enumerate();
            let draws =
                draws.flat_map(|(k, point)| self.projected(k as u8 + 1, plane, point, view));
            let pass = RenderPass {
                label: label.to_owned(),
                color: vec![attachment(self.counts, load)],
                depth_stencil: Some(DepthStencilAttachment {
                    texture: self.stencil,
                    subresource: Subresource::default(),
                    depth_load: LoadOp::DontCare,
                    depth_store: StoreOp::Discard,
                    stencil_load: LoadOp::Clear(0),
                    stencil_store: StoreOp::Discard,
                }),
                draws: draws.collect(),
            };
            Pass::new(PassRole::Samples, pass)
        };
        points.chunks(APART).enumerate().map(pass).collect()
    }

    /// The casters as one point projects them.
    fn projected(
        &self,
        reference: u8,
        plane: &Receiver,
        point: &HardLight,
        view: &View,
    ) -> Vec<Draw> {
        let Some(projection) = plane.projection(point, view) else {
            return Vec::new();
        };
        let pipeline = Arc::new(count_once(projection));
        let casters = self.casters.iter().filter(|c| c.object != plane.object);
        let draw = |c: &CasterDraw| Draw {
            stencil_reference: [reference; 2],
            ..Draw::indexed(&c.name, &pipeline, &c.vertices, &c.indices)
        };
        casters.map(draw).collect()
    }
}

/// Adds 1 where the stencil does not say that it was done for this point.
fn count_once(projection: ClipFromWorld) -> RenderPipeline {
    let once = StencilFaceState {
        compare: CompareFunction::NotEqual,
        pass_op: StencilOperation::Replace,
        ..StencilFaceState::IGNORE
    };
    RenderPipeline {
        label: "projection".into(),
        vertex: Points(projection).stage(),
        fragment: Some(Constant([1.0, 0.0, 0.0, 0.0]).stage()),
        primitive: PrimitiveState::default(),
        depth_stencil: DepthStencilState {
            depth: DepthState {
                compare: CompareFunction::Always,
                write: false,
                bounds: None,
            },
            stencil: StencilState {
                front: once,
                back: once,
            },
            ..DepthStencilState::default()
        },
        color_targets: vec![ColorTargetState::ADDITIVE],
    }
}
