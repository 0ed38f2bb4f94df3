//! Hard shadows by stencil volumes: z-pass, z-fail, or the cheaper one that is
//! right, caster by caster (docs/papers.md, hard shadow volumes).
//!
//! Per light: count the volumes into the stencil, then add the light where the count
//! is 0. More than 255 that may overlap are counted in ranges
//! ([`crate::parts::volumes::stencil_ranges`]). Volumes reach to infinity. z-fail draws both
//! caps and the sides where they *fail* the depth test; the light cap is the
//! caster's own triangles through the caster's own arithmetic, so it fails
//! against the surface by equality. z-pass draws the sides where they pass; it
//! miscounts where the view starts inside the volume, so `auto` takes it only
//! where [`crate::parts::volumes::near_pyramid`] proves that it does not.
//!
//! Visibility is that of the first light asked for, which is drawn last, so
//! that the final stencil is its own.

use gnomon_raster::{Draw, LoadOp, RenderPass};

use crate::param_list;
use crate::parts::frame_settings::FrameSettings;
use crate::parts::passes::{LitTest, Targets};
use crate::parts::shadowed_frame::ShadowedFrame;
use crate::parts::volumes::light_contacts;
use crate::parts::volumes::volume_draws::{VolumeCasters, VolumeSettings};
use crate::technique::{
    Capabilities, Frame, ParamInfo, Params, Pass, PassRole, ShadowKind, Technique, TechniqueError,
};
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
        param_list!(VolumeSettings::PARAMS, FrameSettings::PARAMS)
    }

    fn capabilities(&self) -> Capabilities {
        Capabilities::of_silhouettes(ShadowKind::Hard)
    }

    fn frame(
        &self,
        scene: &Scene,
        size: [u32; 2],
        params: &Params,
    ) -> Result<Frame, TechniqueError> {
        let settings = FrameSettings::read(params)?;
        let casters = VolumeCasters::new(scene, size, &VolumeSettings::read(params)?)?;
        let frame = ShadowedFrame::new(scene, size, &settings)?.with_ambient();
        frame.lit(LitTest::StencilZero, |light| {
            let contact = light_contacts::warning(scene, light.number);
            light.notes.warnings.extend(contact);
            let built = casters.volumes(light.number, light.light().hard(), &[]);
            light.notes.casters.extend(built.uses);
            light.notes.warnings.extend(built.warnings);
            let (label, first) = (light.label("volumes"), light.turn == 0);
            let pass = volumes_pass(light.targets, label, built.draws, first);
            Ok(vec![Pass::new(PassRole::Volumes, pass)])
        })
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
