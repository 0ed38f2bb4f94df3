//! The technique's parameters.

use crate::choices;
use crate::parts::frame_settings::FrameSettings;
use crate::parts::maps::mapped::MapSettings;
use crate::technique::{Condition, Decimals, Param, ParamInfo, Params, TechniqueError};

choices! {
    /// What is attached to silhouettes.
    pub(super) enum Construction {
        /// Rectangles of fixed width, and corners.
        Smoothies = "smoothies",
        /// Cones from vertices, and sheets.
        Cones = "cones",
    }
}

const CONSTRUCTION: Param<Construction> = Param::choice(
    "construction",
    Construction::Smoothies.word(),
    "geometry round silhouettes: smoothies of fixed width in the light's picture, or cones and sheets that touch the light (Wyman and Hansen 2003)",
);

/// Where smoothies are rectangles.
const OF_FIXED_WIDTH: Condition = Condition::Is("construction", &["smoothies"]);

const WIDTH: Param<Option<f64>> = Param::decimal_or(
    &["auto"],
    "width",
    Decimals {
        low: 0.0,
        with_low: false,
    },
    "width of smoothies in the light's picture, tangents; auto: the light's half width over the mean distance of silhouettes",
)
.unit("tangents")
.when(OF_FIXED_WIDTH);

choices! {
    /// What becomes of alpha.
    enum Alpha {
        /// It is divided by 1 - b/r.
        Remapped = "remapped",
        /// It stays.
        Linear = "linear",
    }
}

const ALPHA: Param<Alpha> = Param::choice(
    "alpha",
    Alpha::Remapped.word(),
    "alpha is divided by 1 - b/r, b of the smoothie and r of what is behind it, or left as it is, which parts shadows from their casters",
)
.when(OF_FIXED_WIDTH);

choices! {
    /// How many texels are looked up.
    enum Filter {
        /// One.
        Nearest = "nearest",
        /// Four, weighted.
        Four = "2x2",
    }
}

const FILTER: Param<Filter> = Param::choice(
    "filter",
    Filter::Nearest.word(),
    "look-ups at the nearest texel, or at the nearest 2x2, whose outcomes are weighted",
);

/// What parameters decide.
#[derive(Clone, Copy, Debug)]
pub(super) struct Settings {
    pub(super) construction: Construction,
    /// `None`: from the light.
    pub(super) width: Option<f64>,
    pub(super) remapped: bool,
    pub(super) filtered: bool,
    pub(super) maps: MapSettings,
    pub(super) frame: FrameSettings,
}

impl Settings {
    pub(super) const PARAMS: &'static [ParamInfo] =
        &[CONSTRUCTION.info, WIDTH.info, ALPHA.info, FILTER.info];

    pub(super) fn read(params: &Params) -> Result<Self, TechniqueError> {
        Ok(Self {
            construction: params.get(&CONSTRUCTION)?,
            width: params.get(&WIDTH)?,
            remapped: params.get(&ALPHA)? == Alpha::Remapped,
            filtered: params.get(&FILTER)? == Filter::Four,
            maps: MapSettings::read(params)?,
            frame: FrameSettings::read(params)?,
        })
    }
}
