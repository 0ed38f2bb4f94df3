//! What the penumbra-wedge techniques of papers I and II share.

pub(crate) mod axes;
pub(crate) mod casters;
pub(crate) mod depth_copy;
pub(crate) mod hard;
pub(crate) mod light;
pub(crate) mod reach;
pub(crate) mod report;
pub(crate) mod screen;
pub(crate) mod shape;
pub(crate) mod volume;

use gnomon_raster::{Format, LoadOp, Recording, RenderPass, TextureDescriptor, TextureId};
use gnomon_shaders::penumbra::FULL;
use gnomon_shaders::penumbra::intensity::Interpolation;

use crate::geometry::caster::CasterPolicy;
use crate::geometry::wedge::WedgeMesh;
use crate::geometry::wedge::paper1::{LinkedSettings, LinkedWedge};
use crate::parts::casters::{OPEN_CASTERS, examine, open_casters};
use crate::parts::frame_settings::FrameSettings;
use crate::parts::horizon::HORIZON;
use crate::parts::passes::{SceneDraws, Targets};
use crate::parts::visibility::{VisibilityTexture, attachment};
use crate::technique::{
    Choice, Condition, LightFact, Param, ParamInfo, Params, Pass, PassRole, SceneWedges,
    TechniqueError, WedgeKind,
};
use crate::world::scene::Scene;
use light::{LIGHT_AS, LightAs, LightSphere};
use report::LinkedReport;

impl Choice for Interpolation {
    const NAMES: &'static [&'static str] = &["linear", "smoothstep"];
    const ALL: &'static [Self] = &[Self::Linear, Self::Smoothstep];
}

pub(crate) const INTERPOLATION: Param<Interpolation> = Param::choice(
    "interpolation",
    "linear",
    "between full light and full shadow: linear, or 3s^2 - 2s^3, nearer to a sphere",
)
.when(Condition::Lights(LightFact::Extended));

pub(crate) const EXTRA_WEDGES: Param<bool> = Param::switch(
    "extra-wedges",
    true,
    "up to six more wedges round acute vertices",
)
.when(Condition::Lights(LightFact::Extended));

/// Settings of both techniques on linked wedges.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct PenumbraSettings {
    pub(crate) interpolation: Interpolation,
    pub(crate) extra_wedges: bool,
    pub(crate) light_as: LightAs,
    pub(crate) horizon: bool,
    pub(crate) open_casters: CasterPolicy,
    pub(crate) frame: FrameSettings,
}

impl PenumbraSettings {
    /// Those besides [`INTERPOLATION`], which a technique may have conditions for.
    pub(crate) const OTHER_PARAMS: &'static [ParamInfo] = &[
        EXTRA_WEDGES.info,
        LIGHT_AS.info,
        HORIZON.info,
        OPEN_CASTERS.info,
    ];

    pub(crate) fn read(params: &Params) -> Result<Self, TechniqueError> {
        Ok(Self {
            interpolation: params.get(&INTERPOLATION)?,
            extra_wedges: params.get(&EXTRA_WEDGES)?,
            light_as: params.get(&LIGHT_AS)?,
            horizon: params.get(&HORIZON)?,
            open_casters: open_casters(params)?,
            frame: FrameSettings::read(params)?,
        })
    }

    pub(crate) fn linked(&self) -> LinkedSettings {
        LinkedSettings {
            extra_wedges: self.extra_wedges,
            ..LinkedSettings::default()
        }
    }
}

/// The linked wedges of a scene, to be looked at.
pub(crate) fn scene_wedges(scene: &Scene, params: &Params) -> Result<SceneWedges, TechniqueError> {
    let settings = PenumbraSettings::read(params)?;
    let casters = examine(scene, settings.open_casters)?;
    let mut meshes: Vec<WedgeMesh> = Vec::new();
    for light in settings.frame.lights(scene)? {
        let Some(sphere) = LightSphere::of(&scene.lights[light], settings.light_as) else {
            continue;
        };
        for caster in &casters {
            let report = &mut LinkedReport::default();
            let volume = caster.soft_volume(&sphere, &settings.linked(), None, report);
            meshes.extend(volume.wedges.iter().map(LinkedWedge::mesh));
        }
    }
    Ok(SceneWedges {
        kind: WedgeKind::Linked,
        meshes,
    })
}

/// The light-intensity buffer, which all lights use in turn: signed 16 bits, 255
/// is full light.
pub(crate) fn light_intensity(
    [width, height]: [u32; 2],
    recording: &mut Recording,
) -> Result<TextureId, TechniqueError> {
    let desc = TextureDescriptor::d2("light intensity", Format::R16Sint, width, height);
    Ok(recording.create(&desc)?)
}

/// The buffer as visibility: clamped to 0..=255 (paper I, §4), over 255.
pub(crate) fn visibility(buffer: TextureId) -> VisibilityTexture {
    VisibilityTexture {
        scale: 1.0 / FULL,
        ..VisibilityTexture::red(buffer)
    }
}

/// A pass into a light-intensity buffer, without draws.
pub(crate) fn intensity_pass(
    label: String,
    buffer: TextureId,
    load: LoadOp<[f32; 4]>,
) -> RenderPass {
    RenderPass {
        label,
        color: vec![attachment(buffer, load)],
        depth_stencil: None,
        draws: Vec::new(),
    }
}

/// The pass that gives full light to what takes no shadow, if there is anything.
pub(crate) fn not_receiving_pass(
    label: String,
    buffer: TextureId,
    targets: &Targets,
    draws: &SceneDraws<'_>,
) -> Option<Pass> {
    let list = draws.not_receiving(&label, [FULL, 0.0, 0.0, 0.0]);
    let pass = (!list.is_empty()).then(|| RenderPass {
        depth_stencil: targets.depth_stencil(LoadOp::Load, LoadOp::Load),
        draws: list,
        ..intensity_pass(label, buffer, LoadOp::Load)
    });
    pass.map(|pass| Pass::new(PassRole::NotReceiving, pass))
}

/// Every pixel at `intensity`.
pub(crate) fn cleared(intensity: f32) -> LoadOp<[f32; 4]> {
    LoadOp::Clear([intensity, 0.0, 0.0, 0.0])
}

#[cfg(test)]
mod tests;
