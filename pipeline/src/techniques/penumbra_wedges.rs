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
//! they arise). Wedges of lights so small that f32 does not tell front from back
//! plane (1e-4 of the scene) may be missed at single pixels.

use std::sync::Arc;

use gnomon_raster::state::{ColorTargetState, CullMode, DepthStencilState, PrimitiveState};
use gnomon_raster::{Draw, LoadOp, Recording, RenderPass, RenderPipeline};
use gnomon_shaders::penumbra::FULL;
use gnomon_shaders::penumbra::crossing::WedgeCrossing;
use gnomon_shaders::penumbra::intensity::Interpolation;
use gnomon_shaders::transform::HomogeneousPoints;

use crate::geometry::wedge::paper1::{LinkedSettings, LinkedWedge, smoothed};
use crate::parts::casters::{self, Examined, OPEN_CASTERS};
use crate::parts::passes::{self, LitTest, SceneDraws, Targets};
use crate::parts::visibility::{binding, homogeneous, homogeneous_draw};
use crate::parts::wedges::penumbra::light::{self, LightSphere};
use crate::parts::wedges::penumbra::report::Met;
use crate::parts::wedges::penumbra::screen::{self, Screen};
use crate::parts::wedges::penumbra::volume::SoftVolume;
use crate::parts::wedges::penumbra::{self, EXTRA_WEDGES, INTERPOLATION, hard};
use crate::technique::{CasterUse, Frame, ParamInfo, Params, Technique, TechniqueError, Warning};
use crate::world::scene::Scene;

/// The registry's entry.
pub(crate) struct PenumbraWedges;

const START: ParamInfo = ParamInfo {
    name: "start",
    default: "eye",
    valid: "eye|lit",
    summary: "intensity that rays start with: the eye's own, or full light as in paper I",
};

const SIDE_PLANES: ParamInfo = ParamInfo {
    name: "side-planes",
    default: "evaluate",
    valid: "evaluate|cancel",
    summary: "intensity where rays pass side planes: evaluated, or left out since neighbours cancel",
};

impl Technique for PenumbraWedges {
    fn name(&self) -> &'static str {
        "penumbra-wedges"
    }

    fn summary(&self) -> &'static str {
        "soft shadows of spherical lights by penumbra wedges, entry against exit (paper I)"
    }

    fn params(&self) -> &'static [ParamInfo] {
        const PARAMS: &[ParamInfo] = &[
            INTERPOLATION,
            START,
            SIDE_PLANES,
            EXTRA_WEDGES,
            OPEN_CASTERS,
            passes::LIGHT,
            passes::SHADING,
            passes::COLOR_FORMAT,
            passes::DEPTH_FORMAT,
        ];
        PARAMS
    }

    fn frame(
        &self,
        scene: &Scene,
        size: [u32; 2],
        params: &Params,
    ) -> Result<Frame, TechniqueError> {
        let mut recording = Recording::default();
        let targets = Targets::create(size, params, &mut recording)?;
        let draws = SceneDraws::new(scene, size, params);
        let casters = casters::examine(self.name(), scene, params)?;
        let lights = passes::lights(scene, params)?;
        let builder = Builder {
            scene,
            size,
            params,
            targets: &targets,
            draws: &draws,
            casters: &casters,
            screen: Screen::new(&draws.view, size),
        };
        let mut list = vec![draws.ambient_pass(&targets)];
        let (mut warnings, mut uses) = (Vec::new(), Vec::new());
        let buffer = penumbra::light_intensity(size, &mut recording)?;
        let visibility = penumbra::visibility(buffer);
        for &light in lights.iter().rev() {
            let mut pass = penumbra::intensity_pass(
                passes::label("wedges", light, &lights),
                buffer,
                penumbra::cleared(FULL),
            );
            builder.fill(light, &mut pass, &mut warnings, &mut uses);
            list.push(pass);
            let label = passes::label("not receiving", light, &lights);
            list.extend(penumbra::not_receiving_pass(
                label, buffer, &targets, &draws,
            ));
            let label = passes::label("lit", light, &lights);
            list.push(draws.lit_pass(&targets, light, &label, LitTest::Visibility(visibility)));
        }
        let mut frame = targets.frame(recording, list, visibility.output())?;
        frame.warnings = warnings;
        frame.casters = uses;
        Ok(frame)
    }
}

/// What the passes of all lights share.
struct Builder<'a> {
    scene: &'a Scene,
    size: [u32; 2],
    params: &'a Params,
    targets: &'a Targets,
    draws: &'a SceneDraws<'a>,
    casters: &'a [Examined<'a>],
    screen: Screen,
}

impl Builder<'_> {
    /// Adds what a light's wedges need to its empty pass.
    fn fill(
        &self,
        light: usize,
        pass: &mut RenderPass,
        warnings: &mut Vec<Warning>,
        uses: &mut Vec<CasterUse>,
    ) {
        let source = &self.scene.lights[light];
        warnings.extend(light::substitution(light, source));
        let Some(sphere) = LightSphere::of(source) else {
            pass.depth_stencil = self.targets.depth_stencil(LoadOp::Load, LoadOp::Load);
            for caster in self.casters {
                let view = &self.draws.view;
                let (draw, used) = hard::draw(self.scene, view, self.size, light, caster, None);
                pass.draws.push(draw);
                uses.push(used);
            }
            return;
        };
        let mut met = Met::default();
        let mut start = FULL;
        for caster in self.casters {
            let volume = caster.soft_volume(&sphere, &self.settings(), &mut met);
            start += self.seen_by_eye(caster, &volume);
            let wedges = volume.wedges.iter();
            pass.draws
                .extend(wedges.map(|w| self.draw(&caster.object.name, w)));
        }
        if self.params.get(START.name) == "eye" {
            pass.color[0].load = penumbra::cleared(start);
        }
        warnings.extend(start_warning(light, start));
        warnings.extend(met.warnings(light));
    }

    fn settings(&self) -> LinkedSettings {
        LinkedSettings {
            extra_wedges: self.params.get(EXTRA_WEDGES.name) != "off",
            ..LinkedSettings::default()
        }
    }

    /// What a caster takes from, or its wedges give back to, the eye.
    fn seen_by_eye(&self, caster: &Examined<'_>, volume: &SoftVolume) -> f32 {
        let umbra = volume.winding(&caster.object.mesh, self.scene.camera.eye) as f32;
        let penumbra = volume.wedges.iter().filter_map(|w| self.at_eye(w));
        -FULL * umbra + penumbra.sum::<f32>()
    }

    /// 255 times the eye's intensity in a wedge that holds it, rounded.
    fn at_eye(&self, wedge: &LinkedWedge) -> Option<f32> {
        let planes = self.screen.wedge(&self.draws.view, wedge);
        // Equal to the shader's decision: no plane lies between eye and wedge.
        let inside = planes.iter().all(|p| p.eye_is_inside());
        let s = wedge.intensity(self.scene.camera.eye);
        let s = match penumbra::interpolation(self.params) {
            Interpolation::Linear => s,
            Interpolation::Smoothstep => smoothed(s),
        };
        inside.then(|| ((s as f32).clamp(0.0, 1.0) * FULL).round_ties_even())
    }

    fn draw(&self, label: &str, wedge: &LinkedWedge) -> Draw {
        let view = &self.draws.view;
        let evaluate = self.params.get(SIDE_PLANES.name) != "cancel";
        let shader = WedgeCrossing {
            planes: self.screen.wedge(view, wedge),
            rates: screen::rates(wedge, penumbra::interpolation(self.params)),
            sides: evaluate.then(|| self.screen.sides(view, wedge)),
            at_eye: self.at_eye(wedge).unwrap_or(0.0),
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
        let depth = vec![binding(self.targets.depth_texture())];
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
