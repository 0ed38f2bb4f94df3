//! Tamura, Johan and Nishita 2006: deferred shadowing.

use super::{Claim, Finding, Lab, Measure, ReproduceError, Theirs, Unit, Verdict, scenes};
use gnomon_pipeline::measure::comparison::RadianceScore;
use gnomon_pipeline::truth::oracle::transport::{Transport, TransportObject, TransportSettings};
use gnomon_pipeline::world::environment::{Environment, FitSettings, MapSettings, SKY};
use gnomon_pipeline::world::scene::Scene;
use gnomon_pipeline::world::scene::environment::place;

const TECHNIQUE: &str = "deferred-shadowing";

pub(super) const CLAIMS: &[Claim] = &[
    Claim::new(
        "tamura-precomputed-data",
        "Tamura et al. 2006, table 1",
        Verdict::Arithmetic,
        "precomputed self-shadow is 813 KB for 5,776 vertices and 1212 KB for 8,557",
        precomputed_data,
    ),
    Claim::new(
        "tamura-lights-and-maps",
        "Tamura et al. 2006, §7.1",
        Verdict::Counters,
        "quality depends on the size of occlusion maps rather than on the number of lights, of which 32 suffice",
        lights_and_maps,
    ),
    Claim::new(
        "tamura-transport-once",
        "Tamura et al. 2006, §3",
        Verdict::Arithmetic,
        "an object that moves or turns keeps its precomputed self-shadow",
        transport_once,
    ),
    Claim::quoted(
        "tamura-frame-rates",
        "Tamura et al. 2006, table 1",
        "30 frames a second for Venus and 25 for the trumpet on a GeForce 6800 GT",
    ),
    Claim::quoted(
        "tamura-precomputation-times",
        "Tamura et al. 2006, table 1",
        "85 s of precomputation for Venus and 109 s for the trumpet on a Pentium 4 of 3.2 GHz",
    ),
];

/// Transport of so many vertices that hide nothing.
fn bytes_of(vertices: usize) -> f64 {
    let object = TransportObject {
        positions: &vec![[0.0; 3]; vertices],
        normals: &vec![[0.0, 1.0, 0.0]; vertices],
        triangles: &[],
        casts: false,
    };
    let transport = Transport::new(&object, TransportSettings::default(), &|_| {});
    transport.diffuse_bytes() as f64
}

fn precomputed_data(_: &mut Lab) -> Result<Finding, ReproduceError> {
    const VENUS: usize = 5_776;
    const TRUMPET: usize = 8_557;
    let kib = |vertices| bytes_of(vertices) / 1024.0;
    let near = |theirs: f64| Theirs::Within(0.99 * theirs, 1.01 * theirs);
    Ok(Finding {
        scene: format!("{VENUS} and {TRUMPET} vertices"),
        counted: "bytes of 36 coefficients of four bytes a vertex".to_owned(),
        measures: vec![
            Measure::new(
                "bytes of Venus",
                Theirs::Exactly(831_744.0),
                bytes_of(VENUS),
                Unit::Bytes,
            ),
            Measure::new(
                "Venus, KiB (published: 813)",
                near(813.0),
                kib(VENUS),
                Unit::Number,
            ),
            Measure::new(
                "trumpet, KiB (published: 1212)",
                near(1212.0),
                kib(TRUMPET),
                Unit::Number,
            ),
        ],
        reason: "the published size of the trumpet is 0.7% more than its coefficients".to_owned(),
        charts: Vec::new(),
    })
}

/// Directions of the reference.
const DIRECTIONS: usize = 1024;
/// Largest picture without `--full`.
const SMALL: [u32; 2] = [128, 96];

/// The scene under the built-in sky, and the picture's size.
fn under_sky(lab: &Lab) -> Result<(Scene, Environment, [u32; 2]), ReproduceError> {
    let mut scene = scenes::knot_over_floor()?;
    let map = Environment::open(SKY, MapSettings::default())?;
    place(&mut scene, &map, map.fit(&FitSettings::default())?)?;
    let [width, height] = lab.size();
    let size = match lab.settings().full {
        true => [width, height],
        false => [width.min(SMALL[0]), height.min(SMALL[1])],
    };
    Ok((scene, map, size))
}

fn lights_and_maps(lab: &mut Lab) -> Result<Finding, ReproduceError> {
    quality(lab, [16, 32, 64], [32, 64, 128], DIRECTIONS)
}

fn quality(
    lab: &mut Lab,
    lights: [u32; 3],
    sizes: [u32; 3],
    directions: usize,
) -> Result<Finding, ReproduceError> {
    let (scene, map, size) = under_sky(lab)?;
    let mut errors = [[0.0; 3]; 3];
    let mut measures = Vec::new();
    for (i, lights) in lights.iter().enumerate() {
        for (j, side) in sizes.iter().enumerate() {
            let (lights, side) = (format!("lights={lights}"), format!("map-size={side}"));
            let set = [lights.clone(), side.clone(), "extent=region".to_owned()];
            let set = set.each_ref().map(|s| &**s);
            let done = lab.plain(&scene, TECHNIQUE, &set, size)?;
            let reference = lab.sky(&scene, &map, size, directions);
            let score = RadianceScore::measure(reference, &done)?;
            errors[i][j] = score.relative_rmse;
            let what = format!("{lights}, {side}: RMSE");
            measures.push(Measure::beside(what, "-", score.relative_rmse, Unit::Share));
        }
    }
    let maps = errors[1][0] - errors[1][2];
    let more_lights = errors[0][2] - errors[2][2];
    let suffice = errors[1][2] / errors[2][2];
    let row = |what: &str, theirs, ours| Measure::new(what, theirs, ours, Unit::Ratio);
    measures.push(row(
        "error gained by the largest maps over that by most lights",
        Theirs::AtLeast(1.0),
        maps / more_lights.abs().max(1e-6),
    ));
    measures.push(row(
        "error of the middle number of lights over that of most",
        Theirs::AtMost(1.1),
        suffice,
    ));
    let [width, height] = size;
    Ok(Finding {
        scene: format!("{} under the built-in sky, {width}x{height}", scene.name),
        counted: format!(
            "RMSE of linear light as a share of the mean of {directions} directions in proportion to the map's luminance with a shadow ray each"
        ),
        measures,
        reason: "under a sun, regions are far wider than it: what more lights gain is that they are narrower, while maps are already finer than their shadows are soft".to_owned(),
        charts: Vec::new(),
    })
}

fn transport_once(lab: &mut Lab) -> Result<Finding, ReproduceError> {
    let rest = scenes::knot_mesh()?;
    let list = rest.shading_vertices();
    let object = TransportObject {
        positions: &list.positions,
        normals: &list.normals,
        triangles: &list.triangles,
        casts: true,
    };
    let settings = TransportSettings {
        directions: 64,
        ..TransportSettings::default()
    };
    let [first, again] = [0, 1].map(|_| Transport::kept(&object, settings));
    let anew = if std::sync::Arc::ptr_eq(&first, &again) {
        0
    } else {
        again.rays
    };
    Ok(Finding {
        scene: lab.describe("a knot of 2,421 vertices in its own axes"),
        counted: "rays that are cast for a further frame".to_owned(),
        measures: vec![
            Measure::beside(
                "rays of the first frame",
                "-",
                first.rays as f64,
                Unit::Count,
            ),
            Measure::new(
                "rays of the next",
                Theirs::Exactly(0.0),
                anew as f64,
                Unit::Count,
            ),
        ],
        reason: "what was computed did not fit into what is kept".to_owned(),
        charts: Vec::new(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Judgement, LabSettings};

    #[test]
    fn precomputed_data_and_motion_hold() {
        let mut lab = Lab::new(LabSettings::default(), None);
        for finding in [precomputed_data(&mut lab), transport_once(&mut lab)] {
            let finding = finding.unwrap();
            assert_eq!(
                finding.judgement(),
                Judgement::Holds,
                "{:?}",
                finding.measures
            );
        }
        assert_ne!(bytes_of(5_775), 831_744.0);
    }

    #[test]
    fn quality_is_measured_for_every_pair() {
        let settings = LabSettings {
            size: [32, 24],
            repeat: 1,
            ..LabSettings::default()
        };
        let mut lab = Lab::new(settings, None);
        let finding = quality(&mut lab, [2, 4, 8], [8, 16, 32], 64).unwrap();
        assert_eq!(finding.measures.len(), 11);
        assert!(finding.measures.iter().all(|m| m.ours.is_finite()));
    }
}
