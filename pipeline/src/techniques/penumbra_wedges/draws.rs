//! What is drawn of each caster, whatever the form of the algorithm.

use std::sync::Arc;

use gnomon_raster::state::{ColorTargetState, DepthStencilState};
use gnomon_raster::{Draw, IndexBuffer, RenderPipeline, VertexBuffer};
use gnomon_shaders::penumbra::buffers::Boundary;
use gnomon_shaders::penumbra::intensity::Interpolation;
use gnomon_shaders::transform::HomogeneousPoints;

use super::{CrossingDraws, LightWedges, SidePlanes, start_warning};
use crate::geometry::wedge::paper1::{LinkedWedge, smoothed};
use crate::parts::casters::Examined;
use crate::parts::shadowed_frame::LightTurn;
use crate::parts::volumes::near_pyramid::NearPyramid;
use crate::parts::volumes::{light_contacts, near_cap};
use crate::parts::wedges::penumbra::hard;
use crate::parts::wedges::penumbra::light::{self, LightSphere};
use crate::parts::wedges::penumbra::report::LinkedReport;
use crate::parts::wedges::penumbra::volume::SoftVolume;

impl CrossingDraws<'_> {
    /// Finds what a light needs drawn.
    pub(super) fn fill(&self, turn: &mut LightTurn<'_, '_>, found: &mut LightWedges) {
        let (light, source) = (turn.number, turn.light());
        turn.notes
            .warnings
            .extend(light_contacts::warning(turn.scene, light));
        turn.notes.warnings.extend(light::substitution(
            light,
            source,
            self.settings.penumbra.light_as,
        ));
        let Some(sphere) = LightSphere::of(source, self.settings.penumbra.light_as) else {
            found.is_hard = true;
            self.casters
                .iter()
                .for_each(|c| self.hard_volume(turn, c, found));
            return;
        };
        let mut report = LinkedReport::default();
        let linked = self.settings.penumbra.linked();
        let (points, others): (Vec<_>, Vec<_>) = self
            .casters
            .iter()
            .partition(|c| sphere.is_point_for(&c.object.mesh));
        points.iter().for_each(|c| self.hard_volume(turn, c, found));
        for caster in others {
            let volume = caster.soft_volume(&sphere, &linked, None, &mut report);
            found.wedges.extend(self.near_caps(turn, caster, &volume));
            if let Some(levels) = self.settings.levels {
                self.quads(turn, caster, (&volume, levels), found);
                continue;
            }
            self.start_at_eye(turn, caster, &volume, found);
            let label = &caster.object.name;
            match self.settings.side_planes {
                SidePlanes::Cancel => self.faces(turn, label, &volume, found),
                SidePlanes::Evaluate | SidePlanes::Naive => {
                    let wedges = volume.wedges.iter();
                    found
                        .wedges
                        .extend(wedges.map(|w| self.crossing(turn, label, w)));
                }
            }
        }
        let warning = light::point_warning(light, points.len());
        turn.notes.warnings.extend(warning);
        turn.notes
            .warnings
            .extend(start_warning(light, found.at_eye, self.settings.full()));
        turn.notes.warnings.extend(report.warnings(light));
    }

    fn hard_volume(
        &self,
        turn: &mut LightTurn<'_, '_>,
        caster: &Examined<'_>,
        found: &mut LightWedges,
    ) {
        let (scene, view, light) = (turn.scene, turn.view(), turn.number);
        let (draw, used) = hard::draw(scene, view, self.size, light, caster, None);
        found.volumes.push(draw);
        turn.notes.casters.push(used);
    }

    /// Lit triangles that the near plane cuts away: rays enter or leave the umbra
    /// there.
    fn near_caps(
        &self,
        turn: &LightTurn<'_, '_>,
        caster: &Examined<'_>,
        volume: &SoftVolume,
    ) -> Option<Draw> {
        let view = turn.view();
        let pyramid = NearPyramid::before_near_plane(&turn.scene.camera, self.size);
        let caps = near_cap::cut_away(&pyramid, &caster.object.mesh, &volume.cap);
        if caps.is_empty() {
            return None;
        }
        let vertices = VertexBuffer {
            data: near_cap::corners(view, &caps).flatten().collect(),
            stride: 4,
        };
        let pipeline = RenderPipeline {
            label: "near cap".into(),
            vertex: HomogeneousPoints(near_cap::clip_from_world(view)).stage(),
            fragment: Some(
                Boundary {
                    front: -self.settings.full(),
                }
                .stage(),
            ),
            primitive: near_cap::primitive(),
            depth_stencil: DepthStencilState::default(),
            color_targets: vec![ColorTargetState::ADDITIVE],
        };
        let indices = IndexBuffer::new((0..vertices.len() as u32).collect());
        Some(Draw::indexed(
            &caster.object.name,
            &Arc::new(pipeline),
            &Arc::new(vertices),
            &Arc::new(indices),
        ))
    }

    /// What a caster takes from, and its wedges give back to, the eye; and what of that the
    /// buffer starts with: wedges round the eye count where their faces are drawn, or where
    /// rays leave them.
    fn start_at_eye(
        &self,
        turn: &LightTurn<'_, '_>,
        caster: &Examined<'_>,
        volume: &SoftVolume,
        found: &mut LightWedges,
    ) {
        let umbra = self.settings.full()
            * volume.winding(&caster.object.mesh, turn.scene.camera.eye) as f32;
        let wedges = volume.wedges.iter();
        let penumbra: f32 = wedges.filter_map(|w| self.wedge_at_eye(turn, w)).sum();
        found.at_eye += penumbra - umbra;
        found.start += match self.settings.side_planes {
            SidePlanes::Cancel => -umbra,
            SidePlanes::Evaluate | SidePlanes::Naive => penumbra - umbra,
        };
    }

    /// Full light times the eye's intensity in a wedge that holds it, rounded.
    pub(super) fn wedge_at_eye(
        &self,
        turn: &LightTurn<'_, '_>,
        wedge: &LinkedWedge,
    ) -> Option<f32> {
        let planes = self.screen.wedge(turn.view(), wedge);
        // Equal to the shader's decision: no plane lies between eye and wedge.
        let inside = planes.iter().all(|p| p.eye_is_inside());
        let s = wedge.intensity(turn.scene.camera.eye);
        let s = match self.settings.penumbra.interpolation {
            Interpolation::Linear => s,
            Interpolation::Smoothstep => smoothed(s),
        };
        inside.then(|| ((s as f32).clamp(0.0, 1.0) * self.settings.full()).round_ties_even())
    }
}
