//! Hard shadows by stencil volumes: z-pass, z-fail, or the cheaper one that is
//! right, caster by caster (docs/papers.md, hard shadow volumes).
//!
//! Per light: count the volumes into the stencil, wrapping modulo 256, then add
//! the light where the count is 0. Volumes reach to infinity. z-fail draws both
//! caps and the sides where they *fail* the depth test; the light cap is the
//! caster's own triangles through the caster's own arithmetic, so it fails
//! against the surface by equality. z-pass draws the sides where they pass; it
//! miscounts where the view starts inside the volume, so `auto` takes it only
//! where [`crate::parts::volumes::near_pyramid`] proves that it does not.
//!
//! Visibility is that of the first light asked for, which is drawn last, so
//! that the final stencil is its own.

use gnomon_raster::{Draw, LoadOp, Recording, RenderPass};

use crate::parts::casters;
use crate::parts::passes::{self, LitTest, SceneDraws, Targets};
use crate::parts::volumes::volume_draws::{self, Casters};
use crate::technique::{Frame, ParamInfo, Params, Technique, TechniqueError, VisibilityOutput};
use crate::world::scene::Scene;

/// The registry's entry.
pub(crate) struct ShadowVolumes;

impl Technique for ShadowVolumes {
    fn name(&self) -> &'static str {
        "shadow-volumes"
    }

    fn summary(&self) -> &'static str {
        "hard shadows by stencil volumes to infinity, z-pass or z-fail"
    }

    fn params(&self) -> &'static [ParamInfo] {
        const PARAMS: &[ParamInfo] = &[
            volume_draws::METHOD,
            casters::OPEN_CASTERS,
            passes::LIGHT,
            casters::SKIP,
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
        let casters = Casters::new(self.name(), scene, size, params)?;
        let lights = passes::lights(scene, params)?;
        let mut list = vec![draws.ambient_pass(&targets)];
        let mut uses = Vec::new();
        let mut warnings = Vec::new();
        for (turn, &light) in lights.iter().rev().enumerate() {
            let built = casters.volumes(light, scene.lights[light].hard(), &[]);
            uses.extend(built.uses);
            warnings.extend(built.warnings);
            let label = passes::label("volumes", light, &lights);
            list.push(volumes_pass(&targets, label, built.draws, turn == 0));
            let label = passes::label("lit", light, &lights);
            list.push(draws.lit_pass(&targets, light, &label, LitTest::StencilZero));
        }
        let mut frame = targets.frame(recording, list, VisibilityOutput::StencilZero)?;
        frame.warnings = warnings;
        frame.casters = uses;
        Ok(frame)
    }
}

/// The stencil is zero in the first of several passes, the ambient pass having
/// cleared it; the others clear it themselves.
fn volumes_pass(targets: &Targets, label: String, draws: Vec<Draw>, first: bool) -> RenderPass {
    let stencil = if first {
        LoadOp::Load
    } else {
        LoadOp::Clear(0)
    };
    RenderPass {
        label,
        color: Vec::new(),
        depth_stencil: targets.depth_stencil(LoadOp::Load, stencil),
        draws,
    }
}
