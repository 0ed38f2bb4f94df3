//! The technique's parameters.

use gnomon_shaders::deferred::obscured::Combine;

use crate::choices;
use crate::parts::frame_settings::FrameSettings;
use crate::technique::{Choice, Condition, Param, ParamInfo, Params, TechniqueError};
use crate::truth::oracle::transport::TransportSettings;

/// Where an environment lights the scene.
const ENVIRONMENT: Condition = Condition::Environment;

choices! {
    /// How an environment becomes lights.
    pub(super) enum Decomposition {
        /// Regions of the map.
        KolligKeller = "kollig-keller",
        /// The scene's own lights.
        Fit = "fit",
    }
}

const DECOMPOSITION: Param<Decomposition> = Param::choice(
    "decomposition",
    Decomposition::KolligKeller.word(),
    "lights that cast shadow: regions of the environment by relaxation (the paper's), or the scene's fitted lights",
)
.when(ENVIRONMENT);

/// Where the environment is cut into regions.
const REGIONS: Condition = Condition::All(&[
    ENVIRONMENT,
    Condition::Is("decomposition", &["kollig-keller"]),
]);

const LIGHTS: Param<usize> = Param::<usize>::power_of_two(
    "lights",
    32,
    [1, 256],
    "regions that the environment is cut into; the paper has 16, 32 and 64",
)
.when(REGIONS);

const SEED: Param<u64> = Param::<u64>::whole(
    "seed",
    1,
    [0, u32::MAX as u64],
    "of the places that relaxation begins with",
)
.when(REGIONS);

choices! {
    /// How wide the square of a light is.
    pub(super) enum Extent {
        /// As the region.
        Region = "region",
        /// As its light is spread.
        Spread = "spread",
    }
}

const EXTENT: Param<Extent> = Param::choice(
    "extent",
    Extent::Spread.word(),
    "width of the square that stands for a light: the solid angle over which its luminance is spread, or that of its region (the paper's)",
)
.when(REGIONS);

const MAP_SIZE: Param<u32> = Param::<u32>::power_of_two(
    "map-size",
    64,
    [8, 256],
    "texels along a side of an occlusion map; the paper has 32, 64 and 128",
)
.unit("texels");

choices! {
    /// Which occluders share a map.
    pub(super) enum Groups {
        /// Those whose boxes touch.
        Near = "near",
        /// None.
        Each = "each",
        /// All.
        All = "all",
    }
}

const GROUPS: Param<Groups> = Param::choice(
    "groups",
    Groups::Near.word(),
    "occluders that share a map: those whose bounding boxes touch, none, or all",
);

impl Choice for Combine {
    const NAMES: &'static [&'static str] = &["product", "min", "sum", "midpoint"];
    const ALL: &'static [Self] = &[Self::Product, Self::Min, Self::Sum, Self::Midpoint];
}

const COMBINE: Param<Combine> = Param::choice(
    "combine",
    "product",
    "occlusions of several groups: visibilities multiplied, the least one, occlusions added up to 1, or the middle of the last two",
)
.when(Condition::Not("groups", &["all"]));

choices! {
    /// Where the plane of a map lies.
    pub(super) enum Plane {
        /// Where the shadow of the occluders' centre falls.
        Struck = "struck",
        /// Through the receiver's centre.
        Centre = "centre",
    }
}

const PLANE: Param<Plane> = Param::choice(
    "plane",
    Plane::Struck.word(),
    "plane whose distance decides how wide a penumbra is: through the point that the shadow of the occluders' centre strikes, or through the receiver's centre (the paper's)",
);

choices! {
    /// What a surface has of a small light near its horizon.
    pub(super) enum Grazing {
        /// The cosine.
        Exact = "exact",
        /// What the bands have of it.
        Bands = "bands",
    }
}

const GRAZING: Param<Grazing> = Param::choice(
    "grazing",
    Grazing::Exact.word(),
    "light of small sources: by the cosine, or by the bands (the paper's), which leave surfaces 6% of a light that has set",
)
.when(ENVIRONMENT);

const BANDS: Param<usize> = Param::<usize>::whole(
    "bands",
    6,
    [2, 8],
    "bands of spherical harmonics of diffuse transport; 6 are 36 terms",
)
.unit("bands");

const GLOSSY_BANDS: Param<usize> = Param::<usize>::whole(
    "glossy-bands",
    4,
    [1, 4],
    "bands of glossy transport; 4 are 16 terms",
)
.unit("bands")
.when(Condition::All(&[
    ENVIRONMENT,
    Condition::Is("shading", &["phong"]),
]));

const DIRECTIONS: Param<usize> = Param::<usize>::power_of_two(
    "directions",
    512,
    [64, 65_536],
    "directions of the rays that find what an object hides of itself, once for its shape",
);

choices! {
    /// Format of radiance, maps and images.
    enum FloatFormat {
        /// 16-bit floats.
        F16 = "f16",
        /// 32-bit floats.
        F32 = "f32",
    }
}

const FORMAT: Param<FloatFormat> = Param::choice(
    "format",
    FloatFormat::F16.word(),
    "radiance textures, occlusion maps and images: 16-bit floats (the paper's) or 32-bit ones",
);

/// Checked values.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Settings {
    pub(super) decomposition: Decomposition,
    pub(super) lights: usize,
    pub(super) seed: u64,
    pub(super) extent: Extent,
    /// Texels along a side of a map.
    pub(super) side: u32,
    pub(super) groups: Groups,
    pub(super) combine: Combine,
    pub(super) plane: Plane,
    pub(super) grazing: Grazing,
    pub(super) transport: TransportSettings,
    pub(super) half_floats: bool,
    pub(super) frame: FrameSettings,
}

impl Settings {
    /// The technique's own, before those of all techniques.
    pub(super) const PARAMS: &'static [ParamInfo] = &[
        DECOMPOSITION.info,
        LIGHTS.info,
        SEED.info,
        EXTENT.info,
        MAP_SIZE.info,
        GROUPS.info,
        COMBINE.info,
        PLANE.info,
        GRAZING.info,
        BANDS.info,
        GLOSSY_BANDS.info,
        DIRECTIONS.info,
        FORMAT.info,
    ];

    pub(super) fn read(params: &Params) -> Result<Self, TechniqueError> {
        Ok(Self {
            decomposition: params.get(&DECOMPOSITION)?,
            lights: params.get(&LIGHTS)?,
            seed: params.get(&SEED)?,
            extent: params.get(&EXTENT)?,
            side: params.get(&MAP_SIZE)?,
            groups: params.get(&GROUPS)?,
            combine: params.get(&COMBINE)?,
            plane: params.get(&PLANE)?,
            grazing: params.get(&GRAZING)?,
            transport: TransportSettings {
                bands: params.get(&BANDS)?,
                glossy_bands: params.get(&GLOSSY_BANDS)?,
                directions: params.get(&DIRECTIONS)?,
            },
            half_floats: params.get(&FORMAT)? == FloatFormat::F16,
            frame: FrameSettings::read(params)?,
        })
    }
}
