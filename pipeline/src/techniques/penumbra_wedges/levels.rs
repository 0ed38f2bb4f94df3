//! The hardware variant (paper I, §7 and figure 15): in place of each wedge a few quads
//! through its edge, from the front plane to the back plane, each counted as a hard shadow
//! volume by the depth test. Between two quads the intensity is constant.

use gnomon_raster::state::ColorTargetState;
use gnomon_shaders::penumbra::buffers::Boundary;

use super::{CrossingDraws, LightWedges};
use crate::geometry::winding;
use crate::parts::casters::Examined;
use crate::parts::shadowed_frame::LightTurn;
use crate::parts::wedges::penumbra::hard::{self, Method};
use crate::parts::wedges::penumbra::shape;
use crate::parts::wedges::penumbra::volume::SoftVolume;

impl CrossingDraws<'_> {
    /// `levels` volumes, of which each takes one from the buffer; and those that the eye is
    /// in.
    pub(super) fn quads(
        &self,
        turn: &LightTurn<'_, '_>,
        caster: &Examined<'_>,
        (volume, levels): (&SoftVolume, u32),
        found: &mut LightWedges,
    ) {
        let view = turn.view();
        for level in 0..levels {
            let share = (f64::from(level) + 0.5) / f64::from(levels);
            let (sides, bottom) = volume.level(share);
            let cap = volume.cap.iter();
            let cap = cap.map(|t| t.map(|i| caster.object.mesh.position(i).extend(1.0)));
            let closed = sides.iter().chain(&bottom).chain(&volume.patches).copied();
            let round_eye =
                winding::of_triangles(closed.chain(cap), turn.scene.camera.eye) + volume.all_around;
            found.start -= round_eye as f32;
            found.at_eye -= round_eye as f32;
            let mut pipeline = hard::boundary_pipeline("level", view, Method::DepthPass);
            pipeline.fragment = Some(Boundary { front: -1.0 }.stage());
            pipeline.color_targets = vec![ColorTargetState::ADDITIVE];
            let faces = shape::triangles(view, &sides);
            found
                .wedges
                .push(faces.draw(&caster.object.name, pipeline, Vec::new()));
        }
    }
}
