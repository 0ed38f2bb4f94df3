//! Where techniques break down: their error against the exact oracle on one scene
//! in ever larger and smaller units, and ever further from the origin.
//!
//! `cargo run --release -p gnomon --example breakdown -- FOLDER [SCENE]`
//!
//! writes `breakdown.csv`, `breakdown-scale.svg` and `breakdown-offset.svg` into FOLDER; SCENE is
//! `parallel-plates` unless given, where geometry is no source of error. Truth is that
//! of the same positions, rounded to f32 where they come to lie, so what is measured is
//! the technique and not the model.

#![allow(clippy::print_stdout, reason = "a measurement prints")]

use std::error::Error;
use std::fmt::Write as _;
use std::path::Path;

use glam::DVec3;
use gnomon::draw::plot;
use gnomon_claims::chart::{Axis, Chart, Series};
use gnomon_pipeline::measure::comparison::{Reference, ReferenceKind};
use gnomon_pipeline::measure::render::{RenderSettings, render};
use gnomon_pipeline::technique::{Params, Technique};
use gnomon_pipeline::techniques;
use gnomon_pipeline::truth::metrics::visibility::VisibilityError;
use gnomon_pipeline::world::scene::{Scene, builtin};

const SIZE: [u32; 2] = [240, 160];

/// Which way the scene goes.
const AWAY: DVec3 = DVec3::new(1.0, 0.5, -0.75);

/// What smaller errors are shown as.
const FLOOR: f64 = 1e-8;

/// Exponents of ten of what is varied, in quarters.
const SCALES: std::ops::RangeInclusive<i32> = -60..=64;
const OFFSETS: std::ops::RangeInclusive<i32> = 0..=26;

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let folder = arguments
        .next()
        .ok_or("the folder to write into is missing")?;
    let scene = builtin::build(&arguments.next().unwrap_or_else(|| "parallel-plates".into()))?;
    let curves = [
        curve("scale", &scene, SCALES.step_by(4), |s| (s, DVec3::ZERO)),
        curve("offset", &scene, OFFSETS.step_by(2), |d| (1.0, AWAY * d)),
    ];
    std::fs::create_dir_all(&folder)?;
    let write = |name: &str, text: String| std::fs::write(Path::new(&folder).join(name), text);
    write("breakdown.csv", csv(&curves))?;
    for chart in curves.iter().map(chart) {
        write(&format!("{}.svg", chart.name), plot::svg(&chart))?;
    }
    Ok(())
}

/// RMSE of each technique over one variable.
struct Curve {
    variable: &'static str,
    /// The variable's value, the share of pixels compared, and RMSE per technique;
    /// `None` where it gives no picture.
    points: Vec<(f64, f64, Vec<Option<f64>>)>,
}

fn curve(
    variable: &'static str,
    scene: &Scene,
    quarters: impl Iterator<Item = i32>,
    place: impl Fn(f64) -> (f64, DVec3),
) -> Curve {
    let point = |quarter: i32| {
        let value = libm::pow(10.0, f64::from(quarter) / 4.0);
        let (scale, offset) = place(value);
        let (share, errors) = errors(scene, scale, offset);
        let shown: Vec<_> = errors
            .iter()
            .map(|e| e.map_or("-".into(), |e| format!("{e:.1e}")))
            .collect();
        println!("{variable} {value:8.1e}: {}", shown.join(" "));
        (value, share, errors)
    };
    Curve {
        variable,
        points: quarters.map(point).collect(),
    }
}

/// The share of pixels that truth and pictures have in common, at worst, and RMSE.
fn errors(scene: &Scene, scale: f64, offset: DVec3) -> (f64, Vec<Option<f64>>) {
    let none = || (0.0, vec![None; techniques::all().len()]);
    let Ok(placed) = scene.placed(scale, offset) else {
        return none();
    };
    let Ok(truth) = Reference::new(&placed, 0, SIZE, ReferenceKind::Exact, None, &|| ()) else {
        return none();
    };
    let mut least = 1.0_f64;
    let mut of = |technique: &dyn Technique| {
        let settings = RenderSettings {
            size: SIZE,
            ..RenderSettings::default()
        };
        let done = render(&placed, technique, &Params::defaults(technique), &settings).ok()?;
        // Left out on both sides where the truth has nothing to say: outlines.
        let under = truth.under(&done.depth).ok()?;
        let pairs = done.visibility.iter().zip(&under.truth.values);
        let seen: Vec<f32> = pairs
            .map(|(v, t)| if t.is_nan() { f32::NAN } else { *v })
            .collect();
        let error = VisibilityError::measure(&under.truth, SIZE, &seen).ok()?;
        let all = error.all?;
        let surfaces = done.visibility.iter().filter(|v| !v.is_nan()).count();
        least = least.min(all.pixels as f64 / surfaces as f64);
        Some(all.rmse)
    };
    let errors = techniques::all().iter().map(|t| of(*t)).collect();
    (least, errors)
}

fn csv(curves: &[Curve]) -> String {
    let names: Vec<_> = techniques::all().iter().map(|t| t.name()).collect();
    let mut text = format!("variable,value,pixels compared,{}\n", names.join(","));
    for curve in curves {
        for (value, share, errors) in &curve.points {
            let _ = write!(text, "{},{value:.6e},{share:.4}", curve.variable);
            for error in errors {
                match error {
                    Some(e) => _ = write!(text, ",{e:.6e}"),
                    None => text.push(','),
                }
            }
            text.push('\n');
        }
    }
    text
}

/// A line for each technique, interrupted where it gives no picture.
fn chart(curve: &Curve) -> Chart {
    let series = |k: usize| {
        let error = |e: Option<f64>| e.map_or(f64::NAN, |e| e.max(FLOOR));
        let points = curve.points.iter().map(|p| [p.0, error(p.2[k])]);
        Series::line(techniques::all()[k].name(), points.collect())
    };
    Chart {
        name: format!("breakdown-{}", curve.variable),
        title: format!("RMSE of visibility over {}", curve.variable),
        x: Axis::log10(curve.variable),
        y: Axis::log10("RMSE, 1e-8 where it is less"),
        series: (0..techniques::all().len()).map(series).collect(),
    }
}
