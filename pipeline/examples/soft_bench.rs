//! Times a soft-shadowed frame of the peer scenes, counting on, and measures its
//! error against the exact oracle: our side of `docs/performance/beside-embree.sh`.
//!
//! `cargo run --release -p gnomon-pipeline --example soft_bench -- [--scenes abc] [--size 512]
//! [--technique NAME] [--set key=value,...] [--budget SECONDS] [--threads N] [--json FILE] [--npy FOLDER] [--errors on|off]`
//!
//! Without errors (for profiles) there is nothing of the oracle in the run.
//!
//! A frame is what the technique submits: everything but loading the scene, and
//! finding silhouettes and building wedges, whose time is printed beside it. As
//! among the peers, the light is seen by all surfaces and errors are over all pixels
//! that show one.

#![allow(clippy::print_stdout, reason = "a benchmark prints")]

use std::error::Error;
use std::fmt::Write as _;
use std::time::{Duration, Instant};

use gnomon_pipeline::measure::comparison::{Reference, ReferenceKind};
use gnomon_pipeline::measure::render::{RenderSettings, render};
use gnomon_pipeline::technique::{Params, Technique};
use gnomon_pipeline::techniques;
use gnomon_pipeline::truth::metrics::visibility::{ErrorSummary, VisibilityError};
use gnomon_pipeline::truth::oracle::area::LightRegion;
use gnomon_pipeline::world::scene::{Scene, builtin};
use gnomon_raster::{Gpu, GpuConfig, SubmitReport};

struct Options {
    config: GpuConfig,
    scenes: String,
    size: u32,
    technique: &'static dyn Technique,
    set: Vec<String>,
    budget: Duration,
    json: Option<String>,
    npy: Option<String>,
    errors: bool,
}

fn main() -> Result<(), Box<dyn Error>> {
    let options = options()?;
    let mut rows = Vec::new();
    for name in options.scenes.chars() {
        let scene = builtin::build(&format!("peer-{name}"))?;
        rows.push(measure_scene(&options, &scene, name)?);
    }
    if let Some(path) = &options.json {
        std::fs::write(path, format!("[{}]\n", rows.join(",\n")))?;
    }
    Ok(())
}

fn options() -> Result<Options, Box<dyn Error>> {
    let mut o = Options {
        config: GpuConfig::default(),
        scenes: "abc".into(),
        size: 512,
        technique: techniques::find("soft-shadow-volumes")?,
        set: Vec::new(),
        budget: Duration::from_secs(3),
        json: None,
        npy: None,
        errors: true,
    };
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    for pair in arguments.chunks(2) {
        let [key, value] = pair else {
            return Err(format!("{} needs a value", pair[0]).into());
        };
        match key.as_str() {
            "--threads" => o.config.threads = value.parse()?,
            "--scenes" => o.scenes = value.to_lowercase(),
            "--size" => o.size = value.parse()?,
            "--technique" => o.technique = techniques::find(value)?,
            "--set" => o.set = value.split(',').map(str::to_owned).collect(),
            "--budget" => o.budget = Duration::from_secs_f64(value.parse()?),
            "--json" => o.json = Some(value.clone()),
            "--npy" => o.npy = Some(value.clone()),
            "--errors" => o.errors = value == "on",
            _ => return Err(format!("unknown option {key}").into()),
        }
    }
    Ok(o)
}

fn measure_scene(o: &Options, scene: &Scene, name: char) -> Result<String, Box<dyn Error>> {
    let params = Params::parse(o.technique, &o.set)?;
    let size = [o.size; 2];
    let mut gpu = Gpu::new(o.config)?;
    let start = Instant::now();
    let frame = o.technique.frame(scene, size, &params)?;
    gpu.load(&frame.recording)?;
    let build_ms = start.elapsed().as_secs_f64() * 1e3;
    gpu.submit(&frame.recording.list)?;
    let (mut times, mut report) = (Vec::new(), SubmitReport::default());
    let mut spent = Duration::ZERO;
    while times.len() < 5 || spent < o.budget {
        let start = Instant::now();
        report = gpu.submit(&frame.recording.list)?;
        spent += start.elapsed();
        times.push(start.elapsed().as_secs_f64() * 1e3);
    }
    times.sort_by(f64::total_cmp);
    let at = |share: usize| times[(times.len() - 1) * share / 4];
    let (all, penumbra) = if o.errors {
        let error = errors(o, scene, &params, name)?;
        let penumbra = error.of_region(LightRegion::Penumbra);
        (error.all, penumbra.map_or(0.0, |e| e.rmse))
    } else {
        (ErrorSummary::of(&[0.0]), 0.0)
    };
    let all = all.ok_or("no pixels to compare")?;
    println!(
        "{} {}: frame {:.3} ms [{:.3}, {:.3}, min {:.3}, n {}], set-up {build_ms:.3} ms, RMSE {:.5}, penumbra RMSE {penumbra:.5}",
        name.to_uppercase(),
        o.size,
        at(2),
        at(1),
        at(3),
        times[0],
        times.len(),
        all.rmse,
    );
    let mut passes = String::new();
    for pass in &report.passes {
        let ms = pass.time.as_secs_f64() * 1e3;
        println!("   {:9} {ms:8.3} ms", pass.label);
        let _ = write!(
            passes,
            "{}[\"{}\",{ms}]",
            if passes.is_empty() { "" } else { "," },
            pass.label
        );
    }
    Ok(format!(
        "{{\"scene\":\"{}\",\"size\":{},\"technique\":\"{}\",\"threads\":{},\"median\":{},\"q1\":{},\"q3\":{},\"min\":{},\"n\":{},\"build_ms\":{build_ms},\"rmse\":{},\"rmse_penumbra\":{penumbra},\"max\":{},\"p99\":{},\"passes\":[{passes}]}}",
        name.to_uppercase(),
        o.size,
        o.technique.name(),
        gpu.threads(),
        at(2),
        at(1),
        at(3),
        times[0],
        times.len(),
        all.rmse,
        all.max,
        all.p99,
    ))
}

/// Errors against the oracle, outlines within 1/128 pixel left out.
fn errors(
    o: &Options,
    scene: &Scene,
    params: &Params,
    name: char,
) -> Result<VisibilityError, Box<dyn Error>> {
    let settings = RenderSettings {
        size: [o.size; 2],
        gpu: o.config,
        repeat: 1,
    };
    let done = render(scene, o.technique, params, &settings)?;
    let truth = Reference::new(scene, 0, settings.size, ReferenceKind::Exact, None, &|| ())?;
    let under = truth.under(&done.depth)?;
    if let Some(folder) = &o.npy {
        let path = format!("{folder}/truth_{}_{}.f32", name.to_uppercase(), o.size);
        let bytes = under
            .truth
            .values
            .iter()
            .flat_map(|v| (*v as f32).to_le_bytes());
        std::fs::write(path, bytes.collect::<Vec<u8>>())?;
    }
    let pairs = done.visibility.iter().zip(&under.truth.values);
    let seen: Vec<f32> = pairs
        .map(|(v, t)| if t.is_nan() { f32::NAN } else { *v })
        .collect();
    Ok(VisibilityError::measure(
        &under.truth,
        settings.size,
        &seen,
    )?)
}
