//! The technique's parameters.

use crate::choices;
use crate::geometry::convolution::{Series, Suppression};
use crate::parts::frame_settings::FrameSettings;
use crate::parts::horizon::HORIZON;
use crate::parts::maps::mapped::ViewSettings;
use crate::technique::{Choice, Condition, Param, ParamInfo, Params, TechniqueError, Whole};

const TERMS: Param<u32> =
    Param::<u32>::whole("m", 4, [1, 16], "order M of the Fourier expansion").unit("terms");

choices! {
    /// How images are prefiltered.
    pub(super) enum Filter {
        /// Mip chains.
        Mip = "mip",
        /// Summed-area tables.
        Sat = "sat",
        /// Of what is left after the mean is taken off.
        SatMean = "sat-mean",
        /// Of exact wrapping integers.
        SatU32 = "sat-u32",
    }
}

const FILTER: Param<Filter> = Param::choice(
    "filter",
    Filter::Mip.word(),
    "prefiltering: mip chains, or summed-area tables of floats, of floats less their mean, or of exact wrapping integers",
);

/// Where images are mip chains.
const UNDER_MIP: Condition = Condition::Is("filter", &["mip"]);

choices! {
    /// Where boxes in tables may end.
    enum Edges {
        /// Anywhere.
        Linear = "linear",
        /// At borders of texels.
        Texel = "texel",
    }
}

const EDGES: Param<Edges> = Param::choice(
    "edges",
    Edges::Linear.word(),
    "edges of boxes in tables: anywhere, or at the nearest border of texels, at fewer texels read",
)
.when(Condition::Not("filter", &["mip"]));

choices! {
    /// Formats of images under mip chains.
    enum ImageFormat {
        /// 8-bit CSM and 16-bit CSM-Z.
        Paper = "paper",
        /// 32-bit floats.
        Float = "float",
    }
}

const FORMAT: Param<ImageFormat> = Param::choice(
    "format",
    ImageFormat::Paper.word(),
    "images under mip: 8-bit CSM and 16-bit CSM-Z, or all 32-bit float",
)
.when(UNDER_MIP);

pub(super) const MAP_SIZE: Param<u32> = Param::<u32>::power_of_two(
    "map-size",
    256,
    [64, 2048],
    "texels along a side of the light view",
)
.unit("texels");

impl Choice for Suppression {
    const NAMES: &'static [&'static str] = &["scale", "double", "none"];
    const ALL: &'static [Self] = &[Self::Scale, Self::Double, Self::None];
}

const RINGING: Param<Suppression> = Param::choice(
    "ringing",
    "scale",
    "suppression: scaled about 1/2 until no plateau rings, twice the part above 1/2, or none",
);

const OFFSET: Param<f64> = Param::decimal(
    "offset",
    1.0,
    0.0,
    "taken off receivers' depths, in half-transitions of the expansion",
)
.unit("half-transitions");

const STRENGTH: Param<f64> = Param::decimal(
    "a",
    30.0,
    0.0,
    "strength A of the sharpening s^(1 + A exp(-B(d - z))); 0 for none",
);

const FALLOFF: Param<f64> = Param::decimal(
    "b",
    20.0,
    0.0,
    "falloff B of the sharpening, depths being 0..1 over the light view",
)
.when(Condition::Not("a", &["0"]));

const PLANE_OFFSET: Param<f64> = Param::decimal(
    "plane-offset",
    0.3,
    0.0,
    "share of what a receiver's plane gains over half a kernel that its depth is lessened by, half of it where blockers are looked for; 0: as in the paper",
);

const ITERATE: Param<u32> = Param::<u32>::whole(
    "iterate",
    0,
    [0, 4],
    "times that the average depth is looked up again with the kernel that follows from it",
);

const THRESHOLD: Param<f64> = Param::decimal_above(
    "threshold",
    0.02,
    0.0,
    "1 - s below which a point is lit and the last look-ups are left out; counted as discarded",
);

const MIP_SHARPER: Param<f64> = Param::decimal(
    "mip-sharper",
    1.2,
    0.0,
    "mip levels finer than the one whose texels are as wide as the kernel",
)
.unit("mip levels")
.when(UNDER_MIP);

const PROBES: Param<Option<u32>> = Param::<Option<u32>>::whole_or(
    &["auto"],
    "probes",
    [1, 16],
    Whole::PowerOfTwo,
    "squares along the longer side of a rectangle's kernel under mip; auto: as many as fit it",
)
.when(UNDER_MIP);

const SKIP: Param<bool> = Param::switch(
    "skip",
    true,
    "leave out casters outside a light view, and tiles of the screen to which a further light adds nothing; same bits",
);

/// Checked values.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Settings {
    pub(super) series: Series,
    pub(super) terms: usize,
    pub(super) filter: Filter,
    pub(super) snapped: bool,
    pub(super) all_float: bool,
    /// Texels along a side of the light view.
    pub(super) side: u32,
    pub(super) view: ViewSettings,
    pub(super) strength: f32,
    pub(super) falloff: f32,
    pub(super) iterations: u32,
    pub(super) threshold: f32,
    pub(super) sharper: f64,
    /// `None`: by the light's sides.
    pub(super) probes: Option<u32>,
    pub(super) skip: bool,
    /// Share of the last kernel; 0 for none.
    pub(super) plane_offset: f32,
    pub(super) horizon: bool,
    pub(super) frame: FrameSettings,
}

impl Settings {
    /// The technique's own, before those of all techniques.
    pub(super) const PARAMS: &'static [ParamInfo] = &[
        TERMS.info,
        FILTER.info,
        EDGES.info,
        FORMAT.info,
        MAP_SIZE.info,
        RINGING.info,
        OFFSET.info,
        STRENGTH.info,
        FALLOFF.info,
        ITERATE.info,
        THRESHOLD.info,
        MIP_SHARPER.info,
        PROBES.info,
        PLANE_OFFSET.info,
        HORIZON.info,
        SKIP.info,
    ];

    pub(super) fn read(params: &Params) -> Result<Self, TechniqueError> {
        let terms = params.get(&TERMS)? as usize;
        let side = params.get(&MAP_SIZE)?;
        Ok(Self {
            series: Series::new(terms, params.get(&RINGING)?, params.get(&OFFSET)?),
            terms,
            filter: params.get(&FILTER)?,
            snapped: params.get(&EDGES)? == Edges::Texel,
            all_float: params.get(&FORMAT)? == ImageFormat::Float,
            side,
            view: ViewSettings::read(params, side)?,
            strength: params.get(&STRENGTH)? as f32,
            falloff: params.get(&FALLOFF)? as f32,
            iterations: params.get(&ITERATE)?,
            threshold: params.get(&THRESHOLD)? as f32,
            sharper: params.get(&MIP_SHARPER)?,
            probes: params.get(&PROBES)?,
            skip: params.get(&SKIP)?,
            plane_offset: params.get(&PLANE_OFFSET)? as f32,
            horizon: params.get(&HORIZON)?,
            frame: FrameSettings::read(params)?,
        })
    }
}
