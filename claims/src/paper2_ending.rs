//! What zmax alone saves where wedges end at the floor, as the paper's do.

use gnomon_pipeline::measure::render::Rendered;
use gnomon_pipeline::technique::PassRole;

use super::paper2_tiles::TECHNIQUE;
use super::tally::{counters, ratio};
use super::{Lab, Measure, ReproduceError, Theirs, Unit};

/// Behind the digits of `text-2002`: the floor.
const LENGTH: &str = "wedge-length=2.2";
const ENDLESS: &str = "wedge-length=infinite";

/// Reads of depth by penumbrae, which the three-pass algorithm has apart.
pub(super) fn penumbra_reads(done: &Rendered) -> u64 {
    counters(done, &[PassRole::Wedges]).traffic.tex[0].read_accesses
}

/// Figures of `text-2002`, beside those of `columns`.
pub(super) fn text(lab: &mut Lab) -> Result<Vec<Measure>, ReproduceError> {
    let scene = lab.scene("text-2002")?;
    let render = |length: &str, culling: &str| {
        lab.render(&scene, TECHNIQUE, &["passes=three", length, culling])
    };
    let of = |length: &str| -> Result<[Rendered; 3], ReproduceError> {
        Ok([
            render(length, "culling=none")?,
            render(length, "culling=zmax")?,
            render(length, "culling=zminmax")?,
        ])
    };
    let (ending, endless) = (of(LENGTH)?, of(ENDLESS)?);
    let saved =
        |[none, zmax, _]: &[Rendered; 3]| 1.0 - ratio(penumbra_reads(zmax), penumbra_reads(none));
    let more = ratio(penumbra_reads(&ending[1]), penumbra_reads(&ending[2])) - 1.0;
    let pairs = ending[2].visibility.iter().zip(&endless[2].visibility);
    let other = pairs.filter(|(a, b)| a.to_bits() != b.to_bits()).count();
    Ok(vec![
        Measure::new(
            "text-2002: more penumbra depth reads with zmax than with both",
            Theirs::share(0.5, 0.5),
            more,
            Unit::Share,
        ),
        Measure::new(
            "text-2002: penumbra depth reads that zmax saves",
            Theirs::None {
                neutral: 0.0,
                within: 0.1,
            },
            saved(&ending),
            Unit::Share,
        ),
        Measure::beside(
            "text-2002: the same of endless wedges",
            "-",
            saved(&endless),
            Unit::Share,
        ),
        Measure::new(
            "text-2002: pixels that endless shadows change, of all",
            Theirs::AtMost(1e-3),
            other as f64 / ending[2].visibility.len() as f64,
            Unit::Share,
        ),
    ])
}
