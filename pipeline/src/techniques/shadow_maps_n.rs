//! The mean of N shadow maps, one from each of N points of the light: brute force,
//! and the reference of image-based soft shadows (500 of them in Annen et al. 2008;
//! docs/papers.md, baselines).
//!
//! Every map is rendered and looked up, so it costs N times a shadow map; what it
//! errs by is the texels, the bias and the N steps of a penumbra. Where N is a
//! power of four sums are exact.

use gnomon_raster::state::ColorTargetState;
use gnomon_shaders::shadow_maps::BoxTaps;

use crate::parts::horizon::HORIZON;
use crate::parts::light_samples::light_points;
use crate::parts::maps::light_view::{LightExtent, ViewedLight};
use crate::parts::maps::mapped::{self, Mapped, Margin, Sources};
use crate::parts::passes;
use crate::technique::{Frame, ParamInfo, Params, Technique, TechniqueError};
use crate::world::light::HardLight;
use crate::world::scene::Scene;

/// The registry's entry.
pub(crate) struct ShadowMapsN;

const MAPS: ParamInfo = ParamInfo {
    name: "maps",
    default: "64",
    valid: "N",
    summary: "points of the light, a square number from 1 to 1024",
};

const PATTERN: ParamInfo = ParamInfo {
    name: "pattern",
    default: "rotated-grid",
    valid: "grid|stratified|rotated-grid",
    summary: "how points are spread over the light",
};

const SEED: ParamInfo = ParamInfo {
    name: "seed",
    default: "1",
    valid: "N",
    summary: "of the jitter of stratified points, and of the depth of points in spheres",
};

impl Technique for ShadowMapsN {
    fn name(&self) -> &'static str {
        "shadow-maps-n"
    }

    fn summary(&self) -> &'static str {
        "soft shadows as the mean of N shadow maps from N points of the light"
    }

    fn params(&self) -> &'static [ParamInfo] {
        const PARAMS: &[ParamInfo] = &[
            MAPS,
            PATTERN,
            SEED,
            mapped::MAP_SIZE,
            mapped::BIAS,
            mapped::SLOPE_BIAS,
            mapped::NEAR,
            mapped::VIEW,
            mapped::FIT,
            HORIZON,
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
        let side = mapped::square_side(self.name(), params, MAPS)?;
        let mapped = Mapped {
            name: self.name(),
            scene,
            size,
            params,
            margin: Margin::ONE_TEXEL,
        };
        mapped.frame(
            |light| self.points(scene, light, side, params),
            |look_up| look_up.share(BoxTaps(1)).stage(),
        )
    }
}

impl ShadowMapsN {
    /// The light as points with its axes.
    fn points(
        &self,
        scene: &Scene,
        light: usize,
        side: u32,
        params: &Params,
    ) -> Result<Sources, TechniqueError> {
        let whole = ViewedLight::new(self.name(), &scene.lights[light], light)?;
        let pattern = mapped::pattern(self.name(), params, PATTERN)?;
        let seed = params.get(SEED.name).parse().unwrap_or(0);
        let points = light_points(&scene.lights[light], pattern, side, seed)?;
        let place = |point: &HardLight| match point {
            HardLight::Point(p) => *p,
            HardLight::Directional(_) => whole.frame.centre,
        };
        let extent = match whole.extent {
            LightExtent::Flat(_) => LightExtent::Flat([glam::DVec3::ZERO; 2]),
            LightExtent::None | LightExtent::Ball(_) => LightExtent::None,
        };
        let view = |point| ViewedLight {
            frame: whole.frame.at(place(point)),
            extent,
        };
        Ok(Sources {
            lights: points.iter().map(view).collect(),
            blend: ColorTargetState::ADDITIVE,
        })
    }
}
