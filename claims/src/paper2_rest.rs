//! Paper II's claims besides culling and passes: frame rates over tile sizes (figure 8), the
//! size of back planes, divisions, and depths of tiles on demand.

use std::collections::BTreeSet;
use std::f64::consts::TAU;

use glam::DVec3;
use gnomon_pipeline::geometry::wedge::paper1::{
    LinkedSettings, LinkedStatistics, LinkedWedge, link,
};
use gnomon_pipeline::measure::render::Rendered;
use gnomon_pipeline::technique::PassRole;

use super::lab::parsed;
use super::paper1::{Divided, rearranged};
use super::paper2_tiles::{TECHNIQUE, TILES};
use super::paper2_time::WEDGES;
use super::tally::{pass_time, ratio};
use super::{Claim, Finding, Lab, Lines, Measure, ReproduceError, Theirs, Unit, Verdict};
use crate::chart::{Axis, Chart, Series};

pub(super) const CLAIMS: &[Claim] = &[
    Claim::new(
        "paper2-tile-size-time",
        "paper II, §7, figure 8",
        Verdict::Times,
        "Tiles of 8 to 32 pixels also give the best frame rates: fewest accesses and least \
         rasterisation go together.",
        tile_size_time,
    )
    .read_from(&[Lines::to(1092, 1097)]),
    Claim::new(
        "paper2-on-demand",
        "paper II, §9",
        Verdict::Counters,
        "Finding zmin and zmax on demand, only of tiles that are asked about, changes nothing \
         significant.",
        on_demand,
    )
    .read_from(&[Lines::one(1137)]),
    Claim::new(
        "paper2-back-planes",
        "paper II, §3",
        Verdict::Arithmetic,
        "The back planes of a closed shadow volume have less area in all than its front \
         planes.",
        back_planes,
    )
    .read_from(&[Lines::one(968)]),
    Claim::new(
        "paper2-divisions",
        "paper II, §3 and §9",
        Verdict::Arithmetic,
        "Entry and exit points cost four divisions a pixel; restructured two are left, for \
         the point and for the intensity, and one where depth is kept in eye space.",
        divisions,
    )
    .read_from(&[Lines::one(964), Lines::one(1001), Lines::one(1135)]),
    Claim::new(
        "paper2-sample-levels",
        "paper II, §8",
        Verdict::Counters,
        "Averaging n hard shadows gives n + 1 intensities of shadow at most.",
        sample_levels,
    )
    .read_from(&[Lines::one(1123)]),
];

/// Counts of samples whose share of the light is exact in binary.
const SAMPLES: [u32; 3] = [4, 16, 64];

fn levels(done: &Rendered) -> usize {
    let seen = done.visibility.iter().filter(|v| v.is_finite());
    seen.map(|v| v.to_bits()).collect::<BTreeSet<u32>>().len()
}

fn sample_levels(lab: &mut Lab) -> Result<Finding, ReproduceError> {
    let scene = lab.scene("eg-logo")?;
    let mut measures = Vec::new();
    for n in SAMPLES {
        let done = lab.render(&scene, "sampled-shadow-volumes", &[&format!("samples={n}")])?;
        measures.push(Measure::new(
            format!("{n} samples: intensities"),
            Theirs::AtMost(f64::from(n + 1)),
            levels(&done) as f64,
            Unit::Count,
        ));
    }
    let wedges = lab.render(&scene, TECHNIQUE, &[])?;
    let text = "256 of 8 bits";
    let ours = levels(&wedges) as f64;
    measures.push(Measure::beside("penumbra wedges", text, ours, Unit::Count));
    Ok(Finding {
        scene: lab.describe("eg-logo"),
        counted: "distinct visibilities of the whole picture, to the bit".to_owned(),
        measures,
        reason: "Light of n points is n equal parts, each there or not.".to_owned(),
        charts: Vec::new(),
    })
}

fn tile_size_time(lab: &mut Lab) -> Result<Finding, ReproduceError> {
    let roles: Vec<PassRole> = WEDGES.into_iter().chain([PassRole::TileDepths]).collect();
    let (mut measures, mut series) = (Vec::new(), Vec::new());
    for scene in ["columns", "fractal"] {
        let built = lab.scene(scene)?;
        let names = TILES.map(|t| format!("tile={t}"));
        let sets = names.each_ref().map(|t| ["passes=three", t.as_str()]);
        let runs = sets.each_ref().map(|set| (TECHNIQUE, &set[..]));
        let done = lab.race(&built, runs)?;
        let times: Vec<[f64; 2]> = TILES
            .iter()
            .zip(&done)
            .map(|(t, d)| [f64::from(*t), pass_time(d, &roles)])
            .collect();
        let best = times.iter().min_by(|a, b| a[1].total_cmp(&b[1]));
        measures.push(Measure::new(
            format!("{scene}: tile of least time"),
            Theirs::Within(8.0, 32.0),
            best.map_or(f64::NAN, |t| t[0]),
            Unit::Count,
        ));
        series.push(Series::line(scene, times));
    }
    Ok(Finding {
        scene: lab.describe("columns and fractal"),
        counted: "time of the passes between ambient and lit, those that find depths and \
            classes of tiles with them, three passes"
            .to_owned(),
        measures,
        reason: "A pixel in a culled tile still runs a shader here, which reads its tile's \
            class and ends: what a larger tile saves is tests, what it costs are pixels that \
            read depth. The curve is flat, and its least place moves."
            .to_owned(),
        charts: vec![Chart {
            name: "paper2-tile-size-time".to_owned(),
            title: "Time of wedges over tile size (paper II, figure 8)".to_owned(),
            x: Axis::log2("side of a tile, pixels"),
            y: Axis::linear("milliseconds"),
            series,
        }],
    })
}

fn on_demand(lab: &mut Lab) -> Result<Finding, ReproduceError> {
    let mut measures = Vec::new();
    for name in ["columns", "fractal"] {
        let scene = lab.scene(name)?;
        let (_, params) = parsed(TECHNIQUE, &["passes=three"])?;
        let settings = lab.settings();
        let measured = gnomon_pipeline::measure::tile_traffic::measure(
            &scene,
            settings.size,
            &params,
            settings.gpu,
        )?;
        let traffic = measured.traffic;
        let [width, height] = settings.size.map(u64::from);
        let all = (width.div_ceil(8)) * height.div_ceil(8);
        let saved = (all - traffic.tiles_met.min(all)) * 64;
        measures.extend([
            Measure::new(
                format!("{name}: depth reads that finding bounds on demand saves, of all"),
                Theirs::None {
                    neutral: 0.0,
                    within: 0.1,
                },
                ratio(saved, traffic.depth_reads + width * height),
                Unit::Share,
            ),
            Measure::beside(
                format!("{name}: tiles that some wedge asks about"),
                "-",
                ratio(traffic.tiles_met, all),
                Unit::Share,
            ),
        ]);
    }
    Ok(Finding {
        scene: lab.describe("columns and fractal"),
        counted: "pixels of tiles of 8 that no triangle of a wedge meets, of the depths that \
            finding zmin and zmax and drawing the wedges reads, 4 B each"
            .to_owned(),
        measures,
        reason: "Wedges leave much of the picture alone here.".to_owned(),
        charts: Vec::new(),
    })
}

/// Wedges of a polygon of 32 corners at height 1.5 under a spherical light at height 4.
fn ring(radius: f64) -> Vec<LinkedWedge> {
    let corner = |k: u32| {
        let angle = TAU * f64::from(k) / 32.0;
        DVec3::new(0.5 * libm::cos(angle), 1.5, -0.5 * libm::sin(angle))
    };
    let points: Vec<DVec3> = (0..32).map(corner).collect();
    let (light, settings) = (DVec3::new(0.0, 4.0, 0.0), LinkedSettings::default());
    link(
        &points,
        light,
        radius,
        &settings,
        &mut LinkedStatistics::default(),
    )
}

/// The area of a quad from an edge along two rays to the floor.
fn area([a, b]: [DVec3; 2], rays: [DVec3; 2]) -> f64 {
    let floor = |p: DVec3, ray: DVec3| p - ray * (p.y / ray.y);
    let (c, d) = (floor(a, rays[0]), floor(b, rays[1]));
    0.5 * ((b - a).cross(c - a).length() + (c - b).cross(d - b).length())
}

fn back_planes(_: &mut Lab) -> Result<Finding, ReproduceError> {
    let mut measures = Vec::new();
    for radius in [0.1, 0.3] {
        let wedges = ring(radius);
        let sum = |rays: fn(&LinkedWedge) -> [DVec3; 2]| -> f64 {
            wedges.iter().map(|w| area(w.edge, rays(w))).sum()
        };
        measures.push(Measure::new(
            format!("light of radius {radius}: area of back planes over front planes"),
            Theirs::AtMost(1.0),
            sum(|w| w.back_rays) / sum(|w| w.front_rays),
            Unit::Ratio,
        ));
    }
    Ok(Finding {
        scene: "regular polygon of 32 corners, radius 0.5, at height 1.5 below a sphere at \
            height 4, above a floor"
            .to_owned(),
        counted: "area in the world of all front and all back planes of its wedges down to the \
            floor"
            .to_owned(),
        measures,
        reason: "The silhouette is not convex.".to_owned(),
        charts: Vec::new(),
    })
}

/// Where the ray of a pixel meets the four planes of a wedge: `-far / rate` each.
fn entry_and_exit(planes: [[Divided; 2]; 4]) -> u32 {
    planes
        .iter()
        .map(|[far, rate]| (*far / *rate).divisions())
        .sum()
}

fn divisions(_: &mut Lab) -> Result<Finding, ReproduceError> {
    let of = Divided::of;
    let plane = |k: f64| [of(k), of(k + 1.0)];
    let original = entry_and_exit([1.0, 2.0, 3.0, 4.0].map(plane));
    // One over w gives x, y and z of the world by products.
    let one_over_w = of(1.0) / of(1.7);
    let distances = [0.3, 0.5, 0.25, 0.75].map(of);
    let intensity = rearranged(distances, [1.1, 0.9, 1.2].map(of)).divisions();
    Ok(Finding {
        scene: "none".to_owned(),
        counted: "divisions of the papers' expressions for a pixel: four planes met by its ray; \
            a point by its w, and equation (3) with one division. The shader here has the last \
            form: planes over pixel and depth are positive where those of the world are, and \
            only quotients of them matter"
            .to_owned(),
        measures: vec![
            Measure::new(
                "entry and exit by planes",
                Theirs::Exactly(4.0),
                f64::from(original),
                Unit::Count,
            ),
            Measure::new(
                "point by w, and intensity",
                Theirs::Exactly(2.0),
                f64::from(one_over_w.divisions() + intensity),
                Unit::Count,
            ),
            Measure::new(
                "intensity alone",
                Theirs::Exactly(1.0),
                f64::from(intensity),
                Unit::Count,
            ),
        ],
        reason: "The expressions are not the papers'.".to_owned(),
        charts: Vec::new(),
    })
}
