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

use crate::parts::horizon::HORIZON;
use crate::parts::maps::mapped::{self, Mapped, Margin, Sources};
use crate::parts::passes;
use crate::technique::{Frame, ParamInfo, Params, Technique, TechniqueError};
use crate::world::scene::Scene;

/// The registry's entry.
pub(crate) struct Pcss;

const SAMPLING: ParamInfo = ParamInfo {
    name: "sampling",
    default: "points",
    valid: "points|all",
    summary: "some points of the kernels, or all of their texels",
};

const SEARCH: ParamInfo = ParamInfo {
    name: "search-samples",
    default: "16",
    valid: "N",
    summary: "points that look for blockers, a square number from 1 to 1024",
};

const FILTER: ParamInfo = ParamInfo {
    name: "samples",
    default: "36",
    valid: "N",
    summary: "points that compare depths, a square number from 1 to 1024",
};

const PATTERN: ParamInfo = ParamInfo {
    name: "pattern",
    default: "stratified",
    valid: "grid|stratified|rotated-grid",
    summary: "how points are spread over the kernels, the same for all pixels",
};

const SEED: ParamInfo = ParamInfo {
    name: "seed",
    default: "1",
    valid: "N",
    summary: "of the jitter of stratified points",
};

/// Kernels are wider than any slope bias could make up for: a compromise.
const MARGIN: Margin = Margin {
    bias: 0.5,
    slope: 1.0,
    planes: false,
};

impl Technique for Pcss {
    fn name(&self) -> &'static str {
        "pcss"
    }

    fn summary(&self) -> &'static str {
        "soft shadows by a kernel as wide as the mean blocker asks for"
    }

    fn params(&self) -> &'static [ParamInfo] {
        const PARAMS: &[ParamInfo] = &[
            SAMPLING,
            SEARCH,
            FILTER,
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
        let search = self.points(params, SEARCH, 0)?;
        let filter = self.points(params, FILTER, 1)?;
        let all = params.get(SAMPLING.name) == "all";
        let mapped = Mapped {
            name: self.name(),
            scene,
            size,
            params,
            margin: MARGIN,
        };
        mapped.frame(
            |light| Sources::centre(self.name(), scene, light),
            |look_up| {
                let light_half = look_up.light_half();
                if all {
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

impl Pcss {
    /// Points in -1..1, as many as `info` says; `stage` keeps jitters apart.
    fn points(
        &self,
        params: &Params,
        info: ParamInfo,
        stage: u64,
    ) -> Result<Arc<[[f32; 2]]>, TechniqueError> {
        let side = mapped::square_side(self.name(), params, info)?;
        let pattern = mapped::pattern(self.name(), params, PATTERN)?;
        let seed: u64 = params.get(SEED.name).parse().unwrap_or(0);
        let cells = (0..side).flat_map(|j| (0..side).map(move |i| [i, j]));
        let point = |cell| {
            let place = pattern.place(cell, side, seed * 2 + stage);
            place.map(|a| (2.0 * a - 1.0) as f32)
        };
        Ok(cells.map(point).collect())
    }
}
