//! Percentage-closer filtering: depths are compared one by one, then the outcomes
//! are filtered by one kernel for all receivers (docs/papers.md, baselines). It hides the
//! texels of hard shadows. It is no soft shadow: the kernel knows nothing of light
//! and blockers, which the parallel plates show.

use gnomon_shaders::shadow_maps::{BoxTaps, CubicTaps};

use crate::parts::maps::mapped::{self, Mapped, Margin, Sources};
use crate::parts::passes;
use crate::technique::{Frame, ParamInfo, Params, Technique, TechniqueError};
use crate::world::scene::Scene;

/// The registry's entry.
pub(crate) struct Pcf;

const KERNEL: ParamInfo = ParamInfo {
    name: "kernel",
    default: "box",
    valid: "box|bicubic",
    summary: "the mean of taps x taps texels, or the cubic B-spline over 16",
};

const TAPS: ParamInfo = ParamInfo {
    name: "taps",
    default: "4",
    valid: "N",
    summary: "texels along a side of the box kernel, 1 to 64",
};

const MOST_TAPS: u32 = 64;

impl Technique for Pcf {
    fn name(&self) -> &'static str {
        "pcf"
    }

    fn summary(&self) -> &'static str {
        "shadow mapping with edges blurred by a kernel of fixed width"
    }

    fn params(&self) -> &'static [ParamInfo] {
        const PARAMS: &[ParamInfo] = &[
            KERNEL,
            TAPS,
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
        let taps = taps(self.name(), params)?;
        let cubic = params.get(KERNEL.name) == "bicubic";
        let width = if cubic { 4 } else { taps };
        // Over a kernel a slope bias would have to be as wide as it is, and part shadows
        // from their casters by as much.
        let margin = Margin {
            bias: 0.5,
            slope: if width > 1 { 0.0 } else { 0.5 },
            planes: width > 1,
        };
        let mapped = Mapped {
            name: self.name(),
            scene,
            size,
            params,
            margin,
        };
        mapped.frame(
            |light| Sources::centre(self.name(), scene, light),
            |look_up| match cubic {
                true => look_up.whole(CubicTaps).stage(),
                false => look_up.whole(BoxTaps(taps)).stage(),
            },
        )
    }
}

fn taps(technique: &'static str, params: &Params) -> Result<u32, TechniqueError> {
    let taps = params.get(TAPS.name).parse().unwrap_or(0);
    if (1..=MOST_TAPS).contains(&taps) {
        return Ok(taps);
    }
    Err(TechniqueError::BadValue {
        technique,
        key: TAPS.name,
        value: params.get(TAPS.name).to_owned(),
        valid: "1 to 64",
    })
}
