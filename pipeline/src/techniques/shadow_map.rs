//! Shadow mapping: one look-up in a light view for each receiver (docs/papers.md,
//! baselines). Hard shadows of the light's centre, with the resolution of the view.

use gnomon_shaders::shadow_maps::BoxTaps;

use crate::param_list;
use crate::parts::frame_settings::FrameSettings;
use crate::parts::horizon::HORIZON;
use crate::parts::maps::mapped::{MapSettings, Mapped, Margin, Sources};
use crate::technique::{
    Capabilities, Frame, ParamInfo, Params, ShadowKind, Technique, TechniqueError,
};
use crate::world::scene::Scene;

/// The registry's entry.
pub(crate) struct ShadowMap;

impl Technique for ShadowMap {
    fn name(&self) -> &'static str {
        "shadow-map"
    }

    fn summary(&self) -> &'static str {
        "hard shadows of the light's centre, looked up in a view from there"
    }

    fn params(&self) -> &'static [ParamInfo] {
        param_list!(MapSettings::PARAMS, &[HORIZON.info], FrameSettings::PARAMS)
    }

    fn capabilities(&self) -> Capabilities {
        Capabilities::of_light_views(ShadowKind::Hard)
    }

    fn frame(
        &self,
        scene: &Scene,
        size: [u32; 2],
        params: &Params,
    ) -> Result<Frame, TechniqueError> {
        let mapped = Mapped {
            scene,
            size,
            frame: FrameSettings::read(params)?,
            maps: MapSettings::read(params)?,
            horizon: params.get(&HORIZON)?,
            margin: Margin::ONE_TEXEL,
            apart: false,
        };
        mapped.frame(
            |light| Sources::centre(self.name(), scene, light),
            |look_up| look_up.whole(BoxTaps(1)).stage(),
        )
    }
}
