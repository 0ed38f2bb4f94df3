//! Wedges by the intensities where rays enter and leave them (paper I, §4).

use std::sync::Arc;

use gnomon_raster::state::{ColorTargetState, CullMode, DepthStencilState, PrimitiveState};
use gnomon_raster::{Draw, RenderPipeline};
use gnomon_shaders::penumbra::crossing::WedgeCrossing;
use gnomon_shaders::transform::HomogeneousPoints;

use super::{CrossingDraws, SidePlanes};
use crate::geometry::wedge::paper1::LinkedWedge;
use crate::parts::passes;
use crate::parts::shadowed_frame::LightTurn;
use crate::parts::visibility::{binding, homogeneous, homogeneous_draw};
use crate::parts::wedges::penumbra::screen;

impl CrossingDraws<'_> {
    /// A wedge by its back faces, of which a ray meets one.
    pub(super) fn crossing(
        &self,
        turn: &LightTurn<'_, '_>,
        label: &str,
        wedge: &LinkedWedge,
    ) -> Draw {
        let view = turn.view();
        let evaluate = self.settings.side_planes == SidePlanes::Evaluate;
        let shader = WedgeCrossing {
            planes: self.screen.wedge(view, wedge),
            rates: screen::rates(wedge, self.settings.penumbra.interpolation),
            sides: evaluate.then(|| self.screen.sides(view, wedge)),
            at_eye: self.wedge_at_eye(turn, wedge).unwrap_or(0.0),
            shades: self.settings.full(),
        };
        let pipeline = RenderPipeline {
            label: "wedge".into(),
            vertex: HomogeneousPoints(view.clip_from_world).stage(),
            fragment: Some(shader.stage()),
            primitive: PrimitiveState {
                cull_mode: CullMode::Front,
                ..passes::clamped()
            },
            depth_stencil: DepthStencilState::default(),
            color_targets: vec![ColorTargetState::ADDITIVE],
        };
        let mesh = wedge.mesh();
        let vertices = Arc::new(homogeneous(view, &mesh.vertices));
        let depth = vec![binding(self.depth)];
        homogeneous_draw(label, pipeline, &vertices, &mesh.triangles, depth)
    }
}
