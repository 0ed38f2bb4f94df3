//! Where techniques break down: their error against the exact oracle on one scene
//! in ever larger and smaller units, and ever further from the origin.
//!
//! `cargo run --release -p gnomon-pipeline --example breakdown -- FOLDER [SCENE]`
//!
//! writes `breakdown.csv` and `breakdown.svg` into FOLDER; SCENE is
//! `parallel-plates` unless given, where geometry is no source of error. Truth is that of the same positions, rounded to f32 where they
//! come to lie, so what is measured is the technique and not the model.

#![allow(clippy::print_stdout, reason = "a measurement prints")]

use std::error::Error;
use std::fmt::Write as _;
use std::path::Path;

use glam::DVec3;
use gnomon_pipeline::comparison::{Reference, ReferenceKind};
use gnomon_pipeline::metrics::visibility::VisibilityError;
use gnomon_pipeline::render::{RenderSettings, render};
use gnomon_pipeline::scene::{Scene, builtin};
use gnomon_pipeline::technique::{Params, Technique, techniques};

const SIZE: [u32; 2] = [240, 160];

/// Which way the scene goes.
const AWAY: DVec3 = DVec3::new(1.0, 0.5, -0.75);

/// The least RMSE that the plot shows.
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
    write("breakdown.svg", svg(&curves))?;
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
    let none = || (0.0, vec![None; techniques().len()]);
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
    let errors = techniques().iter().map(|t| of(*t)).collect();
    (least, errors)
}

fn csv(curves: &[Curve]) -> String {
    let names: Vec<_> = techniques().iter().map(|t| t.name()).collect();
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

/// Plot of one curve after the other, both axes logarithmic.
fn svg(curves: &[Curve]) -> String {
    let (width, height) = (860, 360 * curves.len() + 20);
    let mut text = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" \
         font-family=\"sans-serif\" font-size=\"12\">\n\
         <rect width=\"{width}\" height=\"{height}\" fill=\"#fff\"/>\n"
    );
    for (k, curve) in curves.iter().enumerate() {
        plot(&mut text, curve, 360.0 * k as f64);
    }
    text + "</svg>\n"
}

/// Left, right, top and bottom of a plot's frame.
const FRAME: [f64; 4] = [70.0, 590.0, 40.0, 310.0];

fn plot(text: &mut String, curve: &Curve, down: f64) {
    let [left, right, top, bottom] = [FRAME[0], FRAME[1], FRAME[2] + down, FRAME[3] + down];
    let decade = libm::log10;
    let value = |at: usize| curve.points.get(at).map_or(1.0, |p| p.0);
    let (low, high) = (decade(value(0)), decade(value(curve.points.len() - 1)));
    let x = |v: f64| left + (right - left) * (decade(v) - low) / (high - low);
    let y = |e: f64| top - (bottom - top) * decade(e.max(FLOOR)) / -decade(FLOOR);
    let _ = writeln!(
        text,
        "<text x=\"{left}\" y=\"{}\" font-size=\"14\">RMSE of visibility over {}</text>",
        top - 14.0,
        curve.variable
    );
    for exponent in (decade(FLOOR) as i32)..=0 {
        let at = y(libm::pow(10.0, f64::from(exponent)));
        let _ = writeln!(
            text,
            "<path d=\"M{left} {at:.1}H{right}\" stroke=\"#ddd\"/>\
             <text x=\"{}\" y=\"{:.1}\" text-anchor=\"end\">1e{exponent}</text>",
            left - 6.0,
            at + 4.0
        );
    }
    let step = if high - low > 20.0 { 6 } else { 1 };
    for exponent in (low.ceil() as i32..=high as i32).step_by(step) {
        let at = x(libm::pow(10.0, f64::from(exponent)));
        let _ = writeln!(
            text,
            "<path d=\"M{at:.1} {top}V{bottom}\" stroke=\"#ddd\"/>\
             <text x=\"{at:.1}\" y=\"{}\" text-anchor=\"middle\">1e{exponent}</text>",
            bottom + 18.0
        );
    }
    for (k, technique) in techniques().iter().enumerate() {
        let place = [x(value(0)), right + 16.0, top + 18.0 * k as f64 + 10.0];
        line(text, curve, k, &x, &y);
        let _ = writeln!(
            text,
            "<path d=\"M{} {}h18\" stroke=\"{}\" stroke-width=\"2\"{}/>\
             <text x=\"{}\" y=\"{}\">{}</text>",
            place[1],
            place[2] - 4.0,
            colour(k),
            dashes(k),
            place[1] + 24.0,
            place[2],
            technique.name()
        );
    }
}

/// One technique's line, interrupted where it gives no picture.
fn line(
    text: &mut String,
    curve: &Curve,
    k: usize,
    x: &impl Fn(f64) -> f64,
    y: &impl Fn(f64) -> f64,
) {
    let mut path = String::new();
    let mut pen_down = false;
    for (value, _, errors) in &curve.points {
        if let Some(error) = errors[k] {
            let command = if pen_down { 'L' } else { 'M' };
            let _ = write!(path, "{command}{:.1} {:.1}", x(*value), y(error));
        }
        pen_down = errors[k].is_some();
    }
    let _ = writeln!(
        text,
        "<path d=\"{path}\" fill=\"none\" stroke=\"{}\" stroke-width=\"2\"{}/>",
        colour(k),
        dashes(k)
    );
}

/// Colours that colour-blind people can tell apart (Okabe and Ito, 2008).
fn colour(k: usize) -> &'static str {
    const COLOURS: [&str; 8] = [
        "#000000", "#e69f00", "#56b4e9", "#009e73", "#0072b2", "#d55e00", "#cc79a7", "#999999",
    ];
    COLOURS[k % COLOURS.len()]
}

/// Every other line is dashed: where two lie on each other, both are seen.
fn dashes(k: usize) -> &'static str {
    match k % 2 {
        0 => "",
        _ => " stroke-dasharray=\"6 4\"",
    }
}
