//! The techniques' parameters.

use super::MomentMaps;
use crate::choices;
use crate::parts::frame_settings::FrameSettings;
use crate::parts::horizon::HORIZON;
use crate::parts::maps::mapped::{BIAS, FIT, MapSettings, NEAR, SKIP, SLOPE_BIAS, VIEW};
use crate::technique::{Condition, Decimals, Param, ParamInfo, Params, TechniqueError};

choices! {
    /// How wide kernels are.
    enum Width {
        /// The same for all receivers.
        Fixed = "fixed",
        /// As the light seems.
        Light = "light",
    }
}

const WIDTH: Param<Width> = Param::choice(
    "kernel",
    Width::Light.word(),
    "kernels of one width, or as wide as the light seems through the mean blocker",
);

const TAPS: Param<u32> =
    Param::<u32>::whole("taps", 5, [1, 64], "texels along a side of a fixed kernel")
        .unit("texels")
        .when(Condition::Is("kernel", &["fixed"]));

const SEARCH: Param<u32> = Param::<u32>::square(
    "search-samples",
    36,
    [1, 1024],
    "points that look for blockers, a square number from 1 to 1024",
)
.when(Condition::Is("kernel", &["light"]));

const MAP_SIZE: Param<u32> = Param::<u32>::power_of_two(
    "map-size",
    256,
    [16, 2048],
    "texels along a side of a light view, and of its tables",
)
.unit("texels");

const FROM_ZERO: Decimals = Decimals {
    low: 0.0,
    with_low: true,
};

pub(super) const EXPONENT: Param<Option<f64>> = Param::decimal_or(
    &["auto"],
    "exponent",
    Decimals {
        low: 0.0,
        with_low: false,
    },
    "c of exp(c z), depths being 0..1; auto: as much as the tables' bits resolve",
);

pub(super) const SPREAD: Param<Option<f64>> = Param::decimal_or(
    &["auto"],
    "moment-bias",
    FROM_ZERO,
    "share of a spread distribution that is mixed into moments; auto: four units of the tables",
);

pub(super) const CELLS: Param<u32> = Param::<u32>::whole(
    "cells",
    3,
    [1, 8],
    "cells along a side that kernels are cut into",
)
.unit("cells");

choices! {
    /// Where the plane of occluders is.
    pub(super) enum PlaneAt {
        /// As near to the light as any occluder.
        Nearest = "nearest",
        /// Between.
        Middle = "middle",
        /// As far as any.
        Farthest = "farthest",
    }
}

pub(super) const PLANE: Param<PlaneAt> = Param::choice(
    "plane",
    PlaneAt::Middle.word(),
    "distance of the plane that stands for all occluders",
);

choices! {
    /// Which occluders receivers have.
    pub(super) enum Groups {
        /// One mask of all that casts.
        All = "all",
        /// Each convex piece that casts has a mask of all others.
        Each = "each",
    }
}

pub(super) const GROUPS: Param<Groups> = Param::choice(
    "groups",
    Groups::Each.word(),
    "all: one mask of all that casts, in which receivers that cast are themselves; each: a mask \
     without itself for each convex piece that casts and receives",
);

/// Of those with a choice of kernels.
pub(super) const FILTERED: &[ParamInfo] = &[WIDTH.info, TAPS.info, SEARCH.info];

/// As [`MapSettings::PARAMS`], with tables in mind.
pub(super) const MAPS: &[ParamInfo] = &[
    MAP_SIZE.info,
    BIAS.info,
    SLOPE_BIAS.info,
    NEAR.info,
    VIEW.info,
    FIT.info,
    SKIP
        .with_summary("leave out what of pictures and tables nobody reads, and tiles of the screen to which a further light adds nothing; same bits")
        .info,
];

impl PlaneAt {
    /// The distance, between those of the occluders.
    pub(super) fn between(self, near: f64, far: f64) -> f64 {
        match self {
            Self::Nearest => near,
            Self::Middle => (near + far) * 0.5,
            Self::Farthest => far,
        }
    }
}

/// The exponent with which the square of the least exponential is one of the whole numbers
/// up to `largest`.
fn most_exponent(largest: u32) -> f64 {
    libm::log(f64::from(largest)).max(1.0) / 2.0
}

/// How wide kernels are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kernel {
    /// So many texels.
    Fixed(u32),
    /// As the light seems; so many points look for blockers.
    Light(u32),
}

/// Checked values.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Settings {
    pub(super) kernel: Kernel,
    exponent: Option<f64>,
    spread: Option<f64>,
    pub(super) cells: u32,
    pub(super) plane: PlaneAt,
    /// Whether receivers have masks without themselves.
    pub(super) apart: bool,
    pub(super) horizon: bool,
    pub(super) maps: MapSettings,
    pub(super) frame: FrameSettings,
}

impl Settings {
    pub(super) fn read(of: MomentMaps, params: &Params) -> Result<Self, TechniqueError> {
        let has = |kind| of == kind;
        Ok(Self {
            kernel: match of {
                MomentMaps::VarianceSoft | MomentMaps::Mask => Kernel::Light(0),
                _ => Self::kernel(params)?,
            },
            exponent: match has(MomentMaps::Exponential) {
                true => params.get(&EXPONENT)?,
                false => None,
            },
            spread: match has(MomentMaps::Four) {
                true => params.get(&SPREAD)?,
                false => None,
            },
            cells: match has(MomentMaps::VarianceSoft) {
                true => params.get(&CELLS)?,
                false => 1,
            },
            plane: match has(MomentMaps::Mask) {
                true => params.get(&PLANE)?,
                false => PlaneAt::Middle,
            },
            apart: has(MomentMaps::Mask) && params.get(&GROUPS)? == Groups::Each,
            horizon: params.get(&HORIZON)?,
            maps: MapSettings::read(params)?,
            frame: FrameSettings::read(params)?,
        })
    }

    fn kernel(params: &Params) -> Result<Kernel, TechniqueError> {
        Ok(match params.get(&WIDTH)? {
            Width::Fixed => Kernel::Fixed(params.get(&TAPS)?),
            Width::Light => Kernel::Light(params.get(&SEARCH)?),
        })
    }

    /// The exponent where values are whole numbers up to `largest`.
    pub(super) fn exponent_for(&self, largest: u32) -> f64 {
        let most = most_exponent(largest);
        self.exponent.unwrap_or(most).min(f64::from(f32::MAX))
    }

    /// Whether tables of whole numbers up to `largest` do not tell the exponentials asked
    /// for from 0.
    pub(super) fn exponent_is_beyond(&self, largest: u32) -> bool {
        self.exponent_for(largest) > most_exponent(largest)
    }

    /// The share of a spread distribution, likewise.
    pub(super) fn spread_for(&self, largest: u32) -> f64 {
        /// What arithmetic in f32 needs.
        const LEAST: f64 = 1e-6;
        let auto = (4.0 / f64::from(largest)).max(LEAST);
        self.spread.unwrap_or(auto).min(1.0)
    }
}
