//! Soft shadows by penumbra wedges, as first published (paper I).
//!
//! Akenine-Möller and Assarsson, "Approximate Soft Shadows on Arbitrary Surfaces
//! using Penumbra Wedges", 2002. A light-intensity buffer of signed 16 bits per
//! light starts at 255; each ray adds `round(255 s)` where it leaves a wedge, or at
//! the surface that it meets inside, less `round(255 s)` where it entered. Clamped
//! to 0..=255 the sum is the light's visibility. The light is a sphere.
//!
//! What differs from the paper:
//!
//! * Back faces are drawn, not front faces: both cover the same pixels, and an eye
//!   inside a wedge sees back faces all round it.
//! * The buffer starts at the intensity of the *eye* (`start=eye`), which is 255
//!   outside shadow. `start=lit` is the paper's 255, wrong for an eye in shadow.
//! * The two roundings are of the two intensities, not of their difference, and
//!   the intensity in a shared side plane is computed from what both neighbours
//!   share: what one wedge adds there the other takes, to the bit.
//!   `side-planes=cancel` leaves both out (§5 of the paper): a cheaper shader, but
//!   where a ray passes near the line between two front planes rounding can drop
//!   one of a pair, which shows as dots.
//! * Ambient light is drawn first, and the buffer modulates each light as it is
//!   added: the same sum, also for several lights.
//!
//! Pixels without surface (depth 1) keep the start.
//!
//! # Where it is wrong
//!
//! What a ray gains at a side plane is given back only where the neighbour's wedge
//! begins. Beyond the line where the side planes of a wedge meet, and where a
//! wedge is missing, it is not, and the difference stays with everything behind:
//! streaks along the rays of the eye (counted in `overlapping-side-planes` and
//! `wedges-without-sides`; `penumbra-wedges-restructured` keeps such errors where
//! they arise). Wedges of lights of about 1e-4 of the scene, whose front and back
//! planes f32 hardly tells apart, may be missed at single pixels; still smaller lights
//! cast hard shadows (`light-as-point`).

use std::sync::Arc;

use gnomon_raster::state::{ColorTargetState, CullMode, DepthStencilState, PrimitiveState};
use gnomon_raster::{
    Draw, IndexBuffer, LoadOp, RenderPass, RenderPipeline, TextureId, VertexBuffer,
};
use gnomon_shaders::penumbra::FULL;
use gnomon_shaders::penumbra::buffers::Boundary;
use gnomon_shaders::penumbra::crossing::WedgeCrossing;
use gnomon_shaders::penumbra::intensity::Interpolation;
use gnomon_shaders::transform::HomogeneousPoints;

use crate::geometry::wedge::paper1::{LinkedWedge, smoothed};
use crate::parts::casters::{self, Examined};
use crate::parts::frame_settings::FrameSettings;
use crate::parts::passes::{self, LitTest};
use crate::parts::shadowed_frame::{LightTurn, ShadowedFrame};
use crate::parts::visibility::{binding, homogeneous, homogeneous_draw};
use crate::parts::volumes::near_pyramid::NearPyramid;
use crate::parts::volumes::{light_contacts, near_cap};
use crate::parts::wedges::penumbra::light::{self, LightSphere};
use crate::parts::wedges::penumbra::report::LinkedReport;
use crate::parts::wedges::penumbra::screen::{self, Screen};
use crate::parts::wedges::penumbra::volume::SoftVolume;
use crate::parts::wedges::penumbra::{self, PenumbraSettings, hard};
use crate::technique::{
    Capabilities, Condition, Frame, LightFact, Param, ParamInfo, Params, Pass, PassRole,
    SceneWedges, ShadowKind, Technique, TechniqueError, Warning, WedgeUse,
};
use crate::world::scene::Scene;
use crate::{choices, param_list};

/// The registry's entry.
pub(crate) struct PenumbraWedges;

choices! {
    /// Intensity that rays start with.
    enum Start {
        /// The eye's own.
        Eye = "eye",
        /// Full light.
        Lit = "lit",
    }
}

const START: Param<Start> = Param::choice(
    "start",
    Start::Eye.word(),
    "intensity that rays start with: the eye's own, or full light as in paper I",
)
.when(Condition::Lights(LightFact::Extended));

choices! {
    /// Intensity where rays pass side planes.
    enum SidePlanes {
        /// Computed.
        Evaluate = "evaluate",
        /// Left out.
        Cancel = "cancel",
    }
}

const SIDE_PLANES: Param<SidePlanes> = Param::choice(
    "side-planes",
    SidePlanes::Evaluate.word(),
    "intensity where rays pass side planes: evaluated, or left out since neighbours cancel",
)
.when(Condition::Lights(LightFact::Extended));

/// What parameters decide.
struct CrossingSettings {
    start: Start,
    side_planes: SidePlanes,
    penumbra: PenumbraSettings,
}

impl CrossingSettings {
    fn read(params: &Params) -> Result<Self, TechniqueError> {
        Ok(Self {
            start: params.get(&START)?,
            side_planes: params.get(&SIDE_PLANES)?,
            penumbra: PenumbraSettings::read(params)?,
        })
    }
}

impl Technique for PenumbraWedges {
    fn name(&self) -> &'static str {
        "penumbra-wedges"
    }

    fn summary(&self) -> &'static str {
        "soft shadows of spherical lights by penumbra wedges, entry against exit (paper I)"
    }

    fn params(&self) -> &'static [ParamInfo] {
        param_list!(
            &[START.info, SIDE_PLANES.info],
            PenumbraSettings::PARAMS,
            FrameSettings::PARAMS
        )
    }

    fn capabilities(&self) -> Capabilities {
        Capabilities {
            wedges: WedgeUse::Linked,
            ..Capabilities::of_silhouettes(ShadowKind::Soft)
        }
    }

    fn frame(
        &self,
        scene: &Scene,
        size: [u32; 2],
        params: &Params,
    ) -> Result<Frame, TechniqueError> {
        let settings = CrossingSettings::read(params)?;
        let casters = casters::examine(scene, settings.penumbra.open_casters)?;
        let mut frame = ShadowedFrame::new(scene, size, &settings.penumbra.frame)?.with_ambient();
        let draws = CrossingDraws {
            size,
            settings: &settings,
            casters: &casters,
            screen: Screen::new(&frame.draws.view, size),
        };
        let buffer = penumbra::light_intensity(size, &mut frame.recording)?;
        let visibility = penumbra::visibility(buffer);
        frame.lit(LitTest::Visibility(visibility), |light| {
            let mut found = LightWedges::default();
            draws.fill(light, &mut found);
            let mut passes = draws.intensity_passes(light, buffer, found);
            let label = light.label("not receiving");
            passes.extend(penumbra::not_receiving_pass(
                label,
                buffer,
                light.targets,
                light.draws,
            ));
            Ok(passes)
        })
    }

    fn wedges(
        &self,
        scene: &Scene,
        params: &Params,
    ) -> Result<Option<SceneWedges>, TechniqueError> {
        penumbra::scene_wedges(scene, params).map(Some)
    }
}

/// What the draws of all lights share.
struct CrossingDraws<'a> {
    size: [u32; 2],
    settings: &'a CrossingSettings,
    casters: &'a [Examined<'a>],
    screen: Screen,
}

/// What one light needs drawn.
struct LightWedges {
    /// The light has no extent: there are no wedges.
    is_hard: bool,
    /// The eye's intensity among wedges.
    start: f32,
    /// Volumes of casters for which the light has no extent.
    volumes: Vec<Draw>,
    wedges: Vec<Draw>,
}

impl Default for LightWedges {
    fn default() -> Self {
        Self {
            is_hard: false,
            start: FULL,
            volumes: Vec::new(),
            wedges: Vec::new(),
        }
    }
}

impl CrossingDraws<'_> {
    /// The pass of hard volumes, whose depth is tested, and that of wedges, as far as
    /// there are.
    fn intensity_passes(
        &self,
        turn: &LightTurn<'_, '_>,
        buffer: TextureId,
        found: LightWedges,
    ) -> Vec<Pass> {
        let start = match self.settings.start {
            Start::Eye => found.start,
            Start::Lit => FULL,
        };
        let mut load = penumbra::cleared(start);
        let mut list = Vec::new();
        if found.is_hard || !found.volumes.is_empty() {
            // One name where there is one pass.
            let (role, what) = match found.is_hard {
                true => (PassRole::Wedges, "wedges"),
                false => (PassRole::Volumes, "volumes"),
            };
            let mut pass = penumbra::intensity_pass(turn.label(what), buffer, load);
            pass.depth_stencil = turn.targets.depth_stencil(LoadOp::Load, LoadOp::Load);
            pass.draws = found.volumes;
            list.push(Pass::new(role, pass));
            load = LoadOp::Load;
        }
        if !found.is_hard {
            let pass = RenderPass {
                draws: found.wedges,
                ..penumbra::intensity_pass(turn.label("wedges"), buffer, load)
            };
            list.push(Pass::new(PassRole::Wedges, pass));
        }
        list
    }

    /// Finds what a light needs drawn.
    fn fill(&self, turn: &mut LightTurn<'_, '_>, found: &mut LightWedges) {
        let (light, source) = (turn.number, turn.light());
        turn.notes
            .warnings
            .extend(light_contacts::warning(turn.scene, light));
        turn.notes
            .warnings
            .extend(light::substitution(light, source));
        let Some(sphere) = LightSphere::of(source) else {
            found.is_hard = true;
            self.casters
                .iter()
                .for_each(|c| self.hard_volume(turn, c, found));
            return;
        };
        let mut report = LinkedReport::default();
        let mut start = FULL;
        let linked = self.settings.penumbra.linked();
        let (points, others): (Vec<_>, Vec<_>) = self
            .casters
            .iter()
            .partition(|c| sphere.is_point_for(&c.object.mesh));
        points.iter().for_each(|c| self.hard_volume(turn, c, found));
        for caster in others {
            let volume = caster.soft_volume(&sphere, &linked, &mut report);
            start += self.seen_by_eye(turn, caster, &volume);
            found.wedges.extend(self.near_caps(turn, caster, &volume));
            let wedges = volume.wedges.iter();
            found
                .wedges
                .extend(wedges.map(|w| self.draw(turn, &caster.object.name, w)));
        }
        found.start = start;
        let warning = light::point_warning(light, points.len());
        turn.notes.warnings.extend(warning);
        turn.notes.warnings.extend(start_warning(light, start));
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
            fragment: Some(Boundary { front: -FULL }.stage()),
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

    /// What a caster takes from, or its wedges give back to, the eye.
    fn seen_by_eye(
        &self,
        turn: &LightTurn<'_, '_>,
        caster: &Examined<'_>,
        volume: &SoftVolume,
    ) -> f32 {
        let umbra = volume.winding(&caster.object.mesh, turn.scene.camera.eye) as f32;
        let penumbra = volume.wedges.iter().filter_map(|w| self.at_eye(turn, w));
        -FULL * umbra + penumbra.sum::<f32>()
    }

    /// 255 times the eye's intensity in a wedge that holds it, rounded.
    fn at_eye(&self, turn: &LightTurn<'_, '_>, wedge: &LinkedWedge) -> Option<f32> {
        let planes = self.screen.wedge(turn.view(), wedge);
        // Equal to the shader's decision: no plane lies between eye and wedge.
        let inside = planes.iter().all(|p| p.eye_is_inside());
        let s = wedge.intensity(turn.scene.camera.eye);
        let s = match self.settings.penumbra.interpolation {
            Interpolation::Linear => s,
            Interpolation::Smoothstep => smoothed(s),
        };
        inside.then(|| ((s as f32).clamp(0.0, 1.0) * FULL).round_ties_even())
    }

    fn draw(&self, turn: &LightTurn<'_, '_>, label: &str, wedge: &LinkedWedge) -> Draw {
        let view = turn.view();
        let evaluate = self.settings.side_planes == SidePlanes::Evaluate;
        let shader = WedgeCrossing {
            planes: self.screen.wedge(view, wedge),
            rates: screen::rates(wedge, self.settings.penumbra.interpolation),
            sides: evaluate.then(|| self.screen.sides(view, wedge)),
            at_eye: self.at_eye(turn, wedge).unwrap_or(0.0),
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
        let depth = vec![binding(turn.targets.depth_texture())];
        homogeneous_draw(label, pipeline, &vertices, &mesh.triangles, depth)
    }
}

/// Says so where the eye is not in full light.
fn start_warning(light: usize, start: f32) -> Option<Warning> {
    (start != FULL).then(|| Warning {
        code: "eye-in-shadow",
        count: 1,
        message: format!(
            "light {light}: the eye is in shadow, at {start} of 255; start=lit would be wrong here"
        ),
    })
}
