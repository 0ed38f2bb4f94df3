//! Paper III: where time goes, and sixteen lights in one texture.

use super::paper3::TECHNIQUE;
use super::tally::{invocations, pass_time};
use super::{Finding, Lab, Measure, ReproduceError, Theirs, Unit};
use gnomon_pipeline::measure::comparison::{Reference, ReferenceKind};
use gnomon_pipeline::measure::wedge_work::WedgeWork;
use gnomon_pipeline::technique::{DrawRole, PassRole};
use gnomon_pipeline::truth::metrics::visibility::VisibilityError;
use gnomon_pipeline::world::light_image::LightImage;

const WEDGES: [PassRole; 1] = [PassRole::Wedges];

/// Entries along each axis of the coverage texture.
const SIZES: [u32; 4] = [8, 16, 32, 48];

pub(super) fn inside_penumbrae(lab: &mut Lab) -> Result<Finding, ReproduceError> {
    let mut measures = Vec::new();
    for name in ["creature", "spheres"] {
        let scene = lab.scene(name)?;
        let [paper, exact] =
            ["wedge=paper3", "wedge=exact"].map(|set| lab.timed(&scene, TECHNIQUE, &[set]));
        let (paper, exact) = (paper?, exact?);
        measures.push(Measure::new(
            format!("{name}: time of wedges that are penumbrae, of that of paper III's"),
            Theirs::AtLeast(0.5),
            pass_time(&exact, &WEDGES) / pass_time(&paper, &WEDGES),
            Unit::Share,
        ));
        let work = WedgeWork::of(&paper.report, &paper.roles).unwrap_or_default();
        measures.push(Measure::beside(
            format!("{name}: shader invocations that cover something, in paper III's wedges"),
            "-",
            work.covering as f64 / work.shaded.max(1) as f64,
            Unit::Share,
        ));
        let shaded = [&exact, &paper].map(|d| invocations(d, DrawRole::Coverage) as f64);
        measures.push(Measure::beside(
            format!("{name}: invocations in penumbrae, of those in paper III's wedges"),
            "-",
            shaded[0] / shaded[1],
            Unit::Share,
        ));
    }
    Ok(Finding {
        scene: lab.describe("creature and spheres"),
        counted: "time of the wedge pass with the penumbra of each edge as its wedge, over that \
            with the paper's construction; and shader invocations"
            .to_owned(),
        measures,
        reason: "Their shader left points outside a wedge early and took 250 instructions for \
            those inside. Here lanes are shaded together, and a pixel outside costs as much as \
            one inside."
            .to_owned(),
        charts: Vec::new(),
    })
}

pub(super) fn sixteen_lights(lab: &mut Lab) -> Result<Finding, ReproduceError> {
    // Nothing else is off there.
    let scene = lab.scene("parallel-plates")?;
    let image = LightImage::windows();
    let size = lab.size();
    let (kind, of) = (ReferenceKind::Exact, (0, Some(&image)));
    let truth = Reference::with_light_image(&scene, of, size, kind, None, &|| ())?;
    let mut errors = Vec::new();
    for entries in SIZES {
        let entries = format!("texture-size={entries}");
        let done = lab.render(&scene, TECHNIQUE, &["light-image=windows", &entries])?;
        let under = truth.under(&done.depth)?.truth;
        let error = VisibilityError::measure(&under, size, &done.visibility)?;
        errors.push(error.all.map_or(0.0, |e| e.rmse));
    }
    let pairs = SIZES.windows(2).zip(errors.windows(2));
    let falls = pairs.map(|(sizes, errors)| {
        Measure::new(
            format!("RMSE with {} entries an axis over {}", sizes[0], sizes[1]),
            Theirs::AtLeast(1.0),
            errors[0] / errors[1],
            Unit::Ratio,
        )
    });
    let mut measures: Vec<Measure> = falls.collect();
    for (entries, error) in SIZES.iter().zip(&errors) {
        let what = format!("RMSE, {entries} entries an axis");
        measures.push(Measure::beside(what, "-", *error, Unit::Number));
    }
    Ok(Finding {
        scene: lab.describe("parallel-plates under sixteen lights in one image"),
        counted: "RMSE of float visibility against the exact oracle with the same image, nearest \
            look-ups as in the paper"
            .to_owned(),
        measures,
        reason: "Between bright cells coverage is as steep as the light is bright there; entries \
            that do not fall on the cells' borders sample it unevenly."
            .to_owned(),
        charts: Vec::new(),
    })
}
