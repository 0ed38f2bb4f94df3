//! Times hard shadow volumes on peer scenes A, B and C: the whole frame and the
//! stencil pass alone, counting on, in the manner of the peers'
//! `gl_shadow_volumes.py` (same passes, formats, shading and colours).
//!
//! `cargo run --release -p gnomon-pipeline --example peer_bench -- [--threads N] [--simd LEVEL] [--tile N]
//! [--scenes abc] [--sizes 512,1024] [--frames N] [--budget SECONDS] [--json FILE]`
//!
//! `--levels sse2,avx2` times whole frames in `rgba16f` beside `rgba8` at these SIMD levels
//! instead, in turn, and prints the ratio of the shortest times, which other work on the
//! machine disturbs least.

#![allow(clippy::print_stdout, reason = "a benchmark prints")]

use std::error::Error;
use std::fmt::Write as _;
use std::time::{Duration, Instant};

use gnomon_pipeline::geometry::volume::ShadowVolume;
use gnomon_pipeline::technique::Params;
use gnomon_pipeline::techniques;
use gnomon_pipeline::world::adjacency::EdgeAdjacency;
use gnomon_pipeline::world::scene::{Material, Scene, builtin};
use gnomon_raster::{CommandList, Gpu, GpuConfig, SimdLevel, SubmitReport, Subresource};
use sha2::{Digest, Sha256};

struct Options {
    config: GpuConfig,
    scenes: String,
    sizes: Vec<u32>,
    frames: usize,
    budget: Duration,
    json: Option<String>,
    /// Compare colour formats at these levels.
    levels: Vec<SimdLevel>,
}

fn main() -> Result<(), Box<dyn Error>> {
    let options = options()?;
    if !options.levels.is_empty() {
        return compare_formats(&options);
    }
    let threads = Gpu::new(options.config)?.threads();
    let simd = options.config.simd;
    println!(
        "gnomon | simd {simd} | threads {threads} | tile {} | ms: median [q1, q3, min, n]",
        options.config.tile
    );
    let mut rows = Vec::new();
    for name in options.scenes.chars() {
        let scene = peer_scene(name)?;
        for &size in &options.sizes {
            rows.push(measure_scene(&options, &scene, name, size, threads)?);
        }
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
        sizes: vec![512, 1024],
        frames: 200,
        budget: Duration::from_secs(4),
        json: None,
        levels: Vec::new(),
    };
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    for pair in arguments.chunks(2) {
        let [key, value] = pair else {
            return Err(format!("{} needs a value", pair[0]).into());
        };
        match key.as_str() {
            "--threads" => o.config.threads = value.parse()?,
            "--simd" => o.config.simd = value.parse()?,
            "--tile" => o.config.tile = value.parse()?,
            "--scenes" => o.scenes = value.to_lowercase(),
            "--sizes" => o.sizes = value.split(',').map(str::parse).collect::<Result<_, _>>()?,
            "--frames" => o.frames = value.parse()?,
            "--budget" => o.budget = Duration::from_secs_f64(value.parse()?),
            "--levels" => o.levels = value.split(',').map(str::parse).collect::<Result<_, _>>()?,
            "--json" => o.json = Some(value.clone()),
            _ => return Err(format!("unknown option {key}").into()),
        }
    }
    Ok(o)
}

/// A peer scene with the peers' colours.
fn peer_scene(name: char) -> Result<Scene, Box<dyn Error>> {
    let mut scene = builtin::build(&format!("peer-{name}"))?;
    scene.ambient = [0.25; 3];
    scene.background = [0.05, 0.07, 0.12];
    scene.lights[0].colour = [0.75; 3];
    scene.objects[0].material = Material::matt([0.55, 0.60, 0.50]);
    scene.objects[1].material = Material::matt([0.85, 0.45, 0.25]);
    Ok(scene)
}

/// As the peers draw, in a colour format.
fn params(color_format: &str) -> [&str; 4] {
    let format = match color_format {
        "rgba16f" => "color-format=rgba16f",
        _ => "color-format=rgba8",
    };
    ["method=zfail", "skip=off", "depth-format=d24", format]
}

/// Shortest times of frames in `rgba16f` and in `rgba8`, and their ratio.
fn compare_formats(options: &Options) -> Result<(), Box<dyn Error>> {
    println!("level  scene size    rgba8  rgba16f ms  ratio    first pass: ratio");
    for &simd in &options.levels {
        for name in options.scenes.chars() {
            let scene = peer_scene(name)?;
            for &size in &options.sizes {
                let config = GpuConfig {
                    simd,
                    ..options.config
                };
                let [[a, a_first], [b, b_first]] = shortest(options, config, &scene, size)?;
                println!(
                    "{:<6} {:<5} {size:4} {a:8.3} {b:8.3}     {:.3}    {a_first:8.3} {b_first:8.3}  {:.3}",
                    simd.name(),
                    name.to_uppercase(),
                    b / a,
                    b_first / a_first
                );
            }
        }
    }
    Ok(())
}

/// Shortest milliseconds of a frame and of its first pass, in `rgba8` and in `rgba16f`,
/// one after the other in turn.
fn shortest(
    options: &Options,
    config: GpuConfig,
    scene: &Scene,
    size: u32,
) -> Result<[[f64; 2]; 2], Box<dyn Error>> {
    let technique = techniques::find("shadow-volumes")?;
    let mut sides = Vec::new();
    for format in ["rgba8", "rgba16f"] {
        let mut gpu = Gpu::new(config)?;
        let params = Params::parse(technique, params(format))?;
        let frame = technique.frame(scene, [size; 2], &params)?;
        gpu.load(&frame.recording)?;
        sides.push((gpu, frame.recording.list));
    }
    let mut least = [[f64::INFINITY; 2]; 2];
    let end = Instant::now() + options.budget;
    for round in 0.. {
        if round >= 10 && (round >= options.frames || Instant::now() >= end) {
            break;
        }
        for ((gpu, list), least) in sides.iter_mut().zip(&mut least) {
            let start = Instant::now();
            let report = gpu.submit(list)?;
            let whole = start.elapsed().as_secs_f64();
            for (least, time) in least
                .iter_mut()
                .zip([whole, report.passes[0].time.as_secs_f64()])
            {
                *least = least.min(time * 1e3);
            }
        }
    }
    Ok(least)
}

fn measure_scene(
    options: &Options,
    scene: &Scene,
    name: char,
    size: u32,
    threads: usize,
) -> Result<String, Box<dyn Error>> {
    let technique = techniques::find("shadow-volumes")?;
    let params = Params::parse(technique, params("rgba8"))?;
    let mut gpu = Gpu::new(options.config)?;
    let start = Instant::now();
    let frame = technique.frame(scene, [size; 2], &params)?;
    gpu.load(&frame.recording)?;
    let build_ms = start.elapsed().as_secs_f64() * 1e3;
    let part = |i: usize| CommandList {
        passes: vec![frame.recording.list.passes[i].clone()],
    };
    let (ambient, volumes) = (part(0), part(1));

    let (whole, report) = measure(&mut gpu, options, None, &frame.recording.list)?;
    let stencil = gpu
        .texture(frame.outputs.depth_stencil)?
        .read_stencil(Subresource::default())?;
    let (pass, _) = measure(&mut gpu, options, Some(&ambient), &volumes)?;

    let counted = report.passes[1].totals();
    let (fragments, failed) = (counted.fragments.generated, counted.fragments.depth_failed);
    let shadowed = stencil.iter().filter(|s| **s != 0).count();
    let most = stencil.iter().max().copied().unwrap_or(0);
    let rate = fragments as f64 / pass.median / 1e3;
    let passes: Vec<String> = report
        .passes
        .iter()
        .map(|p| format!("{} {:.3}", p.label, p.time.as_secs_f64() * 1e3))
        .collect();
    println!(
        "{} {size:4}  frame {whole}   last: {}",
        name.to_uppercase(),
        passes.join(", ")
    );
    println!("        volume pass {pass}");
    println!(
        "        {fragments} fragments ({failed} fail depth), {rate:.1} Mfragment/s, {shadowed} shadowed pixels, \
         max stencil {most}, {} volume triangles, tiles {}/{} accepted, built in {build_ms:.1} ms",
        counted.primitives.input, counted.tiles.accepted, counted.tiles.tested
    );
    let mut row = String::new();
    write!(
        row,
        r#"{{"driver":"gnomon","simd":"{}","threads":{threads},"scene":"{}","size":{size},"frame":{},"volume":{},"fragments":{fragments},"depth_fail":{failed},"mfrag_s":{rate},"shadowed_pixels":{shadowed},"stencil_max":{most},"volume_triangles":{},"digests":{:?}}}"#,
        options.config.simd,
        name.to_uppercase(),
        whole.json(),
        pass.json(),
        counted.primitives.input,
        digests(scene)
    )?;
    Ok(row)
}

/// Of receiver, caster and volume, as the peers' `scenes.py` makes them.
fn digests(scene: &Scene) -> [String; 3] {
    let [receiver, caster] = [0, 1].map(|i| &*scene.objects[i].mesh);
    let adjacency = EdgeAdjacency::new(caster.triangles());
    let volume = ShadowVolume::of_closed(caster, &adjacency, scene.lights[0].hard());
    [
        digest(receiver.positions(), receiver.triangles()),
        digest(caster.positions(), caster.triangles()),
        digest(volume.positions(), volume.triangles()),
    ]
}

/// First 16 hex digits of SHA-256 over vertices, then indices, little endian.
fn digest<const N: usize>(vertices: &[[f32; N]], triangles: &[[u32; 3]]) -> String {
    let mut hash = Sha256::new();
    for x in vertices.iter().flatten() {
        hash.update(x.to_le_bytes());
    }
    for i in triangles.iter().flatten() {
        hash.update(i.to_le_bytes());
    }
    let bytes = hash.finalize();
    bytes[..8].iter().map(|b| format!("{b:02x}")).collect()
}

/// Times of `timed` in milliseconds, each after an untimed `before`.
fn measure(
    gpu: &mut Gpu,
    options: &Options,
    before: Option<&CommandList>,
    timed: &CommandList,
) -> Result<(Spread, SubmitReport), Box<dyn Error>> {
    let mut times = Vec::new();
    let mut last = SubmitReport::default();
    let end = Instant::now() + options.budget;
    let warm_up = 3;
    while times.len() < 20 + warm_up
        || (times.len() < options.frames + warm_up && Instant::now() < end)
    {
        if let Some(list) = before {
            gpu.submit(list)?;
        }
        let start = Instant::now();
        last = gpu.submit(timed)?;
        times.push(start.elapsed().as_secs_f64() * 1e3);
    }
    times.drain(..warm_up);
    Ok((Spread::of(times), last))
}

/// Quartiles of times in milliseconds.
struct Spread {
    median: f64,
    q1: f64,
    q3: f64,
    min: f64,
    n: usize,
}

impl Spread {
    fn of(mut times: Vec<f64>) -> Self {
        times.sort_by(f64::total_cmp);
        let at = |share: usize| times[(times.len() - 1) * share / 4];
        Self {
            median: at(2),
            q1: at(1),
            q3: at(3),
            min: at(0),
            n: times.len(),
        }
    }

    fn json(&self) -> String {
        let Self {
            median,
            q1,
            q3,
            min,
            n,
        } = self;
        format!(r#"{{"median":{median},"q1":{q1},"q3":{q3},"min":{min},"n":{n}}}"#)
    }
}

impl std::fmt::Display for Spread {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self {
            median,
            q1,
            q3,
            min,
            n,
        } = self;
        write!(f, "{median:.3} [{q1:.3}, {q3:.3}, {min:.3}, {n}]")
    }
}
