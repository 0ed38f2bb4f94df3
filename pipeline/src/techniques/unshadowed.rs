//! The scene without shadows: ambient light, then every light added everywhere.

use gnomon_raster::Recording;

use crate::technique::{Frame, ParamInfo, Params, Technique, TechniqueError, VisibilityOutput};
use crate::world::scene::Scene;

use crate::parts::passes::{self, LitTest, SceneDraws};

/// The registry's entry.
pub(crate) struct Unshadowed;

impl Technique for Unshadowed {
    fn name(&self) -> &'static str {
        "unshadowed"
    }

    fn summary(&self) -> &'static str {
        "every light reaches everything: the picture without shadows"
    }

    fn params(&self) -> &'static [ParamInfo] {
        const PARAMS: &[ParamInfo] = &[
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
        let targets = passes::Targets::create(size, params, &mut recording)?;
        let draws = SceneDraws::new(scene, size, params);
        let mut list = vec![draws.ambient_pass(&targets)];
        let lights = passes::lights(scene, params)?;
        for &light in &lights {
            let label = passes::label("lit", light, &lights);
            list.push(draws.lit_pass(&targets, light, &label, LitTest::Everywhere));
        }
        targets.frame(recording, list, VisibilityOutput::Full)
    }
}
