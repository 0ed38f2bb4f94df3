//! The mean of N shadow maps, one from each of N points of the light: brute force,
//! and the reference of image-based soft shadows (500 of them in Annen et al. 2008;
//! docs/papers.md, baselines).
//!
//! Every map is rendered and looked up, so it costs N times a shadow map; what it
//! errs by is the texels, the bias and the N steps of a penumbra. Where N is a
//! power of four sums are exact.

use gnomon_raster::state::ColorTargetState;
use gnomon_shaders::shadow_maps::BoxTaps;

use crate::param_list;
use crate::parts::frame_settings::FrameSettings;
use crate::parts::horizon::HORIZON;
use crate::parts::light_samples::{Pattern, light_points};
use crate::parts::maps::light_view::{LightExtent, ViewedLight};
use crate::parts::maps::mapped::{MapSettings, Mapped, Margin, Sources};
use crate::technique::{
    Capabilities, Condition, Frame, LightFact, Param, ParamInfo, Params, ShadowKind, Technique,
    TechniqueError,
};
use crate::world::light::HardLight;
use crate::world::scene::Scene;

/// The registry's entry.
pub(crate) struct ShadowMapsN;

const MAPS: Param<u32> = Param::<u32>::square(
    "maps",
    64,
    [1, 1024],
    "points of the light, a square number from 1 to 1024",
)
.when(Condition::Lights(LightFact::Extended));

const PATTERN: Param<Pattern> = Param::choice(
    "pattern",
    "rotated-grid",
    "how points are spread over the light",
)
.when(Condition::Lights(LightFact::Extended));

const SEED: Param<u64> = Param::<u64>::whole(
    "seed",
    1,
    [0, u32::MAX as u64],
    "of the jitter of stratified points, and of the depth of points in spheres",
)
.when(Condition::Any(&[
    Condition::All(&[
        Condition::Is("pattern", &["stratified"]),
        Condition::Lights(LightFact::Extended),
    ]),
    Condition::Lights(LightFact::Sphere),
]));

/// What parameters decide.
struct ShadowMapsNSettings {
    /// Points along a side.
    side: u32,
    pattern: Pattern,
    seed: u64,
    horizon: bool,
    maps: MapSettings,
    frame: FrameSettings,
}

impl ShadowMapsNSettings {
    fn read(params: &Params) -> Result<Self, TechniqueError> {
        Ok(Self {
            side: params.get(&MAPS)?.isqrt(),
            pattern: params.get(&PATTERN)?,
            seed: params.get(&SEED)?,
            horizon: params.get(&HORIZON)?,
            maps: MapSettings::read(params)?,
            frame: FrameSettings::read(params)?,
        })
    }
}

impl Technique for ShadowMapsN {
    fn name(&self) -> &'static str {
        "shadow-maps-n"
    }

    fn summary(&self) -> &'static str {
        "soft shadows as the mean of N shadow maps from N points of the light"
    }

    fn params(&self) -> &'static [ParamInfo] {
        param_list!(
            &[MAPS.info, PATTERN.info, SEED.info],
            MapSettings::PARAMS,
            &[HORIZON.info],
            FrameSettings::PARAMS
        )
    }

    fn capabilities(&self) -> Capabilities {
        Capabilities::of_light_views(ShadowKind::Soft)
    }

    fn frame(
        &self,
        scene: &Scene,
        size: [u32; 2],
        params: &Params,
    ) -> Result<Frame, TechniqueError> {
        let settings = ShadowMapsNSettings::read(params)?;
        let mapped = Mapped {
            scene,
            size,
            frame: settings.frame,
            maps: settings.maps,
            horizon: settings.horizon,
            margin: Margin::ONE_TEXEL,
            apart: false,
        };
        mapped.frame(
            |light| self.points(scene, light, &settings),
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
        settings: &ShadowMapsNSettings,
    ) -> Result<Sources, TechniqueError> {
        let whole = ViewedLight::new(self.name(), &scene.lights[light], light)?;
        let ShadowMapsNSettings {
            pattern,
            side,
            seed,
            ..
        } = *settings;
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
