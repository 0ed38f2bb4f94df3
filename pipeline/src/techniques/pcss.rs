//! Percentage-closer soft shadows: the mean depth of what blocks round a receiver
//! gives the width of the kernel that depths are then compared in (docs/papers.md,
//! baselines).
//!
//! Blockers are looked for as far as the light seems wide through the view's near
//! distance, W(z_n); only those that block count for the mean z_avg; depths are
//! compared over W(z_avg). A rectangle has a width for each axis of the picture;
//! other lights are taken for a square of their area. With every texel of the
//! kernels it is exact where light, blocker and receiver are parallel, but for the
//! texels; with few samples it shows bands, or noise where they are turned.
//!
//! Known errors, of the method: one mean depth stands for all blockers, so a
//! kernel is too wide or too narrow where there are several; surfaces that are
//! seen steeply shadow themselves within the kernel, which the bias can only
//! lessen.

use std::sync::Arc;

use gnomon_shaders::shadow_maps::{SampledKernel, WholeKernel};

use crate::parts::frame_settings::FrameSettings;
use crate::parts::horizon::HORIZON;
use crate::parts::light_samples::Pattern;
use crate::parts::maps::mapped::{
    BIAS, FIT, MAP_SIZE, MapSettings, Mapped, Margin, NEAR, Planes, SKIP, SLOPE_BIAS, Sources, VIEW,
};
use crate::technique::{
    Capabilities, Condition, Frame, Param, ParamInfo, Params, ShadowKind, Technique,
    TechniqueError, Value,
};
use crate::world::scene::Scene;
use crate::{choices, param_list};

/// The registry's entry.
pub(crate) struct Pcss;

choices! {
    /// Which texels of the kernels are read.
    enum Sampling {
        /// Some.
        Points = "points",
        /// All.
        All = "all",
    }
}

const SAMPLING: Param<Sampling> = Param::choice(
    "sampling",
    Sampling::Points.word(),
    "some points of the kernels, or all of their texels",
);

/// Where kernels are sampled at points.
const AT_POINTS: Condition = Condition::Is("sampling", &["points"]);

const SEARCH: Param<u32> = Param::<u32>::square(
    "search-samples",
    16,
    [1, 1024],
    "points that look for blockers, a square number from 1 to 1024",
)
.when(AT_POINTS);

const FILTER: Param<u32> = Param::<u32>::square(
    "samples",
    36,
    [1, 1024],
    "points that compare depths, a square number from 1 to 1024",
)
.when(AT_POINTS);

const PATTERN: Param<Pattern> = Param::choice(
    "pattern",
    "stratified",
    "how points are spread over the kernels, the same for all pixels",
)
.when(AT_POINTS);

const SEED: Param<u64> = Param::<u64>::whole(
    "seed",
    1,
    [0, u32::MAX as u64],
    "of the jitter of stratified points",
)
.when(Condition::All(&[
    AT_POINTS,
    Condition::Is("pattern", &["stratified"]),
]));

/// As [`MapSettings::PARAMS`]. Kernels of few points see a coarser picture as well, and
/// surfaces shadow themselves less in it: of 128 to 1024 texels the least error over the
/// built-in scenes for its bytes.
const MAPS: &[ParamInfo] = &[
    MAP_SIZE.with_default(Value::Whole(256)).info,
    BIAS.info,
    SLOPE_BIAS.info,
    NEAR.info,
    VIEW.info,
    FIT.info,
    SKIP.info,
];

/// What parameters decide.
struct PcssSettings {
    sampling: Sampling,
    /// Points along a side.
    search: u32,
    /// Points along a side.
    filter: u32,
    pattern: Pattern,
    seed: u64,
    horizon: bool,
    maps: MapSettings,
    frame: FrameSettings,
}

impl PcssSettings {
    fn read(params: &Params) -> Result<Self, TechniqueError> {
        Ok(Self {
            sampling: params.get(&SAMPLING)?,
            search: params.get(&SEARCH)?.isqrt(),
            filter: params.get(&FILTER)?.isqrt(),
            pattern: params.get(&PATTERN)?,
            seed: params.get(&SEED)?,
            horizon: params.get(&HORIZON)?,
            maps: MapSettings::read(params)?,
            frame: FrameSettings::read(params)?,
        })
    }

    /// `side` times `side` points in -1..1; `stage` keeps jitters apart.
    fn points(&self, side: u32, stage: u64) -> Arc<[[f32; 2]]> {
        let cells = (0..side).flat_map(|j| (0..side).map(move |i| [i, j]));
        let point = |cell| {
            let place = self.pattern.place(cell, side, self.seed * 2 + stage);
            place.map(|a| (2.0 * a - 1.0) as f32)
        };
        cells.map(point).collect()
    }
}

/// Kernels are wider than any slope bias could make up for: a compromise.
const MARGIN: Margin = Margin {
    bias: 0.5,
    slope: 1.0,
    planes: Planes::Far,
};

impl Technique for Pcss {
    fn name(&self) -> &'static str {
        "pcss"
    }

    fn summary(&self) -> &'static str {
        "soft shadows by a kernel as wide as the mean blocker asks for"
    }

    fn params(&self) -> &'static [ParamInfo] {
        param_list!(
            &[
                SAMPLING.info,
                SEARCH.info,
                FILTER.info,
                PATTERN.info,
                SEED.info
            ],
            MAPS,
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
        let settings = PcssSettings::read(params)?;
        let search = settings.points(settings.search, 0);
        let filter = settings.points(settings.filter, 1);
        let mapped = Mapped {
            scene,
            size,
            frame: settings.frame,
            maps: settings.maps,
            horizon: settings.horizon,
            margin: MARGIN,
            apart: false,
        };
        mapped.frame(
            |light| Sources::centre(self.name(), scene, light),
            |look_up| {
                let light_half = look_up.light_half();
                if settings.sampling == Sampling::All {
                    return look_up.whole(WholeKernel { light_half }).stage();
                }
                let kernel = SampledKernel {
                    light_half,
                    search: search.clone(),
                    filter: filter.clone(),
                };
                look_up.whole(kernel).stage()
            },
        )
    }
}
