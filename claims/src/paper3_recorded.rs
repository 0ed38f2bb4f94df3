//! Paper III's buffer traffic, from recordings under the memory that it describes: every
//! access counted, nothing cached.

use super::paper3::TECHNIQUE;
use super::recorded::{Level, Moved, Recorded, uncached};
use super::tally::ratio;
use super::{Claim, Finding, Lab, Lines, Measure, ReproduceError, Theirs, Unit, Verdict};
use gnomon_pipeline::technique::PassRole;

pub(super) const CLAIMS: &[Claim] = &[Claim::new(
    "paper3-bandwidth-recorded",
    "paper III, §5",
    Verdict::Counters,
    "1024 samples move 585 MB of depth, stencil and visibility a frame, 256 samples \
     146 MB, soft shadow volumes 6.0 MB: from recordings, without caches and HiZ.",
    bandwidth,
)
.read_from(&[Lines::one(1463)])];

const SHADOWS: [PassRole; 3] = [PassRole::Samples, PassRole::HardCount, PassRole::Wedges];

/// Published megabytes: 1,024 samples, 256 samples, soft shadow volumes.
const THEIRS: [f64; 3] = [585.0, 146.0, 6.0];

/// The shadow passes of a recording, as accesses ask for them and in words.
pub(super) fn shadow_passes(recorded: &Recorded) -> Result<[Moved; 2], ReproduceError> {
    let traffic = recorded.judge(&uncached()?)?;
    let levels = [Level::Asked, Level::Moved];
    Ok(levels.map(|level| recorded.moved(&traffic, &SHADOWS, level)))
}

/// Hard shadows of so many points of the light, added up.
pub(super) fn sampled(lab: &Lab, count: u32, size: [u32; 2]) -> Result<[Moved; 2], ReproduceError> {
    let set = format!("samples={count}");
    let run = ("sampled-shadow-volumes", &[&*set][..]);
    shadow_passes(&Recorded::new(lab, &lab.scene("fairy")?, run, size)?)
}

fn soft(lab: &Lab, size: [u32; 2]) -> Result<[Moved; 2], ReproduceError> {
    let run = (TECHNIQUE, &["wedge=paper3"][..]);
    shadow_passes(&Recorded::new(lab, &lab.scene("fairy")?, run, size)?)
}

fn bandwidth(lab: &mut Lab) -> Result<Finding, ReproduceError> {
    // The paper's pictures are square; its largest have 512 pixels a side.
    let size = [lab.size()[0]; 2];
    let counts = [1024, 256, 16];
    let samples = counts.map(|n| sampled(lab, n, size));
    let [all, quarter, few] = samples;
    let (all, quarter, few) = (all?, quarter?, few?);
    let soft = soft(lab, size)?;
    let [asked, words] =
        [0, 1].map(|level| [all, quarter, soft].map(|of: [Moved; 2]| of[level].attachments()));
    let few = few[0].attachments();
    let mut measures = relations(asked, words, few);
    measures.extend(beside(asked, words, &soft[0]));
    Ok(Finding {
        scene: format!("fairy, of our own making, {}x{}", size[0], size[1]),
        counted: "accesses of draws of the shadow passes, from recordings under the profile \
            `naive` (no caches, no HiZ): depth 3 B, stencil 1 B, float visibility 4 B, clears \
            left out; in words depth and stencil of a pixel are one of 4 B; wedges as in \
            paper III"
            .to_owned(),
        measures,
        reason: "Scene and bytes an access of the paper are not stated. Fragments behind the \
            surfaces count here as well: every volume reads depth at each of its pixels."
            .to_owned(),
        charts: Vec::new(),
    })
}

/// What does not depend on scene and bytes.
fn relations(asked: [u64; 3], words: [u64; 3], few: u64) -> Vec<Measure> {
    let times = |what: &str, bytes: [u64; 3]| {
        Measure::new(
            format!("1024 samples over soft shadow volumes, {what}"),
            Theirs::Effect {
                low: 50.0,
                high: 200.0,
                neutral: 1.0,
                slack: 1.0,
            },
            ratio(bytes[0], bytes[2]),
            Unit::Ratio,
        )
    };
    vec![
        Measure::new(
            "theirs: 585 MB over 4, rounded, in MB",
            Theirs::Exactly(THEIRS[1]),
            (THEIRS[0] / 4.0).round(),
            Unit::Number,
        ),
        Measure::new(
            "1024 samples over 256",
            Theirs::None {
                neutral: 4.0,
                within: 0.04,
            },
            ratio(asked[0], asked[1]),
            Unit::Ratio,
        ),
        Measure::new(
            "bytes a sample, 1024 against 16: off by",
            Theirs::None {
                neutral: 0.0,
                within: 0.01,
            },
            ratio(asked[0], few) / 64.0 - 1.0,
            Unit::Share,
        ),
        times("bytes asked for", asked),
        times("words", words),
    ]
}

/// What does, shown beside theirs.
fn beside(asked: [u64; 3], words: [u64; 3], soft: &Moved) -> Vec<Measure> {
    let mut measures = Vec::new();
    let names = [
        ("1024 samples", "585 MB"),
        ("256 samples", "146 MB"),
        ("soft shadow volumes", "6.0 MB"),
    ];
    for (i, (what, theirs)) in names.into_iter().enumerate() {
        let bytes = Unit::Bytes;
        measures.push(Measure::beside(what, theirs, asked[i] as f64, bytes));
        let what = format!("{what}, in words");
        measures.push(Measure::beside(what, theirs, words[i] as f64, bytes));
    }
    measures.push(Measure::beside(
        "a sample",
        "0.571 MB",
        asked[0] as f64 / 1024.0,
        Unit::Bytes,
    ));
    measures.push(Measure::beside(
        "positions read besides, as a texture",
        "depth",
        soft.texture as f64,
        Unit::Bytes,
    ));
    measures
}

#[cfg(test)]
mod tests {
    use super::super::tests::lab;
    use super::*;
    use gnomon_pipeline::measure::render::{RenderSettings, render};
    use gnomon_raster::GpuConfig;

    /// What a recording tells is what a live run without skipping counts.
    #[test]
    fn recorded_bytes_are_those_of_a_run_without_skipping() {
        let lab = lab();
        let scene = lab.scene("fairy").unwrap();
        for (technique, set) in [
            ("sampled-shadow-volumes", &["samples=4"][..]),
            (TECHNIQUE, &["wedge=paper3"][..]),
        ] {
            let recorded = Recorded::new(&lab, &scene, (technique, set), [64, 64]).unwrap();
            let [asked, words] = shadow_passes(&recorded).unwrap();
            let (technique, params) = super::super::lab::parsed(technique, set).unwrap();
            let settings = RenderSettings {
                size: [64, 64],
                gpu: GpuConfig {
                    skip: false,
                    ..GpuConfig::default()
                },
                repeat: 1,
            };
            let live = render(&scene, technique, &params, &settings).unwrap();
            // Passes have clears too; draws do not.
            let passes = live.report.passes.iter().zip(live.roles.passes());
            let passes = passes.filter(|(_, role)| SHADOWS.contains(role));
            let draws = passes.flat_map(|(p, _)| &p.draws);
            let mut counted = 0;
            for draw in draws {
                let t = &draw.counters.traffic;
                counted += t.z.bytes() + t.stencil.bytes() + t.color[0].bytes();
            }
            assert_eq!(asked.attachments(), counted);
            assert!(counted > 0 && words.attachments() >= counted);
        }
    }

    #[test]
    fn samples_cost_alike_and_far_more_than_soft_volumes() {
        let lab = lab();
        let of = |count| sampled(&lab, count, [64, 64]).unwrap()[0].attachments();
        let [four, sixteen] = [4, 16].map(of);
        let each = sixteen as f64 / 4.0 / four as f64;
        assert!((each - 1.0).abs() < 0.05, "{each}");
        let soft = soft(&lab, [64, 64]).unwrap()[0].attachments();
        // A thousand samples are 64 times sixteen.
        assert!(64 * sixteen > 20 * soft, "{sixteen} {soft}");
    }
}
