//! How far each way of finding and storing coverage drifts when silhouette edges are
//! cut into ever more collinear pieces, which changes nothing in truth.
//!
//! `cargo run --release -p gnomon --example subdivision -- FOLDER`
//!
//! writes `subdivision.csv` and plots of it into FOLDER: RMS and largest change
//! of visibility on the parallel plates from whole edges to m pieces each.

#![allow(clippy::print_stdout, reason = "a measurement prints")]

use std::error::Error;
use std::fmt::Write as _;
use std::path::Path;
use std::sync::Arc;

use glam::DVec3;
use gnomon::draw::plot;
use gnomon_claims::chart::{Axis, Chart, Series};
use gnomon_pipeline::measure::render::{RenderSettings, render};
use gnomon_pipeline::technique::Params;
use gnomon_pipeline::techniques::find;
use gnomon_pipeline::world::light::LightShape;
use gnomon_pipeline::world::mesh::Shading;
use gnomon_pipeline::world::scene::{Scene, builtin};
use gnomon_pipeline::world::shape::bevelled_plate_in_pieces;

const SIZE: [u32; 2] = [240, 160];
const PIECES: [u32; 7] = [1, 2, 4, 8, 16, 32, 64];
/// What smaller changes are shown as.
const FLOOR: f64 = 1e-8;

/// A back end: what it is called, technique, settings, and whether under a disc.
type BackEnd = (&'static str, &'static str, &'static [&'static str], bool);

const PAPER3: &str = "soft-shadow-volumes";
const PAPER4: &str = "soft-shadow-volumes-optimised";
const BACK_ENDS: &[BackEnd] = &[
    ("closed form, float", PAPER3, &[], false),
    ("4D texture, nearest", PAPER3, &["backend=texture4d"], false),
    (
        "4D texture, quadlinear, vertices",
        PAPER3,
        &[
            "backend=texture4d",
            "texture-filter=quadlinear",
            "texture-centred=vertex",
        ],
        false,
    ),
    (
        "closed form, 6 of 8 bits",
        PAPER3,
        &["buffer=rgba8x2"],
        false,
    ),
    ("closed form, 12 bits split", PAPER4, &[], false),
    ("split by map, 10 bits", PAPER4, &["split-bits=lut"], false),
    ("8-bit area map, 12 bits", PAPER4, &["coverage=lut"], false),
    (
        "16-bit area map (disc), 12 bits",
        PAPER4,
        &["coverage=lut"],
        true,
    ),
];

fn main() -> Result<(), Box<dyn Error>> {
    let folder = std::env::args().nth(1);
    let folder = folder.ok_or("the folder to write into is missing")?;
    let mut curves = Vec::new();
    for back_end in BACK_ENDS {
        curves.push((back_end.0, drifts(back_end)?));
    }
    std::fs::create_dir_all(&folder)?;
    let write = |name: &str, text: String| std::fs::write(Path::new(&folder).join(name), text);
    write("subdivision.csv", csv(&curves))?;
    for chart in [chart(&curves, 1, "largest"), chart(&curves, 0, "RMS")] {
        write(&format!("{}.svg", chart.name), plot::svg(&chart))?;
    }
    Ok(())
}

/// The plates with each edge of the plate in `pieces`, under their square or a disc.
fn plates(pieces: u32, disc: bool) -> Result<Scene, Box<dyn Error>> {
    let mut scene = builtin::build("parallel-plates")?;
    let plate = bevelled_plate_in_pieces(0.3, 1.0, 0.01, 1.6, pieces);
    scene.objects[1].mesh = Arc::new(plate.into_mesh(Shading::Flat)?);
    if disc {
        scene.lights[0].shape = LightShape::Disc {
            centre: DVec3::Y * 3.0,
            normal: DVec3::NEG_Y,
            radius: 0.5,
        };
    }
    Ok(scene)
}

/// RMS and largest change for each number of pieces but 1.
fn drifts((name, technique, set, disc): &BackEnd) -> Result<Vec<[f64; 2]>, Box<dyn Error>> {
    let technique = find(technique)?;
    let params = Params::parse(technique, set.iter().copied())?;
    let settings = RenderSettings {
        size: SIZE,
        ..RenderSettings::default()
    };
    let picture = |pieces: u32| -> Result<Vec<f32>, Box<dyn Error>> {
        Ok(render(&plates(pieces, *disc)?, technique, &params, &settings)?.visibility)
    };
    let whole = picture(PIECES[0])?;
    let mut all = Vec::new();
    for m in &PIECES[1..] {
        let cut = picture(*m)?;
        let changes = whole.iter().zip(&cut).filter(|(v, _)| !v.is_nan());
        let changes: Vec<f64> = changes.map(|(a, b)| f64::from((a - b).abs())).collect();
        let squares: f64 = changes.iter().map(|c| c * c).sum();
        let largest = changes.iter().copied().fold(0.0, f64::max);
        let rms = (squares / changes.len() as f64).sqrt();
        println!("{name}, {m} pieces: RMS {rms:.2e}, largest {largest:.2e}");
        all.push([rms, largest]);
    }
    Ok(all)
}

fn csv(curves: &[(&str, Vec<[f64; 2]>)]) -> String {
    let mut text = "back end,pieces,RMS,largest\n".to_owned();
    for (name, drifts) in curves {
        for (m, [rms, largest]) in PIECES[1..].iter().zip(drifts) {
            let _ = writeln!(text, "\"{name}\",{m},{rms:.6e},{largest:.6e}");
        }
    }
    text
}

fn chart(curves: &[(&str, Vec<[f64; 2]>)], figure: usize, what: &str) -> Chart {
    let series = |(name, drifts): &(&str, Vec<[f64; 2]>)| {
        let pieces = PIECES[1..].iter().map(|m| f64::from(*m));
        let points = pieces
            .zip(drifts)
            .map(|(m, drift)| [m, drift[figure].max(FLOOR)]);
        Series::line(name, points.collect())
    };
    Chart {
        name: format!("subdivision-{}", what.to_lowercase()),
        title: format!("{what} change of visibility over pieces of each edge"),
        x: Axis::log2("pieces"),
        y: Axis::log10("change, 1e-8 where it is less"),
        series: curves.iter().map(series).collect(),
    }
}
