//! Parameters of techniques on light views.

use super::super::light_view::{FitTo, Fitted, Fitting, Views};
use crate::parts::light_samples::{Pattern, UnknownPattern};
use crate::technique::{ParamInfo, Params, TechniqueError};

pub(crate) const MAP_SIZE: ParamInfo = ParamInfo {
    name: "map-size",
    default: "512",
    valid: "16|32|64|128|256|512|1024|2048|4096",
    summary: "texels along a side of a light view",
};

pub(crate) const BIAS: ParamInfo = ParamInfo {
    name: "bias",
    default: "auto",
    valid: "auto|X",
    summary: "by how much a blocker is nearer to the light, world units; auto: a share of a texel",
};

pub(crate) const SLOPE_BIAS: ParamInfo = ParamInfo {
    name: "slope-bias",
    default: "auto",
    valid: "auto|X",
    summary: "texels over which a caster's slope is taken to push it away from the light",
};

pub(crate) const NEAR: ParamInfo = ParamInfo {
    name: "near",
    default: "auto",
    valid: "auto|X",
    summary: "casters nearer to the light than this are not looked at, world units above 0",
};

pub(crate) const VIEW: ParamInfo = ParamInfo {
    name: "view",
    default: "auto",
    valid: "auto|planar|cube",
    summary: "a view along the light's normal to each side, or cube faces where that is too wide",
};

pub(crate) const FIT: ParamInfo = ParamInfo {
    name: "fit",
    default: "casters",
    valid: "casters|receivers",
    summary: "views hold the casters that matter, or all receivers seen and what filters read there",
};

pub(crate) const SKIP: ParamInfo = ParamInfo {
    name: "skip",
    default: "on",
    valid: "on|off",
    summary: "leave out casters outside a light view, and tiles of the screen to which a further light adds nothing; same bits",
};

/// The checked values of the parameters above.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct MapParams {
    pub(crate) fitting: Fitting,
    pub(crate) views: Views,
    /// `None`: in proportion to the texels.
    bias: Option<f64>,
    /// `None`: the technique's.
    pub(crate) slope_bias: Option<f64>,
    pub(crate) skip: bool,
}

impl MapParams {
    pub(crate) fn new(technique: &'static str, params: &Params) -> Result<Self, TechniqueError> {
        let near = decimal(params, NEAR);
        if near == Some(0.0) {
            return Err(TechniqueError::BadValue {
                technique,
                key: NEAR.name,
                value: params.get(NEAR.name).to_owned(),
                valid: "auto and numbers above 0",
            });
        }
        Ok(Self {
            fitting: Fitting {
                size: params.get(MAP_SIZE.name).parse().unwrap_or(512),
                near,
                to: match params.get(FIT.name) {
                    "receivers" => FitTo::Receivers,
                    _ => FitTo::Casters,
                },
            },
            views: match params.get(VIEW.name) {
                "planar" => Views::Planar,
                "cube" => Views::Cube,
                _ => Views::Auto,
            },
            bias: decimal(params, BIAS),
            slope_bias: decimal(params, SLOPE_BIAS),
            skip: params.get(SKIP.name) != "off",
        })
    }

    /// The bias of a view, world units.
    pub(crate) fn bias(&self, fitted: &Fitted, margin: Margin) -> f64 {
        let texel = fitted.texel_at_far(self.fitting.size);
        self.bias.unwrap_or(texel * margin.bias)
    }
}

/// What keeps surfaces from shadowing themselves, where it is not given. Each
/// technique's is what was best against the exact oracle on the built-in scenes:
/// less leaves dots on surfaces seen steeply from the light, more parts shadows
/// from their casters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Margin {
    /// Bias in texels' widths at the farthest receiver.
    pub(crate) bias: f64,
    /// Slope bias in texels.
    pub(crate) slope: f64,
    /// Whether texels are held against receivers' planes instead, which needs no slope
    /// bias; so they always are under lights that are far away, which may be low over
    /// all that is seen.
    pub(crate) planes: bool,
}

impl Margin {
    /// For one texel: the farthest point of it is half a texel off in both axes.
    pub(crate) const ONE_TEXEL: Self = Self {
        bias: 0.25,
        slope: 0.5,
        planes: false,
    };
}

/// A decimal parameter; `None` for a word.
fn decimal(params: &Params, info: ParamInfo) -> Option<f64> {
    params.get(info.name).parse().ok()
}

/// The side of a square number of points, 1 to 1024.
pub(crate) fn square_side(
    technique: &'static str,
    params: &Params,
    info: ParamInfo,
) -> Result<u32, TechniqueError> {
    let count: u32 = params.get(info.name).parse().unwrap_or(0);
    let side = count.isqrt();
    if (1..=32).contains(&side) && side * side == count {
        return Ok(side);
    }
    Err(TechniqueError::BadValue {
        technique,
        key: info.name,
        value: params.get(info.name).to_owned(),
        valid: "square numbers from 1 to 1024: 1, 4, 9, 16, 25, ...",
    })
}

/// How points are spread, for a technique with such a parameter and a seed.
pub(crate) fn pattern(
    technique: &'static str,
    params: &Params,
    info: ParamInfo,
) -> Result<Pattern, TechniqueError> {
    let pattern = params.get(info.name).parse();
    pattern.map_err(|UnknownPattern(value)| TechniqueError::BadValue {
        technique,
        key: info.name,
        value,
        valid: info.valid,
    })
}
