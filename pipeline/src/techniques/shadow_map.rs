//! Shadow mapping: one look-up in a light view for each receiver (docs/papers.md,
//! baselines). Hard shadows of the light's centre, with the resolution of the view.

use gnomon_shaders::shadow_maps::BoxTaps;

use crate::parts::maps::mapped::{self, Mapped, Margin, Sources};
use crate::parts::passes;
use crate::technique::{Frame, ParamInfo, Params, Technique, TechniqueError};
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
        const PARAMS: &[ParamInfo] = &[
            mapped::MAP_SIZE,
            mapped::BIAS,
            mapped::SLOPE_BIAS,
            mapped::NEAR,
            mapped::VIEW,
            mapped::FIT,
            passes::LIGHT,
            mapped::SKIP,
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
        let mapped = Mapped {
            name: self.name(),
            scene,
            size,
            params,
            margin: Margin::ONE_TEXEL,
        };
        mapped.frame(
            |light| Sources::centre(self.name(), scene, light),
            |look_up| look_up.whole(BoxTaps(1)).stage(),
        )
    }
}
