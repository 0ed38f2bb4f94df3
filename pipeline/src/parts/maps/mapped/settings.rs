//! Parameters of techniques on light views.

use super::super::light_view::{FitTo, Fitted, Fitting, Views};
use crate::technique::{Choice, Decimals, Param, ParamInfo, Params, TechniqueError};

/// Numbers from 0.
const FROM_ZERO: Decimals = Decimals {
    low: 0.0,
    with_low: true,
};

/// Numbers above 0.
const ABOVE_ZERO: Decimals = Decimals {
    low: 0.0,
    with_low: false,
};

impl Choice for Views {
    const NAMES: &'static [&'static str] = &["auto", "planar", "cube"];
    const ALL: &'static [Self] = &[Self::Auto, Self::Planar, Self::Cube];
}

impl Choice for FitTo {
    const NAMES: &'static [&'static str] = &["casters", "receivers"];
    const ALL: &'static [Self] = &[Self::Casters, Self::Receivers];
}

pub(crate) const MAP_SIZE: Param<u32> = Param::<u32>::power_of_two(
    "map-size",
    512,
    [16, 4096],
    "texels along a side of a light view",
)
.unit("texels");

pub(crate) const BIAS: Param<Option<f64>> = Param::decimal_or(
    &["auto"],
    "bias",
    FROM_ZERO,
    "by how much a blocker is nearer to the light, world units; auto: a share of a texel",
)
.unit("world units");

pub(crate) const SLOPE_BIAS: Param<Option<f64>> = Param::decimal_or(
    &["auto"],
    "slope-bias",
    FROM_ZERO,
    "texels over which a caster's slope is taken to push it away from the light",
)
.unit("texels");

pub(crate) const NEAR: Param<Option<f64>> = Param::decimal_or(
    &["auto"],
    "near",
    ABOVE_ZERO,
    "casters nearer to the light than this are not looked at, world units above 0",
)
.unit("world units");

pub(crate) const VIEW: Param<Views> = Param::choice(
    "view",
    "auto",
    "a view along the light's normal to each side, or cube faces where that is too wide",
);

pub(crate) const FIT: Param<FitTo> = Param::choice(
    "fit",
    "casters",
    "views hold the casters that matter, or all receivers seen and what filters read there",
);

pub(crate) const SKIP: Param<bool> = Param::switch(
    "skip",
    true,
    "leave out casters outside a light view, and tiles of the screen to which a further light adds nothing; same bits",
);

/// How views are fitted to a light, with the parameters of all techniques on them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ViewSettings {
    pub(crate) fitting: Fitting,
    pub(crate) views: Views,
}

impl ViewSettings {
    pub(crate) const PARAMS: &'static [ParamInfo] = &[NEAR.info, VIEW.info, FIT.info];

    /// Of views of `size` texels a side.
    pub(crate) fn read(params: &Params, size: u32) -> Result<Self, TechniqueError> {
        Ok(Self {
            fitting: Fitting {
                size,
                near: params.get(&NEAR)?,
                to: params.get(&FIT)?,
                margin: 0.0,
            },
            views: params.get(&VIEW)?,
        })
    }
}

/// Settings of techniques that compare depths in light views.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct MapSettings {
    pub(crate) view: ViewSettings,
    /// `None`: in proportion to the texels.
    bias: Option<f64>,
    /// `None`: the technique's.
    pub(crate) slope_bias: Option<f64>,
    pub(crate) skip: bool,
}

impl MapSettings {
    pub(crate) const PARAMS: &'static [ParamInfo] = &[
        MAP_SIZE.info,
        BIAS.info,
        SLOPE_BIAS.info,
        NEAR.info,
        VIEW.info,
        FIT.info,
        SKIP.info,
    ];

    pub(crate) fn read(params: &Params) -> Result<Self, TechniqueError> {
        Ok(Self {
            view: ViewSettings::read(params, params.get(&MAP_SIZE)?)?,
            bias: params.get(&BIAS)?,
            slope_bias: params.get(&SLOPE_BIAS)?,
            skip: params.get(&SKIP)?,
        })
    }

    /// The bias of a view, world units.
    pub(crate) fn bias(&self, fitted: &Fitted, margin: Margin) -> f64 {
        let texel = fitted.texel_at_far(self.view.fitting.size);
        self.bias.unwrap_or(texel * margin.bias)
    }
}

/// Whether texels are held against receivers' planes instead of their depths, which
/// needs no slope bias.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Planes {
    /// Not at all: what is looked up holds slopes itself.
    Never,
    /// Under lights that are far away, which may be low over all that is seen.
    Far,
    /// Under all lights.
    Always,
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
    /// Where receivers' planes are looked at.
    pub(crate) planes: Planes,
}

impl Margin {
    /// For one texel: the farthest point of it is half a texel off in both axes.
    pub(crate) const ONE_TEXEL: Self = Self {
        bias: 0.25,
        slope: 0.5,
        planes: Planes::Far,
    };
}
