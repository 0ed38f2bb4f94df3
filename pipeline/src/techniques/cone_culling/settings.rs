//! The technique's parameters.

use crate::choices;
use crate::parts::frame_settings::FrameSettings;
use crate::parts::maps::mapped::{MAP_SIZE, SKIP, ViewSettings};
use crate::technique::{Condition, Param, ParamInfo, Params, TechniqueError};

choices! {
    /// How the patches of a cone are found.
    pub(super) enum Method {
        /// At points of a disc.
        Kernel = "kernel",
        /// By a tree of boxes.
        Octree = "octree",
        /// Among all.
        All = "all",
    }
}

const METHOD: Param<Method> = Param::choice(
    "method",
    Method::Kernel.word(),
    "patches are looked up at points of a disc, found by a tree of boxes over them, or all looked at",
);

choices! {
    /// What patches' solid angles are taken from.
    enum PatchForm {
        /// As the paper has it for the method.
        Auto = "auto",
        /// Spheres round them.
        Spheres = "spheres",
        /// Themselves.
        Rectangles = "rectangles",
    }
}

const PATCHES: Param<PatchForm> = Param::choice(
    "patches",
    PatchForm::Auto.word(),
    "solid angles of patches: of spheres round them or of the rectangles themselves; auto: spheres for the kernel, else rectangles",
);

/// Where patches are looked up at points.
const BY_KERNEL: Condition = Condition::Is("method", &["kernel"]);

const SAMPLES: Param<u32> = Param::<u32>::whole(
    "samples",
    88,
    [1, 4096],
    "points of the disc, for each receiver",
)
.when(BY_KERNEL);

const SPREAD: Param<f64> = Param::decimal_above(
    "spread",
    0.6,
    0.0,
    "standard deviation of the points' Gaussian density, radii of the disc",
)
.when(BY_KERNEL);

const SEED: Param<u64> =
    Param::<u64>::whole("seed", 1, [0, u32::MAX as u64], "of the points").when(BY_KERNEL);

/// What parameters decide.
#[derive(Clone, Copy, Debug)]
pub(super) struct Settings {
    pub(super) method: Method,
    /// Rectangles instead of spheres.
    pub(super) rectangles: bool,
    pub(super) samples: u32,
    pub(super) spread: f64,
    pub(super) seed: u64,
    /// Texels along a side.
    pub(super) side: u32,
    pub(super) skip: bool,
    pub(super) view: ViewSettings,
    pub(super) frame: FrameSettings,
}

impl Settings {
    pub(super) const PARAMS: &'static [ParamInfo] = &[
        METHOD.info,
        PATCHES.info,
        SAMPLES.info,
        SPREAD.info,
        SEED.info,
        MAP_SIZE.info,
        SKIP.info,
    ];

    pub(super) fn read(params: &Params) -> Result<Self, TechniqueError> {
        let side = params.get(&MAP_SIZE)?;
        let method = params.get(&METHOD)?;
        Ok(Self {
            method,
            rectangles: match params.get(&PATCHES)? {
                PatchForm::Auto => method != Method::Kernel,
                PatchForm::Spheres => false,
                PatchForm::Rectangles => true,
            },
            samples: params.get(&SAMPLES)?,
            spread: params.get(&SPREAD)?,
            seed: params.get(&SEED)?,
            side,
            skip: params.get(&SKIP)?,
            view: ViewSettings::read(params, side)?,
            frame: FrameSettings::read(params)?,
        })
    }
}
