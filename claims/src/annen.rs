//! Annen, Dong, Mertens, Bekaert, Seidel and Kautz, "Real-Time, All-Frequency
//! Shadows in Dynamic Scenes", 2008: look-ups and memory (§4.1, §6).
//!
//! Its scenes are scans and a robot under probes of St. Peter's and others; ours
//! are built-in, `statue` for its Buddha of 70k faces and the procedural sky for
//! its maps. Its claims are of a program that keeps the images of all lights; ours
//! uses one set for all of them in turn, and sizes here are of one light times
//! their number.

use gnomon_raster::TextureDescriptor;

use super::tally::{bytes_with_levels, counters};
use super::{
    Claim, Finding, Lab, Measure, ReproduceError, Theirs, Unit, Verdict, annen_shadows, annen_sky,
    annen_table,
};
use gnomon_pipeline::technique::PassRole;
use gnomon_pipeline::technique::TechniqueError;

pub(super) const CLAIMS: &[Claim] = &[
    Claim::new(
        "annen-look-ups",
        "Annen et al., §4.1",
        Verdict::Arithmetic,
        "At M = 4 all stages together look up six RGBA texels and one of depth.",
        look_ups,
    ),
    Claim::new(
        "annen-memory",
        "Annen et al., §6",
        Verdict::Arithmetic,
        "At M = 4 mip chains need two RGBA textures of 8 bits and two of 16; summed-area \
         tables need all four in 32 bits.",
        memory,
    ),
    Claim::new(
        "annen-missing-entries",
        "Annen et al., §6, table 1",
        Verdict::Arithmetic,
        "Where table 1 has no entry, the images were more than the memory of the card.",
        missing,
    ),
    Claim::new(
        "annen-table1",
        "Annen et al., §6, table 1",
        Verdict::Times,
        "Frame rates of a statue of 70k faces under 1 to 40 lights, views of 128 to 1024 \
         texels, mip chains and summed-area tables; as times over those of mip chains, 256 \
         texels, one light.",
        annen_table::table,
    ),
    Claim::new(
        "annen-threefold",
        "Annen et al., §6",
        Verdict::Counters,
        "Mip chains are more than three times as fast as summed-area tables.",
        annen_table::threefold,
    ),
    Claim::new(
        "annen-lights",
        "Annen et al., §6, figure 10",
        Verdict::Counters,
        "Of 30, 45 and 60 lights fitted to a map, 30 differ visibly from 1000 sampled \
         directions, and 45 hardly.",
        annen_sky::numbers_of_lights,
    ),
    Claim::new(
        "annen-brute-force",
        "Annen et al., §6, figure 11",
        Verdict::Times,
        "30 lights, by tables or mip chains, look like 500 shadow maps, which are much slower.",
        annen_sky::brute_force,
    ),
    Claim::new(
        "annen-mip-quality",
        "Annen et al., §5 and §6, figure 8",
        Verdict::Counters,
        "Under one light mip chains are less accurate than summed-area tables.",
        annen_shadows::mip_quality,
    ),
    Claim::new(
        "annen-contact",
        "Annen et al., §3.3 and §6, figure 9",
        Verdict::Counters,
        "Sharpening darkens contacts, where a short series leaks light, and leaves large \
         penumbrae alone.",
        annen_shadows::contact,
    ),
    Claim::new(
        "annen-pcss-banding",
        "Annen et al., §6, figure 7",
        Verdict::Counters,
        "Percentage-closer soft shadows band in large penumbrae, having too few samples.",
        annen_shadows::banding,
    ),
    Claim::quoted(
        "annen-frame-rates",
        "Annen et al., §6",
        "GeForce 8800 GTX: 29.4 fps with 30 lights of 256x256; table 1 at 256x256, mip chains \
         228, 44, 25 and 15 fps, tables 110, 13 and 7.5 fps at 1, 10, 20 and 40 lights.",
    ),
    Claim::quoted(
        "annen-other-methods",
        "Annen et al., §6, figure 7",
        "Backprojection darkens too much where depth is complex; bitmasks are a little better \
         at contacts. Quoted, since there is neither technique here.",
    ),
];

pub(super) const TECHNIQUE: &str = "convolution-soft-shadows";

/// What a pixel that goes all the way looks up.
struct LookUps {
    rgba: f64,
    depth: f64,
}

impl LookUps {
    /// From two frames that differ in how many pixels stop before the last look-ups:
    /// what these fetch less is what the last look-ups of a pixel are.
    fn new(lab: &Lab, filter: &str) -> Result<Self, ReproduceError> {
        let scene = lab.scene("cylinder")?;
        let frame = |threshold| {
            let set = [filter, threshold, "map-size=256", "fit=receivers"];
            let done = lab.render(&scene, TECHNIQUE, &set)?;
            Ok::<_, ReproduceError>(counters(&done, &[PassRole::LookUp]))
        };
        let [more, less] = [frame("threshold=0.02")?, frame("threshold=0.7")?];
        let fetches = |slot: usize| more.traffic.tex_fetches[slot] as f64;
        let written = [&more, &less].map(|c| c.fragments.written as f64);
        let last = (fetches(1) - less.traffic.tex_fetches[1] as f64) / (written[0] - written[1]);
        // Views that hold all receivers: each shaded pixel looks up depth.
        let shaded = more.fragment_shader_invocations as f64;
        let first = (fetches(1) - last * written[0]) / shaded;
        Ok(Self {
            rgba: fetches(2) / shaded + first + last,
            depth: fetches(3) / shaded,
        })
    }
}

fn look_ups(lab: &mut Lab) -> Result<Finding, ReproduceError> {
    let mip = LookUps::new(lab, "filter=mip")?;
    let sat = LookUps::new(lab, "filter=sat")?;
    let exactly =
        |what: &str, theirs, ours| Measure::new(what, Theirs::Exactly(theirs), ours, Unit::Count);
    let beside = |what: &str, ours| Measure::beside(what, "-", ours, Unit::Count);
    Ok(Finding {
        scene: lab.describe("cylinder"),
        counted: "API-level fetches of the pass `look-up` for a pixel that goes all the way: \
            two CSM-Z and one depth at the first width, two CSM there and two at the last width; \
            4 B an RGBA8 texel, 8 B an RGBA16, 16 B an RGBA32, 4 B of depth. A box of a table \
            is its four corners, each a filtered fetch. Positions, which the paper has from its \
            own fragments, are left out"
            .to_owned(),
        measures: vec![
            exactly("RGBA look-ups, mip chains", 6.0, mip.rgba),
            exactly("depth look-ups, mip chains", 1.0, mip.depth),
            beside("RGBA look-ups, tables", sat.rgba),
            beside("depth look-ups, tables", sat.depth),
            exactly(
                "fetches a box of a table",
                4.0,
                (sat.rgba + sat.depth) / 7.0,
            ),
        ],
        reason: "A pixel that nothing shadows stops before the last two look-ups.".to_owned(),
        charts: Vec::new(),
    })
}

/// Sides of light views in table 1.
pub(super) const SIDES: [u32; 4] = [128, 256, 512, 1024];
/// Numbers of lights in table 1.
pub(super) const LIGHTS: [usize; 4] = [1, 10, 20, 40];
/// How images are prefiltered, and what table 1 calls it.
pub(super) const FILTERS: [(&str, &str); 2] = [("filter=mip", "mip"), ("filter=sat", "SAT")];

/// Images of a light that are kept for its look-ups, without what filtering needs.
struct Images {
    csm: TextureDescriptor,
    csm_z: TextureDescriptor,
    depth: TextureDescriptor,
}

impl Images {
    fn new(lab: &Lab, filter: &str, side: u32) -> Result<Self, ReproduceError> {
        let scene = lab.scene("cylinder")?;
        let side = format!("map-size={side}");
        let made = lab.textures(&scene, TECHNIQUE, &[filter, &side])?;
        let find = |label: &str| made.iter().find(|t| t.label == label).cloned();
        let all = || Some((find("csm")?, find("csm-z")?, find("csm depth")?));
        let (csm, csm_z, depth) = all().ok_or_else(no_images)?;
        Ok(Self { csm, csm_z, depth })
    }

    fn bytes(&self) -> u64 {
        let all = [&self.csm, &self.csm_z, &self.depth];
        all.into_iter().map(bytes_with_levels).sum()
    }
}

fn no_images() -> TechniqueError {
    TechniqueError::BadValue {
        technique: TECHNIQUE,
        key: "filter",
        value: String::new(),
        valid: "filters that make textures csm, csm-z and csm depth".to_owned(),
    }
}

/// Bytes of a texel of a light view, without mip levels.
fn a_texel(texture: &TextureDescriptor, side: u32) -> f64 {
    let whole = super::tally::bytes_of(texture) as f64;
    whole / (f64::from(side) * f64::from(side))
}

fn memory(lab: &mut Lab) -> Result<Finding, ReproduceError> {
    let side = SIDES[0];
    let [mip, sat] = FILTERS.map(|(filter, _)| Images::new(lab, filter, side));
    let (mip, sat) = (mip?, sat?);
    let texel = |what: &str, theirs, texture: &TextureDescriptor| {
        let theirs = Theirs::Exactly(theirs);
        Measure::new(what, theirs, a_texel(texture, side), Unit::Bytes)
    };
    let mut measures = vec![
        texel("mip: CSM a texel, 2 RGBA8", 8.0, &mip.csm),
        texel("mip: CSM-Z a texel, 2 RGBA16", 16.0, &mip.csm_z),
        texel("SAT: CSM a texel, 2 RGBA32", 32.0, &sat.csm),
        texel("SAT: CSM-Z a texel, 2 RGBA32", 32.0, &sat.csm_z),
        Measure::beside("depth a texel", "-", a_texel(&mip.depth, side), Unit::Bytes),
    ];
    for side in SIDES {
        let [mip, sat] = FILTERS.map(|(filter, _)| Images::new(lab, filter, side));
        let (mip, sat) = (mip?.bytes() as f64, sat?.bytes() as f64);
        let row = |what: &str, ours, unit| {
            Measure::beside(format!("{side}x{side}: {what}"), "-", ours, unit)
        };
        measures.push(row("a light's mip chains", mip, Unit::Bytes));
        measures.push(row("a light's tables", sat, Unit::Bytes));
        measures.push(row("tables over mip chains", sat / mip, Unit::Ratio));
    }
    Ok(Finding {
        scene: "textures that the technique creates".to_owned(),
        counted: "bytes of CSM, CSM-Z and depth images, with their mip levels; second copies \
            that filtering needs, and the light view itself, are left out"
            .to_owned(),
        measures,
        reason: "The formats are others.".to_owned(),
        charts: Vec::new(),
    })
}

/// Memory of the card that the paper names, from its data sheet.
const CARD: f64 = 768.0 * 1024.0 * 1024.0;

fn missing(lab: &mut Lab) -> Result<Finding, ReproduceError> {
    let (mut there, mut missing) = (Vec::new(), Vec::new());
    for (f, (filter, _)) in FILTERS.into_iter().enumerate() {
        for (s, side) in SIDES.into_iter().enumerate() {
            let one = Images::new(lab, filter, side)?.bytes() as f64;
            for (l, lights) in LIGHTS.into_iter().enumerate() {
                let bytes = one * lights as f64;
                match annen_table::FPS[f][s][l] {
                    Some(_) => there.push(bytes),
                    None => missing.push(bytes),
                }
            }
        }
    }
    let most = there.iter().copied().fold(0.0, f64::max);
    let least = missing.iter().copied().fold(f64::INFINITY, f64::min);
    let fit = missing.iter().filter(|b| **b <= CARD).count();
    let too_large = there.iter().filter(|b| **b > CARD).count();
    let count = |what: &str, ours: usize| {
        Measure::new(what, Theirs::Exactly(0.0), ours as f64, Unit::Count)
    };
    Ok(Finding {
        scene: "textures that the technique creates, times the number of lights".to_owned(),
        counted: "bytes of CSM, CSM-Z and depth images with their mip levels, each light with \
            its own; table 1 has 27 entries, and 5 are missing. The card, a GeForce 8800 GTX, \
            has 768 MiB"
            .to_owned(),
        measures: vec![
            Measure::new(
                "least bytes of a missing entry over most of one that is there",
                Theirs::AtLeast(1.0),
                least / most,
                Unit::Ratio,
            ),
            count("missing entries that the card holds", fit),
            count(
                "entries that are there and that it does not hold",
                too_large,
            ),
            Measure::beside("SAT, 128x128, 40 lights: missing", "-", least, Unit::Bytes),
            Measure::beside("SAT, 1024x1024, 20 lights: there", "-", most, Unit::Bytes),
        ],
        reason: "By the formats that the paper gives, tables of 128x128 for 40 lights are some 45 \
            MB and have no entry, while those of 1024x1024 for 20 lights are 1.4 GB, more than \
            the card has, and have one. Memory of the images alone does not explain the table."
            .to_owned(),
        charts: Vec::new(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Judgement, LabSettings, find};

    fn measured(id: &str) -> Finding {
        let settings = LabSettings {
            size: [64, 48],
            ..LabSettings::default()
        };
        let found = find(id).unwrap().measure(&mut Lab::new(settings, None));
        found.unwrap().unwrap()
    }

    #[test]
    fn arithmetic_holds() {
        for id in ["annen-look-ups", "annen-memory"] {
            let found = measured(id);
            assert_eq!(found.judgement(), Judgement::Holds, "{:?}", found.measures);
        }
    }

    /// Memory does not explain where table 1 is empty: shown as what it is.
    #[test]
    fn what_is_missing_would_have_fitted() {
        let found = measured("annen-missing-entries");
        let judged = found.measures[..3].iter().map(Measure::judgement);
        assert!(judged.into_iter().all(|j| j == Judgement::DoesNotHold));
        assert!(found.reason_if_needed().unwrap().contains("1.4 GB"));
        // 128 x 128 texels of four RGBA32 images and depth, 40 lights.
        assert_eq!(found.measures[3].ours, 128.0 * 128.0 * 68.0 * 40.0);
    }
}
