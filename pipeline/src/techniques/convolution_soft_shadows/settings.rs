//! The technique's parameters.

use crate::geometry::convolution::{Series, Suppression};
use crate::parts::maps::light_view::{Fitting, Views};
use crate::parts::maps::mapped::MapParams;
use crate::technique::{ParamInfo, Params, TechniqueError};

pub(super) const TERMS: ParamInfo = ParamInfo {
    name: "m",
    default: "4",
    valid: "1|2|3|4|5|6|7|8|9|10|11|12|13|14|15|16",
    summary: "order M of the Fourier expansion",
};

pub(super) const FILTER: ParamInfo = ParamInfo {
    name: "filter",
    default: "mip",
    valid: "mip|sat|sat-mean|sat-u32",
    summary: "prefiltering: mip chains, or summed-area tables of floats, of floats less their mean, or of exact wrapping integers",
};

pub(super) const EDGES: ParamInfo = ParamInfo {
    name: "edges",
    default: "linear",
    valid: "linear|texel",
    summary: "edges of boxes in tables: anywhere, or at the nearest border of texels, at fewer texels read",
};

pub(super) const FORMAT: ParamInfo = ParamInfo {
    name: "format",
    default: "paper",
    valid: "paper|float",
    summary: "images under mip: 8-bit CSM and 16-bit CSM-Z, or all 32-bit float",
};

pub(super) const MAP_SIZE: ParamInfo = ParamInfo {
    name: "map-size",
    default: "512",
    valid: "64|128|256|512|1024|2048",
    summary: "texels along a side of the light view",
};

pub(super) const RINGING: ParamInfo = ParamInfo {
    name: "ringing",
    default: "scale",
    valid: "scale|double|none",
    summary: "suppression: scaled about 1/2 until no plateau rings, twice the part above 1/2, or none",
};

pub(super) const OFFSET: ParamInfo = ParamInfo {
    name: "offset",
    default: "1",
    valid: "X",
    summary: "taken off receivers' depths, in half-transitions of the expansion",
};

pub(super) const STRENGTH: ParamInfo = ParamInfo {
    name: "a",
    default: "30",
    valid: "X",
    summary: "strength A of the sharpening s^(1 + A exp(-B(d - z))); 0 for none",
};

pub(super) const FALLOFF: ParamInfo = ParamInfo {
    name: "b",
    default: "20",
    valid: "X",
    summary: "falloff B of the sharpening, depths being 0..1 over the light view",
};

pub(super) const ITERATE: ParamInfo = ParamInfo {
    name: "iterate",
    default: "0",
    valid: "0|1|2|3|4",
    summary: "times that the average depth is looked up again with the kernel that follows from it",
};

pub(super) const THRESHOLD: ParamInfo = ParamInfo {
    name: "threshold",
    default: "0.02",
    valid: "X",
    summary: "1 - s below which a point is lit and the last look-ups are left out; counted as discarded",
};

pub(super) const MIP_SHARPER: ParamInfo = ParamInfo {
    name: "mip-sharper",
    default: "0.8",
    valid: "X",
    summary: "mip levels finer than the one whose texels are as wide as the kernel",
};

pub(super) const PROBES: ParamInfo = ParamInfo {
    name: "probes",
    default: "auto",
    valid: "auto|1|2|4|8|16",
    summary: "squares along the longer side of a rectangle's kernel under mip; auto: as many as fit it",
};

pub(super) const SKIP: ParamInfo = ParamInfo {
    name: "skip",
    default: "on",
    valid: "on|off",
    summary: "build images, mip levels and tables only where some receiver reads them, look a further light up only in tiles that it can light; same bits",
};

/// How images are prefiltered.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Filter {
    Mip,
    Sat,
    /// Of what is left after the mean is taken off.
    SatMean,
    SatU32,
}

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
    pub(super) fitting: Fitting,
    pub(super) views: Views,
    pub(super) strength: f32,
    pub(super) falloff: f32,
    pub(super) iterations: u32,
    pub(super) threshold: f32,
    pub(super) sharper: f64,
    /// `None`: by the light's sides.
    pub(super) probes: Option<u32>,
    pub(super) skip: bool,
}

impl Settings {
    pub(super) fn new(technique: &'static str, params: &Params) -> Result<Self, TechniqueError> {
        let number = |info: &ParamInfo| params.get(info.name).parse::<f64>().unwrap_or(0.0);
        let terms = number(&TERMS) as usize;
        let suppression = match params.get(RINGING.name) {
            "none" => Suppression::None,
            "double" => Suppression::Double,
            _ => Suppression::Scale,
        };
        let filter = match params.get(FILTER.name) {
            "sat" => Filter::Sat,
            "sat-mean" => Filter::SatMean,
            "sat-u32" => Filter::SatU32,
            _ => Filter::Mip,
        };
        if number(&THRESHOLD) <= 0.0 {
            return Err(TechniqueError::BadValue {
                technique,
                key: THRESHOLD.name,
                value: params.get(THRESHOLD.name).to_owned(),
                valid: "above 0: the average depth is divided by 1 - s",
            });
        }
        let maps = MapParams::new(technique, params)?;
        Ok(Self {
            fitting: maps.fitting,
            views: maps.views,
            series: Series::new(terms, suppression, number(&OFFSET)),
            terms,
            filter,
            snapped: params.get(EDGES.name) == "texel",
            all_float: params.get(FORMAT.name) == "float",
            side: maps.fitting.size,
            strength: number(&STRENGTH) as f32,
            falloff: number(&FALLOFF) as f32,
            iterations: number(&ITERATE) as u32,
            threshold: number(&THRESHOLD) as f32,
            sharper: number(&MIP_SHARPER),
            probes: params.get(PROBES.name).parse().ok(),
            skip: params.get(SKIP.name) != "off",
        })
    }
}
