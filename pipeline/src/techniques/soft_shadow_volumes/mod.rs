//! Soft shadow volumes (Assarsson and Akenine-Möller, paper III; docs/papers.md, paper III).
//!
//! Per light: the visibility buffer starts at 1; hard shadow quads take 1 where
//! the light's centre is hidden; then each silhouette edge's penumbra wedge adds
//! what the edge covers of the light on the umbra side of its quad, and takes it
//! away on the other. For one caster with one simple silhouette loop that is the
//! visible share of the light, not an approximation of it. What overlaps, and
//! silhouettes that differ over the light, are the papers' known errors.
//!
//! # Departures from the paper, and why
//!
//! * Quads are counted by the side of eye and receiver, not by depth: count and
//!   sign then share one predicate to the bit, and neither caps nor z-fail are
//!   needed for an eye in shadow. `count=depth` and `buffer=rgba8` count as the paper.
//! * Floats are blended, in one pass for all wedges; `copy-back=on` does without, as the
//!   paper had to.
//! * The receiver's position comes from an attachment of the ambient pass instead
//!   of the depth buffer, whose 24 bits would be seen in the penumbra.
//! * Wedges only choose pixels. The shader gives exactly 0 outside the penumbra,
//!   so `wedge` and `skip` change counters and no bit.

mod buffers;
mod settings;
mod umbra;
mod volumes;

use crate::param_list;
use crate::parts::frame_settings::FrameSettings;
use crate::parts::passes::LitTest;
use crate::parts::shadowed_frame::ShadowedFrame;
use crate::parts::volumes::light_contacts;
use crate::parts::wedges::soft::covering::{CoveringSettings, Coverings};
use crate::parts::wedges::soft::edges::SoftCasters;
use crate::parts::wedges::soft::light::SoftLight;
use crate::parts::wedges::soft::settings::{SOFT_LIGHTS, SoftSettings, WEDGE};
use crate::technique::{
    Capabilities, CarryChannels, Frame, ParamInfo, Params, Pass, PassRole, SceneWedges, ShadowKind,
    Technique, TechniqueError, WedgeUse,
};
use crate::world::light_image::LightImage;
use crate::world::scene::Scene;
use buffers::Buffers;
use settings::{BUFFER, COPY_BACK, COUNT, Count, SoftVolumesSettings};
use umbra::Umbra;
use volumes::LightVolumes;

/// The registry's entry.
pub(crate) struct SoftShadowVolumes;

impl Technique for SoftShadowVolumes {
    fn name(&self) -> &'static str {
        "soft-shadow-volumes"
    }

    fn summary(&self) -> &'static str {
        "soft shadows of rectangles, discs, spheres and polygons by penumbra wedges (paper III)"
    }

    fn params(&self) -> &'static [ParamInfo] {
        param_list!(
            &[WEDGE.info],
            CoveringSettings::PARAMS,
            &[BUFFER.info, COUNT.info, COPY_BACK.info],
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
        let settings = SoftVolumesSettings::read(params)?;
        let soft = settings.soft;
        let has_image = settings.covering.image.is_some();
        let scene = &*settings.covering.lit(scene);
        let casters = SoftCasters::new(scene, size, soft.open_casters)?;
        let frame = ShadowedFrame::new(scene, size, &soft.frame)?;
        let frame = frame.with_horizon(soft.horizon, has_image);
        let (mut frame, positions) = frame.with_positions()?;
        let buffers = Buffers::create(size, &settings, &mut frame.recording)?;
        let mut coverings = Coverings::default();
        frame.lit(LitTest::Visibility(buffers.visibility()), |turn| {
            let number = turn.number;
            let contact = light_contacts::warning(scene, number);
            turn.notes.warnings.extend(contact);
            let (source, reach, seen) = (turn.light(), casters.size(), soft.seen());
            let light = SoftLight::new(self.name(), source, number, turn.view(), reach, seen)?;
            let silhouettes = casters.silhouettes(light.centre);
            let covering = &settings.covering;
            let mut volumes = LightVolumes {
                view: turn.view(),
                targets: turn.targets,
                positions,
                buffers: &buffers,
                light: &light,
                settings: &soft,
                covering: coverings.of(self.name(), &light, number, covering, turn.recording)?,
            };
            let umbra = Umbra {
                view: turn.view(),
                targets: turn.targets,
                positions,
                buffers: &buffers,
                light: &light,
                by_depth: settings.count == Count::Depth,
            };
            let (quads, label) = (turn.label("quads"), turn.label("wedges"));
            let warnings = &mut turn.notes.warnings;
            let mut passes = umbra.passes(&quads, &silhouettes);
            passes.extend(volumes.wedge_passes(&label, &silhouettes, warnings));
            passes.extend(umbra.stencil_pass(&quads, &silhouettes));
            let layers = || casters.most_layers(light.centre);
            warnings.extend(umbra.warning(&quads, layers));
            let resolve = buffers.resolve_pass(turn.label("resolve"), turn.targets, positions);
            passes.extend(resolve.map(|pass| Pass::new(PassRole::Resolve, pass)));
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
        let settings = SoftSettings::read(params)?;
        settings.scene_wedges(self.name(), scene, 1).map(Some)
    }

    fn carry_channels(&self, params: &Params) -> Result<Option<CarryChannels>, TechniqueError> {
        Ok(SoftVolumesSettings::read(params)?.carry_channels())
    }
}
