//! Soft shadow volumes, optimised (paper IV; docs/papers.md, paper IV): tight wedges, a
//! shader that computes coverage or looks it up, 12 bits of coverage split over
//! 8-bit buffers, silhouettes combined, and lights split.
//!
//! Per part of a light and group of silhouettes: the hard count in the stencil, what inner
//! halves of wedges add in one RGBA8 buffer and what outer halves take in another, and a
//! pass that reads both, 8 bytes a pixel, and the stencil, and makes visibility of them.
//! With `combine=sum` all casters are one group; otherwise each outline is one, with its
//! holes, or each caster, or each loop, and what they hide together is kept in bytes
//! between groups, as is what parts of a light show. Nothing of it is a float. Lights with
//! an image have a pair of buffers for each colour, and inner and outer halves apart.
//!
//! # Departures from the paper, and why
//!
//! * Both buffers are attached at once, which the paper names as the alternative, and the
//!   shader chooses by the side of the hard quad, which it had to leave for want of
//!   precision: here count and side are one expression on one position (as in
//!   `soft-shadow-volumes`). With `halves=on` wedges are drawn as the paper's are, one half
//!   and buffer after the other: less colour traffic and more of depth and stencil.
//! * The hard count is in seven bits of the stencil and not in the colour buffers, where it
//!   would take room for carries; wedges are noted in the eighth. Where more silhouettes
//!   lie over one another than that counts, they are counted in groups.
//! * Positions are 32-bit floats where the paper has 16: they come from the ambient pass,
//!   and are read only.
//! * Visibility is left in two bytes for the lit pass, which the paper lets read both
//!   buffers: depth and stencil are attached there. `horizon=on`, which is not the paper's,
//!   limits it by blending, and has it in a float.
//! * Carry bits hold [`gnomon_shaders::split_volumes::CAPACITY`] full contributions
//!   for certain; the counters tell where a channel saturated.

mod buffers;
mod lookups;
mod part;
mod settings;
mod volumes;

use gnomon_shaders::split_volumes;

use crate::param_list;
use crate::parts::frame_settings::FrameSettings;
use crate::parts::passes::LitTest;
use crate::parts::shadowed_frame::ShadowedFrame;
use crate::parts::volumes::light_contacts;
use crate::parts::wedges::soft::covering::CoveringSettings;
use crate::parts::wedges::soft::edges::SoftCasters;
use crate::parts::wedges::soft::light::split;
use crate::parts::wedges::soft::settings::{SOFT_LIGHTS, SoftSettings};
use crate::parts::wedges::soft::wedges::warnings_of;
use crate::technique::{
    Capabilities, CarryChannels, Frame, ParamInfo, Params, SceneWedges, ShadowKind, Technique,
    TechniqueError, WedgeUse,
};
use crate::world::light_image::LightImage;
use crate::world::scene::Scene;
use buffers::Buffers;
use lookups::Lookups;
use part::PartOfLight;
use settings::OptimisedSettings;
use volumes::PartStatistics;

/// The registry's entry.
pub(crate) struct SoftShadowVolumesOptimised;

impl Technique for SoftShadowVolumesOptimised {
    fn name(&self) -> &'static str {
        "soft-shadow-volumes-optimised"
    }

    fn summary(&self) -> &'static str {
        "soft shadows by tight wedges, 12 bits in 8-bit buffers, split lights (paper IV)"
    }

    fn params(&self) -> &'static [ParamInfo] {
        param_list!(
            settings::PARAMS,
            CoveringSettings::PARAMS,
            SoftSettings::PARAMS,
            FrameSettings::PARAMS
        )
    }

    fn capabilities(&self) -> Capabilities {
        Capabilities {
            wedges: WedgeUse::Single,
            lights: SOFT_LIGHTS,
            ..Capabilities::of_silhouettes(ShadowKind::Soft)
        }
    }

    fn frame(
        &self,
        scene: &Scene,
        size: [u32; 2],
        params: &Params,
    ) -> Result<Frame, TechniqueError> {
        let settings = OptimisedSettings::read(params)?;
        let soft = settings.soft;
        let has_image = settings.covering.image.is_some();
        let scene = &*settings.covering.lit(scene);
        let casters = SoftCasters::new(scene, size, soft.open_casters)?;
        let frame = ShadowedFrame::new(scene, size, &soft.frame)?;
        let frame = frame.with_horizon(soft.horizon, has_image);
        let (mut frame, positions) = frame.with_positions()?;
        let depth_stencil = frame.targets.depth_texture();
        let mut buffers = Buffers::create(size, depth_stencil, &settings, &mut frame.recording)?;
        let mut lookups = Lookups::default();
        frame.lit(LitTest::Visibility(buffers.visibility()), |turn| {
            let (light, number) = (turn.light(), turn.number);
            let contact = light_contacts::warning(scene, number);
            turn.notes.warnings.extend(contact);
            let parts = split(self.name(), light, number, settings.split)?;
            let mut passes = Vec::new();
            let mut statistics = PartStatistics::default();
            for part in 0..parts.len() {
                let of = PartOfLight {
                    technique: self.name(),
                    settings: &settings,
                    casters: &casters,
                    positions,
                    parts: &parts,
                    part,
                };
                passes.extend(of.passes(turn, &mut buffers, &mut lookups, &mut statistics)?);
            }
            let label = turn.label("wedges");
            let warnings = warnings_of(&label, &statistics.wedges, &statistics.areas);
            turn.notes.warnings.extend(warnings);
            turn.notes.warnings.extend(statistics.hole_warning(&label));
            Ok(passes)
        })
    }

    fn light_image(&self, params: &Params) -> Result<Option<LightImage>, TechniqueError> {
        Ok(CoveringSettings::read(params)?.light_image())
    }

    fn wedges(
        &self,
        scene: &Scene,
        params: &Params,
    ) -> Result<Option<SceneWedges>, TechniqueError> {
        let settings = OptimisedSettings::read(params)?;
        let wedges = settings
            .soft
            .scene_wedges(self.name(), scene, settings.split)?;
        Ok(Some(wedges))
    }

    fn carry_channels(&self, _: &Params) -> Result<Option<CarryChannels>, TechniqueError> {
        let [bits, count] = split_volumes::BITS_AND_CHANNELS;
        let count = count as usize;
        Ok(Some(CarryChannels { bits, count }))
    }
}
